"""Correspondence points of ShapeWorks (.particles): a point in each line, its place in the file says which it is.

ShapeWorks (Cates et al. 2017, "ShapeWorks: particle-based shape correspondence and visualization software", in
Statistical Shape and Deformation Analysis) writes x, y and z with blanks between them, no header and no unit. Local
particles lie on the subject's own mesh, in the frame of its file; world particles have been aligned and do not.
"""

from __future__ import annotations

import math
from os import PathLike, fspath

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.io.text.file_preflight import read_bytes
from geocontact.io.text.units import LENGTH


def read_particles(path: str | PathLike[str], unit: str) -> Float[np.ndarray, "n 3"]:
    """Points [m] in the order of the file; empty lines at its end are passed over."""
    file = fspath(path)
    if unit not in LENGTH:
        raise InputError(file, "", f"unit {unit!r} is none of length", f"expected one of {', '.join(LENGTH)}")
    text = read_bytes(path).decode("utf-8-sig", errors="replace")
    rows = [_point(line, number, file) for number, line in enumerate(text.rstrip().splitlines(), 1)]
    return LENGTH[unit] * np.array(rows)


def _point(line: str, number: int, file: str) -> list[float]:
    words = line.split()
    try:
        values = [float(word) for word in words]
    except ValueError:
        values = []
    if len(values) != 3 or not all(map(math.isfinite, values)):
        raise InputError(file, f"line {number}", f"{line.strip()[:40]!r} is no point", "expected x y z")
    return values
