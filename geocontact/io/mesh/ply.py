"""PLY, ASCII and binary of both byte orders: checked, made plain, and read by trimesh.

trimesh 5.2 refuses binary files that mix triangles and quads, appends the halves of such quads to ASCII ones, splits
vertices at texture seams, and takes edges for a path. It is given the vertices and triangles alone, under a header of
our own; the rows of a binary file of triangles are handed over as they are.
"""

from __future__ import annotations

import struct
from array import array
from collections.abc import Iterator
from dataclasses import dataclass, field
from io import BytesIO
from itertools import islice

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.errors import InputError
from geocontact.io.mesh import mesh_checks
from geocontact.io.mesh.mesh_checks import triangles
from geocontact.io.text.file_preflight import (
    as_integers,
    integer,
    lines,
    not_a,
    remedy,
    require_numbers,
    shown,
    warn_open_end,
)

BYTE_ORDER = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
"""numpy's sign for the byte order of each format; empty for text."""

_CODE = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"}
_CODE |= {"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4"}
_CODE |= {"float": "f4", "double": "f8", "float32": "f4", "float64": "f8"}
_TYPE = {code: kind for kind, code in _CODE.items() if not kind[-1].isdecimal()}
_HEADER_LIMIT = 1 << 16
_AGAIN = "export it again"


@dataclass(frozen=True)
class Property:
    """One property of an element: a number of type `dtype`, or a list of them when `length` (its type) is given."""

    name: str
    dtype: np.dtype[np.generic]
    length: np.dtype[np.generic] | None = None


@dataclass(frozen=True)
class Element:
    """A kind of thing (`vertex`, `face`), how many rows of it there are, and what each row holds."""

    name: str
    rows: int
    properties: list[Property] = field(default_factory=list)

    @property
    def least_row(self) -> int:
        """Bytes of a row whose lists are empty."""
        return sum((p.length or p.dtype).itemsize for p in self.properties)


@dataclass(frozen=True)
class PlyHeader:
    """Elements in the order of the file, numpy's byte order (empty for text), and the byte where the data begin."""

    byte_order: str
    elements: list[Element]
    body: int


def read_header(data: bytes, file: str) -> PlyHeader:
    """Header of a PLY file; its element counts are possible for a file of this size and are not too large."""
    lines, body = _header_lines(data, file)
    byte_order = _byte_order(lines[1] if len(lines) > 1 else "", file)
    elements: list[Element] = []
    for number, line in enumerate(lines[2:], start=3):
        try:
            _add(line.split(), byte_order or "<", elements)
        except (ValueError, KeyError, IndexError, TypeError) as error:
            what = f"bad PLY header line {shown(line.encode())}"
            raise InputError(file, f"line {number}", what, _AGAIN) from error
    header = PlyHeader(byte_order, elements, body)
    _require_possible(header, len(data) - body, file)
    return header


def plain_header(byte_order: str, vertex: Element, face: Element, index_list: str) -> bytes:
    """Header of a file that holds vertices and faces; readers find no meaning in what is not a corner or coordinate."""
    form = next(name for name, sign in BYTE_ORDER.items() if sign == byte_order)
    lines = ["ply", f"format {form} 1.0"]
    for element in (vertex, face):
        lines.append(f"element {element.name} {element.rows}")
        for number, p in enumerate(element.properties):
            name = (
                "vertex_indices"
                if p.name == index_list
                else p.name
                if p.name in ("x", "y", "z")
                else f"skipped{number}"
            )
            length = f"list {_TYPE[p.length.str[1:]]} " if p.length is not None else ""
            lines.append(f"property {length}{_TYPE[p.dtype.str[1:]]} {name}")
    return "\n".join([*lines, "end_header\n"]).encode()


def _header_lines(data: bytes, file: str) -> tuple[list[str], int]:
    if data[:3] != b"ply" or not data[3:4].isspace():
        raise not_a("a PLY file", data, file)
    newline = b"\r\n" if data[3:5] == b"\r\n" else data[3:4]
    end = data.find(newline + b"end_header" + newline, 0, _HEADER_LIMIT)
    if end < 0:
        what = f"the PLY header has no 'end_header' line in its first {_HEADER_LIMIT} bytes"
        raise InputError(file, "", what, f"it is cut off or damaged, {_AGAIN}")
    lines = data[:end].decode("ascii", "backslashreplace").split(newline.decode())
    return lines, end + len(b"end_header") + 2 * len(newline)


def _byte_order(line: str, file: str) -> str:
    words = line.split()
    if len(words) == 3 and words[0] == "format" and words[1] in BYTE_ORDER and words[2] == "1.0":
        return BYTE_ORDER[words[1]]
    what = f"PLY format line {shown(line.encode())} is not 'format {'|'.join(BYTE_ORDER)} 1.0'"
    raise InputError(file, "line 2", what, _AGAIN)


def _add(words: list[str], byte_order: str, elements: list[Element]) -> None:
    """Add what one header line declares; ValueError, KeyError, IndexError or TypeError when it is not understood."""
    match words:
        case [] | ["comment" | "obj_info", *_]:
            pass
        case ["element", name, rows] if rows.isdecimal() and len(rows) < 19:
            if any(name == element.name for element in elements):
                raise ValueError(name)
            elements.append(Element(name, int(rows)))
        case ["property", "list", length, kind, name] if _CODE[length][0] != "f":
            properties = elements[-1].properties
            properties.append(Property(name, np.dtype(byte_order + _CODE[kind]), np.dtype(byte_order + _CODE[length])))
        case ["property", kind, name]:
            elements[-1].properties.append(Property(name, np.dtype(byte_order + _CODE[kind])))
        case _:
            raise ValueError(words)


def _require_possible(header: PlyHeader, body_bytes: int, file: str) -> None:
    counts = {element.name: element.rows for element in header.elements}
    mesh_checks.require_count(counts.get("face", 0), mesh_checks.MAX_FACES, "faces", file)
    mesh_checks.require_count(counts.get("vertex", 0), mesh_checks.MAX_VERTICES, "vertices", file)
    least = 0
    for element in header.elements:
        names = [p.name for p in element.properties]
        if len(set(names)) < len(names) or (element.rows and not names):
            raise InputError(file, f"element {element.name}", "has no or repeated properties", _AGAIN)
        # A row of text takes at least one digit and one blank for each property; the last row may lack its line end.
        least += element.rows * (element.least_row if header.byte_order else 2 * len(names))
    if least > body_bytes + (not header.byte_order):
        declared = ", ".join(f"{rows} {name}" for name, rows in counts.items())
        what = f"the PLY header declares {declared}: at least {least} bytes, but {body_bytes} follow it"
        raise InputError(file, "", what, "the file is cut off or damaged, export or download it again")


_CUT_OFF = "the file is cut off or damaged, export or download it again"
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
            what, meant = f"{element.name}: {error}", remedy(error, _CUT_OFF)
            raise InputError(file, f"line {error.line}", what, meant) from error.__cause__
        if count < element.rows:
            what = f"the header declares {element.rows} rows of {element.name}, the file has {count}"
            raise InputError(file, "", what, _CUT_OFF)
    extra = next(rows, None)
    if extra is not None:
        raise InputError(file, f"line {extra[0]}", "more rows than the header declares", _CUT_OFF)
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
            raise InputError(file, "element vertex", "is cut off or has lists, which are not read", _CUT_OFF)
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
        raise InputError(file, "", what, _CUT_OFF)
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
        raise InputError(file, f"element {element.name}", what, _CUT_OFF) from error


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


INDEX_LISTS = ("vertex_indices", "vertex_index")
"""Names under which writers store the corners of a face."""


def read_ply(data: bytes, file: str) -> tuple[Float[np.ndarray, "n 3"], Int[np.ndarray, "m 3"]]:
    """Vertices of a PLY file in its own unit and precision, and its faces; other elements are skipped."""
    from trimesh.exchange.ply import load_ply  # half a second

    header = read_header(data, file)
    elements = {element.name: element for element in header.elements}
    coordinates = [_property(elements["vertex"], (name,), False, file) for name in "xyz"]
    corner_list = _property(elements["face"], INDEX_LISTS, True, file)
    if corner_list.dtype.kind == "f":
        raise InputError(file, "element face", "has vertex indices that are no integers", "export it again")
    plain = (plain_binary if header.byte_order else plain_ascii)(data, header, corner_list.name, file)
    with np.errstate(over="ignore"):  # a number too large for the declared type becomes infinite, and is refused later
        mesh = load_ply(BytesIO(plain), skip_materials=True, fix_texture=False)
    kind = np.float32 if all(p.dtype.str[1:] == "f4" for p in coordinates) else np.float64
    vertices, corners = np.asarray(mesh["vertices"]), np.asarray(mesh["faces"])
    if len(vertices) != elements["vertex"].rows or len(corners) < elements["face"].rows:
        raise InputError(file, "", "trimesh read fewer vertices or faces than the file holds", "export it again")
    sizes = np.full(len(corners), 3)
    faces = triangles(corners.reshape(-1).astype(np.int64), sizes, len(vertices), file)
    return vertices.astype(kind), faces


def _property(element: Element, names: tuple[str, ...], is_list: bool, file: str) -> Property:
    for candidate in element.properties:
        if candidate.name in names and (candidate.length is not None) == is_list:
            return candidate
    kind = "list " if is_list else ""
    what = f"has no {kind}property {' or '.join(names)}"
    raise InputError(file, f"element {element.name}", what, "export it again as a triangle surface")
