"""Arrays of a VTP file: text, base64 inline, base64 or raw appended; plain or zlib-compressed."""

from __future__ import annotations

import binascii
import zlib
from bisect import bisect_right
from xml.etree.ElementTree import Element

import numpy as np

from geocontact.io.text_lines import as_numbers
from geocontact.io.vtp_preflight import Document, Encoding

_TYPES = {f"{kind}{8 * size}": f"{kind[0].lower()}{size}" for kind in ("Int", "UInt", "Float") for size in (1, 2, 4, 8)}
_TYPES = {name: code for name, code in _TYPES.items() if code not in ("f1", "f2")}


def array_values(element: Element, count: int, document: Document) -> np.ndarray:
    """The `count` numbers of a `<DataArray>` in the type it declares.

    `count` is what the rest of the file asks for; ValueError when the array has another number of values or cannot be
    decoded. Nothing larger than `count` numbers is decompressed.
    """
    declared = element.get("type", "")
    if declared not in _TYPES:
        raise ValueError(f"numbers of type {declared or 'unknown'} are not read")
    dtype = np.dtype(document.encoding.byte_order + _TYPES[declared])
    text, element.text = (element.text or "").encode(), None
    match element.get("format", "ascii"):
        case _ if count == 0:
            return np.empty(0, dtype)
        case "ascii":
            return _from_text(text, count, dtype)
        case "binary":
            stored = _base64(text)
        case "appended":
            stored = _appended(int(element.get("offset", "0")), document)
        case other:
            raise ValueError(f"format {other} is not read")
    decode = _inflated if document.encoding.compressed else _plain
    return np.frombuffer(decode(stored, count * dtype.itemsize, document.encoding), dtype)


def _from_text(text: bytes, count: int, dtype: np.dtype[np.generic]) -> np.ndarray:
    values = as_numbers(text, integers=dtype.kind != "f")
    if len(values) != count:
        raise ValueError(f"{len(values)} numbers where {count} are declared")
    with np.errstate(over="ignore"):
        return values.astype(dtype)


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


def _appended(offset: int, document: Document) -> bytes:
    later = bisect_right(document.offsets, offset)
    stop = document.offsets[later] if later < len(document.offsets) else len(document.appended)
    if not 0 <= offset < len(document.appended):
        raise ValueError(f"offset {offset} is outside the {len(document.appended)} bytes of appended data")
    stored = document.appended[offset:stop]
    return _base64(stored) if document.base64 else stored


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
