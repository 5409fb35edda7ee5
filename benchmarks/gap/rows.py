"""Rows of a long benchmark, kept as they come in a file that is only added to.

A run that is interrupted loses nothing, and runs with other seeds add to the same file. What is added up is of one
version of the package: a run of another version is refused, as is one whose seed is there already.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from geocontact.analyses.frame.source_digest import digest


def begin(path: Path, seed: int, about: Mapping[str, Any]) -> None:
    """Note a run in the file; SystemExit where it cannot be added to what is there."""
    here = digest()
    for run in kept(path)[0]:
        if run["version"] != here:
            sys.exit(f"{path}: rows of version {run['version']}, this is {here}: move the file away")
        if run["seed"] == seed:
            sys.exit(f"{path}: has rows of seed {seed}: take another --seed, or move the file away")
    path.parent.mkdir(parents=True, exist_ok=True)
    _add(path, {"run": {"seed": seed, "version": here, **about}})


def keep(path: Path, seed: int, row: Mapping[str, Any]) -> None:
    """Add a row, also from one of several processes, and tell it."""
    _add(path, {"row": {"seed": seed, **row}})
    print(json.dumps(row), file=sys.stderr, flush=True)


def kept(path: Path) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """Runs and rows, both in the order in which they came; none where there is no file."""
    lines = list(_lines(path))
    return [one["run"] for one in lines if "run" in one], [one["row"] for one in lines if "row" in one]


def _lines(path: Path) -> Iterator[dict[str, Any]]:
    whole = path.read_text(encoding="utf-8").splitlines(keepends=True) if path.is_file() else []
    yield from (json.loads(line) for line in whole if line.endswith("\n"))  # a line that was cut off is no row


def _add(path: Path, line: Mapping[str, Any]) -> None:
    with path.open("a", encoding="utf-8") as file:
        file.write(json.dumps(line) + "\n")
