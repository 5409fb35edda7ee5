"""Description of a gait study with a prosthetic foot: persons, and their stances on force plates.

    [persons.P1]
    mass = { value = 77.3, unit = "kg" }
    static = "P1/standing.trc"
    side = "right"
    sex = "male"
    residual = { value = 45, unit = "%" }
    functional = "P1/hip.trc"
    law = "P1/law.toml"

    [[trials]]
    name = "P1_medium_1"
    person = "P1"
    setting = "medium"
    markers = "P1_medium_1/walking.trc"
    plates = "P1_medium_1/plates.mot"
    plate = "own_force"
    other_plate = "other_force"
    calibrated = true
    law = "P1/law_medium.toml"
    ground = "plane:-0.05,1,0,0"

Files are looked for beside the description. `fulcrum = { value = 100, unit = "mm" }` stands in place of a `setting`.
`calibrated` marks a trial that its `law` was fitted to: that of the trial, such as one for each setting, else the
person's. `ground` is a plane or stairs as in `prosthesis simulate`. What may be left out: `side`, `sex`, `residual`,
`functional`, `law`, `name`, `calibrated`, `ground`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from geocontact.data.body_segments import Sex
from geocontact.data.errors import InputError
from geocontact.io.recordings.shoulder_device import stated_number
from geocontact.io.text.toml_text import toml_of

LARGEST = 1_000_000
"""Bytes of a description."""
SEXES: tuple[Sex, ...] = ("male", "female")
Side = Literal["right", "left"]
SIDES: tuple[Side, ...] = ("right", "left")
Setting = Literal["low", "medium", "high"]
SETTINGS: tuple[Setting, ...] = ("low", "medium", "high")
KEYS = {
    "persons": ("mass", "static", "side", "sex", "residual", "functional", "law"),
    "trials": (
        "person",
        "markers",
        "plates",
        "plate",
        "other_plate",
        "setting",
        "fulcrum",
        "name",
        "calibrated",
        "law",
        "ground",
    ),
}


@dataclass(frozen=True)
class GaitPerson:
    """Mass with the prosthesis [kg], files, side of the prosthesis, row of the segment table, share of the shank."""

    mass: float
    static: Path
    side: Side
    sex: Sex
    residual: float | None
    functional: Path | None
    law: Path | None


@dataclass(frozen=True)
class GaitStance:
    """One stance as it is described.

    Parameters
    ----------
    plate, other_plate
        Under the prosthetic foot and under the other one.
    setting, fulcrum
        Of the foot, one of both; the fulcrum in m.
    calibrated
        Whether the law was fitted to it.
    law
        In place of the person's.
    ground
        As it is written; None for the floor.
    """

    name: str
    person: str
    markers: Path
    plates: Path
    plate: str
    other_plate: str
    setting: Setting | None
    fulcrum: float | None
    calibrated: bool
    law: Path | None
    ground: str | None

    @property
    def foot(self) -> str:
        """The setting's name, else the fulcrum in words."""
        return self.setting or f"{1e3 * (self.fulcrum or 0.0):g} mm"


@dataclass(frozen=True)
class GaitStudy:
    """Everything in the description."""

    persons: Mapping[str, GaitPerson]
    trials: tuple[GaitStance, ...]


def read_gait_study(path: Path) -> GaitStudy:
    """The description; InputError for what is missing or cannot be."""
    content = toml_of(path, LARGEST)
    unknown = [key for key in content if key not in KEYS]
    if unknown:
        raise InputError(path, f"`{unknown[0]}`", "is not known here", f"write {', '.join(KEYS)}")
    told = content.get("persons")
    if not isinstance(told, dict) or not told or not all(isinstance(each, dict) for each in told.values()):
        raise InputError(path, "", "no [persons.NAME]", f"write one for each, with {', '.join(KEYS['persons'])}")
    persons = {name: _person(path, name, each) for name, each in told.items()}
    trials = content.get("trials")
    if not isinstance(trials, list) or not trials:
        raise InputError(path, "", "no [[trials]]", f"write one for each stance, with {', '.join(KEYS['trials'])}")
    found = tuple(_trial(path, k, each, persons) for k, each in enumerate(trials, 1))
    names = [each.name for each in found]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InputError(path, "[[trials]]", f"two have the name {twice!r}", "give each its own name")
    return GaitStudy(persons, found)


def _person(path: Path, name: str, told: Mapping[str, Any]) -> GaitPerson:
    place = f"[persons.{name}]"
    _require_keys(path, place, told, "persons")
    mass = stated_number(path, f"{place} mass", _needed(path, place, told, "mass"), "kg", ()).value
    if not 20.0 <= mass <= 300.0:
        raise InputError(path, place, f"{mass:g} kg is no mass of a walking person", "give it in kg")
    side = next((each for each in SIDES if each == told.get("side", "right")), None)
    if side is None:
        raise InputError(path, place, f"side {told['side']!r} is none", f"write {' or '.join(SIDES)}")
    sex = next((each for each in SEXES if each == told.get("sex", "male")), None)
    if sex is None:
        what = f"sex {told['sex']!r} is not in the table of segments"
        raise InputError(path, place, what, f"write {' or '.join(SEXES)}")
    share = None
    if "residual" in told:
        share = stated_number(path, f"{place} residual", told["residual"], "-", ()).value
        if not 0.0 < share < 1.0:
            raise InputError(path, place, f"residual {share:g} is no part of the shank", "write for example 45 %")
    static = _file(path, f"{place} static", str(_needed(path, place, told, "static")))
    more = [_file(path, f"{place} {key}", str(told[key])) if key in told else None for key in ("functional", "law")]
    return GaitPerson(mass, static, side, sex, share, *more)


def _trial(path: Path, number: int, told: Any, persons: Mapping[str, GaitPerson]) -> GaitStance:
    place = f"[[trials]] {number}"
    if not isinstance(told, dict):
        raise InputError(path, place, "is no table", f"write {', '.join(KEYS['trials'])}")
    _require_keys(path, place, told, "trials")
    person, markers, plates, plate, other = (str(_needed(path, place, told, key)) for key in KEYS["trials"][:5])
    if person not in persons:
        raise InputError(path, place, f"no [persons.{person}]", f"there are {', '.join(persons)}")
    if ("setting" in told) == ("fulcrum" in told):
        raise InputError(path, place, "needs a setting or a fulcrum", f"write setting = {' or '.join(SETTINGS)}")
    setting = next((each for each in SETTINGS if each == told.get("setting")), None)
    if "setting" in told and setting is None:
        raise InputError(path, place, f"setting {told['setting']!r} is none", f"write {' or '.join(SETTINGS)}")
    fulcrum = None
    if "fulcrum" in told:
        fulcrum = stated_number(path, f"{place} fulcrum", told["fulcrum"], "m", ()).value
        if not 0.066 <= fulcrum <= 0.151:
            raise InputError(path, place, f"a fulcrum of {1e3 * fulcrum:g} mm", "it goes from 66 to 151 mm")
    calibrated = told.get("calibrated", False)
    if not isinstance(calibrated, bool):
        raise InputError(path, place, f"calibrated {calibrated!r}", "write true or false")
    return GaitStance(
        str(told.get("name", f"{person}_{number}")),
        person,
        _file(path, f"{place} markers", markers),
        _file(path, f"{place} plates", plates),
        plate,
        other,
        setting,
        fulcrum,
        calibrated,
        _file(path, f"{place} law", str(told["law"])) if "law" in told else None,
        str(told["ground"]) if "ground" in told else None,
    )


def _require_keys(path: Path, place: str, told: Mapping[str, Any], kind: str) -> None:
    odd = [key for key in told if key not in KEYS[kind]]
    if odd:
        raise InputError(path, place, f"{odd[0]!r} is not known here", f"write {', '.join(KEYS[kind])}")


def _needed(path: Path, place: str, told: Mapping[str, Any], key: str) -> Any:
    if key not in told:
        raise InputError(path, place, f"no {key}", "add it")
    return told[key]


def _file(study: Path, place: str, named: str) -> Path:
    file = study.parent / named
    if not file.is_file():
        raise InputError(study, place, f"there is no file {named}", "give its path from the study's folder")
    return file
