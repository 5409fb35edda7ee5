"""The curves of a study: a column of every trial's table over 0 to 100 % of its span, by subject and condition."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import say
from geocontact.analyses.frame.folder import is_inside
from geocontact.analyses.motion.styles import Cutting
from geocontact.data.errors import InputError
from geocontact.io.results import coordinates_of, over_time
from geocontact.io.text.units import split_header
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
    at
        Which rows of a table with several for each time were taken: "threshold 2 mm"; "" where there is one.
    """

    column: str
    names: tuple[str, ...]
    subjects: tuple[str, ...]
    conditions: tuple[str, ...]
    matrix: Float[np.ndarray, "n 101"]
    at: str = ""

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

    With events a curve is the mean over the gait cycles of its trial, else it is over the whole span. Where a table has
    several rows for each time, such as thresholds, the first are taken unless `[summary] where` names others, and said.
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
    found, several = [], dict[str, list[object]]()
    for one in there:
        table = pd.read_parquet(files[one.name])
        chosen = _rows_of(study, table, columns)
        found.append(_curves(study, table, columns, chosen, cutting, recording_of(one, recorded)))
        for column in (each for each in chosen or () if len(table[each].unique()) > 1):
            several.setdefault(column, []).append((chosen or {})[column])
    values, at = np.array(found), ", ".join(_in_words(*each) for each in several.items())
    if first := [_in_words(name, used) for name, used in several.items() if name not in study.summary.where]:
        say(f"curves are at {', '.join(first)}, the first of several values; `where` of [summary] names others")
    subjects, conditions = subjects_of(study, there), conditions_of(study, there)
    names = tuple(trial.name for trial in there)
    return tuple(StudyCurves(each, names, subjects, conditions, values[:, k], at) for k, each in enumerate(columns))


def _in_words(column: str, values: Sequence[object]) -> str:
    """ "threshold 2 mm"; of trials with several values "threshold 1, 2 mm"."""
    name, unit = split_header(column)
    known = dict.fromkeys(f"{value:g}" if isinstance(value, float) else str(value) for value in values)
    return " ".join(part for part in (name, ", ".join(known), unit) if part)


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


def _rows_of(study: StudyFile, table: pd.DataFrame, columns: Sequence[str]) -> dict[str, object] | None:
    """Values of columns whose rows make the curves of a trial; None where its table lacks a column."""
    asked = study.summary
    if any(name not in table.columns for name in (*columns, asked.over, *asked.where)):
        return None
    return {**_first_of_each(table, asked.over), **asked.where}


def _curves(
    study: StudyFile,
    table: pd.DataFrame,
    columns: Sequence[str],
    chosen: Mapping[str, object] | None,
    cutting: Cutting | None,
    recording: str,
) -> Float[np.ndarray, "c 101"]:
    """Curves of one trial: rows that are chosen, over their span or over the gait cycle; NaN where there are none."""
    for name, value in (chosen or {}).items():
        table = table[table[name] == value]
    at = np.empty(0) if chosen is None else table[study.summary.over].to_numpy(float)
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
