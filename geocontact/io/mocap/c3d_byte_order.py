"""A .c3d file of MIPS (SGI) computers, whose numbers have the high byte first, as one of PC (Intel): ezc3d reads these.

Places of the numbers as c3d.org's user guide has them. Texts and numbers of one byte are the same in both.
"""

from __future__ import annotations

import struct

from geocontact.io.mocap.c3d_parameters import INTEL, entries, parameters

_BLOCK = 512
_HEADER = ((2, 12, 2), (12, 16, 4), (16, 20, 2), (20, 24, 4), (294, 304, 2), (304, 376, 4))
"""First byte, end and size of the numbers in the header: counts, scale, where data begin, rate, events and times."""

_SCALE, _DATA_START = 12, 16


def as_intel(data: bytes) -> bytes:
    """The same file with the low byte first; IndexError or struct.error where its sections cannot be followed.

    A parameter that says that the next one stands behind the section is the last one.
    """
    out = bytearray(data)
    (scale,), (first,) = struct.unpack_from(">f", data, _SCALE), struct.unpack_from(">H", data, _DATA_START)
    section = _BLOCK * (first - 1)  # its end: data follow it
    for begin, end, size in _HEADER:
        _turn(out, begin, end, size)
    for _, _, ahead_at in entries(data, ">"):
        _turn(out, ahead_at, ahead_at + 2, 2)
        if ahead_at + struct.unpack_from("<h", out, ahead_at)[0] >= section:
            out[ahead_at : ahead_at + 2] = bytes(2)
    for one in parameters(data, ">"):
        if one.kind > 1:
            _turn(out, one.numbers_at, one.numbers_at + one.kind * one.count, one.kind)
    size = 4 if scale < 0.0 else 2  # data are real where the scale is negative
    begin = (first - 1) * _BLOCK
    _turn(out, begin, begin + (len(out) - begin) // size * size, size)
    out[(data[0] - 1) * _BLOCK + 3] = INTEL
    return bytes(out)


def _turn(out: bytearray, begin: int, end: int, size: int) -> None:
    """Each number of so many bytes turned round."""
    if not 0 <= begin <= end <= len(out):
        raise IndexError(f"numbers from byte {begin} to {end} of {len(out)}")
    turned = bytearray(end - begin)
    for k in range(size):
        turned[k::size] = out[begin + size - 1 - k : end : size]
    out[begin:end] = turned
