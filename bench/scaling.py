"""How Sahl's time and memory grow: `bench/run scaling`.

A cube of spheres, a fifth of them glass and a fifth mirrors, from which one thing at a time is changed: threads, pixels,
samples, primitives, lights, depth. Each render is a process of its own with all kernels in Sahl's program cache; all of
them are gone through once for each repetition. Times are those of rendering, without loading and trees.
"""

import argparse
import json
import os
import pathlib
import random
import tempfile

from measure import SAHL, Run, machine_facts, spread, write_report

# What everything is measured at but the one thing.
BASE = {"threads": os.cpu_count(), "side": 512, "spp": 1, "primitives": 100_000, "lights": 2, "depth": 4}
AXES = {
    "threads": [count for count in (1, 2, 4, 8, 16, 32, 64) if count < os.cpu_count()] + [os.cpu_count()],
    "side": [256, 512, 1024, 2048, 4096, 8192],
    "spp": [1, 4, 16, 64],
    "primitives": [1_000, 10_000, 100_000, 1_000_000, 10_000_000],
    "lights": [1, 2, 4, 8, 16, 32, 64],
    "depth": [0, 1, 2, 3, 4, 6, 8, 12],
}
HELP = {"threads": "threads", "side": "pixels a side of the image", "spp": "samples a pixel",
        "primitives": "spheres in the cube", "lights": "lights", "depth": "generations after the camera's rays"}

EDGE = 10.0


def write_cube(path, primitives, lights):
    """An NFF file. Spheres of 0.3 to 0.9 of their cells, so that any number of them hides about as much."""
    randomly = random.Random(1)
    cells = 1
    while cells ** 3 < primitives:
        cells += 1
    cell = EDGE / cells
    fills = {"f 0.7 0.5 0.3 0.9 0.1 20 0 0": [], "f 0.9 0.9 0.9 0.2 0.8 60 0 0": [], "f 1 1 1 0.05 0.1 60 0.8 1.5": []}
    kinds = [*fills.values()]
    for number in range(primitives):
        radius = cell / 2 * randomly.uniform(0.3, 0.9)
        place = [(axis + 0.5) * cell - EDGE / 2 + randomly.uniform(-1, 1) * (cell / 2 - radius)
                 for axis in (number % cells, number // cells % cells, number // cells // cells)]
        kinds[(0, 1, 0, 2, 0)[number % 5]].append(f"s {place[0]:.6g} {place[1]:.6g} {place[2]:.6g} {radius:.4g}\n")
    with open(path, "w") as file:
        file.write("b 0.3 0.4 0.6\nv\nfrom 7 6 15\nat 0 0 0\nup 0 1 0\nangle 40\nhither 0.1\nresolution 512 512\n")
        for _ in range(lights):
            file.write("l {:.4g} {:.4g} {:.4g}\n".format(*(randomly.uniform(-20, 20) for _ in range(2)), 20))
        for fill, spheres in fills.items():
            file.write(fill + "\n")
            file.writelines(spheres)


class Cubes:
    """The files, each written when it is first asked for."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)

    def path(self, point):
        path = self.folder / f"cube-{point['primitives']}-{point['lights']}.nff"
        if not path.exists():
            write_cube(path, point["primitives"], point["lights"])
        return path


def command(cubes, point, *more):
    return [SAHL, "render", cubes.path(point), "-o", cubes.folder / "image.exr", "--size", f"{point['side']}x{point['side']}",
            "--spp", point["spp"], "--depth", point["depth"], "--threads", point["threads"], "--json", "-q", *more]


def events(run):
    return {event["event"]: event for event in map(json.loads, run.output.splitlines())}


class Measurement:
    """One point of one axis."""

    def __init__(self, point):
        self.point = point
        self.seconds = []
        self.events, self.memory, self.plan = {}, 0, {}

    def measure(self, cubes):
        if not self.plan:
            self.plan = events(Run(command(cubes, self.point, "--dry-run")))["plan"]
        run = Run(command(cubes, self.point))
        self.events = events(run)
        self.seconds.append(self.events["image"]["seconds"])
        self.memory = run.peak_bytes

    def result(self):
        image, start, plan = self.events["image"], self.events["start"], self.plan["memory"]
        rays = image["rays"] + image["shadow_rays"]
        tree = plan["bvh_nodes"] + plan["leaf_blocks"] + plan["shapes"]
        return {
            **self.point,
            "rays": rays,
            "camera_rays": self.point["side"] ** 2 * self.point["spp"],
            "seconds": spread(self.seconds),
            "ns_per_ray": spread([1e9 * seconds / rays for seconds in self.seconds]),
            "bytes_per_ray": plan["ray_queues"] / self.plan["ray_budget"],
            "bytes_per_primitive": tree / self.point["primitives"],
            "bytes_per_pixel": (plan["film"] + plan["image"] + plan["encoder"]) / self.point["side"] ** 2,
            "bvh_seconds": start["bvh_seconds"],
            "process_bytes": self.memory,
        }


def measurements(options):
    """By axis; the base point is one measurement, whichever axis it is on."""
    known = {}
    axes = {}
    for axis in options.axis:
        axes[axis] = []
        for value in AXES[axis]:
            if axis == "primitives" and value > options.most_primitives or axis == "side" and value > options.most_side:
                continue
            point = {**BASE, axis: value}
            axes[axis].append(known.setdefault(tuple(point.values()), Measurement(point)))
    return axes, list(known.values())


def print_axis(axis, results):
    print(f"\n{HELP[axis]}\n{axis:>12}{'Mrays':>9}{'s':>9}{'ns/ray':>9} {'least..most':^15}{'bytes/ray':>10}"
          f"{'/primitive':>11}{'/pixel':>7}{'process MB':>11}{'tree s':>8}")
    for result in results:
        ns = result["ns_per_ray"]
        print(f"{result[axis]:12}{result['rays'] * 1e-6:9.2f}{result['seconds']['median']:9.3f}{ns['median']:9.1f}"
              f" {ns['min']:6.1f}..{ns['max']:<7.1f}{result['bytes_per_ray']:10.0f}{result['bytes_per_primitive']:11.0f}"
              f"{result['bytes_per_pixel']:7.0f}{result['process_bytes'] * 1e-6:11.0f}{result['bvh_seconds']:8.2f}")


def main():
    parser = argparse.ArgumentParser(prog="bench/run scaling", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--json", metavar="FILE", help="write all figures to this file")
    parser.add_argument("--axis", action="append", choices=AXES, help="this alone (may be given several times)")
    parser.add_argument("--most-primitives", type=int, default=10_000_000, metavar="N",
                        help="leave larger scenes out; 10 million take about 6 GB (default: 10000000)")
    parser.add_argument("--most-side", type=int, default=8192, metavar="N", help="leave larger images out (default: 8192)")
    parser.add_argument("--repetitions", type=int, default=3, help="that medians are of (default: 3)")
    options = parser.parse_args()
    options.axis = options.axis or list(AXES)
    axes, points = measurements(options)
    with tempfile.TemporaryDirectory() as folder:
        cubes = Cubes(folder)
        Run(command(cubes, BASE))  # compiles what is not compiled yet
        for _ in range(options.repetitions):
            for point in points:
                point.measure(cubes)
        machine = machine_facts()
    results = {axis: [measurement.result() for measurement in along] for axis, along in axes.items()}
    print(f"{machine['processor']}, {machine['cores']} cores, load {machine['load_average']:.1f}; base: "
          + ", ".join(f"{name} {value}" for name, value in BASE.items()))
    for axis, along in results.items():
        print_axis(axis, along)
    if options.json:
        write_report({"machine": machine, "repetitions": options.repetitions, "base": BASE, "axes": results}, options.json)


if __name__ == "__main__":
    main()
