"""Arrays of a VTP file: text, base64 inline, base64 or raw appended; plain or zlib-compressed.

They are decoded to see that they are whole: VTK 9.7 takes a text array with too many numbers, or a damaged base64 one,
without a word, and ends the process where a damaged size makes it ask for more memory than there is.
"""

from __future__ import annotations

import binascii
import zlib
from xml.etree.ElementTree import Element

import numpy as np
from jaxtyping import Int

from geocontact.io.mesh.vtp_preflight import Document, Encoding
from geocontact.io.text.text_lines import count_of_numbers

_TYPES = {f"{kind}{8 * size}": f"{kind[0].lower()}{size}" for kind in ("Int", "UInt", "Float") for size in (1, 2, 4, 8)}
_TYPES = {name: code for name, code in _TYPES.items() if code not in ("f1", "f2")}


def require_values(element: Element, count: int, document: Document) -> bytes:
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


def require_integers(element: Element, count: int, document: Document) -> Int[np.ndarray, " n"]:
    """The `count` integers of a `<DataArray>`; ValueError as in `require_values`, and when it is one of decimals."""
    stored, dtype = require_values(element, count, document), _dtype(element, document)
    if dtype.kind == "f":
        raise ValueError("they are no integers")
    if element.get("format", "ascii") == "ascii":
        return np.fromstring(stored, np.int64, sep=" ")
    return np.frombuffer(stored, dtype).astype(np.int64)


def _dtype(element: Element, document: Document) -> np.dtype[np.generic]:
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
