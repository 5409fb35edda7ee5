"""The curves of a study: a column of every trial's table over 0 to 100 % of its span, by subject and condition."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.folder import is_inside
from geocontact.analyses.motion.styles import Cutting
from geocontact.data.errors import InputError
from geocontact.io.results import coordinates_of, over_time
from geocontact.study.description import StudyFile
from geocontact.study.store import Store
from geocontact.study.trials import CohortTrial

STEPS = np.linspace(0.0, 100.0, 101)
"""Places on the curves [%]."""
MOST = 3
"""Columns that are taken where a study names none."""


@dataclass(frozen=True, eq=False)
class StudyCurves:
    """Curves of one column, a row for each trial; NaN where a trial has no value.

    Parameters
    ----------
    column
        With its unit, as in the table.
    names, subjects, conditions
        Of the trials.
    """

    column: str
    names: tuple[str, ...]
    subjects: tuple[str, ...]
    conditions: tuple[str, ...]
    matrix: Float[np.ndarray, "n 101"]

    @property
    def groups(self) -> dict[str, Float[np.ndarray, "_ 101"]]:
        """Curves of each condition, one for each subject: the mean of the subject's trials."""
        return {condition: np.array(list(self.by_subject(condition).values())) for condition in self.known}

    @property
    def known(self) -> tuple[str, ...]:
        """Conditions in the order of the trials."""
        return tuple(dict.fromkeys(self.conditions))

    def by_subject(self, condition: str) -> dict[str, Float[np.ndarray, " 101"]]:
        """Mean curve of each subject in a condition."""
        places: dict[str, list[int]] = {}
        for k, (subject, own) in enumerate(zip(self.subjects, self.conditions, strict=True)):
            if own == condition:
                places.setdefault(subject, []).append(k)
        return {subject: self.matrix[own].mean(axis=0) for subject, own in places.items()}


def curves_of(
    study: StudyFile, done: Sequence[tuple[CohortTrial, str]], store: Store, cutting: Cutting | None = None
) -> tuple[StudyCurves, ...]:
    """Curves of the columns that [summary] names, or of the first few; none where no table is over time.

    With events a curve is the mean over the gait cycles of its trial, else it is over the whole span.
    """
    name = _named(study) or _first_over_time(done, store)
    if not name:
        return ()
    files = {trial.name: store.place(address) / f"{name}.parquet" for trial, address in done}
    there = [trial for trial, _ in done if files[trial.name].is_file()]
    if not there:
        raise InputError(study.path, "[summary] table", f"no trial has a table {name!r}", "see the folder tables")
    columns = _required(study, files[there[0].name], name)
    recorded = set() if cutting is None else {each.recording for each in cutting.events}
    values = np.array([_curves(study, files[one.name], columns, cutting, recording_of(one, recorded)) for one in there])
    subjects, conditions = subjects_of(study, there), conditions_of(study, there)
    names = tuple(trial.name for trial in there)
    return tuple(StudyCurves(column, names, subjects, conditions, values[:, k]) for k, column in enumerate(columns))


def require_summary(study: StudyFile, one: tuple[CohortTrial, str], store: Store, *, alike: bool) -> None:
    """InputError where a trial that is done does not have what `[summary]` names.

    `alike`: all trials have the same options, so that a table that this one lacks none has.
    """
    name = _named(study) or _first_over_time([one], store)
    file = store.place(one[1]) / f"{name}.parquet"
    if name and file.is_file():
        _required(study, file, name)
    elif name and alike:
        known = ", ".join(store.report(one[1])["tables"])
        raise InputError(study.path, "[summary] table", f"no trial has a table {name!r}", f"there are {known}")


def _named(study: StudyFile) -> str:
    """The table that `[summary]` names, "" where it names none; InputError for a path that leads elsewhere."""
    name = study.summary.table
    if name and not is_inside(study.home, f"{name}.parquet"):
        raise InputError(study.path, "[summary] table", f"{name[:80]!r} is not the name of a table", "see tables")
    return name


def _required(study: StudyFile, file: Path, name: str) -> tuple[str, ...]:
    """Columns that the summary is about; InputError where the table does not have one of them."""
    asked, first = study.summary, pd.read_parquet(file)
    columns = asked.columns or _columns(first, asked.over)
    missing = next((each for each in (*columns, asked.over, *asked.where) if each not in first.columns), None)
    if missing is not None:
        known = ", ".join(map(str, first.columns))
        raise InputError(study.path, "[summary]", f"table {name!r} has no column {missing!r}", f"there are {known}")
    return columns


def _first_over_time(done: Sequence[tuple[CohortTrial, str]], store: Store) -> str:
    for trial_and_address in done[:1]:
        place = store.place(trial_and_address[1])
        for name in store.report(trial_and_address[1])["tables"]:
            if over_time(pd.read_parquet(place / f"{name}.parquet")):
                return str(name)
    return ""


def _columns(table: pd.DataFrame, over: str) -> tuple[str, ...]:
    """The first columns of numbers that are no coordinates."""
    apart = {over, *(coordinates_of(table) if over_time(table) else ())}
    numbers = [str(name) for name in table.select_dtypes("number").columns if name not in apart]
    return tuple(name for name in numbers if len(set(table[name])) > 1)[:MOST]


def recording_of(trial: CohortTrial, known: Collection[str]) -> str:
    """What a table of events calls the recording of a trial: its recording, its name, or one of its files."""
    named = (str(trial.factors[name]) for name in ("recording",) if name in trial.factors)
    texts = (str(value) for value in trial.options.values())
    names = [*named, trial.name, *(Path(text).stem for text in texts)]
    return next((name for name in names if name in known), names[0])


def _curves(
    study: StudyFile, file: Path, columns: Sequence[str], cutting: Cutting | None, recording: str
) -> Float[np.ndarray, "c 101"]:
    """Curves of one trial: rows that are chosen, over their span or over the gait cycle."""
    asked = study.summary
    table = pd.read_parquet(file)
    missing = next((name for name in (*columns, asked.over, *asked.where) if name not in table.columns), None)
    if missing is not None:
        return np.full((len(columns), len(STEPS)), np.nan)
    chosen = {**_first_of_each(table, asked.over), **asked.where}
    for name, value in chosen.items():
        table = table[table[name] == value]
    at = table[asked.over].to_numpy(float)
    if len(at) < 2 or not (np.diff(at) > 0.0).all():
        return np.full((len(columns), len(STEPS)), np.nan)
    if cutting is not None:
        trials = cutting.trials_of(recording, at, {name: table[name].to_numpy(float) for name in columns})
        return np.array([np.vstack(list(trials[name].values())).mean(axis=0) for name in columns])
    share = 100.0 * (at - at[0]) / (at[-1] - at[0])
    return np.array([np.interp(STEPS, share, table[name].to_numpy(float)) for name in columns])


def _first_of_each(table: pd.DataFrame, over: str) -> dict[str, object]:
    """The first value of each column that numbers rows beside the one that curves are over."""
    others = [name for name in (coordinates_of(table) if over_time(table) else ()) if name != over]
    return {name: table[name].iloc[0] for name in others}


def subjects_of(study: StudyFile, trials: Sequence[CohortTrial]) -> tuple[str, ...]:
    """The subject of each trial; its own name where it has none."""
    return tuple(str(trial.factors.get(study.summary.subject, trial.name)) for trial in trials)


def conditions_of(study: StudyFile, trials: Sequence[CohortTrial]) -> tuple[str, ...]:
    """The condition, and the values of swept options: "fast, threshold 4"."""
    found = []
    for trial in trials:
        words = [str(trial.factors[study.summary.condition])] if study.summary.condition in trial.factors else []
        words += [f"{name} {trial.factors[name]}" for name in study.sweep if name in trial.factors]
        found.append(", ".join(words) or "all")
    return tuple(found)
