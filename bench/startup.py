"""From the start of `sahl` to its first pixel and its end: `bench/run startup`.

A 64x64 image in a new process each time, with Sahl's program cache (warm) and without one (cold: everything is compiled,
tested and stored, as in the first run on a machine). So few rays have kernels that are compiled without optimization
then; a 512x512 image has optimized ones. Files are in the system's cache in all cases. The times come from processes as
a user starts them; what they consist of comes from others, which a library watches from within (startup_probe.cpp). All
kinds take turns.
"""

import argparse
import pathlib
import tempfile

from measure import BUILD, ROOT, SAHL, Run, machine_facts, spread, spread_text, write_report

PROBE = BUILD / "bench" / "sahl_startup_probe.so"
EMPTY = BUILD / "bench" / "sahl_empty"
SCENE = ROOT / "scenes" / "whitted.json"
CACHE_FILE = ".sahl-program"

# In the order in which they happen.
PARTS = {
    "loader": "the loader, constructors of libraries",
    "scene": "command line, scene file",
    "platform": "PoCL, its device, a queue",
    "program": "kernel sources, program cache",
    "build": "clBuildProgram",
    "self_test": "the kernels' self-test",
    "upload": "trees, buffers",
    "first_launch": "each kernel's first launch, until it starts: loading or compiling it",
    "render": "the other time until the image is there",
    "store": "storing the compiled kernels",
    "encode": "image file",
    "exit": "freeing, ending",
}


class Timeline:
    """What the probe saw of a process. Times in ns of one clock."""

    def __init__(self, run, log):
        self.start, self.end = run.started_ns, run.ended_ns
        self.main = 0
        self.calls, self.kernels, self.renames = [], [], []
        for line in log.read_text().splitlines():
            kind, *rest = line.split(" ")
            if kind == "main":
                self.main = int(rest[0])
            elif kind == "call":
                self.calls.append((rest[0], int(rest[1]), int(rest[2])))
            elif kind == "kernel":
                self.kernels.append((rest[0], *map(int, rest[1:])))
            elif kind == "rename":
                self.renames.append((int(rest[0]), rest[1]))

    def first(self, name):
        """Start of the first call of that name."""
        return min(start for call, start, _ in self.calls if call == name)

    def last_end(self, name, before):
        """End of the last call of that name before a time."""
        return max(end for call, _, end in self.calls if call == name and end < before)

    def stored(self, after, before):
        """When the program cache was written, the last time between the two; `after` if never."""
        return max([after] + [time for time, path in self.renames if path.endswith(CACHE_FILE) and after < time < before])

    def render_start(self):
        """The first launch that is no self-test's: all of those are before the cache is written for the first time."""
        generates = [queued for name, queued, *_ in self.kernels if name == "generate"]
        return min(time for time in generates if time > self.stored(0, generates[-1]))

    def first_launches(self, begin, end):
        """By kernel, what goes by until it starts for the first time, between the two: loading or compiling it."""
        waited, seen, previous_end = {}, set(), 0
        for name, _, submitted, start, ended in self.kernels:
            if name not in seen and begin <= submitted < end:
                waited[name] = start - max(submitted, previous_end)
            seen.add(name)
            previous_end = ended
        return waited

    def split(self, output):
        """Milliseconds of each of PARTS, and of the way to the first pixel."""
        written = max(time for time, path in self.renames if path == str(output))
        queue = self.last_end("clCreateCommandQueue", written)
        build_start, build_end = self.first("clBuildProgram"), self.last_end("clBuildProgram", written)
        launch = self.render_start()
        tested = self.stored(build_end, launch)
        image = self.last_end("clWaitForEvents", written)
        times = {
            "loader": self.main,
            "scene": self.first("clGetPlatformIDs"),
            "platform": queue,
            "program": build_start,
            "build": build_end,
            "self_test": tested,
            "upload": launch,
            "render": image,
            "store": self.stored(image, written),
            "encode": written,
            "exit": self.end,
        }
        parts, previous = {}, self.start
        for name, end in times.items():
            parts[name] = end - previous
            previous = end
        parts["first_launch"] = 0
        for name, begin, end in (("self_test", build_end, tested), ("render", launch, image)):
            loading = sum(self.first_launches(begin, end).values())
            parts[name] -= loading
            parts["first_launch"] += loading
        shadows = [end for name, queued, _, _, end in self.kernels if name.startswith("shadow") and queued >= launch]
        return {name: ns * 1e-6 for name, ns in parts.items()}, (shadows[0] - self.start) * 1e-6


class Bench:
    def __init__(self, folder, scene):
        self.folder = pathlib.Path(folder)
        self.output = self.folder / "image.png"
        self.command = [SAHL, "render", scene, "--size", "64x64", "-q", "-o", self.output]
        # One that optimized kernels are compiled for.
        self.large_command = [SAHL, "render", scene, "--size", "512x512", "-q", "-o", self.output]
        self.exr_command = [*self.command[:-1], self.folder / "image.exr"]
        self.colds = 0
        self.times = {}

    def timed(self, kind, command, environment=None):
        run = Run(command, environment)
        self.times.setdefault(kind, []).append(run.seconds * 1e3)
        self.times.setdefault(kind + "_processor", []).append(run.processor_seconds * 1e3)

    def warm_cache(self):
        return {"SAHL_CACHE_DIR": str(self.folder / "warm")}

    def cold_cache(self):
        self.colds += 1
        return {"SAHL_CACHE_DIR": str(self.folder / f"cold-{self.colds}")}

    def watched(self, command, cache=None):
        log = self.folder / "probe.txt"
        run = Run(command, {**(cache or {}), "LD_PRELOAD": str(PROBE), "SAHL_PROBE": str(log)})
        return Timeline(run, log)


def split_of_fastest(bench, timelines):
    """Of one process, so that parts add up, the one that other work disturbed least. And the spread of the time to the
    first pixel over all of them."""
    fastest = min(timelines, key=lambda timeline: timeline.end - timeline.start)
    first_pixels = [timeline.split(bench.output)[1] for timeline in timelines]
    return fastest.split(bench.output)[0], spread(first_pixels)


def measure(bench, repetitions, cold_repetitions):
    Run([SAHL, "warm", "-q"], bench.warm_cache())
    warm, cold = [], []
    for repetition in range(repetitions):
        bench.timed("warm", bench.command, bench.warm_cache())
        warm.append(bench.watched(bench.command, bench.warm_cache()))
        bench.timed("help", [SAHL, "--help"])
        bench.timed("empty", [EMPTY])
        bench.timed("warm_exr", bench.exr_command, bench.warm_cache())
        if repetition < cold_repetitions:
            bench.timed("cold", bench.command, bench.cold_cache())
            cold.append(bench.watched(bench.command, bench.cold_cache()))
            bench.timed("cold_large", bench.large_command, bench.cold_cache())
    times = {name: spread(values) for name, values in bench.times.items()}
    split, first_pixel = split_of_fastest(bench, warm)
    cold_split, cold_first_pixel = split_of_fastest(bench, cold)
    return {
        "warm_ms": times["warm"]["median"],
        "cold_ms": times["cold"]["median"],
        "split": split,
        "cold_split": cold_split,
        "first_pixel_ms": {"warm": first_pixel, "cold": cold_first_pixel},
        "cold_first_launch_ms": {name: ns * 1e-6 for name, ns in cold[0].first_launches(0, cold[0].end).items()},
        "help_over_empty_ms": times["help"]["median"] - times["empty"]["median"],
        "times_ms": times,
    }


def print_report(report):
    machine = report["machine"]
    print(f"{machine['processor']}, {machine['cores']} cores, load {machine['load_average']:.1f}; medians in ms"
          " (least to most)\n")
    for name, text in (("warm", "64x64 image, warm"), ("cold", "64x64 image, cold"),
                       ("cold_large", "512x512 image, cold: optimized kernels"),
                       ("warm_exr", "the same as EXR, by OpenImageIO, warm"), ("help", "sahl --help"),
                       ("empty", "an empty program with the same libraries")):
        times = report["times_ms"]
        print(f"  {text:42}{spread_text(times[name]):>24}   processor {times[name + '_processor']['median']:.0f}")
    for name in ("warm", "cold"):
        print(f"  {'first pixel, ' + name:42}{spread_text(report['first_pixel_ms'][name]):>24}")
    print(f"\n  {'the fastest':14}{'warm':>8}{'cold':>8}")
    for name, text in PARTS.items():
        print(f"  {name:14}{report['split'][name]:8.1f}{report['cold_split'][name]:8.1f}   {text}")
    slowest = sorted(report["cold_first_launch_ms"].items(), key=lambda item: -item[1])
    print("\n  compiled at the first launch, cold: " + ", ".join(f"{name} {ms:.0f}" for name, ms in slowest))


def main():
    parser = argparse.ArgumentParser(prog="bench/run startup", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--json", metavar="FILE", help="write all figures to this file")
    parser.add_argument("--scene", default=SCENE, help="another scene (default: scenes/whitted.json)")
    parser.add_argument("--repetitions", type=int, default=11, help="of warm runs (default: 11)")
    parser.add_argument("--cold-repetitions", type=int, default=5, help="of cold ones (default: 5)")
    options = parser.parse_args()
    if not 1 <= options.cold_repetitions <= options.repetitions:
        parser.error("--repetitions is to be --cold-repetitions or more, and both at least 1")
    with tempfile.TemporaryDirectory() as folder:
        report = {"machine": machine_facts(), "scene": str(options.scene),
                  "repetitions": options.repetitions, "cold_repetitions": options.cold_repetitions,
                  **measure(Bench(folder, options.scene), options.repetitions, options.cold_repetitions)}
    print_report(report)
    if options.json:
        write_report(report, options.json)


if __name__ == "__main__":
    main()
