"""Numbers that are given at the start: those of all trials, those of one, and what a model of the package needs."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from pathlib import Path

from geocontact.chain.system import System
from geocontact.data.errors import InputError
from geocontact.data.gap_case import GapCase
from geocontact.io.text.side_table import read_side_table
from geocontact.systems.base import Base
from geocontact.systems.catalogue import SYSTEMS


def trial_numbers(starts: Mapping[str, float], trials: Collection[str]) -> dict[str, dict[str, float]]:
    """Numbers that are named after a trial, by trial and name: t01.level=0.5; InputError for one that is not finite."""
    found: dict[str, dict[str, float]] = {}
    for name, value in starts.items():
        trial, _, own = name.rpartition(".")
        if not own or not math.isfinite(value):
            raise InputError("", "`number`", f"is {name}={value:g}", "write a name and a finite number: k=100")
        if trial in trials:
            found.setdefault(trial, {})[own] = value
    return found


def shared_numbers(starts: Mapping[str, float], case: GapCase) -> dict[str, float]:
    """Numbers that all trials have alike."""
    trials = [one.name for one in (*case.calibration, *case.evaluation)]
    return {name: value for name, value in starts.items() if name.rpartition(".")[0] not in trials}


def require_trial_numbers(case: GapCase, shared: Collection[str]) -> None:
    """Refuse a number that some trials only have, and one that is among those of all trials, which would be taken."""
    trials = (*case.calibration, *case.evaluation)
    for name in dict.fromkeys(own for one in trials for own in one.covariates):
        having = [one.name for one in trials if name in one.covariates]
        if name in shared:
            what = f"{name} is given for all trials and for {', '.join(having)}"
            raise InputError("", "`number`", what, "leave out one of the two")
        if lacking := [f"{one.name}.{name}" for one in trials if one.name not in having]:
            what = f"needs {', '.join(lacking)} beside {having[0]}.{name}"
            raise InputError("", "`number`", what, f"give each, as in {lacking[0]}=1.5")


def needed_numbers(model: str, channels: Collection[str], files: Mapping[str, str]) -> dict[str, str]:
    """Numbers with SI units that a model of the package needs; ValueError for a table that it cannot use."""
    needs = next(each.needs for each in SYSTEMS if each.name == model)
    tables = {name: read_side_table(Path(file)) for name, file in files.items()}
    return dict(needs.numbers(channels, tables)) if needs is not None else {}


def shipped_model(
    base: Base, starts: Mapping[str, float], channels: Collection[str], case: GapCase
) -> tuple[System, Mapping[str, str]]:
    """A model of the package at its start values, and the SI units of its numbers.

    Raises
    ------
    InputError
        Tables or numbers that it needs are missing, all of them by name, or it takes none of such a name.
    """
    needs = base.needs
    if needs is None:
        raise InputError(base.name, "", "does not say what it needs", "name another model")
    _check_tables(base.name, needs.tables, case)
    try:
        needed = needs.numbers(channels, case.tables)
    except ValueError as error:
        raise InputError("", "`table`", str(error), "correct the table") from error
    given = shared_numbers(starts, case)
    unknown = [name for name in given if name not in needed and name not in needs.per_trial]
    trials = (*case.calibration, *case.evaluation)
    unknown += [f"{one.name}.{own}" for one in trials for own in one.covariates if own not in needs.per_trial]
    if unknown:
        every = ", ".join((*needed, *(f"<trial>.{name}" for name in needs.per_trial)))
        raise InputError("", "`number`", f"{base.name} has no number {unknown[0]}", f"it has {every}")
    lacking = [f"{name} [{unit}]" for name, unit in needed.items() if name not in given]
    for each in trials:
        lacking += [f"{each.name}.{own}" for own in needs.per_trial if own not in given and own not in each.covariates]
    if lacking:
        what = f"{base.name} needs {', '.join(lacking)}"
        raise InputError("", "`number`", what, f"give each, as in {lacking[0].partition(' ')[0]}=1.5")
    try:
        return base.build((), given, case.tables), needed
    except ValueError as error:
        raise InputError("", "`number`", str(error), "correct it") from error


def _check_tables(model: str, needed: Mapping[str, tuple[str, ...]], case: GapCase) -> None:
    for name, columns in needed.items():
        if name not in case.tables:
            what = f"{model} needs a table of the columns {', '.join(columns)}"
            raise InputError("", "`table`", what, f"give it as {name}={name}.csv")
    for name in case.tables:
        if name not in needed:
            takes = f"it takes {', '.join(needed)}" if needed else "it takes none"
            raise InputError("", "`table`", f"{model} has no table {name}", takes)
