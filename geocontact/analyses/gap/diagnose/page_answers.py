"""Where the gap is, how far it shrinks and how sure the answer is, as the page draws it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from geocontact.analyses.gap.case import percent
from geocontact.analyses.gap.diagnose.answer import axis_units
from geocontact.analyses.gap.diagnose.curves import effect_words, quantity_of
from geocontact.analyses.gap.diagnose.shrinking import axis_words, printed
from geocontact.analyses.gap.nats import ODDS, ahead_words
from geocontact.data.diagnosis import Diagnosis
from geocontact.data.gap_cells import BAND, FAST, FAST_PHASE, Cell, Region
from geocontact.gap.diagnose import Findings
from geocontact.gap.levels import WORTH_NAMING
from geocontact.gap.localise.structure import SHAPE
from geocontact.view.curves.gap_map import ENERGIES, MARKS, SIGNIFICANT, WIDE, edge_text
from geocontact.view.curves.quantity import Quantity
from geocontact.view.curves.sheet import number
from geocontact.view.page.content import IntervalRow, Intervals, StripBlock, Strips

MODELS = 12
"""Models that are drawn; the table has all."""
LEAST_PROBABLE = 0.005
FULL = 0.5
"""Share of a channel's gap at which the shades of the map end: cells of a strip with twenty seldom have more."""
SCALE = ("0 %", "12.5 %", "25 %", "37.5 %", "50 % of the gap or more")
MAP = (
    "The more colour a cell has, the more of the channel's gap lies there (noise taken off; a strip makes 100 %). "
    "+ measured above, − below the prediction, • neither (an energy): at these cells chance alone is unlikely "
    f"(p-value of at most {SIGNIFICANT:g} for the whole map). Inputs, rates and load are cut so that each cell has as "
    "many samples. All trials, base model."
)
NO_SHARE = (
    f" `no_gap` beside regions: what is surely missed there is less than {100.0 * WORTH_NAMING:.0f} % of a channel's "
    "squared error, no share worth a name."
)
REGIONS = (
    " Regions are cells of phase, state and rate that touch; where trials are independent, on average one in twenty at "
    "most of those that are found is chance (false-discovery rate). Beside a strong gap they reach beyond its place, "
    "and of few trials little is found."
)
REDUCTIONS = (
    "Root mean square error on trials that no parameter was fitted to. The whisker is the 95 % interval of the error "
    "that remains on new trials of the same kind: where it reaches beyond 100 %, the error may also grow on such a "
    "trial. No model gets below the noise floor."
)


def map_strips(findings: Findings) -> Strips:
    """The gap map: a strip for each axis, a row for each channel."""
    cells = findings.cells
    channels, units = list(dict.fromkeys(c.channel for c in cells)), axis_units(findings)
    axes = list(dict.fromkeys(c.axis for c in cells))
    ordered = [*(axis for axis in WIDE if axis in axes), *(axis for axis in axes if axis not in WIDE)]
    blocks = [_block([c for c in cells if c.axis == axis], axis, channels, units.get(axis, "")) for axis in ordered]
    whose = f" of {channels[0]}" if len(channels) == 1 else ""
    found = findings.diagnosis.regions
    blocks += [region_block(found, channels)] if found else []
    return Strips(f"Where the gap{whose} is", "", channels, blocks, SCALE, MAP + region_caption(findings.diagnosis))


def region_caption(d: Diagnosis) -> str:
    """What regions are; beside `no_gap` first that they hold no share worth a name."""
    if not d.regions:
        return ""
    return (NO_SHARE if d.verdict == "no_gap" else "") + REGIONS


def region_block(found: Sequence[Region], channels: Sequence[str]) -> StripBlock:
    """Parts of the trial that regions lie in, with the share that these hold of each channel's squared error."""
    count = SHAPE[0]
    values = np.zeros((len(channels), count))
    texts = [["no region"] * count for _ in channels]
    marks = [[""] * count for _ in channels]
    for c, name in enumerate(channels):
        for k in range(count):
            middle = (k + 0.5) / count
            here = [one for one in found if one.channel == name and one.phase[0] < middle < one.phase[1]]
            if here:
                values[c, k] = min(sum(one.share for one in here) / FULL, 1.0)
                texts[c][k] = "; ".join(region_words(one) for one in here)
                marks[c][k] = MARKS[int(np.sign(here[0].mean))]
    edges = 100.0 * np.linspace(0.0, 1.0, count + 1)
    return StripBlock(
        "regions, phase of the trial [%]", [edge_text(e, 100.0) for e in edges], values, texts, marks, True
    )


def region_words(one: Region) -> str:
    """Place, share and false-discovery rate of a region."""
    return f"{one.place}: {percent(one.share)} % of the squared error, false-discovery rate {one.q_value:.2g}"


def _block(cells: list[Cell], axis: str, channels: list[str], unit: str) -> StripBlock:
    name, per_si, shown_in = _axis(axis, unit)
    lows = sorted({c.low for c in cells})
    values = np.full((len(channels), len(lows)), np.nan)
    texts = [["not known"] * len(lows) for _ in channels]
    marks = [[""] * len(lows) for _ in channels]
    for c in cells:
        at = channels.index(c.channel), lows.index(c.low)
        values[at] = min(max(c.share / FULL, 0.0), 1.0)
        texts[at[0]][at[1]] = f"{percent(c.share)} % of the gap, p-value {c.p_value:.2g}"
        if c.p_value <= SIGNIFICANT:
            marks[at[0]][at[1]] = MARKS[0 if c.axis in ENERGIES else int(np.sign(c.gap))]
    edges = per_si * np.array([*lows, max(c.high for c in cells)])
    span = float(np.ptp(edges[np.isfinite(edges)]))
    label = f"{name} [{shown_in}]" if shown_in else name
    return StripBlock(label, [edge_text(float(e), span) for e in edges], values, texts, marks, axis in WIDE)


def _axis(axis: str, unit: str) -> tuple[str, float, str]:
    """Name of an axis in words, what its values are multiplied by, and the unit that they then have."""
    if axis in WIDE:
        return (
            (f"phase, faster than {FAST:g} Hz" if axis == FAST_PHASE else "phase of the trial"),
            100.0,
            "%",
        )
    if axis == BAND:
        return "frequency", 1.0, "Hz"
    shown_in, per_si = printed(unit)
    return axis_words(axis), per_si, shown_in


def reduction_bars(findings: Findings) -> Intervals:
    """Errors on held-out trials, each channel in per cent of the base model's."""
    rows = []
    named = any(t.named is not None for t in findings.held_out)
    for name, gap in findings.diagnosis.gap.items():
        quantity, whole = quantity_of(findings, name), gap.rmse_before or 1.0
        rows.append(_size(quantity, whole, gap.rmse_before, "base model"))
        if named:
            ends = (100.0 * (1.0 - gap.ci95[1]), 100.0 * (1.0 - gap.ci95[0]))
            rows.append(_size(quantity, whole, gap.rmse_after, f"with {effect_words(findings)}", ends))
        rows.append(_size(replace(quantity, name=f"{name}, floor"), whole, gap.noise_floor, "noise floor"))
    title, unit = "How far the error shrinks on held-out trials", "% of the base model's error"
    return Intervals(title, unit, rows, bars=True, words=REDUCTIONS)


def _size(
    quantity: Quantity, whole: float, size: float, kind: str, ends: tuple[float, float] = (np.nan, np.nan)
) -> IntervalRow:
    shown = number(float(quantity.shown(np.array(size))))
    return IntervalRow(f"{quantity.name}: {shown} {quantity.unit}", 100.0 * size / whole, ends[0], ends[1], kind)


def ranking_bars(findings: Findings) -> Intervals:
    """Evidence of every model over the base model."""
    shown = findings.ranking[:MODELS]
    kinds = {"none": "base model", "unknown": "without a name"}
    rows = [
        IntervalRow(_model(one.label, one.probability), one.gain, kind=kinds.get(one.label, "known")) for one in shown
    ]
    rest = len(findings.ranking) - len(shown)
    more = f" {rest} further models are in the table." if rest else ""
    meaning = f"Evidence of a model over the base model; p is the probability of an answer. {ODDS}"
    words = f"{meaning} {ahead_words(findings.ranking, findings.diagnosis.effects)}{more}".strip()
    return Intervals("How sure that is", "nats of evidence over the base model", rows, bars=True, words=words)


def _model(label: str, probability: float | None) -> str:
    return label if probability is None or probability < LEAST_PROBABLE else f"{label} (p = {probability:.2f})"
