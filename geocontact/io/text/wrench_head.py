"""What the moments of a table of forces refer to, as run.json beside it says, or lines above its header.

Lines are `# point_mm = x, y, z` and `# frame = name`: they are written by hand, and by geocontact before version 0.2.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.io.text.file_preflight import read_json
from geocontact.io.text.plain_table import open_plain
from geocontact.io.text.storage_header import LONGEST_LINE

MOST_LINES = 100
RUN = "run.json"

_LINE = re.compile(r"#\s*(?P<key>point_mm|frame)\s*=\s*(?P<value>.*?)\s*", re.DOTALL)


@dataclass(frozen=True, eq=False)
class WrenchHead:
    """None for what a table does not say.

    Parameters
    ----------
    point
        That moments refer to [m].
    frame
        Name of the frame; what follows a semicolon in its line are words for the reader.
    """

    point: Float[np.ndarray, " 3"] | None = None
    frame: str | None = None


def read_wrench_head(path: Path) -> WrenchHead:
    """Head of a table that can be read, whatever its format; lines above its header count before."""
    with open_plain(path, "replace") as stream:
        lines = [stream.readline(LONGEST_LINE) for _ in range(MOST_LINES)]
    point, frame = None, None
    for number, line in enumerate(takewhile(lambda each: each.startswith("#"), lines), 1):
        found = _LINE.fullmatch(line)
        if found and found["key"] == "point_mm":
            point = _point(found["value"], path, f"line {number}")
        elif found:
            frame = found["value"].partition(";")[0].strip() or None
    return _of_run(path) if point is None and frame is None else WrenchHead(point, frame)


def _of_run(path: Path) -> WrenchHead:
    """What the run that wrote the table says; nothing where there is none, or where it says nothing of this table."""
    run = path.with_name(RUN)
    try:
        told = read_json(run)["tables"][path.name]
        point, frame = told.get("point_mm"), told.get("frame")
    except (ValueError, LookupError, TypeError, AttributeError, RecursionError):
        return WrenchHead()
    named = frame if isinstance(frame, str) and frame else None
    return WrenchHead(None if point is None else _point(",".join(map(str, point)), run, "tables"), named)


def _point(text: str, path: Path, place: str) -> Float[np.ndarray, " 3"]:
    try:
        point = np.array([float(part) for part in text.split(",")])
    except ValueError:
        point = np.zeros(0)
    if point.shape != (3,) or not np.isfinite(point).all():
        raise InputError(path, place, f"point_mm is {text[:40]!r}", "write for example # point_mm = 0, 0, 0")
    return point * 1e-3
