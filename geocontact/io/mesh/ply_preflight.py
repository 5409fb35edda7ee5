"""PLY header: complete, of a known format, and with counts that the file is long enough to hold."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from geocontact.data.errors import InputError
from geocontact.io.mesh import limits
from geocontact.io.text.file_preflight import not_a
from geocontact.io.text.text_lines import shown

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
    """Header of a PLY file; its element counts are possible for a file of this size and within `limits`."""
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
    limits.require_count(counts.get("face", 0), limits.MAX_FACES, "faces", file)
    limits.require_count(counts.get("vertex", 0), limits.MAX_VERTICES, "vertices", file)
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
