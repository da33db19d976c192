"""How often `sahl profile --ab` is wrong: `bench/run alarms`.

Alarms: both sides have the same kernels, so that each row that is called faster or slower is a false alarm. Findings: on
the other side the intersect kernel traces some groups of rays twice, so that it takes 5 % longer, and `--fail-if
intersect:+0%` has to say so. Runs of both kinds take turns.
"""

import argparse
import json
import pathlib
import shutil
import statistics
import tempfile

from measure import ROOT, SAHL, Run, fail, machine_facts, write_report

KERNEL = "intersect_packet.cl"
WORK = """        Packet packet;
        load_packet(&packet, rays, ray_ids, capacity, first, count);
        intersect_packet_of_rays(&bvh, &packet);
        store_packet(&packet, hits, hit_ids, capacity, first, count);
"""
# Groups drawn by lot, as neighbours cost much the same. More than 5 %: a group costs less the second time, and a launch
# takes some time that no group does. What comes out is reported.
SLOWED = """        const uint lot = (uint)get_global_id(0) * 2654435761u >> 16;
        for (uint twice = lot % 1000u < 92u ? 2u : 1u; twice > 0u; --twice) {
""" + WORK + "        }\n"


def slow_kernels(folder):
    """A copy of kernels/ whose intersect kernel does 5 % more."""
    shutil.copytree(ROOT / "kernels", folder)
    file = folder / KERNEL
    text = file.read_text()
    if text.count(WORK) != 1:
        fail(f"{file.name} is not as bench/alarms.py knows it: the slowdown cannot be put in")
    file.write_text(text.replace(WORK, SLOWED))


def compare(options, base, other):
    """One comparison: its rows by name, what `--fail-if` says of the kernel, and the pairs of frames."""
    run = Run([SAHL, "profile", options.scene, "--size", options.size, "--depth", options.depth,
               *(["--repeat", options.pairs] if options.pairs else []), "--json", "-q", "--ab",
               f"SAHL_KERNEL_DIR={base}", f"SAHL_KERNEL_DIR={other}", "--fail-if", "intersect:+0%"], statuses=(0, 9))
    event = next(event for event in map(json.loads, run.output.splitlines()) if event["event"] == "profile_diff")
    rows = {}
    for row in event["rows"]:
        generation = "" if row["generation"] is None else f"/{row['generation']}"
        rows[row["kernel"] + generation] = row
    return rows, event["limits"][0], event["pairs"]


def differing(rows):
    return [name for name, row in rows.items() if row["verdict"] in ("faster", "slower")]


def main():
    parser = argparse.ArgumentParser(prog="bench/run alarms", description="False alarms and findings of sahl profile --ab.")
    parser.add_argument("--runs", type=int, default=100, help="of each kind (default: 100)")
    parser.add_argument("--pairs", type=int, help="of frames in a run (default: that of --ab)")
    parser.add_argument("--scene", default=str(ROOT / "scenes" / "whitted.json"))
    parser.add_argument("--size", default="256x256")
    parser.add_argument("--depth", default="0", help="generations after the camera rays (default: 0)")
    parser.add_argument("--json", metavar="FILE", help="the report as JSON")
    options = parser.parse_args()

    report = {"machine": machine_facts(), "scene": pathlib.Path(options.scene).name, "size": options.size,
              "depth": options.depth, "runs": []}
    alarms = findings = 0
    with tempfile.TemporaryDirectory() as folder:
        slow = pathlib.Path(folder) / "kernels"
        slow_kernels(slow)
        same = ROOT / "kernels"
        for number in range(options.runs):
            wrong = differing(compare(options, same, same)[0])
            _, found, report["pairs"] = compare(options, same, slow)
            alarms += bool(wrong)
            findings += found["exceeded"]
            report["runs"].append({"alarms": wrong, "intersect": found})
            print(f"{number + 1:3} runs: {alarms} false alarms, {findings} findings; intersect {found['ratio']:.3f} "
                  f"({found['ratio_low']:.3f} to {found['ratio_high']:.3f}){' alarm: ' + ', '.join(wrong) if wrong else ''}",
                  flush=True)
    slowdown = statistics.median(run["intersect"]["ratio"] for run in report["runs"])
    report.update(false_alarms=alarms, findings=findings, slowdown=slowdown)
    facts = report["machine"]
    print(f"{facts['processor']}, {facts['cores']} cores, load {facts['load_average']:.1f}")
    print(f"{report['scene']}, {options.size}, {report['pairs']} pairs a run: {alarms} of {options.runs} runs of equal kernels "
          f"with a false alarm, a slowdown of {100 * (slowdown - 1):.1f} % (median) found in {findings} of {options.runs}")
    if options.json:
        write_report(report, options.json)


if __name__ == "__main__":
    main()
