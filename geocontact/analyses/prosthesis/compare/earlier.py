"""Stances that were simulated before, as their run.json says how: another way to describe a study."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import cast

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.frame.rerun import read_run
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.data.body_segments import BodySegments
from geocontact.data.errors import InputError

COMMAND = "prosthesis simulate"


@dataclass(frozen=True, eq=False)
class AskedStance:
    """One stance: whose it is, on which foot, and what a simulation of it is asked.

    Parameters
    ----------
    setting
        Its name, or the fulcrum in words.
    calibrated
        Whether the law of its sole was fitted to it.
    segments
        Of the person a study describes; None where the options name sex and age.
    """

    name: str
    person: str
    setting: str
    calibrated: bool
    asked: ProsthesisSimulateOptions
    segments: BodySegments | None


def simulated_before(runs: Sequence[Path]) -> list[AskedStance]:
    """Stances of earlier runs; InputError for another analysis, inputs that have changed, or a run without a plate.

    Paths start from the present folder, as they did at first. A person is who has one standing trial, called by its
    folder, and by more of its path where others have that name; a stance is called by person and setting. Whether a law
    was fitted to a stance is not recorded: it counts as a prediction, with a reservation.
    """
    asked = [_asked(run) for run in runs]
    scores = {each.score for each in asked}
    if len(scores) > 1:
        raise InputError(runs[0], "`runs`", f"have scores {' and '.join(sorted(scores))}", "simulate them with one")
    _require_one_person_each(runs, asked)
    called = _names(_standing(each) for each in asked)
    persons = [called[_standing(each)] for each in asked]
    settings = [each.setting if each.fulcrum is None else f"{1e3 * each.fulcrum:g} mm" for each in asked]
    names = [re.sub("[ /]", "_", f"{person}_{setting}") for person, setting in zip(persons, settings, strict=True)]
    of, met = Counter(names), Counter[str]()
    for k, name in enumerate(names):
        met[name] += 1
        names[k] = name if of[name] == 1 else f"{name}_{met[name]}"
    fitted = [name for name, each in zip(names, asked, strict=True) if each.law is not None]
    if fitted:
        reserve(
            f"{', '.join(fitted)}: whether the law was fitted to that stance is not recorded; a prediction is assumed"
        )
    rows = zip(names, persons, settings, asked, strict=True)
    return [AskedStance(name, person, setting, False, each, None) for name, person, setting, each in rows]


def _asked(file: Path) -> ProsthesisSimulateOptions:
    """What one run was asked."""
    run = read_run(file)
    if run.command != COMMAND:
        raise InputError(file, "", f"is of `{run.command}`", f"give the run.json of {COMMAND}")
    changed = run.changed()
    if changed:
        raise InputError(changed[0], "", f"has changed since the run in {run.folder}", "simulate it again")
    add_input("`runs`", file)
    try:
        asked = ProsthesisSimulateOptions(**run.in_si())
    except TypeError as error:
        raise InputError(
            file, "options_si", str(error), "was it written by another version? simulate it again"
        ) from None
    if asked.schedule is not None:
        what = "moves the fulcrum from stance to stance: a comparison is of one"
        raise InputError(file, "`schedule`", what, "simulate the stance with its `setting` or `fulcrum`")
    if asked.plate is None:
        raise InputError(file, "`plate`", "was not named: nothing to compare with", "simulate it with its plate")
    return asked


def _standing(asked: ProsthesisSimulateOptions) -> Path:
    return cast(Path, asked.static).resolve()


def _require_one_person_each(runs: Sequence[Path], asked: Sequence[ProsthesisSimulateOptions]) -> None:
    """InputError where runs have one standing trial, and two masses or sides."""
    known: dict[tuple[Path, str], object] = {}
    for run, each in zip(runs, asked, strict=True):
        mass = None if each.mass is None else f"{each.mass:g} kg"
        for option, value in (("mass", mass), ("side", each.side)):
            first = known.setdefault((_standing(each), option), value) if value is not None else None
            if first != value:
                what = f"is {value}, in an earlier one with the same standing trial {first}"
                raise InputError(
                    run, f"`{option}`", what, "simulate both with one, or compare them one after the other"
                )


def _names(files: Iterable[Path]) -> Mapping[Path, str]:
    """What each standing trial's person is called: as little of the path, from the folder upwards, as tells them
    apart.
    """
    different = list(dict.fromkeys(files))
    deepest = max(len(file.parent.parts) for file in different)
    for count in range(1, deepest + 1):
        folders = {file: "/".join(file.parent.parts[1:][-count:]) or file.stem for file in different}
        for named in (folders, {file: f"{folder}/{file.stem}" for file, folder in folders.items()}):
            if len(set(named.values())) == len(different):
                return named
    return {file: file.as_posix() for file in different}
