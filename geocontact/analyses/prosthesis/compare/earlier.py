"""Stances that were simulated before, as their run.json says how: another way to describe a study."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from geocontact.analyses.frame.collector import add_input
from geocontact.analyses.frame.rerun import read_run
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
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
    """

    name: str
    person: str
    setting: str
    calibrated: bool
    asked: ProsthesisSimulateOptions


def simulated_before(runs: Sequence[Path]) -> list[AskedStance]:
    """Stances of earlier runs; InputError for another analysis, inputs that have changed, or a run without a plate.

    Paths start from the present folder, as they did at first. A person is called by the folder of the standing trial, a
    stance by person and setting. Whether a law was fitted to a stance is not recorded: it counts as a prediction.
    """
    asked = [_asked(run) for run in runs]
    scores = {each.score for each in asked}
    if len(scores) > 1:
        raise InputError(runs[0], "`runs`", f"have scores {' and '.join(sorted(scores))}", "simulate them with one")
    persons = [_person(each) for each in asked]
    settings = [each.setting if each.fulcrum is None else f"{1e3 * each.fulcrum:g} mm" for each in asked]
    names = [f"{person}_{setting}".replace(" ", "_") for person, setting in zip(persons, settings, strict=True)]
    of, met = Counter(names), Counter[str]()
    for k, name in enumerate(names):
        met[name] += 1
        names[k] = name if of[name] == 1 else f"{name}_{met[name]}"
    rows = zip(names, persons, settings, asked, strict=True)
    return [AskedStance(name, person, setting, False, each) for name, person, setting, each in rows]


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
    if asked.plate is None:
        raise InputError(file, "`plate`", "was not named: nothing to compare with", "simulate it with its plate")
    return asked


def _person(asked: ProsthesisSimulateOptions) -> str:
    static = asked.static or Path()
    return static.resolve().parent.name or static.stem
