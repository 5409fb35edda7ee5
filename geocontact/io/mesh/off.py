"""OFF (Geomview's Object File Format), ASCII: checked line by line, then read by trimesh.

One vertex and one face a line, as all writers do: `OFF`, the counts `vertices faces edges` (in the next line or the
same), vertices `x y z`, faces `n i j k …` with 0-based indices. Prefixes ST, C and N (texture, colours, normals of
vertices) and colours behind faces are passed over; `#` begins a comment; edges are not counted. Binary files and those
of 4 or n dimensions are refused. trimesh 5.2 alone takes a file cut off within a face, ignores rows behind the last
face, finds the keyword anywhere, and sorts triangles before other polygons: it is given plain rows of triangles.
Format: http://www.geomview.org/docs/html/OFF.html
"""

from __future__ import annotations

import re
from array import array
from collections.abc import Callable, Iterator
from io import BytesIO
from itertools import islice

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

_KEYWORD = re.compile(rb"(ST)?C?N?OFF")
_OTHER_KIND = re.compile(rb"(ST)?C?N?(4|4n|n)OFF")
_WHOLE = re.compile(rb"[+-]?[0-9]{1,18}")
_CUT_OFF = "the file is cut off or damaged, export or download it again"
_AGAIN = "export it again as ASCII OFF"
_Row = tuple[int, list[bytes]]


def read_off(data: bytes, file: str) -> tuple[Float[np.ndarray, "n 3"], Int[np.ndarray, "m 3"]]:
    """Vertices of an OFF file in its own unit (float64), and its faces, polygons as consecutive triangles."""
    from trimesh.exchange.off import load_off  # half a second

    rows = _rows(data)
    vertices, faces, plain_rows = _counts(rows, data, file)
    points, corners, sizes = bytearray(), array("q"), array("q")
    _read_rows(rows, vertices, "vertices", file, lambda words: points.extend(_vertex(words, plain_rows)))
    _read_rows(rows, faces, "faces", file, lambda words: _append_face(words, corners, sizes))
    extra = next(rows, None)
    if extra is not None:
        raise InputError(file, f"line {extra[0]}", "more rows than its counts declare", _CUT_OFF)
    warn_open_end(data, file)
    cut = triangles(as_integers(corners), as_integers(sizes), vertices, file)
    head = b"OFF\n%d %d 0\n" % (vertices, len(cut))
    mesh = load_off(BytesIO(b"".join([head, points, *(b"3 %d %d %d\n" % (a, b, c) for a, b, c in cut.tolist())])))
    if mesh["vertices"].shape != (vertices, 3) or mesh["faces"].shape != cut.shape:
        raise InputError(file, "", "trimesh read another number of vertices or faces than the file holds", _AGAIN)
    return np.asarray(mesh["vertices"]), np.asarray(mesh["faces"], dtype=np.int64)


def _rows(data: bytes) -> Iterator[_Row]:
    """Number and words of every line that has any, without comments."""
    start = len(BYTE_ORDER_MARK) if data.startswith(BYTE_ORDER_MARK) else 0
    for number, line in enumerate(lines(data, start), start=1):
        words = line.partition(b"#")[0].split()
        if words:
            yield number, words


def _counts(rows: Iterator[_Row], data: bytes, file: str) -> tuple[int, int, bool]:
    """How many vertices and faces there are, and whether a vertex has nothing but x, y and z."""
    number, words = next(rows, (1, [b""]))
    keyword, *words = words
    found = _KEYWORD.fullmatch(keyword)
    if found is None:
        if _OTHER_KIND.fullmatch(keyword):
            what = f"{shown(keyword)} files have coordinates of another number than 3"
            raise InputError(file, f"line {number}", what, _AGAIN)
        raise not_a("an OFF file", data, file)
    if words[:1] == [b"BINARY"]:
        raise InputError(file, f"line {number}", "is a binary OFF file", _AGAIN)
    if not words:
        number, words = next(rows, (number, []))
    try:
        counts = [_whole(word) for word in words]
    except ValueError as error:
        raise InputError(file, f"line {number}", f"counts of vertices and faces: {error}", _AGAIN) from error
    if len(counts) not in (2, 3):
        what = f"{len(counts)} numbers where the counts of vertices, faces and edges are expected"
        raise InputError(file, f"line {number}", what, _AGAIN)
    mesh_checks.require_count(counts[0], mesh_checks.MAX_VERTICES, "vertices", file)
    mesh_checks.require_count(counts[1], mesh_checks.MAX_FACES, "faces", file)
    return counts[0], counts[1], keyword == b"OFF"


def _read_rows(rows: Iterator[_Row], count: int, noun: str, file: str, read: Callable[[list[bytes]], None]) -> None:
    """Hand `count` rows to `read`; InputError with the line for what it refuses, or where there are fewer."""
    found = 0
    for number, words in islice(rows, count):
        try:
            read(words)
        except ValueError as error:
            raise InputError(file, f"line {number}", f"{noun}: {error}", remedy(error, _CUT_OFF)) from error
        found += 1
    if found < count:
        raise InputError(file, "", f"its counts declare {count} {noun}, the file has {found}", _CUT_OFF)


def _vertex(words: list[bytes], plain_rows: bool) -> bytes:
    if len(words) < 3 or (plain_rows and len(words) > 3):
        raise ValueError(f"a row of {len(words)} numbers, expected x y z")
    require_numbers(words)
    return b"%b %b %b\n" % (words[0], words[1], words[2])


def _append_face(words: list[bytes], corners: array[int], sizes: array[int]) -> None:
    """Append the corners of a row `n i j k …`; further numbers are its colour: an index, or 3 or 4 numbers."""
    size = _whole(words[0])
    further = words[1 + max(size, 0) :]
    if size < 0 or len(words) < 1 + size or len(further) not in (0, 1, 3, 4):
        raise ValueError(f"{len(words) - 1} numbers follow the number of corners, {size}")
    require_numbers(further)
    corners.extend(map(_whole, words[1 : 1 + size]))
    sizes.append(size)


def _whole(word: bytes) -> int:
    """A word as an integer, without a decimal point; ValueError names what is none."""
    if not _WHOLE.fullmatch(word):
        raise ValueError(f"{shown(word)} is not a whole number")
    return int(word)
