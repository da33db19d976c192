"""What the benchmarks of whole processes share: runs, medians and their spread, facts of the machine, reports."""

import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / "release"
SAHL = BUILD / "sahl"


class Run:
    """A finished process: its output, its wall-clock and its processor time (both in seconds), the most memory it had."""

    def __init__(self, command, environment=None, statuses=(0,)):
        outputs = []
        self.started_ns = time.clock_gettime_ns(time.CLOCK_MONOTONIC_RAW)
        process = subprocess.Popen([str(part) for part in command], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True, errors="replace",
                                   env={**os.environ, **(environment or {})})
        for line in process.stdout:
            outputs.append(line)
        _, status, usage = os.wait4(process.pid, 0)
        self.ended_ns = time.clock_gettime_ns(time.CLOCK_MONOTONIC_RAW)
        process.returncode = os.waitstatus_to_exitcode(status)
        process.stdout.close()
        self.seconds = (self.ended_ns - self.started_ns) * 1e-9
        self.processor_seconds = usage.ru_utime + usage.ru_stime
        self.peak_bytes = usage.ru_maxrss * 1024
        self.output = "".join(outputs)
        if process.returncode not in statuses:
            fail(f"{' '.join(str(part) for part in command)}: status {process.returncode}\n{self.output}")


def fail(message):
    sys.exit(f"bench/run: {message}")


def spread(values):
    """{median, min, max} of at least one value."""
    return {"median": statistics.median(values), "min": min(values), "max": max(values)}


def spread_of_quotients(numerators, denominators):
    """Each over its neighbour in time: what a machine's changing speed moves least."""
    return spread([a / b for a, b in zip(numerators, denominators)])


def spread_text(values, form="{:.0f}"):
    """'12 (11 to 14)'."""
    return (form + " (" + form + " to " + form + ")").format(values["median"], values["min"], values["max"])


def geometric_mean(values):
    return math.exp(sum(math.log(value) for value in values) / len(values))


def value_of(file, key, separator):
    """What follows the first `key` and its separator in a file of /proc or /etc."""
    for line in pathlib.Path(file).read_text().splitlines():
        if line.startswith(key):
            return line.split(separator, 1)[1].strip().strip('"')
    return "unknown"


def machine_facts():
    """Of the machine, and how much other work it has."""
    version = Run([SAHL, "--version"]).output.splitlines()
    return {
        "processor": value_of("/proc/cpuinfo", "model name", ":"),
        "cores": os.cpu_count(),
        "memory": value_of("/proc/meminfo", "MemTotal", ":"),
        "system": value_of("/etc/os-release", "PRETTY_NAME", "="),
        "sahl": version[0].split()[-1],
        "opencl": "; ".join(line.split(": ", 1)[1] for line in version[1:]),
        "load_average": os.getloadavg()[0],
    }


def write_report(report, file):
    try:
        pathlib.Path(file).write_text(json.dumps(report, indent=2) + "\n")
    except OSError as error:
        fail(f"{file}: cannot be written: {error.strerror}")
