"""How often `sahl profile --ab` is wrong: `bench/run alarms`.

Alarms: both sides have the same kernels, so that each row that is called faster or slower is a false alarm. Findings: on
the other side the intersect kernel traces every twentieth group of rays twice, 5 % more work, and has to be called slower.
Runs of both kinds take turns.
"""

import argparse
import json
import pathlib
import shutil
import tempfile

from measure import ROOT, SAHL, Run, fail, machine_facts, write_report

KERNEL = "intersect_packet.cl"
WORK = """        Packet packet;
        load_packet(&packet, rays, ray_ids, capacity, first, count);
        intersect_packet_of_rays(&bvh, &packet);
        store_packet(&packet, hits, hit_ids, capacity, first, count);
"""
SLOWED = "        for (uint twice = (uint)get_global_id(0) % 20u == 0u ? 2u : 1u; twice > 0u; --twice) {\n" + WORK + "        }\n"


def slow_kernels(folder):
    """A copy of kernels/ whose intersect kernel does 5 % more."""
    shutil.copytree(ROOT / "kernels", folder)
    file = folder / KERNEL
    text = file.read_text()
    if text.count(WORK) != 1:
        fail(f"{file.name} is not as bench/alarms.py knows it: the slowdown cannot be put in")
    file.write_text(text.replace(WORK, SLOWED))


def compare(options, base, other):
    """The rows of one comparison, by name."""
    run = Run([SAHL, "profile", options.scene, "--size", options.size, "--repeat", options.pairs, "--json", "-q", "--ab",
               f"SAHL_KERNEL_DIR={base}", f"SAHL_KERNEL_DIR={other}"])
    event = next(event for event in map(json.loads, run.output.splitlines()) if event["event"] == "profile_diff")
    rows = {}
    for row in event["rows"]:
        generation = "" if row["generation"] is None else f"/{row['generation']}"
        rows[row["kernel"] + generation] = row
    return rows


def differing(rows):
    return [name for name, row in rows.items() if row["verdict"] in ("faster", "slower")]


def main():
    parser = argparse.ArgumentParser(prog="bench/run alarms", description="False alarms and findings of sahl profile --ab.")
    parser.add_argument("--runs", type=int, default=100, help="of each kind (default: 100)")
    parser.add_argument("--pairs", type=int, default=30, help="of frames in a run (default: 30)")
    parser.add_argument("--scene", default=str(ROOT / "scenes" / "whitted.json"))
    parser.add_argument("--size", default="256x256")
    parser.add_argument("--json", metavar="FILE", help="the report as JSON")
    options = parser.parse_args()

    report = {"machine": machine_facts(), "scene": pathlib.Path(options.scene).name, "size": options.size,
              "pairs": options.pairs, "runs": []}
    alarms = findings = 0
    with tempfile.TemporaryDirectory() as folder:
        slow = pathlib.Path(folder) / "kernels"
        slow_kernels(slow)
        same = ROOT / "kernels"
        for number in range(options.runs):
            wrong = differing(compare(options, same, same))
            found = compare(options, same, slow)["intersect"]
            alarms += bool(wrong)
            findings += found["verdict"] == "slower"
            report["runs"].append({"alarms": wrong, "intersect": found})
            print(f"{number + 1:3} runs: {alarms} false alarms, {findings} findings; intersect {found['ratio']:.3f} "
                  f"({found['ratio_low']:.3f} to {found['ratio_high']:.3f}){' alarm: ' + ', '.join(wrong) if wrong else ''}",
                  flush=True)
    report.update(false_alarms=alarms, findings=findings)
    facts = report["machine"]
    print(f"{facts['processor']}, {facts['cores']} cores, load {facts['load_average']:.1f}")
    print(f"{report['scene']}, {options.size}, {options.pairs} pairs a run: {alarms} of {options.runs} runs of equal kernels "
          f"with a false alarm, a slowdown of 5 % found in {findings} of {options.runs}")
    if options.json:
        write_report(report, options.json)


if __name__ == "__main__":
    main()
