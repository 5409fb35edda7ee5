"""Correspondence points of ShapeWorks (.particles): a point in each line, its place in the file says which it is.

ShapeWorks (Cates et al. 2017, "ShapeWorks: particle-based shape correspondence and visualization software", in
Statistical Shape and Deformation Analysis) writes x, y and z with blanks between them, no header and no unit. Local
particles lie on the subject's own mesh, in the frame of its file; world particles have been aligned and do not.
"""

from __future__ import annotations

from os import PathLike, fspath

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.data.magnitude import too_large
from geocontact.data.plausible import TOO_LARGE
from geocontact.io.text.file_preflight import BYTE_ORDER_MARK, is_number, lines, read_text_bytes, shown
from geocontact.io.text.units import LENGTH


def read_particles(path: str | PathLike[str], unit: str) -> Float[np.ndarray, "n 3"]:
    """Points [m] in the order of the file, at least one; empty lines at its end are passed over."""
    file = fspath(path)
    if unit not in LENGTH:
        raise InputError(file, "", f"unit {unit!r} is none of length", f"expected one of {', '.join(LENGTH)}")
    text = read_text_bytes(path).removeprefix(BYTE_ORDER_MARK).rstrip()
    if not text:
        raise InputError(file, "", "holds no particles", "expected x y z in each line")
    points = np.array([_point(line, number, file) for number, line in enumerate(lines(text), 1)])
    odd = np.argwhere(too_large(points))
    if len(odd):
        row, axis = odd[0]
        what = f"{'xyz'[axis]} is {points[row, axis]:g}, which {TOO_LARGE}"
        raise InputError(file, f"line {row + 1}", what, "check its digits and its exponent")
    return LENGTH[unit] * points


def _point(line: bytes, number: int, file: str) -> list[float]:
    words = line.split()
    values = [float(word) for word in words] if all(map(is_number, words)) else []
    if len(values) != 3 or not np.isfinite(values).all():
        raise InputError(file, f"line {number}", f"{shown(line.strip())} is not a point", "expected x y z")
    return values
