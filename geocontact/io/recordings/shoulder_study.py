"""The description of a study: its trials, their files, and the device."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from geocontact.data.errors import InputError
from geocontact.io.text.toml_text import toml_of

LARGEST = 1_000_000
"""Bytes of a description."""
NEEDED = ("name", "person", "task", "level", "side", "markers")
FILES = ("tool", "recorded", "wearer", "without", "without_tool")
SIDES = ("right", "left")


@dataclass(frozen=True)
class StudyTrial:
    """One trial as it is described; paths are those of the files, None where none is named.

    Parameters
    ----------
    level
        As it is written: "100%" or 0.5.
    side
        Of logger and mat.
    without, without_tool
        Markers and tool of the same work without the device.
    """

    name: str
    person: str
    task: str
    level: str
    side: str
    markers: Path
    tool: Path | None
    recorded: Path | None
    wearer: Path | None
    without: Path | None
    without_tool: Path | None


@dataclass(frozen=True)
class StudyFile:
    """The device by name or file, and the trials in their order."""

    device: str
    trials: tuple[StudyTrial, ...]


def read_study_file(path: Path) -> StudyFile:
    """A study; InputError for what is missing, unknown or twice there."""
    content = toml_of(path, LARGEST)
    for key in content:
        if key not in ("device", "trial"):
            raise InputError(path, f"`{key}`", "is not known here", "write device and [[trial]]")
    listed = content.get("trial")
    if not isinstance(listed, list) or not listed:
        raise InputError(path, "", "no [[trial]]", f"write one with {', '.join(NEEDED)}")
    trials = tuple(_trial(path, k, told) for k, told in enumerate(listed, start=1))
    names = [each.name for each in trials]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise InputError(path, "[[trial]]", f"two have the name {twice[0]!r}", "give each its own")
    device = str(content.get("device", "lucy"))
    beside = path.parent / device
    return StudyFile(str(beside) if beside.is_file() else device, trials)


def _trial(path: Path, number: int, told: Any) -> StudyTrial:
    place = f"[[trial]] {number}"
    if not isinstance(told, dict):
        raise InputError(path, place, "is no table", f"write {', '.join(NEEDED)}")
    missing = [name for name in NEEDED if name not in told]
    if missing:
        raise InputError(path, place, f"{missing[0]} is missing", f"it needs {', '.join(NEEDED)}")
    unknown = sorted(set(told) - {*NEEDED, *FILES})
    if unknown:
        raise InputError(path, place, f"{unknown[0]} is not known", f"known are {', '.join((*NEEDED, *FILES))}")
    side = str(told["side"])
    if side not in SIDES:
        raise InputError(path, place, f"side is {side!r}", "write right or left")
    name, person, task, level = (str(told[each]) for each in ("name", "person", "task", "level"))
    markers = _file(path, f"{place} markers", str(told["markers"]))
    tool, recorded, wearer, without, without_tool = (
        _file(path, f"{place} {each}", str(told[each])) if each in told else None for each in FILES
    )
    return StudyTrial(name, person, task, level, side, markers, tool, recorded, wearer, without, without_tool)


def _file(study: Path, place: str, named: str) -> Path:
    file = study.parent / named
    if not file.is_file():
        raise InputError(study, place, f"there is no file {named}", "give its path from the study's folder")
    return file
