"""Wavefront OBJ: checked line by line, then read by trimesh.

Only `v` and `f` matter; materials, textures, normals, groups and free-form curves are passed over and no other file
is opened. A keyword that OBJ does not know refuses the file: had it been a damaged `v`, every later index would shift.
trimesh 5.2 counts negative indices from the end of the file (the format: from the line where they stand), sorts faces
by material, splits vertices at texture seams and joins the words around a continued line: it is given plain `v x y z`
and `f a b c` lines, so that face i is the i-th of the file.
"""

from __future__ import annotations

import re
from array import array
from io import BytesIO

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.errors import InputError
from geocontact.io.mesh import mesh_checks
from geocontact.io.mesh.mesh_checks import triangles
from geocontact.io.text.file_preflight import (
    BYTE_ORDER_MARK,
    as_integers,
    lines,
    not_a,
    remedy,
    require_numbers,
    shown,
    warn_open_end,
)

_PASSED_OVER = frozenset(
    b"vt vn vp l p g o s mg usemtl mtllib usemap maplib lod bevel c_interp d_interp shadow_obj trace_obj cstype deg "
    b"bmat step curv curv2 surf parm trim hole scrv sp end con ctech stech call csh".split()
)
_CORNER = re.compile(rb"([+-]?[0-9]{1,18})(?:/[+-]?[0-9]*(?:/(?:[+-]?[0-9]+)?)?)?")
_AGAIN = "export it again"


def read_obj(data: bytes, file: str) -> tuple[Float[np.ndarray, "n 3"], Int[np.ndarray, "m 3"]]:
    """Vertices of an OBJ file in its own unit (float64) and its faces; extra numbers of `v` (w, colour) are dropped."""
    from trimesh.exchange.obj import load_obj  # half a second

    text, count, faces = _plain(data, file)
    text += b"".join(b"f %d %d %d\n" % (a, b, c) for a, b, c in (faces + 1).tolist())
    (mesh,) = load_obj(BytesIO(text), skip_materials=True, maintain_order=True)["geometry"].values()
    if len(mesh["vertices"]) != count or len(mesh["faces"]) != len(faces):
        raise InputError(file, "", "trimesh read another number of vertices or faces than the file holds", _AGAIN)
    return np.asarray(mesh["vertices"]), np.asarray(mesh["faces"])


def _plain(data: bytes, file: str) -> tuple[bytearray, int, Int[np.ndarray, "m 3"]]:
    """The vertices as `v x y z` lines, how many there are, and the triangles of the faces, 0-based."""
    if b"\0" in data:
        raise not_a("an OBJ file", data, file)
    if b"\\" in data:
        data = re.sub(rb"\\\r?\n", b" ", data)
    text, count = bytearray(), 0
    corners, sizes = array("q"), array("q")
    start = len(BYTE_ORDER_MARK) if data.startswith(BYTE_ORDER_MARK) else 0
    for number, line in enumerate(lines(data, start), start=1):
        words = line.partition(b"#")[0].split()
        if not words:
            continue
        keyword = words.pop(0)
        try:
            if keyword == b"v":
                text += b"v %b %b %b\n" % _vertex(words)
                count += 1
            elif keyword in (b"f", b"fo"):
                corners.extend(_face(words, count))
                sizes.append(len(words))
            elif keyword not in _PASSED_OVER:
                raise ValueError(f"{shown(keyword)} is not an OBJ keyword")
        except ValueError as error:
            meant = remedy(error, _AGAIN)
            if number == 1 and meant == _AGAIN:
                raise not_a("an OBJ file", data, file) from error
            raise InputError(file, f"line {number}", str(error), meant) from error
    mesh_checks.require_count(count, mesh_checks.MAX_VERTICES, "vertices", file)
    faces = triangles(as_integers(corners), as_integers(sizes), count, file)
    warn_open_end(data, file)
    return text, count, faces


def _vertex(words: list[bytes]) -> tuple[bytes, bytes, bytes]:
    if len(words) not in (3, 4, 6, 7):
        raise ValueError(f"a vertex of {len(words)} numbers, expected x y z")
    require_numbers(words)
    return words[0], words[1], words[2]


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
