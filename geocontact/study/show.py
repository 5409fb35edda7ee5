"""The page of a study: mean curves by condition, what differs, who lies apart, a link to each trial's page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import current
from geocontact.analyses.frame.result import REPORT
from geocontact.analyses.frame.words import headline
from geocontact.data.trial import mean_and_sd
from geocontact.io.text.units import split_header
from geocontact.study.curves import STEPS, StudyCurves
from geocontact.view.curves.over_cycle import mean_over_cycle
from geocontact.view.curves.quantity import CYCLE, Quantity
from geocontact.view.curves.style import DOUBLE, PALETTE, in_style, panels
from geocontact.view.page.content import Curve, Curves, Page, Section, Table
from geocontact.view.page.tables import frame_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DRAWN = len(PALETTE)
"""Conditions that curves are drawn of."""
ROWS = 500
"""Rows of the table of trials that the page shows; trials.csv has all."""


def study_page(title: str, curves: Sequence[StudyCurves], tables: Mapping[str, pd.DataFrame]) -> Page:
    """The page, with curves that can be read by pointing at them."""
    sections: list[Section] = [section for one in curves if (section := _panel(one)).curves]
    for name, words in (
        ("values", "Mean and largest value of the subjects"),
        ("agreement", "Agreement of conditions"),
        ("outliers", "Trials that lie apart"),
    ):
        if name in tables and len(tables[name]):
            sections.append(frame_table(words, tables[name]))
    sections.append(_trials(tables["trials"]))
    return Page(
        title,
        f"geocontact {current().command}",
        STEPS if curves else np.zeros(1),
        "cycle [%]" if curves else "",
        headline=headline(current().sentences),
        sections=tuple(sections),
        plays=False,
    )


def _panel(one: StudyCurves) -> Curves:
    name, unit = split_header(one.column)
    drawn = []
    for condition, values in _drawn(one).items():
        mean, sd = mean_and_sd(values)
        several = len(values) > 1
        words = f"{condition} (n = {len(values)})"
        drawn.append(Curve(words, mean, mean - sd if several else None, mean + sd if several else None))
    return Curves(f"{name}: mean ± SD over subjects", _printed(unit), drawn)


def _drawn(one: StudyCurves) -> dict[str, np.ndarray]:
    """Conditions that have a curve, not more than there are colours."""
    there = {name: values[np.isfinite(values).all(axis=1)] for name, values in one.groups.items()}
    return {name: there[name] for name in list(there)[:DRAWN] if len(there[name])}


def _printed(unit: str | None) -> str:
    """A unit in print: mm² for mm^2."""
    return (unit or "-").replace("^2", "²").replace("^3", "³")


def _trials(manifest: pd.DataFrame) -> Table:
    shown = manifest.iloc[:ROWS]
    words = f"Trials, {ROWS} of {len(manifest)}" if len(manifest) > ROWS else "Trials"
    told = frame_table(words, shown.drop(columns="folder"))
    links = [f"{folder}/{REPORT}" if folder else "" for folder in shown["folder"]]
    return Table(told.title, told.header, told.rows, links=links)


@in_style
def study_figure(curves: Sequence[StudyCurves]) -> Figure | None:
    """Mean ± SD of every quantity and condition; None where no trial has a whole curve."""
    curves = [one for one in curves if _drawn(one)]
    if not curves:
        return None
    figure, axes = panels(1, len(curves), DOUBLE, 0.06)
    for one, own in zip(curves, axes, strict=True):
        name, unit = split_header(one.column)
        mean_over_cycle(STEPS, _drawn(one), Quantity(name.replace("_", " "), _printed(unit)), own, CYCLE)
    return figure
