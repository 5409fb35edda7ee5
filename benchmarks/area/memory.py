"""Peak memory of one engine in a process of its own: `python -m benchmarks.area.memory "libigl AABB"`."""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
from pathlib import Path

from benchmarks.one_core import pin

FRAMES = 3


def peaks(names: list[str], pair: str, faces: int) -> dict[str, float]:
    """Peak resident memory [MB] of each engine in its own child process; "" is the pair alone, without any engine."""
    found = {}
    for name in names:
        command = [sys.executable, "-m", "benchmarks.area.memory", name, "--pair", pair, "--faces", str(faces)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode == 0:
            found[name] = float(json.loads(done.stdout.splitlines()[-1]))
    return found


def peak_of_this_process() -> float:
    """Peak resident memory [MB]; on Linux from /proc, for getrusage there starts with the parent's peak."""
    status = Path("/proc/self/status")
    if status.exists():
        lines = dict(line.split(":", 1) for line in status.read_text().splitlines() if ":" in line)
        if "VmHWM" in lines:
            return float(lines["VmHWM"].split()[0]) / 1024
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / (1024**2 if sys.platform == "darwin" else 1024)


def main() -> None:
    """Child: prepare, do a few frames, print the peak [MB]."""
    parser = argparse.ArgumentParser()
    parser.add_argument("engine")
    parser.add_argument("--pair", default="knee")
    parser.add_argument("--faces", type=int, default=50_000)
    options = parser.parse_args()
    pin()
    from benchmarks.engines.all import engine_named
    from benchmarks.pairs import PAIRS

    pair = PAIRS[options.pair](options.faces, FRAMES)
    if options.engine:
        step = engine_named(options.engine).prepare(pair)
        for k in range(len(pair.rotation)):
            step(k)
    sys.stdout.write(json.dumps(peak_of_this_process()) + "\n")


if __name__ == "__main__":
    main()
