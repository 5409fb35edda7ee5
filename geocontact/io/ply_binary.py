"""Rows of a binary PLY file."""

from __future__ import annotations

import struct
from array import array

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.errors import InputError
from geocontact.io.ply_preflight import Element, Header
from geocontact.io.text_lines import as_integers

_AGAIN = "the file is cut off or damaged, export or download it again"
_Lists = tuple[Int[np.ndarray, " k"], Int[np.ndarray, " p"]]
_STRUCT = {"i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "f4": "f", "f8": "d"}


def read_binary(
    data: bytes, header: Header, index_list: str, file: str
) -> tuple[Float[np.ndarray, "n 3"], Int[np.ndarray, " k"], Int[np.ndarray, " p"]]:
    """Vertices (float32 or float64 as stored), corners of all faces, number of corners of each face.

    The rows must end where the file ends. Lists of one length throughout are read at once, others row by row.
    """
    vertices: Float[np.ndarray, "n 3"] = np.empty((0, 3))
    corners, sizes = np.empty(0, np.int64), np.empty(0, np.int64)
    position = header.body
    for element in header.elements:
        rows = _equal_rows(data, position, element)
        if element.name == "vertex":
            if rows is None or any(p.length is not None for p in element.properties):
                raise InputError(file, "element vertex", "is cut off or has lists, which are not read", _AGAIN)
            vertices = _vertices(rows)
        elif rows is not None and element.name == "face":
            lists = rows[index_list].astype(np.int64)
            corners, sizes = lists.reshape(-1), np.full(len(lists), lists.shape[1], np.int64)
        if rows is not None:
            position += rows.nbytes
            continue
        try:
            (found, lengths), position = _walk(data, position, element, header.byte_order, index_list)
        except (struct.error, ValueError) as error:
            what = f"its rows do not fit in the file's {len(data)} bytes"
            raise InputError(file, f"element {element.name}", what, _AGAIN) from error
        if element.name == "face":
            corners, sizes = found, lengths
    if position != len(data):
        what = f"{len(data) - position} bytes follow the last of the rows that the PLY header declares"
        raise InputError(file, "", what, _AGAIN)
    return vertices, corners, sizes


def _equal_rows(data: bytes, position: int, element: Element) -> np.ndarray | None:
    """The rows as one structured array when every list is as long as in the first row (below 256), else None."""
    fields: list[tuple[str, np.dtype[np.generic]] | tuple[str, np.dtype[np.generic], tuple[int]]] = []
    end = position
    lists: dict[str, int] = {}
    for p in element.properties:
        if p.length is None:
            fields.append((p.name, p.dtype))
            end += p.dtype.itemsize
            continue
        if element.rows == 0 or end + p.length.itemsize > len(data):
            return None
        length = int(np.frombuffer(data, p.length, 1, end)[0])
        end += p.length.itemsize + length * p.dtype.itemsize
        if not 0 <= length < 256 or end > len(data):
            return None
        lists[f"length of {p.name}"] = length
        fields += [(f"length of {p.name}", p.length), (p.name, p.dtype, (length,))]
    row = np.dtype(fields)
    if position + element.rows * row.itemsize > len(data):
        return None
    rows = np.frombuffer(data, row, element.rows, position)
    return rows if all((rows[name] == length).all() for name, length in lists.items()) else None


def _vertices(rows: np.ndarray) -> Float[np.ndarray, "n 3"]:
    single = all(rows.dtype[name].itemsize <= 4 for name in "xyz")
    kind = np.float32 if single else np.float64
    return np.stack([rows[name].astype(kind) for name in "xyz"], axis=1)


def _walk(data: bytes, position: int, element: Element, byte_order: str, index_list: str) -> tuple[_Lists, int]:
    """Row by row; struct.error or ValueError when a row runs over the end of the file."""
    corners, sizes = array("q"), array("q")
    plan = [
        (p.name == index_list, p.length and struct.Struct(byte_order + _STRUCT[p.length.str[1:]]), p.dtype)
        for p in element.properties
    ]
    for _ in range(element.rows):
        for wanted, length, dtype in plan:
            count = 1
            if length is not None:
                (count,) = length.unpack_from(data, position)
                position += length.size
            end = position + count * dtype.itemsize
            if not position <= end <= len(data):
                raise ValueError(f"a list of {count} values at byte {position}")
            if wanted:
                corners.extend(struct.unpack_from(f"{byte_order}{count}{_STRUCT[dtype.str[1:]]}", data, position))
                sizes.append(count)
            position = end
    return (as_integers(corners), as_integers(sizes)), position
