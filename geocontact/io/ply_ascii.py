"""Rows of an ASCII PLY file."""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from itertools import islice

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.errors import InputError
from geocontact.io.ply_preflight import Element, Header
from geocontact.io.text_lines import as_floats, as_integers, integer, lines, numbers, warn_open_end

_AGAIN = "the file is cut off or damaged, export or download it again"
_Row = tuple[int, list[bytes]]


def read_ascii(
    data: bytes, header: Header, index_list: str, file: str
) -> tuple[Float[np.ndarray, "n 3"], Int[np.ndarray, " k"], Int[np.ndarray, " p"]]:
    """Vertices (float32 when the header says so), corners of all faces, number of corners of each face.

    Every element takes one line; blank lines do not count.
    """
    rows = _rows(data, header.body)
    vertices: Float[np.ndarray, "n 3"] = np.empty((0, 3))
    corners, sizes = array("q"), array("q")
    for element in header.elements:
        some = islice(rows, element.rows)
        try:
            if element.name == "vertex":
                count, vertices = _vertices(some, element)
            elif element.name == "face":
                count = _faces(some, element, index_list, corners, sizes)
            else:
                count = sum(1 for _ in some)
        except _RowError as error:
            raise InputError(file, f"line {error.line}", f"{element.name}: {error}", _AGAIN) from error.__cause__
        if count < element.rows:
            what = f"the header declares {element.rows} rows of {element.name}, the file has {count}"
            raise InputError(file, "", what, _AGAIN)
    extra = next(rows, None)
    if extra is not None:
        raise InputError(file, f"line {extra[0]}", "more rows than the header declares", _AGAIN)
    warn_open_end(data, file)
    return vertices, as_integers(corners), as_integers(sizes)


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


def _vertices(rows: Iterator[_Row], element: Element) -> tuple[int, Float[np.ndarray, "n 3"]]:
    if any(p.length is not None for p in element.properties):
        raise _RowError(1, "list properties of vertices are not read")
    names = [p.name for p in element.properties]
    columns = [names.index(name) for name in "xyz"]
    values = array("d")
    for number, words in rows:
        if len(words) != len(names):
            raise _RowError(number, f"{len(words)} values where the header declares {len(names)}")
        try:
            found = numbers(words)
        except ValueError as error:
            raise _RowError(number, str(error)) from error
        values.extend([found[i] for i in columns])
    vertices = as_floats(values).reshape(-1, 3)
    if all(element.properties[i].dtype.itemsize <= 4 for i in columns):
        with np.errstate(over="ignore"):
            return len(vertices), vertices.astype(np.float32)
    return len(vertices), vertices


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
                    numbers(words[position - 1 : position])
                position += length
        except (ValueError, IndexError) as error:
            raise _RowError(number, str(error)) from error
        if position != len(words):
            raise _RowError(number, f"{len(words)} values where the lengths of its lists ask for {position}")
    return len(sizes)
