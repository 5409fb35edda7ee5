"""Parameter section of a .c3d file, read for what makes ezc3d refuse a sound file.

Layout as c3d.org's user guide has it: four bytes, then groups and parameters one after another, each with its name, how
far it is to the next, and numbers of one, two or four bytes, the last of them real.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from math import prod

from geocontact.data.errors import InputError

INTEL, MIPS = 84, 86
"""Processor types in the parameter section; integers of the second have the high byte first."""

COUNTS = {
    "POINT": ("USED", "FRAMES", "DATA_START"),
    "ANALOG": ("USED", "OFFSET"),
    "FORCE_PLATFORM": ("USED", "TYPE", "CHANNEL", "ZERO"),
}
"""Parameters that are whole numbers, which some programs write as real ones; ezc3d takes whole ones only."""

_WHOLE, _REAL = 2, 4
_LARGEST = 0x7FFF
_BLOCK = 512


@dataclass(frozen=True)
class _Parameter:
    """Its names, kind of number (bytes), how many there are, and where kind and numbers stand in the file."""

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
        found = [p for p in _parameters(data) if p.kind == _REAL and p.name in COUNTS.get(p.group, ())]
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


def _require_whole(file: str, parameter: _Parameter, values: tuple[float, ...], analogs: bool) -> None:
    for value in values:
        if abs(value) <= _LARGEST and (value == round(value) or not analogs):
            continue
        what = f"is {value:g}; ezc3d takes whole numbers of two bytes there, the file itself may be sound"
        raise InputError(file, f"{parameter.group}:{parameter.name}", what, "save it with whole numbers")


def _shorten(out: bytearray, parameter: _Parameter, values: list[int], end: int) -> None:
    """Numbers of two bytes for those of four; what follows in the section moves up."""
    at, spared = parameter.numbers_at, 2 * parameter.count
    (ahead,) = struct.unpack_from("<h", out, parameter.kind_at - 2)
    if ahead:
        struct.pack_into("<h", out, parameter.kind_at - 2, ahead - spared)
    out[parameter.kind_at] = _WHOLE
    out[at:end] = struct.pack(f"<{len(values)}h", *values) + out[at + 2 * spared : end] + bytes(spared)


def _parameters(data: bytes) -> Iterator[_Parameter]:
    """All parameters, as far as the section can be followed; groups come before theirs or after."""
    at, groups = (data[0] - 1) * _BLOCK + 4, dict[int, str]()
    places: list[tuple[int, int, str, int]] = []
    while at < len(data) and data[at] != 0:
        letters, group = struct.unpack_from("<bb", data, at)
        name = data[at + 2 : at + 2 + abs(letters)].decode("latin-1")
        ahead_at = at + 2 + abs(letters)
        (ahead,) = struct.unpack_from("<h", data, ahead_at)
        if group < 0:
            groups[-group] = name.upper()
        else:
            places.append((group, struct.unpack_from("<b", data, ahead_at + 2)[0], name.upper(), ahead_at + 2))
        if ahead <= 0:
            break
        at = ahead_at + ahead
    for group, kind, name, kind_at in places:
        sizes = data[kind_at + 2 : kind_at + 2 + data[kind_at + 1]]
        yield _Parameter(groups.get(group, ""), name, kind, prod(sizes), kind_at, kind_at + 2 + len(sizes))
