"""What an installation of the core weighs, package by package: `python -m benchmarks.robustness.install_size`.

The checkout is copied (what git knows, as it stands) and installed twice into environments of their own: by
`make demo`, which runs the main job on a synthetic knee and so compiles kernels, and by `pip install .` at the versions
of the lock. Counted are MB of 10^6 bytes of disk blocks (`du -sm` counts 2^20), and CPU seconds of all child processes.
`--only make` or `--only pip` does one of them; `--venv FOLDER` weighs an environment that is there. Writes
results/install_size.json.
"""

from __future__ import annotations

import argparse
import os
import resource
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from importlib.metadata import distributions
from pathlib import Path
from typing import Any

from benchmarks.machine import git, write_results

ROOT = Path(__file__).resolve().parents[2]
AIM = {"MB": 500, "cpu_s": 60}
HIDDEN = {"NUMBA_CACHE_DIR", "GEOCONTACT_CACHE", "PYTHONPATH", "PYTHONDONTWRITEBYTECODE", "MAKEFLAGS", "VIRTUAL_ENV"}
SMALL = 5.0  # MB; packages below are one sum


def cpu_seconds(words: list[str | Path], folder: Path) -> float:
    """CPU time of a command and all that it starts."""
    known = {name: value for name, value in os.environ.items() if name not in HIDDEN}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(words, cwd=folder, env=known, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return round(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, 1)


def on_disk(files: Iterator[Path]) -> float:
    """MB of the blocks of files."""
    return sum(each.lstat().st_blocks for each in files if not each.is_dir() or each.is_symlink()) * 512 / 1e6


def weighed(venv: Path) -> dict[str, Any]:
    """MB of the whole environment and of each package with its bytecode, the heaviest first."""
    (site,) = sorted(venv.glob("lib/python*/site-packages")) or [venv / "Lib" / "site-packages"]
    found: dict[str, float] = {}
    for package in distributions(path=[str(site)]):
        listed = {Path(str(package.locate_file(name))) for name in package.files or ()}
        compiled = {one for each in listed for one in (each.parent / "__pycache__").glob(f"{each.stem}.*.pyc")}
        found[package.name] = on_disk(each for each in listed | compiled if os.path.lexists(each))
    heavy = sorted(((mb, name) for name, mb in found.items() if mb >= SMALL), reverse=True)
    packages = {name: round(mb, 1) for mb, name in heavy}
    rest = sum(found.values()) - sum(mb for mb, _ in heavy)
    return {"MB": round(on_disk(venv.rglob("*"))), "packages_MB": packages, "smaller_ones_MB": round(rest, 1)}


def copied(folder: Path) -> Path:
    """A copy of the checkout, of what git knows."""
    clone = folder / "geocontact"
    for name in git(ROOT, "ls-files", "--cached", "--others", "--exclude-standard").splitlines():
        if (ROOT / name).is_file():
            (clone / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, clone / name)
    return clone


def by_make(clone: Path, python: str) -> dict[str, Any]:
    """`make demo`: packages first, then the demo, which compiles kernels and bytecode."""
    setting = f"PYTHON={python}"
    packages = cpu_seconds(["make", ".venv/core.stamp", setting], clone)
    installed = round(on_disk((clone / ".venv").rglob("*")))
    first = cpu_seconds(["make", "demo", setting], clone)
    again = cpu_seconds(["make", "demo", setting], clone)
    seconds = {"packages": packages, "demo, first": first, "together": round(packages + first, 1), "demo, again": again}
    return {"MB_before_the_first_run": installed, **weighed(clone / ".venv"), "cpu_s": seconds}


def by_pip(clone: Path, python: str) -> dict[str, Any]:
    """`pip install .` as pip does it: whole packages, all of their bytecode."""
    sys.path.insert(0, str(ROOT / ".ci"))
    from core_lock import pins  # type: ignore[import-not-found]

    (clone / "pins.txt").write_text(pins((clone / "requirements.lock").read_text("utf-8")), encoding="utf-8")
    subprocess.run([python, "-m", "venv", "environment"], cwd=clone, check=True)
    pip = ["environment/bin/python", "-m", "pip", "install", "--quiet", "--constraint", "pins.txt", "."]
    seconds = cpu_seconds([*pip], clone)
    return {**weighed(clone / "environment"), "cpu_s": seconds}


def main() -> None:
    """Measure and write."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.robustness.install_size", description=__doc__)
    parser.add_argument("--only", choices=("make", "pip"))
    parser.add_argument("--venv", type=Path, help="weigh this environment, write nothing")
    parser.add_argument("--python", default=sys.executable)
    given = parser.parse_args()
    if given.venv:
        print(weighed(given.venv))
        return
    figures: dict[str, Any] = {"aim": AIM}
    for name, way in (("make", by_make), ("pip", by_pip)):
        if given.only in (None, name):
            with tempfile.TemporaryDirectory() as scratch:
                figures[name] = way(copied(Path(scratch)), given.python)
                print(name, figures[name], flush=True)
    if given.only is None:
        print(write_results("install_size", {}, figures))


if __name__ == "__main__":
    main()
