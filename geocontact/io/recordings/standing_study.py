"""Description of trials of standing up from a chair.

    mass = { value = 70, unit = "kg" }
    height = { value = 1.75, unit = "m" }

    [noise]
    length = { value = 0.5, unit = "mm" }
    angle = { value = 0.3, unit = "deg" }
    rate = { value = 0.02, unit = "rad/s" }
    force = { value = 2, unit = "N" }
    centre = { value = 1, unit = "mm" }

    [[trials]]
    name = "T1"
    coordinates = "T1_coordinates.sto"
    rates = "T1_rates.sto"
    plates = "T1_plates.mot"
    feet = "feet"
    chair = "chair"

Files are looked for beside the description. `noise` are standard deviations of one sample; `rate` is that of turns and,
in m/s, of the foot's place. `feet` and `chair` are plates in `plates`. `free` and `tracks`, lists of names, may stand
beside mass and height, `start` and `end` [s] in a trial instead of `chair`; with `sitting = true` a trial begins while
the person still sits, and the chair's force is a load on the model. With `exoskeleton = true` a trial also has
`torques` of all joints of both legs (.sto, [N m]) and `strap`, the normal force of the mat of one leg on the person,
forwards positive (.csv, `time [s], normal [N]`), or the wrench.csv of a mat on a scan of the thigh, x forwards. A list
of files, such as mats in front and behind, has the sum of their forces. `strap_shank` and `strap_pelvis` are the same
of further straps; at the pelvis the force is that of the whole module. A trial needs one of the three.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from geocontact.data.errors import InputError
from geocontact.data.file_names import same_place
from geocontact.data.plausible import KG, Plausible
from geocontact.data.units import m
from geocontact.io.recordings.shoulder_device import stated_number
from geocontact.io.text.toml_text import toml_of

NAME = re.compile(r"[\w-]{1,40}")
LARGEST = 1_000_000
"""Bytes of a description."""
BODY = Plausible("the mass of a person", KG, (20.0, 300.0))
TALL = Plausible("the height of a person", m, (0.8, 2.5))
NOISE = {"length": "m", "angle": "rad", "rate": "rad/s", "force": "N", "centre": "m", "torque": "N m", "strap": "N"}
KEYS = ("mass", "height", "exoskeleton", "noise", "free", "tracks", "trials")
FILES = ("coordinates", "rates", "plates", "torques")
ELSEWHERE = ("shank", "pelvis")
"""Sites of straps besides the thigh's."""
TRIAL = ("name", *FILES, "strap", *(f"strap_{site}" for site in ELSEWHERE), "feet", "chair", "sitting", "start", "end")


@dataclass(frozen=True)
class StandingTrialFiles:
    """A trial as it is described.

    Parameters
    ----------
    coordinates, rates, plates, torques
        Files; all but the first may be missing.
    strap
        Files whose forces add; none where the thigh's strap was not recorded.
    elsewhere
        The same by further sites, of those that were recorded.
    feet, chair
        Plates by name or number.
    sitting
        Whether the trial begins before seat-off, with the chair's force as a load.
    start, end
        Of what is used [s].
    """

    name: str
    coordinates: Path
    rates: Path | None
    plates: Path | None
    torques: Path | None
    strap: tuple[Path, ...]
    elsewhere: Mapping[str, tuple[Path, ...]]
    feet: str | None
    chair: str | None
    sitting: bool
    start: float | None
    end: float | None


@dataclass(frozen=True)
class StandingStudy:
    """Everything in the description.

    Parameters
    ----------
    mass, height
        [kg], [m].
    exoskeleton
        Whether it was worn.
    noise
        Standard deviations in SI by the keys of `NOISE`; those that are told.
    free, tracks
        Names as written; None where nothing is.
    """

    mass: float
    height: float
    exoskeleton: bool
    noise: Mapping[str, float]
    free: tuple[str, ...] | None
    tracks: tuple[str, ...] | None
    trials: tuple[StandingTrialFiles, ...]


def read_standing_study(path: Path) -> StandingStudy:
    """The description; InputError for what is missing or cannot be."""
    content = toml_of(path, LARGEST)
    _require_keys(path, "", content, KEYS)
    mass, height = (_measure(path, content, name, what) for name, what in (("mass", BODY), ("height", TALL)))
    told = content.get("noise", {})
    if not isinstance(told, dict):
        raise InputError(path, "noise", "is no table", "write [noise]")
    _require_keys(path, "[noise]", told, tuple(NOISE))
    noise = {name: stated_number(path, f"[noise] {name}", each, NOISE[name], ()).value for name, each in told.items()}
    still = next((name for name, value in noise.items() if value <= 0.0), None)
    if still is not None:
        raise InputError(path, f"[noise] {still}", "is not above 0", "give what one sample is off by")
    trials = content.get("trials")
    if not isinstance(trials, list) or not trials:
        raise InputError(path, "", "no [[trials]]", "name coordinates, plates and feet of each")
    found = tuple(_trial(path, k, each) for k, each in enumerate(trials, 1))
    twice = same_place(each.name for each in found)
    if twice is not None:
        raise InputError(path, "[[trials]]", f"two have the name {twice!r}", "give each its own name")
    free, tracks = (_names(path, content, key) for key in ("free", "tracks"))
    worn = content.get("exoskeleton", False)
    if not isinstance(worn, bool):
        raise InputError(path, "exoskeleton", f"{worn!r} is neither true nor false", "write exoskeleton = true")
    return StandingStudy(mass, height, worn, noise, free, tracks, found)


def _measure(path: Path, content: Mapping[str, Any], name: str, what: Plausible) -> float:
    if name not in content:
        raise InputError(path, "", f"no {name}", f'write {name} = {{ value = …, unit = "{what.unit.name}" }}')
    value = stated_number(path, name, content[name], what.unit.si, ()).value
    wrong = what.refusal(value)
    if wrong is not None:
        raise InputError(path, name, *wrong)
    return value


def _names(path: Path, content: Mapping[str, Any], key: str) -> tuple[str, ...] | None:
    told = content.get(key)
    if told is None:
        return None
    if not isinstance(told, list) or not all(isinstance(each, str) for each in told):
        raise InputError(path, key, "is no list of names", f'write {key} = ["…", "…"]')
    return tuple(told)


def _require_keys(path: Path, place: str, told: Mapping[str, Any], known: tuple[str, ...]) -> None:
    odd = [key for key in told if key not in known]
    if odd:
        raise InputError(path, place, f"{odd[0]!r} is not known here", f"write {', '.join(known)}")


def _trial(path: Path, number: int, told: Any) -> StandingTrialFiles:
    place = f"[[trials]] {number}"
    if not isinstance(told, dict):
        raise InputError(path, place, "is no table", f"write {', '.join(TRIAL)}")
    _require_keys(path, place, told, TRIAL)
    if "coordinates" not in told:
        raise InputError(path, place, "no coordinates", "name the file of angles and the foot's place")
    coordinates, *files = (_file(path, f"{place} {key}", told.get(key)) for key in FILES)
    if coordinates is None:
        raise InputError(path, place, "no coordinates", "name the file of angles and the foot's place")
    feet, chair = (None if told.get(key) is None else str(told[key]) for key in ("feet", "chair"))
    sitting = told.get("sitting", False)
    if not isinstance(sitting, bool):
        raise InputError(path, place, f"sitting {sitting!r} is neither true nor false", "write sitting = true")
    if sitting and (chair is None or files[1] is None):
        raise InputError(path, place, "sitting without the force of a chair", "name plates, and chair among them")
    start, end = (_time(path, place, told, key) for key in ("start", "end"))
    name = str(told.get("name", f"T{number}"))
    if not NAME.fullmatch(name):
        raise InputError(path, place, f"name {name!r} cannot be that of a file", "write letters, digits, - and _")
    rates, forces, torques = files
    strap = _files(path, f"{place} strap", told.get("strap"))
    others = {site: _files(path, f"{place} strap_{site}", told.get(f"strap_{site}")) for site in ELSEWHERE}
    others = {site: files for site, files in others.items() if files}
    told_files = (coordinates, rates, forces, torques, strap, others)
    return StandingTrialFiles(name, *told_files, feet, chair, sitting, start, end)


def _time(path: Path, place: str, told: Mapping[str, Any], key: str) -> float | None:
    value = told.get(key)
    if value is not None and (isinstance(value, bool) or not isinstance(value, (int, float))):
        raise InputError(path, place, f"{key} {value!r} is no time", "write it in s")
    return None if value is None else float(value)


def _files(study: Path, place: str, named: Any) -> tuple[Path, ...]:
    """One or several."""
    each = named if isinstance(named, list) else [named]
    return tuple(file for one in each if (file := _file(study, place, one)) is not None)


def _file(study: Path, place: str, named: Any) -> Path | None:
    if named is None:
        return None
    file = study.parent / str(named)
    if not file.is_file():
        raise InputError(study, place, f"there is no file {named}", "give its path from the study's folder")
    return file
