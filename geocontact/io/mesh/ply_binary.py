"""Rows of a binary PLY file."""

from __future__ import annotations

import struct
from array import array

import numpy as np
from jaxtyping import Int

from geocontact.data.errors import InputError
from geocontact.io.mesh.ply_preflight import Element, PlyHeader, Property, plain_header
from geocontact.io.mesh.polygons import triangles
from geocontact.io.text.text_lines import as_integers

_AGAIN = "the file is cut off or damaged, export or download it again"
_Lists = tuple[Int[np.ndarray, " k"], Int[np.ndarray, " p"]]
_STRUCT = {"i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "f4": "f", "f8": "d"}


def plain_binary(data: bytes, header: PlyHeader, index_list: str, file: str) -> bytes:
    """The file as one of vertices and triangles alone; its rows end where it ends.

    Rows are handed on as they are; only faces that are not all triangles are written anew, cut into triangles.
    """
    vertex, face = (next(e for e in header.elements if e.name == name) for name in ("vertex", "face"))
    points, corners = b"", b""
    lists: _Lists | None = None
    position = header.body
    for element in header.elements:
        start, rows = position, _equal_rows(data, position, element)
        if element is vertex and (rows is None or any(p.length is not None for p in element.properties)):
            raise InputError(file, "element vertex", "is cut off or has lists, which are not read", _AGAIN)
        if rows is None:
            found, position = _walked(data, position, element, header.byte_order, index_list, file)
        else:
            position += rows.nbytes
        if element is vertex:
            points = data[start:position]
        elif element is face and rows is None:
            lists = found
        elif element is face and rows is not None:
            equal = rows[index_list]
            if equal.shape[1] == 3:
                corners = data[start:position]
            else:
                lists = equal.reshape(-1).astype(np.int64), np.full(len(equal), equal.shape[1])
    if position != len(data):
        what = f"{len(data) - position} bytes follow the last of the rows that the PLY header declares"
        raise InputError(file, "", what, _AGAIN)
    if lists is not None:
        face, corners = _cut(triangles(*lists, vertex.rows, file), header.byte_order, index_list)
    return plain_header(header.byte_order, vertex, face, index_list) + points + corners


def _cut(faces: Int[np.ndarray, "m 3"], byte_order: str, index_list: str) -> tuple[Element, bytes]:
    """Rows of triangles that hold nothing else."""
    length, kind = np.dtype("u1"), np.dtype(byte_order + "i4")
    rows = np.empty(len(faces), [("length", length), ("corners", kind, (3,))])
    rows["length"], rows["corners"] = 3, faces
    return Element("face", len(faces), [Property(index_list, kind, length)]), rows.tobytes()


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


def _walked(
    data: bytes, position: int, element: Element, byte_order: str, index_list: str, file: str
) -> tuple[_Lists, int]:
    try:
        return _walk(data, position, element, byte_order, index_list)
    except (struct.error, ValueError) as error:
        what = f"its rows do not fit in the file's {len(data)} bytes"
        raise InputError(file, f"element {element.name}", what, _AGAIN) from error


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
