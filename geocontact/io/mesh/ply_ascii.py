"""Rows of an ASCII PLY file."""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from itertools import islice

import numpy as np

from geocontact.data.errors import InputError
from geocontact.io.mesh.ply_preflight import Element, PlyHeader, Property, plain_header
from geocontact.io.mesh.polygons import triangles
from geocontact.io.text.text_lines import as_integers, integer, lines, remedy, require_numbers, warn_open_end

_AGAIN = "the file is cut off or damaged, export or download it again"
_AXES = ("x", "y", "z")
_Row = tuple[int, list[bytes]]


def plain_ascii(data: bytes, header: PlyHeader, index_list: str, file: str) -> bytes:
    """The file as one of `x y z` and `3 a b c` rows; every row was found complete and made of numbers.

    Every element takes one line; blank lines do not count.
    """
    rows = _rows(data, header.body)
    points = bytearray()
    corners, sizes = array("q"), array("q")
    for element in header.elements:
        some = islice(rows, element.rows)
        try:
            if element.name == "vertex":
                count = _vertices(some, element, points)
            elif element.name == "face":
                count = _faces(some, element, index_list, corners, sizes)
            else:
                count = sum(1 for _ in some)
        except _RowError as error:
            what, meant = f"{element.name}: {error}", remedy(error, _AGAIN)
            raise InputError(file, f"line {error.line}", what, meant) from error.__cause__
        if count < element.rows:
            what = f"the header declares {element.rows} rows of {element.name}, the file has {count}"
            raise InputError(file, "", what, _AGAIN)
    extra = next(rows, None)
    if extra is not None:
        raise InputError(file, f"line {extra[0]}", "more rows than the header declares", _AGAIN)
    warn_open_end(data, file)
    vertex = next(element for element in header.elements if element.name == "vertex")
    faces = triangles(as_integers(corners), as_integers(sizes), vertex.rows, file)
    # Whole numbers by declaration may still be written with decimals.
    xyz = [p if p.dtype.kind == "f" else Property(p.name, np.dtype("f8")) for p in vertex.properties if p.name in _AXES]
    face = Element("face", len(faces), [Property(index_list, np.dtype("i4"), np.dtype("u1"))])
    head = plain_header("", Element("vertex", vertex.rows, xyz), face, index_list)
    return b"".join([head, points, *(b"3 %d %d %d\n" % (a, b, c) for a, b, c in faces.tolist())])


class _RowError(ValueError):
    def __init__(self, line: int, what: str) -> None:
        super().__init__(what)
        self.line = line


def _rows(data: bytes, body: int) -> Iterator[_Row]:
    first = len(data[:body].splitlines()) + 1
    for number, line in enumerate(lines(data, body), start=first):
        words = line.split()
        if words:
            yield number, words


def _vertices(rows: Iterator[_Row], element: Element, points: bytearray) -> int:
    """Append the coordinates of `rows` to `points`, in the order of the header."""
    if any(p.length is not None for p in element.properties):
        raise _RowError(1, "list properties of vertices are not read")
    names = [p.name for p in element.properties]
    i, j, k = sorted(names.index(name) for name in _AXES)
    count = 0
    for number, words in rows:
        if len(words) != len(names):
            raise _RowError(number, f"{len(words)} values where the header declares {len(names)}")
        try:
            require_numbers(words)
        except ValueError as error:
            raise _RowError(number, str(error)) from error
        points += b"%b %b %b\n" % (words[i], words[j], words[k])
        count += 1
    return count


def _faces(rows: Iterator[_Row], element: Element, index_list: str, corners: array[int], sizes: array[int]) -> int:
    for number, words in rows:
        try:
            position = 0
            for p in element.properties:
                length = integer(words[position]) if p.length is not None else 0
                if length < 0:
                    raise ValueError(f"a list of {length} values")
                position += 1
                if p.name == index_list:
                    corners.extend(map(integer, words[position : position + length]))
                    sizes.append(length)
                elif p.length is None:
                    require_numbers(words[position - 1 : position])
                position += length
        except (ValueError, IndexError) as error:
            raise _RowError(number, str(error)) from error
        if position != len(words):
            raise _RowError(number, f"{len(words)} values where the lengths of its lists ask for {position}")
    return len(sizes)
