"""Held-out trials as they were measured and as they are predicted, and what remains: for the page and for figures."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.analyses.gap.case import percent
from geocontact.analyses.gap.diagnose.answer import PART_WORDS, axis_units
from geocontact.analyses.gap.diagnose.shrinking import axis_words, printed
from geocontact.data.diagnosis_evidence import HeldOut
from geocontact.data.motion import Course
from geocontact.gap.diagnose import Findings
from geocontact.gap.levels import WORTH_NAMING
from geocontact.view.curves.declared import INK, Curve, Curves, CurveSheet, Shade, stroke
from geocontact.view.curves.diagnosis_answers import ranking_figure, reductions_figure
from geocontact.view.curves.drawn import drawn
from geocontact.view.curves.error_budget import BudgetBar, error_budget_figure
from geocontact.view.curves.gap_map import gap_map_figure, gap_surface_figure
from geocontact.view.curves.quantity import Quantity
from geocontact.view.curves.sheet import number
from geocontact.view.page.content import Readout, Row

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SURFACE = "gap_surface_"
FRAMES = 201
PHASE = np.linspace(0.0, 1.0, FRAMES)
"""Fractions of a trial that curves are shown at."""
OVER = Course("phase of the trial", "%", 100.0 * PHASE)
SIDE_BY_SIDE = 6
"""Held-out trials of a channel that a figure holds."""
MEASURED, BASE, NAMED, FLOOR = INK, stroke(1), stroke(0), stroke(3)
Z95 = 1.959964


def quantity_of(findings: Findings, channel: str) -> Quantity:
    """A channel as it is drawn: lengths in mm, angles in degrees."""
    return Quantity(channel, *printed(findings.attribution.problem.system.unit(channel)))


def effect_words(findings: Findings) -> str:
    """What the curves are drawn with."""
    return " + ".join(findings.diagnosis.effects) or "the most probable candidate"


def worst_first(findings: Findings) -> list[str]:
    """Channels, those with the largest part of the gap first."""
    share = {w.channel: w.share for w in findings.diagnosis.where}
    return sorted(findings.attribution.problem.system.outputs, key=lambda name: -share.get(name, 0.0))


def resampled(trial: HeldOut, values: Float[np.ndarray, "t c"]) -> Float[np.ndarray, "p c"]:
    """Columns of a trial at `PHASE`, by linear interpolation; NaN next to what is not there."""
    return np.stack([np.interp(PHASE, trial.phase, column) for column in values.T], axis=1)


def trial_panel(findings: Findings, channel: str, trial: HeldOut) -> Curves:
    """One channel of one held-out trial: measured, predicted by the base model, and with what was named."""
    quantity, models = quantity_of(findings, channel), _models(findings, trial)
    parts = [("measured", trial.measured, MEASURED), *models]
    curves = [_curve(findings, channel, trial, values, *look) for look, values in _looks(parts)]
    return Curves(f"{channel}, held-out trial {trial.name}", quantity.unit, curves)


def residual_panel(findings: Findings, channel: str, trial: HeldOut) -> Curves:
    """Measured less predicted; the band is the noise floor, the shaded window holds 70 % of the gap."""
    d, quantity = findings.diagnosis, quantity_of(findings, channel)
    off = [(name, trial.measured - values, look) for name, values, look in _models(findings, trial)]
    curves = [_curve(findings, channel, trial, values, *look) for look, values in _looks(off)]
    noise = float(quantity.shown(np.array(Z95 * d.gap[channel].noise_floor)))
    none = np.zeros(FRAMES)
    curves.append(Curve("noise alone, 95 %", none, none - noise, none + noise, stroke=FLOOR))
    windows = [w.phase for w in d.where if w.channel == channel]
    spans = [Shade("70 % of the gap", 100.0 * low, 100.0 * high) for low, high in windows]
    title = f"{channel}, held-out trial {trial.name}: measured − predicted"
    return Curves(title, quantity.unit, curves, spans=spans)


Predicted = tuple[str, Float[np.ndarray, "t c"], int]


def _models(findings: Findings, trial: HeldOut) -> list[Predicted]:
    named = [] if trial.named is None else [(f"with {effect_words(findings)}", trial.named, NAMED)]
    return [("base model", trial.base, BASE), *named]


def _looks(parts: Sequence[Predicted]) -> list[tuple[tuple[str, int], Float[np.ndarray, "t c"]]]:
    return [((name, look), values) for name, values, look in parts]


def _curve(
    findings: Findings, channel: str, trial: HeldOut, values: Float[np.ndarray, "t c"], name: str, look: int
) -> Curve:
    c = findings.attribution.problem.system.outputs.index(channel)
    return Curve(name, quantity_of(findings, channel).shown(resampled(trial, values)[:, c]), stroke=look)


def gap_figures(findings: Findings) -> dict[str, Figure]:
    """Budget, map, errors, ranking, residuals, cells of each mat, and curves of each channel."""
    d, trials = findings.diagnosis, findings.held_out[:SIDE_BY_SIDE]
    channels = findings.attribution.problem.system.outputs
    effect = effect_words(findings) if any(t.named is not None for t in findings.held_out) else ""
    found = {
        "gap_map": map_figure(findings),
        "reductions": reductions_figure(d.gap, [quantity_of(findings, name) for name in d.gap], effect),
        "ranking": ranking_figure(findings.ranking),
        "gap_residuals": _sheet([residual_panel(findings, name, trial) for name in channels for trial in trials]),
    }
    found |= {"budget": error_budget_figure(budget_bars(findings), PART_WORDS)} if d.budget else {}
    found |= {
        name: gap_surface_figure(one) for name, one in zip(surface_names(findings), findings.surface, strict=True)
    }
    for c, name in enumerate(channels):
        panels = [trial_panel(findings, name, trial) for trial in trials]
        found[f"before_after_{_file_name(name, c)}"] = _sheet(panels)
    return found


def budget_bars(findings: Findings) -> list[BudgetBar]:
    """A bar for each channel before, and one after where something is named."""
    d, bars = findings.diagnosis, []
    named = any(t.named is not None for t in findings.held_out)
    for name, parts in d.budget.items():
        quantity, gap = quantity_of(findings, name), d.gap[name]
        shares = {part: each.share for part, each in parts.items()}
        rows = [(f"{name}, base model", shares, gap.rmse_before)]
        if named:
            rows.append((f"{name}, with {effect_words(findings)}", shares | {"effects": 0.0}, gap.rmse_after))
        bars += [BudgetBar(label, own, _printed(quantity, size)) for label, own, size in rows]
    return bars


def budget_words(findings: Findings) -> list[str]:
    """What the error of each channel consists of, as root mean squares; where it is unexplained if nothing is named."""
    said, d = [], findings.diagnosis
    nothing = not any(trial.named is not None for trial in findings.held_out)  # else `where` is where the effect acts
    where = {w.channel: w.phase for w in d.where} if nothing else {}
    for name, parts in d.budget.items():
        quantity, before = quantity_of(findings, name), d.gap[name].rmse_before
        sizes = {part: before * float(np.sqrt(max(each.share, 0.0))) for part, each in parts.items()}
        shown = [f"{_printed(quantity, size)} {PART_WORDS[part]}" for part, size in sizes.items() if size > 0.0]
        place = ""
        if name in where and parts["unexplained"].share >= WORTH_NAMING:
            place = f", most of it in {percent(where[name][0])} to {percent(where[name][1])} % of each trial"
        said.append(f"{name}: of {_printed(quantity, before)}, {', '.join(shown)}{place}")
    return said


def _printed(quantity: Quantity, size: float) -> str:
    return f"{number(float(quantity.shown(np.array(size))))} {quantity.unit}".strip()


def _sheet(panels: Sequence[Curves]) -> Figure:
    return drawn(CurveSheet(panels, OVER, min(2, len(panels))))


def map_figure(findings: Findings) -> Figure:
    """Where the gap is."""
    named = {cell.axis: axis_words(cell.axis) for cell in findings.cells}
    cells = tuple(replace(cell, axis=named[cell.axis]) for cell in findings.cells)
    return gap_map_figure(cells, {axis_words(axis): unit for axis, unit in axis_units(findings).items()})


def surface_names(findings: Findings) -> list[str]:
    """Names of the figures of cells, one for each mat."""
    return [f"{SURFACE}{_file_name(one.site, k)}" for k, one in enumerate(findings.surface)]


def _file_name(channel: str, number: int) -> str:
    return channel if re.fullmatch(r"\w{1,60}", channel, re.ASCII) else str(number + 1)


def readout(findings: Findings) -> Readout:
    """Root mean square residual at the phase under the cursor, over the held-out trials."""
    rows, trials = [], findings.held_out
    for c, name in enumerate(findings.attribution.problem.system.outputs):
        quantity = quantity_of(findings, name)
        for words, off in (
            ("base model", [t.measured - t.base for t in trials]),
            (f"with {effect_words(findings)}", [t.measured - t.named for t in trials if t.named is not None]),
        ):
            if off:
                rows.append(_row(f"{name}, {words} off by", quantity, trials, off, c))
    return Readout(rows, title="At this phase, held-out trials together (rms)")


def _row(label: str, quantity: Quantity, trials: Sequence[HeldOut], off: Sequence[np.ndarray], c: int) -> Row:
    values = np.array([resampled(t, part)[:, c] for t, part in zip(trials, off, strict=True)])
    there = np.isfinite(values)
    squares = np.where(there, values, 0.0) ** 2
    mean = squares.sum(axis=0) / np.where(there.any(axis=0), there.sum(axis=0), np.nan)
    shown = quantity.shown(np.sqrt(mean))
    scale = float(np.nanmax(shown, initial=0.0))
    return Row(label, quantity.unit, [number(value, scale) for value in shown])
