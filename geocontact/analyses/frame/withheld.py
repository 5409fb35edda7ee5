"""What is withheld of a result that contradicts its data: ends of intervals, bands, and verdicts on numbers.

An interval says how well a number is known if the model is right. Where the data contradict the model it says nothing,
and no number is known, best or better. Tables, curves, files in JSON and pages of all analyses pass here, so that an
analysis withholds nothing by itself but in its sentences (`collector.if_it_fits`).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from geocontact.view.curves.declared import Curves, CurveSheet
from geocontact.view.page.content import Intervals, Readout, Section, Table

CONTRADICTED = "contradicts the data"
"""Verdict on a number of a model that its data contradict."""
KEPT = ("held", "unknown")
"""Verdicts that do not come from the fit."""
VERDICT = "verdict"
END = re.compile(
    r"(?<![a-z])(lower|upper)(?![a-z])|^profile parts$|(?<![a-z])9\d ?%|^interval$|^profile_likelihood$"
    r"|(?<![a-z])ci9\d(?![0-9])|^(block|wild)_bootstrap$|^(parts|open)$"
    r"|standard[ _]errors?|^sd_[a-z]|(?<!noise)_sd_[A-Za-z]"
)
"""Names of columns and keys that hold ends of intervals, or the standard error of a result: `sd_fx`, `point_sd_mm`.
`sd` and `force_sd [N]` are spreads of what was recorded, over trials or cycles, and hold without a model."""
PLUS_MINUS = re.compile(r"(?<=\d) ± \S+")
"""A standard error behind a number."""
BEFOREHAND = re.compile(r"^(prior|bound)")
"""Names of those that were there before the fit."""


INTERVAL = "interval"
"""Spans and level lines with this in their names are withheld."""


def is_end(name: str) -> bool:
    """Whether a column or a key holds an end of an interval.

    >>> [is_end(name) for name in ("E_star_lower [Pa]", "bootstrap upper", "prior lower", "slower", "value")]
    [True, True, False, False, False]
    >>> [is_end(name) for name in ("standard error", "sd_fx [N]", "point_sd_mm", "force_sd [N]", "noise_sd_N_m", "sd")]
    [True, True, True, False, False, False]
    """
    return bool(END.search(name)) and not BEFOREHAND.search(name)


def withheld_tables(tables: Mapping[str, pd.DataFrame], claims: Iterable[str] = ()) -> dict[str, pd.DataFrame]:
    """Tables without ends of intervals and verdicts.

    Parameters
    ----------
    claims
        Further columns that hold only if the model does, such as "better than present": they are emptied.
    """
    return {name: _table(table, frozenset(claims)) for name, table in tables.items()}


def _table(table: pd.DataFrame, claims: frozenset[str]) -> pd.DataFrame:
    shown = table.copy()
    for name in map(str, table.columns):
        if name.split(": ")[-1] == VERDICT:
            shown[name] = [each if each in KEPT else CONTRADICTED for each in table[name]]
        elif name in claims or is_end(name):
            shown[name] = np.nan
    return shown


def withheld_sheets(sheets: Mapping[str, CurveSheet]) -> dict[str, CurveSheet]:
    """Sets of curves without their bands."""
    return {name: replace(sheet, panels=[_curves(each) for each in sheet.panels]) for name, sheet in sheets.items()}


def _curves(panel: Curves) -> Curves:
    lines = [replace(each, lower=None, upper=None) for each in panel.curves]
    spans = [each for each in panel.spans if INTERVAL not in each.name]
    limits = [each for each in panel.limits if INTERVAL not in each.name]
    return replace(panel, curves=lines, spans=spans, limits=limits)


def withheld_json(content: Any) -> Any:
    """A nested result with None for ends of intervals, and verdicts replaced."""
    if isinstance(content, Mapping):
        return {key: _value(str(key), each) for key, each in content.items()}
    if isinstance(content, (list, tuple)):
        return [withheld_json(each) for each in content]
    return content


def _value(key: str, value: Any) -> Any:
    if is_end(key) and not isinstance(value, Mapping):
        return None
    if key == VERDICT and isinstance(value, str) and value not in KEPT:
        return CONTRADICTED
    return withheld_json(value)


def withheld_section(section: Section) -> Section:
    """A part of a page without whiskers and ends of intervals; its curves come from those of the result."""
    if isinstance(section, Intervals):
        rows = [replace(row, lower=np.nan, upper=np.nan) for row in section.intervals]
        return replace(section, intervals=rows)
    if isinstance(section, Table) and not section.folded:
        ends = [is_end(name) for name in section.header]
        rows_of = [["" if end else _bare(cell) for cell, end in zip(row, ends, strict=True)] for row in section.rows]
        return replace(section, rows=rows_of)
    if isinstance(section, Readout):
        return replace(section, rows=[replace(row, texts=[_bare(each) for each in row.texts]) for row in section.rows])
    return section


def _bare(cell: Any) -> Any:
    """A cell without the standard error behind its number."""
    return PLUS_MINUS.sub("", cell) if isinstance(cell, str) else cell
