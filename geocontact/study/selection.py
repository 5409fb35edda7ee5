"""Which evaluations a call asks for."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path

from geocontact.data.errors import InputError
from geocontact.io.text.file_preflight import open_text
from geocontact.study.description import StudyFile
from geocontact.study.options import CohortOptions
from geocontact.study.plan import WITHOUT
from geocontact.study.steps import StepRun
from geocontact.study.trial_run import FAILED, SET_ASIDE, WRONG
from geocontact.study.trials import trials_of

MANIFEST = "trials"
"""Table of the evaluations and what became of them."""


def asked_for(study: StudyFile, o: CohortOptions, out: Path) -> Callable[[StepRun], bool]:
    """Whether an evaluation that has no results is made; InputError where no run before it says what failed."""
    chosen = [each.partition("=")[::2] for each in o.only]
    trials = trials_of(study)
    failed: set[tuple[str, str]] | None = None
    if o.redo_failed:
        file = out / f"{MANIFEST}.csv"
        if not file.is_file():
            raise InputError(file, "`redo_failed`", "there is no such file", "run the study without it first")
        with open_text(file) as text:
            rows = list(csv.DictReader(text))
        failed = {
            (row.get("step", study.own_name), row["name"])
            for row in rows
            if row["state"] in (WRONG, FAILED, SET_ASIDE, WITHOUT)
        }

    def asked(one: StepRun) -> bool:
        of = any(all(str(trials[k].factors.get(name)) == value for name, value in chosen) for k in one.trials)
        return of and (failed is None or (one.step, one.trial.name) in failed)

    return asked
