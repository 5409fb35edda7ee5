"""The page of a study: mean curves by condition, what differs, who lies apart, a link to each trial's page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import current
from geocontact.analyses.frame.result import REPORT
from geocontact.analyses.frame.words import MOST, headline
from geocontact.data.motion import Course
from geocontact.io.text.units import split_header
from geocontact.study.curves import STEPS, StudyCurves
from geocontact.study.tables import means_by_condition
from geocontact.view.curves.declared import Curves, CurveSheet, mean_curve
from geocontact.view.curves.style import PALETTE
from geocontact.view.page.content import Page, Picture, Section, Table
from geocontact.view.page.tables import frame_table

DRAWN = len(PALETTE)
"""Conditions that curves are drawn of."""
ROWS = 500
"""Rows of the table of trials that the page shows; trials.csv has all."""


def study_page(
    title: str,
    curves: Sequence[StudyCurves],
    tables: Mapping[str, pd.DataFrame],
    graph: Sequence[Picture] = (),
    home: Path | None = None,
) -> Page:
    """The page, with curves that can be read by pointing at them, and the graph of the steps behind them.

    Trials whose page is in `home`, the folder that theirs start from, are linked to it.
    """
    sections: list[Section] = [*study_curves(curves).panels]
    for name, words in (
        ("values", "Mean and largest value of the subjects"),
        ("agreement", "Agreement of conditions"),
        ("outliers", "Trials that lie apart"),
    ):
        if name in tables and len(tables[name]):
            sections.append(frame_table(words, _known(tables[name])))
    sections += graph
    sections.append(_trials(tables["trials"], home))
    return Page(
        title,
        f"geocontact {current().command}",
        STEPS if curves else np.zeros(1),
        "cycle [%]" if curves else "",
        headline=headline(_answer_first(current().sentences, means_by_condition(curves))),
        sections=tuple(sections),
        plays=False,
    )


def _answer_first(sentences: Sequence[str], answers: Sequence[str]) -> list[str]:
    """Means by condition before the count of trials."""
    return [*answers[: MOST - 1], *(line for line in sentences if line not in answers), *answers[MOST - 1 :]]


def _known(table: pd.DataFrame) -> pd.DataFrame:
    """The table without columns that have no value, such as the SD of one subject."""
    return table.loc[:, [name for name in table.columns if (table[name].notna() & (table[name] != "")).any()]]


def _panel(one: StudyCurves) -> Curves:
    name, unit = split_header(one.column)
    drawn = [mean_curve(condition, values, k) for k, (condition, values) in enumerate(_drawn(one).items())]
    several = any(len(values) > 1 for values in _drawn(one).values())
    title = f"{name.replace('_', ' ')} over the cycle" + (f", {one.at}" if one.at else "")
    return Curves(f"{title}, mean of the subjects" if several else title, _printed(unit), drawn)


def _drawn(one: StudyCurves) -> dict[str, np.ndarray]:
    """Conditions that have a curve, not more than there are colours."""
    there = {name: values[np.isfinite(values).all(axis=1)] for name, values in one.groups.items()}
    return {name: there[name] for name in list(there)[:DRAWN] if len(there[name])}


def _printed(unit: str | None) -> str:
    """A unit in print: mm² for mm^2."""
    return (unit or "-").replace("^2", "²").replace("^3", "³")


def _trials(manifest: pd.DataFrame, home: Path | None) -> Table:
    shown = manifest.iloc[:ROWS]
    words = f"Trials, {ROWS} of {len(manifest)}" if len(manifest) > ROWS else "Trials"
    told = frame_table(words, _known(shown.drop(columns="folder")), most=ROWS)
    pages = [f"{folder}/{REPORT}" if folder else "" for folder in shown["folder"]]
    links = [page if page and home and (home / page).is_file() else "" for page in pages]
    return Table(told.title, told.header, told.rows, links=links)


def study_curves(curves: Sequence[StudyCurves]) -> CurveSheet:
    """Mean ± SD of every quantity and condition, of those that have a whole curve."""
    return CurveSheet([_panel(one) for one in curves if _drawn(one)], Course("cycle", "%", STEPS))
