"""VTP (VTK XML PolyData): well-formed, of a known encoding, with counts within the limits.

VTK's own reader ends the process on some damaged files, which no caller can catch: what it is given (`plain_document`)
holds nothing but the arrays of a surface that were checked before.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from dataclasses import dataclass, field
from xml.etree.ElementTree import Element, ParseError, SubElement, tostring

from defusedxml.common import DefusedXmlException  # type: ignore[import-untyped]
from defusedxml.ElementTree import fromstring  # type: ignore[import-untyped]

from geocontact.data.errors import InputError
from geocontact.io.mesh import limits
from geocontact.io.text.file_preflight import not_a

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
        """As the attributes of `<VTKFile>`."""
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
class Document:
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


def read_document(data: bytes, file: str) -> Document:
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
    limits.require_count(sum(piece.polygons for piece in pieces), limits.MAX_FACES, "faces (Polys)", file)
    limits.require_count(sum(piece.points for piece in pieces), limits.MAX_VERTICES, "vertices", file)
    appended = root.find("AppendedData")
    in_base64 = raw is None
    text = (appended.text or "").strip().encode().removeprefix(b"_") if appended is not None else b""
    offsets = sorted({_whole(a.get("offset", "0"), file) for a in root.iter("DataArray") if a.get("offset")})
    return Document(_encoding(root, file), pieces, text if raw is None else raw, in_base64, offsets)


def plain_document(document: Document, piece: Piece, arrays: dict[str, Element]) -> bytes:
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
    limits.require_at_most(points, limits.MAX_VERTICES, "vertices", file)
    limits.require_at_most(polygons, limits.MAX_FACES, "faces", file)
    return Piece(element, points, polygons)


def _whole(text: str, file: str) -> int:
    if not (text.strip().isascii() and text.strip().isdecimal() and len(text) < 19):
        raise InputError(file, "", f"'{text[:24]}' is not a count or an offset", "the file is damaged, save it again")
    return int(text)
