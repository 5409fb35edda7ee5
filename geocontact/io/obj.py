"""Wavefront OBJ: checked and read in one pass, line by line.

Only `v` and `f` matter; materials, textures, normals, groups and free-form curves are passed over and no other file
is opened. A keyword that OBJ does not know refuses the file: had it been a damaged `v`, every later index would shift.
trimesh 5.2 counts negative indices from the end of the file (the format: from the line where they stand) and sorts
faces by material; here face i is the i-th of the file.
"""

from __future__ import annotations

import re
from array import array

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.errors import InputError
from geocontact.io import limits
from geocontact.io.file_preflight import not_a
from geocontact.io.polygons import triangles
from geocontact.io.text_lines import BYTE_ORDER_MARK, as_floats, as_integers, lines, numbers, shown, warn_open_end

_PASSED_OVER = frozenset(
    b"vt vn vp l p g o s mg usemtl mtllib usemap maplib lod bevel c_interp d_interp shadow_obj trace_obj cstype deg "
    b"bmat step curv curv2 surf parm trim hole scrv sp end con ctech stech call csh".split()
)
_CORNER = re.compile(rb"([+-]?[0-9]{1,18})(?:/[+-]?[0-9]*(?:/(?:[+-]?[0-9]+)?)?)?")
_AGAIN = "export it again"


def read_obj(data: bytes, file: str) -> tuple[Float[np.ndarray, "n 3"], Int[np.ndarray, "m 3"]]:
    """Vertices of an OBJ file in its own unit (float64) and its faces; extra numbers of `v` (w, colour) are dropped."""
    if b"\0" in data:
        raise not_a("an OBJ file", data, file)
    if b"\\" in data:
        data = re.sub(rb"\\\r?\n", b" ", data)
    coordinates, corners, sizes = array("d"), array("q"), array("q")
    start = len(BYTE_ORDER_MARK) if data.startswith(BYTE_ORDER_MARK) else 0
    for number, line in enumerate(lines(data, start), start=1):
        words = line.partition(b"#")[0].split()
        if not words:
            continue
        keyword = words.pop(0)
        try:
            if keyword == b"v":
                coordinates.extend(_vertex(words))
            elif keyword in (b"f", b"fo"):
                corners.extend(_face(words, len(coordinates) // 3))
                sizes.append(len(words))
            elif keyword not in _PASSED_OVER:
                raise ValueError(f"{shown(keyword)} is no OBJ keyword")
        except ValueError as error:
            if number == 1:
                raise not_a("an OBJ file", data, file) from error
            raise InputError(file, f"line {number}", str(error), _AGAIN) from error
    return _assembled(coordinates, corners, sizes, data, file)


def _assembled(
    coordinates: array[float], corners: array[int], sizes: array[int], data: bytes, file: str
) -> tuple[Float[np.ndarray, "n 3"], Int[np.ndarray, "m 3"]]:
    vertices = as_floats(coordinates).reshape(-1, 3)
    limits.require_count(len(vertices), limits.MAX_VERTICES, "vertices", file)
    faces = triangles(as_integers(corners), as_integers(sizes), len(vertices), file)
    warn_open_end(data, file)
    return vertices, faces


def _vertex(words: list[bytes]) -> list[float]:
    if len(words) not in (3, 4, 6, 7):
        raise ValueError(f"a vertex of {len(words)} numbers, expected x y z")
    return numbers(words)[:3]


def _face(words: list[bytes], defined: int) -> list[int]:
    """0-based vertex indices of a face; negative ones count back from the vertices defined so far."""
    if len(words) < 3:
        raise ValueError(f"a face of {len(words)} corners, at least 3 expected")
    indices = []
    for word in words:
        match = _CORNER.fullmatch(word)
        if match is None:
            raise ValueError(f"{shown(word)} is not a face corner, expected v, v/vt, v//vn or v/vt/vn")
        index = int(match[1])
        if index == 0 or index < -defined:
            raise ValueError(f"vertex index {index} is out of range, indices start at 1 or -{defined} here")
        indices.append(index - 1 if index > 0 else defined + index)
    return indices
