"""Which evaluations a call asks for."""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

from geocontact.data.errors import InputError
from geocontact.io.text.file_preflight import open_text
from geocontact.study.description import StudyFile
from geocontact.study.options import CohortOptions
from geocontact.study.plan import WITHOUT
from geocontact.study.steps import StepRun
from geocontact.study.store import UNREADABLE
from geocontact.study.trial_run import FAILED, SET_ASIDE, WRONG
from geocontact.study.trials import TrialRow, trials_of

MANIFEST = "trials"
"""Table of the evaluations and what became of them."""
NAMED = 10
"""Values that a message names."""


def refuse_odd(study: StudyFile, only: Sequence[str]) -> None:
    """InputError for a name or a value that no trial has, a name that is given twice, and what no trial has at once."""
    trials = trials_of(study)
    known = [*dict.fromkeys(name for trial in trials for name in trial.factors)]
    chosen: dict[str, str] = {}
    for name, _, value in (each.partition("=") for each in only):
        if name not in known:
            raise InputError(study.path, "`only`", f"no trial has {name!r}", f"names are {', '.join(known)}")
        if name in chosen:
            raise InputError(study.path, "`only`", f"{name} is given twice", "give one value of each name")
        values = [*dict.fromkeys(str(trial.factors[name]) for trial in trials if name in trial.factors)]
        if value not in values:
            more = ", …" if len(values) > NAMED else ""
            remedy = f"values are {', '.join(values[:NAMED])}{more}"
            raise InputError(study.path, "`only`", f"no trial has {name} {value!r:.60}", remedy)
        chosen[name] = value
    if not any(_has(trial, chosen) for trial in trials):
        raise InputError(study.path, "`only`", f"no trial has {' and '.join(only)}", "leave one of them out")


def _has(trial: TrialRow, chosen: Mapping[str, str]) -> bool:
    return all(str(trial.factors.get(name)) == value for name, value in chosen.items())


def failed_before(study: StudyFile, out: Path) -> dict[tuple[str, str], tuple[str, str]]:
    """State and words of what failed, by step and name, as the last run has it; InputError where it has no table."""
    file = out / f"{MANIFEST}.csv"
    if not file.is_file():
        raise InputError(file, "`redo_failed`", "there is no such file", "run the study without it first")
    with open_text(file) as text:
        rows = list(csv.DictReader(text))
    return {
        (row.get("step") or study.own_name, row["name"]): (row["state"], row.get("words") or "")
        for row in rows
        if row["state"] in (WRONG, FAILED, SET_ASIDE, WITHOUT)
    }


def known_failures(study: StudyFile, out: Path) -> dict[tuple[str, str], tuple[str, str]]:
    """The same; nothing where no table says it."""
    with suppress(*UNREADABLE, csv.Error):
        return failed_before(study, out)
    return {}


def asked_for(study: StudyFile, o: CohortOptions, out: Path) -> Callable[[StepRun], bool]:
    """Whether an evaluation that has no results is made; InputError where no run before it says what failed."""
    chosen = {name: value for name, _, value in (each.partition("=") for each in o.only)}
    trials = trials_of(study)
    failed = failed_before(study, out) if o.redo_failed else None

    def asked(one: StepRun) -> bool:
        of = any(_has(trials[k], chosen) for k in one.trials)
        return of and (failed is None or (one.step, one.trial.name) in failed)

    return asked
