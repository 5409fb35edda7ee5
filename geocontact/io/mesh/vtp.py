"""VTP (VTK XML PolyData): checked by us, then read by VTK, which comes with pyvista.

Points and polygons are read; lines, single points and data arrays are passed over.

VTK's own reader ends the process on some damaged files, which no caller can catch: what it is given (`plain_document`)
holds nothing but the arrays of a surface that were checked before.

They are decoded to see that they are whole: VTK 9.7 takes a text array with too many numbers, or a damaged base64 one,
without a word, and ends the process where a damaged size makes it ask for more memory than there is.
"""

from __future__ import annotations

import binascii
import re
import zlib
from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TypeVar
from xml.etree.ElementTree import Element, ParseError, SubElement, tostring

import numpy as np
from defusedxml.common import DefusedXmlException  # type: ignore[import-untyped]
from defusedxml.ElementTree import fromstring  # type: ignore[import-untyped]
from jaxtyping import Float, Int

from geocontact.data.errors import InputError, memory_is_short
from geocontact.io.mesh import mesh_checks
from geocontact.io.mesh.mesh_checks import triangles
from geocontact.io.text.file_preflight import count_of_numbers, not_a, remedy

_RAW = re.compile(rb"<AppendedData\b[^>]*\bencoding\s*=\s*[\"']raw[\"'][^>]*>\s*_")
_RAW_END = b"</AppendedData>"
_ORDERS = {"LittleEndian": "<", "BigEndian": ">"}
_HEADERS = {"UInt32": "u4", "UInt64": "u8"}
_ZLIB = "vtkZLibDataCompressor"
_RESAVE = 'save it again, for example by pyvista.read("x.vtp").save("y.vtp")'


@dataclass(frozen=True)
class Encoding:
    """How the arrays of the file are stored: numpy's byte order sign, type of the block sizes, zlib or not."""

    byte_order: str
    header: str
    compressed: bool

    @property
    def attributes(self) -> dict[str, str]:
        """The attributes of `<VTKFile>` that numbers need."""
        named = {
            "byte_order": next(name for name, sign in _ORDERS.items() if sign == self.byte_order),
            "header_type": next(name for name, code in _HEADERS.items() if code == self.header),
        }
        return named | ({"compressor": _ZLIB} if self.compressed else {})


@dataclass(frozen=True)
class Piece:
    """One `<Piece>`: its element and the numbers of points and polygons it declares."""

    element: Element
    points: int
    polygons: int


@dataclass(frozen=True)
class VtpDocument:
    """The parsed XML without its appended raw bytes, which come along unparsed.

    `appended` are the bytes after the underscore, raw or still base64 text (`base64`); `offsets` are where arrays
    begin in them, ascending.
    """

    encoding: Encoding
    pieces: list[Piece]
    appended: bytes = b""
    base64: bool = True
    offsets: list[int] = field(default_factory=list)

    def appended_at(self, array: Element) -> bytes:
        """What is appended for a `<DataArray>`, up to where the next one begins; ValueError when nothing is."""
        offset = int(array.get("offset", "0"))
        later = bisect_right(self.offsets, offset)
        stop = self.offsets[later] if later < len(self.offsets) else len(self.appended)
        if not 0 <= offset < len(self.appended):
            raise ValueError(f"offset {offset} is outside the {len(self.appended)} bytes of appended data")
        return self.appended[offset:stop]


def read_document(data: bytes, file: str) -> VtpDocument:
    """Structure of a VTP file; refuses other VTK types, entities and document types, triangle strips, no polygons."""
    if b"<VTKFile" not in data:
        raise not_a("a VTP file", data, file)
    xml, raw = _without_raw_bytes(data, file)
    try:
        root: Element = fromstring(xml, forbid_dtd=True)
    except DefusedXmlException as error:
        raise InputError(file, "", "declares a document type or entities, which are not read", _RESAVE) from error
    except (ParseError, ValueError, LookupError) as error:
        raise InputError(file, "", f"is not well-formed XML ({error})", "it is cut off or damaged") from error
    if root.tag != "VTKFile" or root.get("type") != "PolyData":
        what = f"holds {root.tag} {root.get('type', '')}, expected VTKFile PolyData"
        raise InputError(file, "", what, "save the surface as PolyData")
    pieces = [_piece(element, file) for element in root.iterfind("PolyData/Piece")]
    mesh_checks.require_count(sum(piece.polygons for piece in pieces), mesh_checks.MAX_FACES, "faces (Polys)", file)
    mesh_checks.require_count(sum(piece.points for piece in pieces), mesh_checks.MAX_VERTICES, "vertices", file)
    appended = root.find("AppendedData")
    in_base64 = raw is None
    text = (appended.text or "").strip().encode().removeprefix(b"_") if appended is not None else b""
    offsets = sorted({_whole(a.get("offset", "0"), file) for a in root.iter("DataArray") if a.get("offset")})
    return VtpDocument(_encoding(root, file), pieces, text if raw is None else raw, in_base64, offsets)


def plain_document(document: VtpDocument, piece: Piece, arrays: dict[str, Element]) -> bytes:
    """A file with nothing in it but one piece and its arrays `Points`, `connectivity` and `offsets`.

    One piece, because VTK 9.7 numbers the vertices wrongly behind a piece without polygons.
    """
    root = Element("VTKFile", {"type": "PolyData", "version": "1.0", **document.encoding.attributes})
    counts = {"NumberOfPoints": str(piece.points), "NumberOfPolys": str(piece.polygons)}
    inner = SubElement(SubElement(root, "PolyData"), "Piece", counts)
    groups = {name: SubElement(inner, name) for name in ("Points", "Polys")}
    appended = b""
    for name, array in arrays.items():
        kept = {key: array.get(key, "") for key in ("type", "format") if array.get(key)}
        kept |= {"NumberOfComponents": "3"} if name == "Points" else {"Name": name}
        if array.get("format") == "appended":
            kept["offset"] = str(len(appended))
            appended += document.appended_at(array)
        SubElement(groups["Points" if name == "Points" else "Polys"], "DataArray", kept).text = array.text
    xml: bytes = tostring(root, "utf-8")
    if not appended:
        return xml
    encoding = b"base64" if document.base64 else b"raw"
    head = xml.removesuffix(b"</VTKFile>") + b'<AppendedData encoding="%b">_' % encoding
    return b"".join([head, appended, b"</AppendedData></VTKFile>"])


def _without_raw_bytes(data: bytes, file: str) -> tuple[bytes, bytes | None]:
    """XML with its raw appended section emptied, and that section; None when there is none."""
    start = _RAW.search(data)
    if start is None:
        return data, None
    end = data.rfind(_RAW_END)
    if end < start.end():
        raise InputError(file, "", "the appended data have no end", "it is cut off or damaged")
    return data[: start.end()] + data[end:], data[start.end() : end]


def _encoding(root: Element, file: str) -> Encoding:
    order, header = root.get("byte_order", "LittleEndian"), root.get("header_type", "UInt32")
    compressor = root.get("compressor", "")
    if order not in _ORDERS or header not in _HEADERS or compressor not in ("", _ZLIB):
        what = f"byte_order {order}, header_type {header}, compressor {compressor or 'none'} are not read"
        raise InputError(file, "VTKFile", what, _RESAVE)
    return Encoding(_ORDERS[order], _HEADERS[header], compressor == _ZLIB)


def _piece(element: Element, file: str) -> Piece:
    if _whole(element.get("NumberOfStrips", "0"), file):
        raise InputError(file, "Piece", "holds triangle strips", "triangulate it first")
    points, polygons = (_whole(element.get(name, "0"), file) for name in ("NumberOfPoints", "NumberOfPolys"))
    mesh_checks.require_at_most(points, mesh_checks.MAX_VERTICES, "vertices", file)
    mesh_checks.require_at_most(polygons, mesh_checks.MAX_FACES, "faces", file)
    return Piece(element, points, polygons)


def _whole(text: str, file: str) -> int:
    if not (text.strip().isascii() and text.strip().isdecimal() and len(text) < 19):
        raise InputError(file, "", f"'{text[:24]}' is not a count or an offset", "the file is damaged, save it again")
    return int(text)


_TYPES = {f"{kind}{8 * size}": f"{kind[0].lower()}{size}" for kind in ("Int", "UInt", "Float") for size in (1, 2, 4, 8)}
_TYPES = {name: code for name, code in _TYPES.items() if code not in ("f1", "f2")}


def require_values(element: Element, count: int, document: VtpDocument) -> bytes:
    """Refuse (ValueError) a `<DataArray>` that cannot be decoded or does not hold `count` numbers; its text or bytes.

    `count` is what the rest of the file asks for; nothing larger than `count` numbers is decompressed.
    """
    dtype = _dtype(element, document)
    text = (element.text or "").encode()
    match element.get("format", "ascii"):
        case "ascii":
            found = count_of_numbers(text, integers=dtype.kind != "f")
            if found != count:
                raise ValueError(f"{found} numbers where {count} are declared")
            return text
        case "binary":
            stored = _base64(text)
        case "appended":
            stored = document.appended_at(element)
            stored = _base64(stored) if document.base64 else stored
        case other:
            raise ValueError(f"format {other} is not read")
    decode = _inflated if document.encoding.compressed else _plain
    return decode(stored, count * dtype.itemsize, document.encoding)


def require_integers(element: Element, count: int, document: VtpDocument) -> Int[np.ndarray, " n"]:
    """The `count` integers of a `<DataArray>`; ValueError as in `require_values`, and when it is one of decimals."""
    stored, dtype = require_values(element, count, document), _dtype(element, document)
    if dtype.kind == "f":
        raise ValueError("they are not integers")
    if element.get("format", "ascii") == "ascii":
        return np.fromstring(stored, np.int64, sep=" ")
    return np.frombuffer(stored, dtype).astype(np.int64)


def _dtype(element: Element, document: VtpDocument) -> np.dtype[np.generic]:
    declared = element.get("type", "")
    if declared not in _TYPES:
        raise ValueError(f"numbers of type {declared or 'unknown'} are not read")
    return np.dtype(document.encoding.byte_order + _TYPES[declared])


def _base64(text: bytes) -> bytes:
    """Decode base64 that may consist of several padded runs, as VTK writes sizes and data."""
    text, runs = b"".join(text.split()), []
    start = 0
    while start < len(text):
        pad = text.find(b"=", start)
        stop = len(text) if pad < 0 else start + -(-(pad + 1 - start) // 4) * 4
        runs.append(binascii.a2b_base64(text[start:stop], strict_mode=True))
        start = stop
    return runs[0] if len(runs) == 1 else b"".join(runs)


def _sizes(stored: bytes, count: int, encoding: Encoding) -> list[int]:
    head = np.dtype(encoding.byte_order + encoding.header)
    if count < 0 or count * head.itemsize > len(stored):
        raise ValueError(f"{len(stored)} bytes are too few for their own sizes")
    return [int(size) for size in np.frombuffer(stored, head, count)]


def _plain(stored: bytes, expected: int, encoding: Encoding) -> bytes:
    (size,) = _sizes(stored, 1, encoding)
    head = int(encoding.header[1])
    if size != expected or size + head > len(stored):
        raise ValueError(f"{size} bytes declared and {len(stored) - head} there where {expected} are needed")
    return stored[head : head + size]


def _inflated(stored: bytes, expected: int, encoding: Encoding) -> bytes:
    blocks, size, last = _sizes(stored, 3, encoding)
    sizes = _sizes(stored, 3 + blocks, encoding)[3:]
    whole = [size] * blocks
    if last and blocks:
        whole[-1] = last
    if sum(whole) != expected:
        raise ValueError(f"{sum(whole)} bytes declared where {expected} are needed")
    position = (3 + blocks) * int(encoding.header[1])
    parts = []
    for packed, unpacked in zip(sizes, whole, strict=True):
        inflate = zlib.decompressobj()
        part = inflate.decompress(stored[position : position + packed], unpacked + 1)
        if len(part) != unpacked or not inflate.eof:
            raise ValueError(f"a compressed block gives {len(part)} bytes instead of {unpacked}")
        parts.append(part)
        position += packed
    return b"".join(parts)


_Checked = TypeVar("_Checked")
_AGAIN = "the file is damaged, save it again"


def read_vtp(data: bytes, file: str) -> tuple[Float[np.ndarray, "n 3"], Int[np.ndarray, "m 3"]]:
    """Vertices in the file's own unit and precision and the faces of all pieces, in the order of the file."""
    document = read_document(data, file)
    points, corners, sizes, before = [], [], [], 0
    for piece in document.pieces:
        arrays = _checked_arrays(piece, document, file)
        if not piece.points and not piece.polygons:
            continue
        found, ends, indices = _parsed(plain_document(document, piece, arrays), file)
        if (len(found), len(ends) - 1) != (piece.points, piece.polygons):
            what = "VTK read another number of points or polygons than the file holds"
            raise InputError(file, "", what, _AGAIN)
        lowest, highest = (int(indices.min()), int(indices.max())) if len(indices) else (0, 0)
        if lowest < 0 or highest >= piece.points:
            what = f"vertex index {lowest if lowest < 0 else highest} is outside 0 to {piece.points - 1}"
            raise InputError(file, "Polys connectivity", what, _AGAIN)
        points.append(found)
        corners.append(indices + before)
        sizes.append(np.diff(ends))
        before += piece.points
    vertices = np.concatenate(points)
    return vertices, triangles(np.concatenate(corners), np.concatenate(sizes), len(vertices), file)


def _checked_arrays(piece: Piece, document: VtpDocument, file: str) -> dict[str, Element]:
    """The arrays of a surface, each of which holds as many numbers as the others ask for."""
    arrays = {}
    if piece.points:
        arrays["Points"], _ = _checked(require_values, piece, "Points", None, 3 * piece.points, document, file)
    if piece.polygons:
        arrays["offsets"], ends = _checked(require_integers, piece, "Polys", "offsets", piece.polygons, document, file)
        if np.diff(ends, prepend=0).min() < 0:
            raise InputError(file, "Polys offsets", "do not ascend", _AGAIN)
        total = int(ends[-1])
        mesh_checks.require_at_most(total, 3 * mesh_checks.MAX_FACES, "polygon corners", file)
        arrays["connectivity"], _ = _checked(require_integers, piece, "Polys", "connectivity", total, document, file)
    return arrays


def _checked(
    check: Callable[[Element, int, VtpDocument], _Checked],
    piece: Piece,
    group: str,
    name: str | None,
    count: int,
    document: VtpDocument,
    file: str,
) -> tuple[Element, _Checked]:
    place = " ".join(part for part in (group, name) if part)
    element = _find(piece.element, group, name)
    if element is None:
        raise InputError(file, place, "is missing", _AGAIN)
    try:
        return element, check(element, count, document)
    except (ValueError, zlib.error) as error:
        raise InputError(file, place, f"cannot be read: {error}", remedy(error, _AGAIN)) from error


def _find(piece: Element, group: str, name: str | None) -> Element | None:
    for element in piece.iterfind(f"{group}/DataArray"):
        if name is None or element.get("Name") == name:
            return element
    return None


def _parsed(
    document: bytes, file: str
) -> tuple[Float[np.ndarray, "n 3"], Int[np.ndarray, " p1"], Int[np.ndarray, " k"]]:
    """Points, ends of the polygons (0 before the first) and their corners as VTK reads them."""
    try:
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
    except ImportError as error:
        if memory_is_short(error):
            raise
        what = f".vtp is read by VTK, which comes with pyvista and cannot be used here ({error})"
        raise InputError(file, "", what, "pip install 'geocontact[view]', or convert it to .stl or .ply") from error
    reader, complaints = vtkXMLPolyDataReader(), []
    reader.AddObserver("ErrorEvent", lambda *_: complaints.append("error"))
    reader.ReadFromInputStringOn()
    reader.SetInputString(document)  # type: ignore[call-overload]  # a std::string, which takes bytes
    reader.Update()
    surface = reader.GetOutput()
    if complaints or surface.GetPoints() is None:
        raise InputError(file, "", "VTK cannot read its numbers", _AGAIN)
    points = vtk_to_numpy(surface.GetPoints().GetData())
    polygons = surface.GetPolys()
    ends, corners = (vtk_to_numpy(a) for a in (polygons.GetOffsetsArray(), polygons.GetConnectivityArray()))
    kind = np.float32 if points.dtype == np.float32 else np.float64
    return points.astype(kind), ends.astype(np.int64), corners.astype(np.int64)
