"""From a clone to the first result on a machine that has Python and make: `python -m
benchmarks.robustness.first_result`.

The repository is cloned, and the packages that `make demo` installs are downloaded, which is not counted. Counted is
`make demo` in the clone, with no index to ask: a virtual environment, the packages from the files, the kernels
compiled, the main job on a synthetic knee, figures and page. Writes results/first_result.json. CPU seconds and room on
the disk are those of `benchmarks.robustness.install_size`.
"""

from __future__ import annotations

import argparse
import os
import runpy
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from benchmarks.machine import write_results

ROOT = Path(__file__).resolve().parents[2]
AIM = 90.0  # s
FIRST = "demo-result/report.html"


def done(words: list[str], folder: Path, **more: str) -> float:
    """Seconds that a command takes in a folder; caches that other clones left are out of its sight."""
    hidden = {"NUMBA_CACHE_DIR", "PYTHONPATH", "PYTHONDONTWRITEBYTECODE", "MAKEFLAGS"}
    known = {name: value for name, value in os.environ.items() if name not in hidden}
    began = time.perf_counter()
    subprocess.run(words, cwd=folder, env=known | more, check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - began


def only_looked_up(clone: Path) -> bytes:
    """Entries of the lock that pip asks for when it works out what the core needs, and that are not installed."""
    part = runpy.run_path(str(clone / ".ci/core_lock.py"))
    entries: str = part["subset"]((clone / "requirements.lock").read_text(encoding="utf-8"), part["ONLY_TO_BUILD"])
    return entries.encode()


def measured() -> dict[str, float | bool]:
    """Seconds of the download and of `make demo`, which ends with a page."""
    with tempfile.TemporaryDirectory() as scratch:
        clone, wheels = Path(scratch) / "geocontact", Path(scratch) / "wheels"
        done(["git", "clone", "--quiet", str(ROOT), str(clone)], Path(scratch))
        lock = Path(scratch) / "core.lock"
        lock.write_bytes(
            subprocess.check_output([sys.executable, ".ci/core_lock.py"], cwd=clone) + only_looked_up(clone)
        )
        asked = ["--quiet", "--require-hashes", "--no-deps", "-r", str(lock), "-d", str(wheels)]
        loaded = done([sys.executable, "-m", "pip", "download", *asked], clone)
        demo = done(["make", "demo"], clone, PIP_NO_INDEX="1", PIP_FIND_LINKS=str(wheels))
        return {"download_s": loaded, "demo_s": demo, "aim_s": AIM, "page": (clone / FIRST).exists()}


def main() -> None:
    """Measure and write."""
    argparse.ArgumentParser(
        prog="python -m benchmarks.robustness.first_result", description=__doc__.splitlines()[0]
    ).parse_args()
    figures = measured()
    print(figures, write_results("first_result", {}, figures))


if __name__ == "__main__":
    main()
