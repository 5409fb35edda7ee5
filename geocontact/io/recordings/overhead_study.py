"""Description of a study of overhead work: tasks, persons, and which trial is whose.

    [tasks.T1]
    tool = { value = 1.3, unit = "kg" }
    push = { value = 35, unit = "N" }
    dominant_share = 1.0

    [persons.P1]
    mass = { value = 82, unit = "kg" }
    sex = "male"
    dominant = "right"
    upper_arm = { value = 296, unit = "mm" }

    [[trials]]
    name = "P1T1S0"
    person = "P1"
    task = "T1"
    markers = "P1T1S0/markers.trc"
    tool = "P1T1S0/tool.csv"
    upright = [0.0, 0.5]

    [[trials]]
    name = "P1T1S100"
    person = "P1"
    task = "T1"
    markers = "P1T1S100/markers.trc"
    tool = "P1T1S100/tool.csv"
    level = "100%"
    recorded = "P1T1S100/recorded.csv"
    recorded_other = "P1T1S100/recorded_other.csv"
    without = "P1T1S0"

Files are looked for beside the description. A trial with a `level` was recorded in the device: logger and mat of the
dominant arm are in `recorded`, those of the other arm in `recorded_other`, and `without` names the same work without
the device. What tells no more than these may be left out: `dominant_share`, lengths of the person, `name`, `upright`,
`level`, `recorded`, `recorded_other`, `without`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from geocontact.data.body_segments import Sex
from geocontact.data.errors import InputError
from geocontact.io.recordings.shoulder_device import stated_number
from geocontact.io.text.toml_text import toml_of

LARGEST = 1_000_000
"""Bytes of a description."""
SEXES: tuple[Sex, ...] = ("female", "male")
DOMINANT = ("right", "left")
LENGTHS = ("upper_arm", "shoulder_width", "torso")
"""Of a person, to which a device is adjusted."""
RECORDED = ("recorded", "recorded_other")
"""Of the dominant arm, and of the other one."""
KEYS = {
    "tasks": ("tool", "push", "dominant_share"),
    "persons": ("mass", "sex", "dominant", *LENGTHS),
    "trials": ("person", "task", "markers", "tool", "upright", "name", "level", *RECORDED, "without"),
}


@dataclass(frozen=True)
class StudyTask:
    """Tool [kg], push [N], and the dominant hand's share of it."""

    tool: float
    push: float
    dominant_share: float | None


@dataclass(frozen=True)
class StudyPerson:
    """Mass [kg], sex, the side of the dominant hand, and those of `LENGTHS` that are known [m]."""

    mass: float
    sex: Sex
    dominant: str
    lengths: Mapping[str, float]


@dataclass(frozen=True)
class StudyTrial:
    """A trial as it is described.

    Parameters
    ----------
    upright
        A span of upright stance [s].
    level
        Support level as it is written, "100%" or 0.5; None where the device was not worn.
    recorded, recorded_other
        Of logger and mat, on the dominant side and on the other.
    without
        Name of the trial of the same work without the device.
    """

    name: str
    person: str
    task: str
    markers: Path
    tool: Path
    upright: tuple[float, float] | None
    level: str | None = None
    recorded: Path | None = None
    recorded_other: Path | None = None
    without: str | None = None


@dataclass(frozen=True)
class OverheadStudy:
    """Everything in the description."""

    tasks: Mapping[str, StudyTask]
    persons: Mapping[str, StudyPerson]
    trials: tuple[StudyTrial, ...]


def read_overhead_study(path: Path) -> OverheadStudy:
    """The description; InputError for what is missing or cannot be."""
    content = toml_of(path, LARGEST)
    unknown = [key for key in content if key not in KEYS]
    if unknown:
        raise InputError(path, f"`{unknown[0]}`", "is not known here", f"write {', '.join(KEYS)}")
    tasks = {name: _task(path, name, told) for name, told in _tables(path, content, "tasks").items()}
    persons = {name: _person(path, name, told) for name, told in _tables(path, content, "persons").items()}
    trials = content.get("trials")
    if not isinstance(trials, list) or not trials:
        raise InputError(path, "", "no [[trials]]", "name person, task, markers and tool of each")
    found = tuple(_trial(path, k, told, tasks, persons) for k, told in enumerate(trials, 1))
    _require_names(path, found)
    return OverheadStudy(tasks, persons, found)


def _require_names(path: Path, trials: tuple[StudyTrial, ...]) -> None:
    """Names that stand for one trial, and `without` that is one of them."""
    names = [each.name for each in trials]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InputError(path, "[[trials]]", f"two have the name {twice!r}", "give each its own name")
    lost = next((each for each in trials if each.without is not None and each.without not in names), None)
    if lost is not None:
        what = f"without: no trial {lost.without!r}"
        raise InputError(path, f"[[trials]] {lost.name}", what, f"there are {', '.join(names)}")


def _tables(path: Path, content: Mapping[str, Any], kind: str) -> dict[str, dict[str, Any]]:
    found = content.get(kind)
    if not isinstance(found, dict) or not found or not all(isinstance(each, dict) for each in found.values()):
        raise InputError(path, "", f"no [{kind}.NAME]", f"write one for each, with {', '.join(KEYS[kind])}")
    for name, told in found.items():
        _require_keys(path, f"[{kind}.{name}]", told, kind)
    return found


def _require_keys(path: Path, place: str, told: Mapping[str, Any], kind: str) -> None:
    odd = [key for key in told if key not in KEYS[kind]]
    if odd:
        raise InputError(path, place, f"{odd[0]!r} is not known here", f"write {', '.join(KEYS[kind])}")


def _needed(path: Path, place: str, told: Mapping[str, Any], key: str) -> Any:
    if key not in told:
        raise InputError(path, place, f"no {key}", "add it")
    return told[key]


def _task(path: Path, name: str, told: Mapping[str, Any]) -> StudyTask:
    place = f"[tasks.{name}]"
    tool, push = (
        stated_number(path, f"{place} {key}", _needed(path, place, told, key), unit, ()).value
        for key, unit in (("tool", "kg"), ("push", "N"))
    )
    share = told.get("dominant_share")
    if share is not None and not (isinstance(share, (int, float)) and 0.0 <= share <= 1.0):
        raise InputError(path, place, f"dominant_share {share!r} is no share", "write a number from 0 to 1")
    if tool < 0.0 or push < 0.0:
        raise InputError(path, place, "tool and push must not be negative", "the push is upward")
    return StudyTask(tool, push, None if share is None else float(share))


def _person(path: Path, name: str, told: Mapping[str, Any]) -> StudyPerson:
    place = f"[persons.{name}]"
    mass = stated_number(path, f"{place} mass", _needed(path, place, told, "mass"), "kg", ()).value
    if not 20.0 <= mass <= 300.0:
        raise InputError(path, place, f"{mass:g} kg is no mass of a person", "give it in kg")
    sex, dominant = (_needed(path, place, told, key) for key in ("sex", "dominant"))
    known = next((each for each in SEXES if each == sex), None)
    if known is None:
        raise InputError(path, place, f"sex {sex!r} is not in the table of segments", f"write {' or '.join(SEXES)}")
    if dominant not in DOMINANT:
        raise InputError(path, place, f"dominant {dominant!r} is no side", f"write {' or '.join(DOMINANT)}")
    lengths = {key: stated_number(path, f"{place} {key}", told[key], "m", ()).value for key in LENGTHS if key in told}
    return StudyPerson(mass, known, dominant, lengths)


def _trial(
    path: Path, number: int, told: Any, tasks: Mapping[str, StudyTask], persons: Mapping[str, StudyPerson]
) -> StudyTrial:
    place = f"[[trials]] {number}"
    if not isinstance(told, dict):
        raise InputError(path, place, "is no table", f"write {', '.join(KEYS['trials'])}")
    _require_keys(path, place, told, "trials")
    person, task, markers, tool = (str(_needed(path, place, told, key)) for key in KEYS["trials"][:4])
    for name, there, kind in ((person, persons, "persons"), (task, tasks, "tasks")):
        if name not in there:
            raise InputError(path, place, f"no [{kind}.{name}]", f"there are {', '.join(there)}")
    upright = told.get("upright")
    if upright is not None and not (
        isinstance(upright, list) and len(upright) == 2 and all(isinstance(each, (int, float)) for each in upright)
    ):
        raise InputError(path, place, f"upright {upright!r} is no span", "write [first, last] in s")
    span = None if upright is None else (float(upright[0]), float(upright[1]))
    own, other = (None if key not in told else _file(path, f"{place} {key}", str(told[key])) for key in RECORDED)
    return StudyTrial(
        str(told.get("name", f"{person}{task}")),
        person,
        task,
        _file(path, f"{place} markers", markers),
        _file(path, f"{place} tool", tool),
        span,
        str(told["level"]) if "level" in told else None,
        own,
        other,
        str(told["without"]) if "without" in told else None,
    )


def _file(study: Path, place: str, named: str) -> Path:
    file = study.parent / named
    if not file.is_file():
        raise InputError(study, place, f"there is no file {named}", "give its path from the study's folder")
    return file
