"""Head of OpenSim's text tables (.mot, .sto): declared counts and what it says of angles.

Both forms are read: `nRows=`, `nColumns=`, `inDegrees=` with optional free text (versions 1 to 3), and SIMM's
`name`, `datacolumns`, `datarows`, `range`. Everything ends with a line `endheader`.
Source: OpenSim 4.6, Storage.cpp and STOFileAdapter; SIMM 4 manual, motion files.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from io import TextIOBase
from typing import Literal

from geocontact.data.errors import InputError

AngleUnit = Literal["deg", "rad"]

LONGEST_LINE = 1_000_000
"""Characters of a header or label line; longer ones are not tables."""

_LONGEST_HEADER = 2000
_PAIR = re.compile(r"(\w+)\s*=\s*(.*)")
_SIMM = re.compile(r"(datacolumns|datarows)\s+(\S+)", re.IGNORECASE)
_ROWS = ("nrows", "nr", "datarows")
_COLUMNS = ("ncolumns", "nc", "datacolumns")
_YES_NO: dict[str, AngleUnit] = {"yes": "deg", "y": "deg", "true": "deg", "no": "rad", "n": "rad", "false": "rad"}


@dataclass(frozen=True)
class AngleEvidence:
    """What a header says of its angles.

    `unit` is None when it says nothing or contradicts itself; `text` is the line it says it in and `line` its number
    (0 when it says nothing); `conflict` is the contradiction in words, else "". `simm` marks SIMM's header form, which
    has no place for a unit and is in degrees by convention.
    """

    unit: AngleUnit | None = None
    text: str = ""
    line: int = 0
    conflict: str = ""
    simm: bool = False


@dataclass(frozen=True)
class StorageHeader:
    """Declared counts, each with the text and the line that declares it, and the evidence on angles.

    `version` is "" where none is given; `lines` is the number of lines up to and including `endheader`.
    """

    rows: tuple[tuple[int, str, int], ...]
    columns: tuple[tuple[int, str, int], ...]
    angles: AngleEvidence
    version: str
    lines: int


def read_storage_header(stream: TextIOBase, file: str, kind: str = "double") -> StorageHeader:
    """Header of a .mot or .sto file with cells of a kind; `stream` is left at the line of column labels.

    A file that does not say its `DataType` holds plain numbers (double).
    """
    rows: list[tuple[int, str, int]] = []
    columns: list[tuple[int, str, int]] = []
    said: list[tuple[AngleUnit, str, int]] = []
    simm, version, number, said_kind = False, "", 0, "double"
    for number, line in _header_lines(stream, file):
        key, value, simm_key = _pair(line)
        simm |= simm_key
        if key in _ROWS or key in _COLUMNS:
            (rows if key in _ROWS else columns).append((_count(value, line, number, file), line, number))
        elif key == "version":
            version = value
        elif key == "indegrees":
            said.append((_flag(value, number, file), f"inDegrees={value}", number))
        elif key == "datatype":
            said_kind = value.lower()
            if said_kind != kind:
                wanted = "export plain numbers (double)" if kind == "double" else f"DataType={kind.title()} is expected"
                raise InputError(file, f"line {number}", f"DataType={value} cannot be used", wanted)
        elif (unit := unit_in_text(line)) is not None:
            said.append((unit, line, number))
    if said_kind != kind:
        raise InputError(file, "", f"holds plain numbers, not DataType={kind.title()}", "export orientations")
    return StorageHeader(tuple(rows), tuple(columns), _judge(said, simm), version, number + 1)


def unit_in_text(line: str) -> AngleUnit | None:
    """Unit of angles that a line of free text states: "Angles are in degrees." gives "deg".

    OpenSim's standard sentence "… in degrees (yes) or radians (no)" names both and is no evidence; nor is a line
    with a negation.
    """
    words = set(re.findall(r"[a-z]+", line.lower()))
    degrees, radians = bool(words & {"degree", "degrees"}), bool(words & {"radian", "radians"})
    if degrees == radians or words & {"not", "neither", "whether", "if"}:
        return None
    return "deg" if degrees else "rad"


def _header_lines(stream: TextIOBase, file: str) -> Iterator[tuple[int, str]]:
    for number in range(1, _LONGEST_HEADER + 1):
        line = stream.readline(LONGEST_LINE)
        text = line.strip()
        if text.lower() == "endheader":
            return
        if not line or len(line) >= LONGEST_LINE:
            break
        yield number, text
    raise InputError(file, "", "no line 'endheader' found", "is this an OpenSim .mot or .sto file, and complete?")


def _pair(line: str) -> tuple[str, str, bool]:
    """Key in lower case, value, and whether it is SIMM's `key value` form; empty key for free text."""
    if match := _PAIR.fullmatch(line):
        return match[1].lower(), match[2].strip(), False
    if match := _SIMM.fullmatch(line):
        return match[1].lower(), match[2], True
    return "", line, False


def _count(value: str, line: str, number: int, file: str) -> int:
    if not (value.isascii() and value.isdigit() and len(value) < 12):
        raise InputError(file, f"line {number}", f"'{line[:80]}' is not a count", "write a whole number")
    return int(value)


def _flag(value: str, number: int, file: str) -> AngleUnit:
    if value.lower() not in _YES_NO:
        raise InputError(file, f"line {number}", f"inDegrees={value[:40]} is neither yes nor no", "correct the header")
    return _YES_NO[value.lower()]


def _judge(said: list[tuple[AngleUnit, str, int]], simm: bool) -> AngleEvidence:
    """One verdict from all that is said; a contradiction is kept in words until an angle is needed."""
    if not said:
        return AngleEvidence(simm=simm)
    unit, text, line = said[0]
    for other, other_text, other_line in said[1:]:
        if other != unit:
            spoken = {"deg": "degrees", "rad": "radians"}[other]
            what = other_text if other_text.startswith("inDegrees") else f"the text says {spoken}"
            return AngleEvidence(None, text, line, f"header says {text} but {what} (line {other_line})", simm)
    return AngleEvidence(unit, text, line, simm=simm)
