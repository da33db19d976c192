"""Whole frames by Sahl and by POV-Ray 3.7: `bench/run frames`.

Each scene at the same size, depth and number of threads, in new processes that take turns; files are in the system's
cache and Sahl's kernels in its own. The scenes are Haines' Standard Procedural Databases below SAHL_TEST_DATA, each at its
full size where it is there and at its largest small one otherwise, and those of our own that POV-Ray can render
(povray_scene.py). The images are compared; those of a scene that differ by more than is known of it are an error.
"""

import argparse
import json
import os
import pathlib
import re
import sys
import tempfile

from measure import (ROOT, SAHL, Run, fail, geometric_mean, machine_facts, spread, spread_of_quotients, write_report)
from povray_scene import Unconvertible, povray_scene

# Of 255: rounding is 1, and two ways of rounding are another.
THRESHOLD = 2
# Percent of pixels. Edges take another pixel's side here and there. The teapot's normals vary over long thin triangles;
# through gears' glass a ray passes many surfaces that lie in each other.
MOST_PIXELS_OFF = {"teapot": 1, "gears": 3}
MOST_PIXELS_OFF_ELSEWHERE = 0.1


def family(path):
    """'gears' of gears-s1.nff."""
    return re.sub(r"-s\d+$", "", path.stem)


def databases(data):
    """One file of each of the Standard Procedural Databases that are there."""
    folder = pathlib.Path(data) / "spd" / "nff"
    chosen = {}
    for path in sorted(folder.glob("small/*.nff"), key=lambda path: path.stat().st_size) + sorted(folder.glob("*.nff")):
        chosen[family(path)] = path
    return [chosen[name] for name in sorted(chosen)]


def own_scenes():
    return sorted(path for path in (ROOT / "scenes").iterdir() if path.suffix in (".json", ".nff"))


class Frame:
    """A scene at one size, its commands, and what was measured."""

    def __init__(self, path, size, threads, folder):
        self.path, self.size, self.name = path, size, path.stem
        base = pathlib.Path(folder) / f"{path.stem}-{size}"
        converted = base.with_suffix(".json")
        Run([SAHL, "convert", path, converted, "-q"])
        scene = json.loads(converted.read_text())
        self.depth = scene.get("depth", 5)
        base.with_suffix(".pov").write_text(povray_scene(scene, 1))
        self.images = [f"{base}-sahl.png", f"{base}-povray.png"]
        self.sahl = [SAHL, "render", path, "-o", self.images[0], "--size", f"{size}x{size}", "--transfer", "linear",
                     "--threads", threads, "--json", "-q"]
        self.povray = ["povray", f"+I{base}.pov", f"+O{self.images[1]}", f"+W{size}", f"+H{size}", "-A", "-J",
                       f"+WT{threads}", "-D", "-V", "+FN8", "File_Gamma=1.0"]
        self.render, self.trace, self.processes, self.processors = [], [], ([], []), ([], [])
        self.rays = 0

    def measure_once(self):
        sahl, povray = Run(self.sahl), Run(self.povray)
        image = json.loads(sahl.output.splitlines()[-1])
        self.rays = image["rays"] + image["shadow_rays"]
        self.render.append(image["seconds"])
        trace = re.search(r"Trace Time:.*\(([0-9.]+) seconds\)", povray.output)
        if not trace:
            fail(f"{self.name}: POV-Ray says no trace time:\n{povray.output}")
        self.trace.append(float(trace[1]))
        for run, seconds, processor in zip((sahl, povray), self.processes, self.processors):
            seconds.append(run.seconds)
            processor.append(run.processor_seconds)

    def pixels_off(self):
        compare = Run([SAHL, "compare", *self.images, "--threshold", f"{THRESHOLD}/255", "--max-pixels", "100%", "--json"])
        return json.loads(compare.output.splitlines()[-1])["pixels_over"]

    def most_pixels_off(self):
        return self.size ** 2 * MOST_PIXELS_OFF.get(family(self.path), MOST_PIXELS_OFF_ELSEWHERE) / 100

    def result(self):
        ratio = spread_of_quotients(self.trace, self.render)
        process_ratio = spread_of_quotients(self.processes[1], self.processes[0])
        return {
            "name": self.name,
            "size": self.size,
            "sahl_s": spread(self.render)["median"],
            "povray_s": spread(self.trace)["median"],
            "ratio": ratio["median"],
            "process_ratio": process_ratio["median"],
            "pixels_off": self.pixels_off(),
            "most_pixels_off": int(self.most_pixels_off()),
            "depth": self.depth,
            "rays": self.rays,
            "processor_ratio": spread_of_quotients(self.processors[1], self.processors[0])["median"],
            "sahl_process_s": spread(self.processes[0])["median"],
            "povray_process_s": spread(self.processes[1])["median"],
            "spreads": {"sahl_s": spread(self.render), "povray_s": spread(self.trace), "ratio": ratio,
                        "process_ratio": process_ratio},
        }


def frames(options, folder):
    """Those that can be compared; says of the others why not."""
    paths = ([pathlib.Path(path) for path in options.scenes] if options.scenes
             else databases(os.environ.get("SAHL_TEST_DATA", "")) + own_scenes())
    for size in options.size:
        for path in paths:
            try:
                yield Frame(path, size, options.threads, folder)
            except Unconvertible as error:
                if size == options.size[0]:
                    print(f"{path.stem} is left out, for POV-Ray cannot have it: {error}", file=sys.stderr)


def print_row(scene):
    ratio = scene["spreads"]["ratio"]
    off = 100 * scene["pixels_off"] / scene["size"] ** 2
    print(f"{scene['name']:12}{scene['size']:6}{scene['depth']:6}{1e-6 * scene['rays'] / scene['sahl_s']:9.1f}"
          f"{scene['sahl_s']:9.3f}{scene['povray_s']:9.3f}{scene['ratio']:8.2f} {ratio['min']:6.2f}..{ratio['max']:<6.2f}"
          f"{scene['process_ratio']:8.2f}{scene['processor_ratio']:10.2f}{off:9.3f}", flush=True)


def means_of(scenes):
    """Geometric means over all scenes of a size, and the least ratio of rendering."""
    means = []
    for size in dict.fromkeys(scene["size"] for scene in scenes):
        chosen = [scene for scene in scenes if scene["size"] == size]
        means.append({"size": size, "least_ratio": min(scene["ratio"] for scene in chosen),
                      **{key: geometric_mean([scene[key] for scene in chosen])
                         for key in ("ratio", "process_ratio", "processor_ratio")}})
    return means


def main():
    parser = argparse.ArgumentParser(prog="bench/run frames", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help="these scene files alone")
    parser.add_argument("--json", metavar="FILE", help="write all figures to this file")
    parser.add_argument("--size", type=lambda text: [int(size) for size in text.split(",")], default=[2048, 512],
                        metavar="N[,N…]", help="width and height of the images (default: 2048,512)")
    parser.add_argument("--threads", type=int, default=2, help="of both (default: 2)")
    parser.add_argument("--repetitions", type=int, default=5, help="that medians are of (default: 5)")
    options = parser.parse_args()
    scenes = []
    machine = machine_facts()
    machine["povray"] = re.search(r"POV-Ray ([0-9.]+[0-9])", Run(["povray", "--version"]).output)[1]
    print(f"{machine['processor']}, load {machine['load_average']:.1f}; POV-Ray {machine['povray']}, {options.threads} threads\n")
    print(f"{'scene':12}{'size':>6}{'depth':>6}{'Mrays/s':>9}{'Sahl s':>9}{'POV s':>9}{'ratio':>8} {'least..most':^14}"
          f"{'process':>8}{'processor':>10}{'% off':>9}")
    with tempfile.TemporaryDirectory() as folder:
        for frame in frames(options, folder):
            Run(frame.sahl)  # compiles what is not compiled yet
            for _ in range(options.repetitions):
                frame.measure_once()
            scenes.append(frame.result())
            print_row(scenes[-1])
    if not scenes:
        fail("no scenes: set SAHL_TEST_DATA or name some")
    print()
    means = means_of(scenes)
    for mean in means:
        print("geometric means at {size}: {ratio:.2f} (least {least_ratio:.2f}), process {process_ratio:.2f},"
              " processor {processor_ratio:.2f}".format(**mean))
    if options.json:
        write_report({"machine": machine, "threads": options.threads, "repetitions": options.repetitions,
                      "scenes": scenes, "means": means}, options.json)
    different = [f"{scene['name']} at {scene['size']}" for scene in scenes if scene["pixels_off"] > scene["most_pixels_off"]]
    if different:
        fail("different images, so that times do not compare: " + ", ".join(different))


if __name__ == "__main__":
    main()
