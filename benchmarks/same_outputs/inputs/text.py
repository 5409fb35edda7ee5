"""Small text files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np


def written(file: Path, text: str) -> Path:
    """The file, with this text."""
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text, encoding="utf-8")
    return file


def table(file: Path, columns: Mapping[str, Sequence[float] | np.ndarray], head: str = "") -> Path:
    """A .csv with a header row, nine digits; NaN is an empty cell. `head` comes before it."""
    rows = zip(*columns.values(), strict=True)
    lines = (",".join(cell if isinstance(cell, str) else _cell(cell) for cell in row) for row in rows)
    return written(file, head + "\n".join([",".join(columns), *lines]) + "\n")


def storage(file: Path, columns: Mapping[str, Sequence[float] | np.ndarray], degrees: bool = False) -> Path:
    """A table of OpenSim, its first column the time."""
    rows = list(zip(*columns.values(), strict=True))
    head = [file.stem, "version=1", f"nRows={len(rows)}", f"nColumns={len(columns)}"]
    head += [f"inDegrees={'yes' if degrees else 'no'}", "endheader", "\t".join(columns)]
    return written(file, "\n".join([*head, *("\t".join(map(_cell, row)) for row in rows)]) + "\n")


def _cell(value: float) -> str:
    return "" if np.isnan(value) else f"{value:.9g}"
