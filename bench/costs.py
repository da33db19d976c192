"""What the kernels do, counted, beside what is declared of it: `bench/run costs`.

The plain-OpenCL kernels run in Oclgrind, which interprets them; a plugin (count_costs.cpp) counts floating-point operations
and bytes of global memory. `sahl profile` says what is declared for the same rays (engine/profile/declared_cost.cpp,
kernels/count_visits.h). Scenes of one shape, past which all rays go through its box, give a ray, a node and a block of each
kind; a scene of everything gives whole kernels. Oclgrind and the headers for its plugin come from Debian and are unpacked
into build/oclgrind: installed, Oclgrind would be one more OpenCL device.
"""

import argparse
import json
import os
import pathlib
import tempfile

from measure import ROOT, SAHL, Run, fail, write_report

TOOL = ROOT / "build" / "oclgrind"
PACKAGES = ["liboclgrind-21.10", "oclgrind", "libreadline8", "liboclgrind-dev", "llvm-14-dev"]
LIBRARIES = TOOL / "usr" / "lib" / "x86_64-linux-gnu"

# Rays come from z = 10 down to (x, y), which is inside the shape's box and beside the shape.
SHAPES = {
    "triangle": ([0.9, 0.9], {"type": "mesh", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]]}),
    "sphere": ([0.9, 0.9], {"type": "sphere", "center": [0, 0, 0], "radius": 1}),
    "ellipsoid": ([1.8, 0.9], {"type": "sphere", "transform": [{"scale": [2, 1, 1]}]}),
    "cone": ([0.9, 0.9], {"type": "cylinder", "base": [0, 0, 0], "top": [0, 0, 1], "radius": 1, "capped": False}),
    "solid cone": ([0.9, 0.9], {"type": "cylinder", "base": [0, 0, 0], "top": [0, 0, 1], "radius": 1}),
    "disc": ([0.9, 0.9], {"type": "disc", "center": [0, 0, 0], "normal": [0, 0, 1], "radius": 1}),
    "box": ([1.3, 1.3], {"type": "box", "min": [-1, -1, -1], "max": [1, 1, 1],
                         "transform": [{"rotate": 45, "axis": [0, 0, 1]}]}),
    # Seen from its back: the plane alone is looked at.
    "polygon": ([0.5, 0.5], {"type": "polygon", "sides": "back", "vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]}),
}
AWAY = "none: the root"
REFERENCE_BYTES = 4  # to the block, in its node
LINE_BYTES = 64
# What is declared in full, but for what a work-item or a group of rays has once.
COUNTED_WHOLE = {"generate": ("flop", "bytes"), "shade": ("flop",), "count_children": ("bytes",), "sum_children": ("bytes",), "compact": ("bytes",)}
NEARLY = 0.01


def unpack():
    (TOOL / "packages").mkdir(parents=True, exist_ok=True)
    if not (TOOL / "usr" / "include" / "oclgrind").exists():
        Run(["sh", "-c", f"cd {TOOL}/packages && apt-get download {' '.join(PACKAGES)} && "
                         f"for package in *.deb; do dpkg -x $package {TOOL}; done"])
    headers = [f"-isystem{TOOL}/usr/include{folder}" for folder in ("", "/llvm-14", "/llvm-c-14")]
    plugin = TOOL / "count_costs.so"
    Run(["c++", "-std=c++20", "-O1", "-shared", "-fPIC", "-fno-rtti", *headers, ROOT / "bench" / "count_costs.cpp",
         f"-L{LIBRARIES}", "-l:liboclgrind-21.10.so", "-o", plugin])
    vendors = TOOL / "vendors"
    vendors.mkdir(exist_ok=True)
    (vendors / "oclgrind.icd").write_text(f"{TOOL}/usr/lib/oclgrind/liboclgrind-rt-icd.so\n")
    return plugin


class Counter:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.environment = {
            "OCL_ICD_VENDORS": str(TOOL / "vendors"), "LD_LIBRARY_PATH": str(LIBRARIES), "LC_ALL": "C",
            # Its interpreter lacks some functions that Clang's passes put in.
            "OCLGRIND_BUILD_OPTIONS": "-cl-opt-disable -disable-llvm-passes",
            "OCLGRIND_PLUGINS": str(unpack()), "SAHL_COSTS": str(self.folder / "costs"),
            "XDG_CACHE_HOME": str(TOOL / "cache")}

    def render(self, scene, options):
        """Sums of a frame, by kernel."""
        costs = self.folder / "costs"
        for _ in range(2):  # the first may test the kernels, whose launches are counted too
            costs.unlink(missing_ok=True)
            Run([SAHL, "render", scene, *options, "-q", "-o", self.folder / "image.png"], self.environment)
        sums = {}
        for line in costs.read_text().splitlines():
            launch = json.loads(line)
            kernel = sums.setdefault(launch.pop("kernel").removesuffix("_scalar"), dict.fromkeys(launch, 0))
            for what, count in launch.items():
                kernel[what] += count
        return sums


def declared(scene, options):
    """Totals of a frame, by kernel."""
    run = Run([SAHL, "profile", scene, *options, "--repeat", "1", "--warm-up", "0", "--json", "-q"])
    rows = json.loads(run.output.splitlines()[-1])["kernel_totals"]
    return {row["kernel"]: {"rays": row["rays_in"], **{
        what: None if row[what + "_per_ray"] is None else row[what + "_per_ray"] * row["rays_in"]
        for what in ("flop", "bytes")}} for row in rows}


def scene_of(name, folder):
    at, shape = SHAPES.get(name, ([0.9, 0.9], SHAPES["sphere"][1]))
    scene = {"sahl": 1, "film": {"width": 4, "height": 4}, "materials": {"grey": {"diffuse": [1, 1, 1]}},
             "cameras": {"down": {"eye": [*at, 10], "look_at": [*at, 20 if name == AWAY else 0], "up": [0, 1, 0], "fov": 0.1}},
             "objects": [{**shape, "material": "grey"}]}
    file = pathlib.Path(folder) / "scene.json"
    file.write_text(json.dumps(scene))
    return file


def units(counter, options):
    """[(unit, declared FLOP, counted, declared bytes, counted)] of a ray: alone with the root, then with a block too."""
    rows, base = [], None
    for name in (AWAY, *SHAPES):
        scene = scene_of(name, counter.folder)
        says = declared(scene, options)["intersect"]
        does = counter.render(scene, options)["intersect"]
        rays = says["rays"]
        row = [says["flop"] / rays, does["flop"] / rays, says["bytes"] / rays, (does["loaded"] + does["stored"]) / rays]
        if name != AWAY:
            row[3] -= REFERENCE_BYTES
        base = base or row
        rows.append(("a ray and a node" if name == AWAY else f"a block: {name}",
                     row if name == AWAY else [a - b for a, b in zip(row, base)]))
    return rows


def main():
    parser = argparse.ArgumentParser(prog="bench/run costs", description="Declared costs of kernels beside counted ones.")
    parser.add_argument("--scene", default=str(ROOT / "scenes" / "primitives.json"), help="whose kernels are counted whole")
    parser.add_argument("--size", default="24x16", help="of its image, two samples a pixel (default: 24x16)")
    parser.add_argument("--json", metavar="FILE", help="the report as JSON")
    options = parser.parse_args()
    os.environ.pop("SAHL_KERNEL_DIR", None)

    way = ["--traversal", "scalar"]
    with tempfile.TemporaryDirectory() as folder:
        counter = Counter(folder)
        rows = units(counter, [*way, "--depth", "0"])
        frame = [options.scene, [*way, "--size", options.size, "--spp", "2"]]
        says, does = declared(*frame), counter.render(*frame)

    wrong = 0
    print(f"{'of a ray':<24}{'FLOP':>10}{'counted':>10}{'bytes':>10}{'counted':>10}")
    for unit, row in rows:
        # Bytes are declared in whole lines, as memory gives them: of a node's last one few words are read, of a block's
        # its primitives' ids; a word of a triangles' block is read twice.
        right = row[0] == row[1] and -4 <= row[2] - row[3] <= LINE_BYTES
        wrong += not right
        print(f"{unit:<24}" + "".join(f"{value:>10.0f}" for value in row) + ("" if right else "  differs"))
    print(f"\n{'of a frame, a ray':<24}{'FLOP':>10}{'counted':>10}{'bytes':>10}{'counted':>10}")
    kernels = {}
    for kernel, total in says.items():
        count, rays = does[kernel], total["rays"]
        count["bytes"] = count["loaded"] + count["stored"]
        right = all(abs(total[what] - count[what]) <= NEARLY * count[what] for what in COUNTED_WHOLE.get(kernel, ()))
        wrong += not right
        row = [total["flop"], count["flop"], total["bytes"], count["bytes"]]
        kernels[kernel] = row = [None if value is None else value / rays for value in row]
        print(f"{kernel:<24}" + "".join(f"{'-' if value is None else f'{value:.1f}':>10}" for value in row)
              + ("" if right else "  differs"))
    if options.json:
        write_report({"units": dict(rows), "kernels": kernels}, options.json)
    if wrong:
        fail(f"{wrong} declared costs are not what is counted: kernels/count_visits.h, engine/profile/declared_cost.cpp")


if __name__ == "__main__":
    main()
