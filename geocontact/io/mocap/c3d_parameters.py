"""The parameter section of a .c3d file, of any byte order, mended where ezc3d refuses a sound file.

Layout as c3d.org's user guide has it: four bytes, then groups and parameters one after another, each with its name, how
far it is to the next, and numbers of one, two or four bytes, the last of them real. ezc3d takes counts as whole numbers
only, and rates, scales and places as real ones only.

Places of the numbers as c3d.org's user guide has them. Texts and numbers of one byte are the same in both.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from math import prod

from geocontact.data.errors import InputError

_HEADER = ((2, 12, 2), (12, 16, 4), (16, 20, 2), (20, 24, 4), (294, 304, 2), (304, 376, 4))
"""First byte, end and size of the numbers in the header: counts, scale, where data begin, rate, events and times."""

_SCALE, _FIRST_DATA_BLOCK = 12, 16


def as_intel(data: bytes) -> bytes:
    """The same file with the low byte first; IndexError or struct.error where its sections cannot be followed.

    A parameter that says that the next one stands behind the section is the last one.
    """
    out = bytearray(data)
    (scale,), (first,) = struct.unpack_from(">f", data, _SCALE), struct.unpack_from(">H", data, _FIRST_DATA_BLOCK)
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


INTEL, MIPS = 84, 86
"""Processor types in the parameter section; numbers of the second have the high byte first."""

COUNTS = {
    "POINT": ("USED", "FRAMES", "DATA_START"),
    "ANALOG": ("USED", "OFFSET"),
    "FORCE_PLATFORM": ("USED", "TYPE", "CHANNEL", "ZERO"),
}
"""Parameters that are whole numbers, which some programs write as real ones."""

REALS = {
    "POINT": ("RATE", "SCALE"),
    "ANALOG": ("RATE", "SCALE", "GEN_SCALE"),
    "FORCE_PLATFORM": ("CORNERS", "ORIGIN", "CAL_MATRIX"),
}
"""Parameters that are real numbers, which some programs write as whole ones."""

_WHOLE, _REAL = 2, 4
_LARGEST = 0x7FFF
_BLOCK = 512
_DATA_START = 16  # in the header, the first block of data
_CLOSING = 4  # bytes of nothing behind the last parameter: its description's length, and an end


@dataclass(frozen=True)
class C3dParameter:
    """A parameter: its names, kind of number (bytes), how many there are, and where kind and numbers stand in the
    file.
    """

    group: str
    name: str
    kind: int
    count: int
    kind_at: int
    numbers_at: int


def processor(data: bytes) -> int:
    """Type of the processor by the parameter section; 0 where there is none."""
    at = (data[0] - 1) * _BLOCK
    return data[at + 3] if 0 <= at < len(data) - 3 else 0


def with_whole_counts(data: bytes, file: str, analogs: bool) -> bytes | None:
    """The file with counts as whole numbers; None where there is nothing to change.

    Without `analogs` the offsets of channels are rounded, as nothing else depends on them; with them InputError for one
    that is not whole, which ezc3d cannot take off.
    """
    if processor(data) != INTEL:
        return None
    try:
        found = [p for p in parameters(data) if p.kind == _REAL and p.name in COUNTS.get(p.group, ())]
        numbers = [struct.unpack_from(f"<{p.count}f", data, p.numbers_at) for p in found]
    except (IndexError, struct.error):  # a damaged section is for ezc3d to judge
        return None
    if not found:
        return None
    out, start = bytearray(data), (data[0] - 1) * _BLOCK
    end = start + _BLOCK * data[start + 2]
    for parameter, values in zip(reversed(found), reversed(numbers), strict=True):
        _require_whole(file, parameter, values, analogs)
        _shorten(out, parameter, [round(value) for value in values], end)
    return bytes(out)


def _require_whole(file: str, parameter: C3dParameter, values: tuple[float, ...], analogs: bool) -> None:
    for value in values:
        if abs(value) <= _LARGEST and (value == round(value) or not analogs):
            continue
        what = f"is {value:g}; ezc3d takes whole numbers of two bytes there, the file itself may be sound"
        raise InputError(file, f"{parameter.group}:{parameter.name}", what, "save it with whole numbers")


def _shorten(out: bytearray, parameter: C3dParameter, values: list[int], end: int) -> None:
    """Numbers of two bytes for those of four; what follows in the section moves up."""
    at, spared = parameter.numbers_at, 2 * parameter.count
    (ahead,) = struct.unpack_from("<h", out, parameter.kind_at - 2)
    if ahead:
        struct.pack_into("<h", out, parameter.kind_at - 2, ahead - spared)
    out[parameter.kind_at] = _WHOLE
    out[at:end] = struct.pack(f"<{len(values)}h", *values) + out[at + 2 * spared : end] + bytes(spared)


def with_real_numbers(data: bytes) -> bytes | None:
    """The file with rates, scales and places as real numbers; None where there is nothing to change.

    The section grows by blocks where it must, and what follows it moves.
    """
    if processor(data) != INTEL:
        return None
    try:
        found = [p for p in parameters(data) if p.kind == _WHOLE and p.name in REALS.get(p.group, ())]
        numbers = [struct.unpack_from(f"<{p.count}h", data, p.numbers_at) for p in found]
        start = (data[0] - 1) * _BLOCK
        end = start + _BLOCK * data[start + 2]
        out = bytearray(data)
        for parameter, values in zip(reversed(found), reversed(numbers), strict=True):
            _widen(out, parameter, values)
        return _in_blocks(out, start, end, len(out) - len(data)) if found else None
    except (IndexError, struct.error):
        return None


def _widen(out: bytearray, parameter: C3dParameter, values: tuple[int, ...]) -> None:
    """Numbers of four bytes for those of two; all that follows in the file moves down."""
    (ahead,) = struct.unpack_from("<h", out, parameter.kind_at - 2)
    if ahead:
        struct.pack_into("<h", out, parameter.kind_at - 2, ahead + 2 * len(values))
    out[parameter.kind_at] = _REAL
    at = parameter.numbers_at
    out[at : at + 2 * len(values)] = struct.pack(f"<{len(values)}f", *values)


def _in_blocks(out: bytearray, start: int, end: int, grown: int) -> bytes:
    """The file with its section, which was to end at `end` and has grown, in whole blocks, and its data after them."""
    before = (end - start) // _BLOCK
    used = len(out[start : end + grown].rstrip(b"\0")) + _CLOSING
    after = max(before, -(-used // _BLOCK))
    section = bytes(out[start : end + grown])[: after * _BLOCK].ljust(after * _BLOCK, b"\0")
    out[start : end + grown] = section
    out[start + 2] = after
    places = [_DATA_START, *(p.numbers_at for p in parameters(out) if (p.group, p.name) == ("POINT", "DATA_START"))]
    for place in places:
        (data_start,) = struct.unpack_from("<H", out, place)
        struct.pack_into("<H", out, place, data_start + after - before)
    return bytes(out)


def parameters(data: bytes | bytearray, order: str = "<") -> Iterator[C3dParameter]:
    """All parameters, as far as the section can be followed; groups come before theirs or after.

    `order` of the bytes is that of `struct`.
    """
    groups: dict[int, str] = {}
    places: list[tuple[int, str, int]] = []
    for group, name, ahead_at in entries(data, order):
        if group < 0:
            groups[-group] = name
        else:
            places.append((group, name, ahead_at + 2))
    for group, name, kind_at in places:
        (kind,) = struct.unpack_from("<b", data, kind_at)
        sizes = data[kind_at + 2 : kind_at + 2 + data[kind_at + 1]]
        yield C3dParameter(groups.get(group, ""), name, kind, prod(sizes), kind_at, kind_at + 2 + len(sizes))


def entries(data: bytes | bytearray, order: str = "<") -> Iterator[tuple[int, str, int]]:
    """Number (negative of a group), name, and where it says how far it is to the next, of groups and parameters."""
    at = (data[0] - 1) * _BLOCK + 4
    end = min(at - 4 + _BLOCK * (data[at - 2] or len(data)), len(data))  # some programs do not count the blocks
    while at < end and data[at] != 0:
        letters, group = struct.unpack_from("<bb", data, at)
        ahead_at = at + 2 + abs(letters)
        (ahead,) = struct.unpack_from(f"{order}h", data, ahead_at)
        yield group, data[at + 2 : ahead_at].decode("latin-1").upper(), ahead_at
        if ahead <= 0:
            break
        at = ahead_at + ahead
