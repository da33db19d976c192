"""What `sahl batch` adds to rendering: `bench/run batch`.

Thousands of images of a few pixels, of one scene with a turning camera: what an image takes beyond its rendering, what it
takes to list them and to find that they are finished, and how often the scene was read, the tree built and the kernels
compiled.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import tempfile
import time

from measure import ROOT, SAHL, Run, machine_facts, spread, spread_text, write_report

SCENE = ROOT / "scenes" / "field.json"


def write_manifest(folder, images):
    manifest = pathlib.Path(folder) / "manifest.json"
    manifest.write_text(json.dumps({
        "settings": {"size": [16, 12]},
        "outputs": "images/{frame:05}.png",
        "jobs": [{"scene": str(SCENE), "frames": f"1-{images}",
                  "cameras": [{"name": "turn", "eye": [0, 3, 10], "look_at": [0, 0, 0],
                               "turn": {"keys": [[1, 0], [images + 1, 360]]}}]}]}))
    return manifest


def run_batch(command, environment=None):
    """Its events, each with the time it came at."""
    begin = time.monotonic()
    process = subprocess.Popen([str(part) for part in command] + ["--json", "-q"], stdout=subprocess.PIPE, text=True,
                               env={**os.environ, **(environment or {})})
    events = [(time.monotonic() - begin, json.loads(line)) for line in process.stdout]
    if process.wait() != 0:
        raise SystemExit(f"bench/run: {command}: status {process.returncode}")
    return events


def of_images(events):
    images = [(at, event) for at, event in events if event["event"] == "image"]
    gaps = [b - a for (a, _), (b, _) in zip(images, images[1:])]
    rendering = sum(event["seconds"] for _, event in images) / len(images)
    a_frame = (images[-1][0] - images[0][0]) / (len(images) - 1)
    return {
        "images": len(images),
        "first_s": images[0][0],
        "frame_ms": 1e3 * a_frame,
        "median_frame_ms": 1e3 * statistics.median(gaps),
        "rendering_ms": 1e3 * rendering,
        "overhead_ms": 1e3 * (a_frame - rendering),
        "scenes_read": sum(event["loaded"] for _, event in images),
        "trees_built": sum(event["built"] for _, event in images),
    }


def timed(command, repetitions, statuses):
    walls, processors = [], []
    for _ in range(repetitions):
        run = Run(["sh", "-c", '"$0" "$@" >/dev/null; case $? in ' + statuses + ") ;; *) exit 1 ;; esac", *command])
        walls.append(run.seconds)
        processors.append(run.processor_seconds)
    return {"wall_s": spread(walls), "processor_s": spread(processors)}


def listed(command, repetitions):
    """Until the last image is named, and until the end: after that come the scene, its memory and an estimate."""
    runs = [run_batch(command) for _ in range(repetitions)]
    return {"list_s": spread([max(at for at, event in run if event["event"] == "job") for run in runs]),
            "wall_s": spread([run[-1][0] for run in runs])}


def measure(images, repetitions):
    with tempfile.TemporaryDirectory() as folder:
        manifest = write_manifest(folder, images)
        command = [SAHL, "batch", manifest]
        report = {"list": timed([*command, "--check"], repetitions, "7"),
                  "dry_run": listed([*command, "--dry-run"], repetitions)}
        report["warm"] = of_images(run_batch(command))
        report["finished"] = timed([*command, "--check"], repetitions, "0")
        report["again"] = timed([*command, "-q"], repetitions, "0")
        cold = {"SAHL_CACHE_DIR": str(pathlib.Path(folder) / "cache")}
        few = [SAHL, "batch", write_manifest(folder, images // 10), "-o", pathlib.Path(folder) / "cold/{frame}.png"]
        report["cold"] = of_images(run_batch(few, cold))
        return report


def print_report(report):
    machine = report["machine"]
    print(f"{machine['processor']}, {machine['cores']} cores, load {machine['load_average']:.1f}\n")
    print(f"  {'':10}{'images':>8}{'first, s':>10}{'each, ms':>10}{'median':>8}{'rendering':>11}{'beyond it':>11}"
          f"{'scenes read':>13}{'trees built':>13}")
    for name in ("warm", "cold"):
        run = report[name]
        print(f"  {name:10}{run['images']:8}{run['first_s']:10.2f}{run['frame_ms']:10.2f}{run['median_frame_ms']:8.2f}"
              f"{run['rendering_ms']:11.2f}{run['overhead_ms']:11.2f}{run['scenes_read']:13}{run['trees_built']:13}")
    print(f"\n  {report['images']} images{'s':>20}{'processor':>24}")
    dry_run = report["dry_run"]
    print(f"  {'--dry-run, all named':24}{spread_text(dry_run['list_s'], '{:.2f}'):>24}")
    print(f"  {'--dry-run, whole':24}{spread_text(dry_run['wall_s'], '{:.2f}'):>24}")
    for name, text in (("list", "--check, none finished"), ("finished", "--check, all finished"),
                       ("again", "again, nothing to do")):
        times = report[name]
        print(f"  {text:24}{spread_text(times['wall_s'], '{:.2f}'):>24}{times['processor_s']['median']:10.2f}")


def main():
    parser = argparse.ArgumentParser(prog="bench/run batch", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--json", metavar="FILE", help="write all figures to this file")
    parser.add_argument("--images", type=int, default=10000, help="(default: 10000)")
    parser.add_argument("--repetitions", type=int, default=5, help="of lists (default: 5)")
    options = parser.parse_args()
    if options.images < 20 or options.repetitions < 1:
        parser.error("--images is to be at least 20 and --repetitions at least 1")
    report = {"machine": machine_facts(), "images": options.images, **measure(options.images, options.repetitions)}
    print_report(report)
    if options.json:
        write_report(report, options.json)


if __name__ == "__main__":
    main()
