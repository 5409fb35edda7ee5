"""What a figure depends on besides the code."""

from __future__ import annotations

import datetime as dt
import importlib.metadata
import json
import os
import platform
import shutil
import subprocess
from collections.abc import Set as AbstractSet
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent


def commit(root: Path = ROOT) -> str:
    """Commit that a folder has checked out; "unknown" where it is no checkout of its own, or git is not there."""
    top, head = git(root, "rev-parse", "--show-toplevel"), git(root, "rev-parse", "--short", "HEAD")
    return head if head and top and Path(top).resolve() == root.resolve() else "unknown"


def git(folder: Path, *words: str) -> str:
    """Answer of git in a folder; empty where git or the repository is missing."""
    program = shutil.which("git")
    if program is None:
        return ""
    return subprocess.run([program, *words], capture_output=True, text=True, cwd=folder, check=False).stdout.strip()


def write_results(name: str, asked: dict[str, Any], figures: Any, packages: AbstractSet[str] = frozenset()) -> Path:
    """benchmarks/results/NAME.json: figures with commit, machine, versions, and what was asked for, seeds among it."""
    told = {"commit": commit(), "asked": asked, "machine": machine(), "versions": versions(set(packages))}
    file = HERE / "results" / f"{name}.json"
    file.write_text(as_json({**told, "figures": figures}), encoding="utf-8")
    return file


def as_json(value: Any, indent: int = 1) -> str:
    """Text of a file of results; null stands for what is not finite, as JSON has no word for it."""
    from geocontact.analyses.frame.json_file import plain  # late: cores are chosen before anything is imported

    return json.dumps(plain(value), indent=indent, allow_nan=False) + "\n"


def stamp(packages: AbstractSet[str] = frozenset()) -> dict[str, Any]:
    """What a part of a report that is written part by part was made by: commit, machine, versions."""
    return {"commit": commit(), "machine": machine(), "versions": versions(set(packages))}


def machine() -> dict[str, str]:
    """Processor, system, Python, load and date."""
    load = f"{os.getloadavg()[0]:.2f}" if hasattr(os, "getloadavg") else "unknown"
    return {
        "date": dt.datetime.now(dt.UTC).isoformat(timespec="minutes"),
        "processor": processor(),
        "cores": str(os.cpu_count()),
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        "load": load,
    }


def processor() -> str:
    """Model name; on Linux with family and model number, for cloud machines hide the name."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor() or "unknown"
    facts: dict[str, str] = {}
    for line in lines:
        name, _, value = line.partition(":")
        facts.setdefault(name.strip(), value.strip())
    family, number = facts.get("cpu family", "?"), facts.get("model", "?")
    return f"{facts.get('model name', 'unknown')} (family {family}, model {number})"


def versions(packages: set[str]) -> dict[str, str]:
    """Versions of those that are installed."""
    found = {}
    for package in sorted(packages | {"numpy", "numba", "llvmlite"}):
        try:
            found[package] = importlib.metadata.version(package)
        except importlib.metadata.PackageNotFoundError:
            continue
    return found
