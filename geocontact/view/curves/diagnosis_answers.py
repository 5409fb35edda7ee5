"""What a diagnosis answers, in figures: ranking, separability, detectability, reductions and reliability."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.data.diagnosis import ChannelGap
from geocontact.data.diagnosis_evidence import Ranked
from geocontact.view.curves.quantity import Quantity
from geocontact.view.curves.sheet import number, plain
from geocontact.view.curves.style import BLACK, DOUBLE, GREY, MARKERS, PALETTE, SINGLE, SMALL, empty, in_style, legend

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.figure import Figure


ROW = 0.0048  # height of a bar with its distance to the next [m]
MOST = 12  # models drawn


@in_style
def ranking_figure(models: Sequence[Ranked]) -> Figure:
    """Draw the gains as bars, the largest on top, with the probability of each single answer beside its best model."""
    shown = sorted(models, key=lambda one: -one.gain)[:MOST]
    if not shown:
        raise ValueError("models: nothing to rank")
    figure = empty(DOUBLE, 0.014 + ROW * len(shown))
    axes = figure.subplots()
    rows = np.arange(len(shown))
    colours = [PALETTE[2] if one.label == "unknown" else GREY if one.label == "none" else PALETTE[0] for one in shown]
    axes.barh(rows, [one.gain for one in shown], color=colours, height=0.7)
    axes.axvline(0.0, color=BLACK, lw=0.6)
    most = max(abs(one.gain) for one in shown) or 1.0
    for row, one in enumerate(shown):
        text = number(one.gain) if abs(one.gain) < 100.0 else f"{one.gain:.0f}"
        if one.probability is not None and one.probability >= 0.005:
            text += f"  (p = {one.probability:.2f})"
        axes.text(max(one.gain, 0.0) + 0.02 * most, row, text.replace("-", "−"), va="center", fontsize=6.5)
    axes.set_yticks(rows, [plain(one.label, 48) for one in shown])
    axes.set_ylabel("model")
    axes.invert_yaxis()
    axes.set_xlim(min(0.0, *(1.1 * one.gain for one in shown)), 1.3 * most)
    axes.set_xlabel("gain of evidence over the base model [nats]")
    return figure


CELL = 0.0048  # side of a cell [m]
SEPARABILITY_MOST = 20.0  # nats at which the colours end: separable beyond doubt
FEW = 40  # effects up to which cells carry numbers


@in_style
def separability_figure(true: Sequence[str], imitators: Sequence[str], nats: Float[np.ndarray, "e f"]) -> Figure:
    """Draw the matrix, a row per effect that is there, a column per model that is fitted instead.

    Parameters
    ----------
    true, imitators
        Labels of rows and columns.
    nats
        What the imitator leaves.
    """
    if not len(true):
        raise ValueError("separability: no effect to draw")
    figure = empty(DOUBLE, 0.03 + CELL * len(true))
    axes = figure.subplots()
    picture = axes.imshow(
        np.clip(nats, 0.0, SEPARABILITY_MOST), vmin=0.0, vmax=SEPARABILITY_MOST, cmap="cividis", aspect="auto"
    )
    axes.set_yticks(range(len(true)), [plain(name, 32) for name in true], fontsize=5.5)
    axes.set_xticks(range(len(imitators)), [plain(name, 32) for name in imitators], rotation=90, fontsize=5.5)
    axes.set_ylabel("effect that is there")
    axes.set_xlabel("model that is fitted instead")
    if len(true) <= FEW:
        for row, col in np.argwhere(nats < SEPARABILITY_MOST):
            shade = "white" if nats[row, col] < 0.6 * SEPARABILITY_MOST else "black"
            axes.text(col, row, f"{max(nats[row, col], 0.0):.0f}", ha="center", va="center", color=shade, fontsize=5.0)
    bar = figure.colorbar(picture, ax=axes, pad=0.01)
    bar.set_label(f"nats by which it is separated (to {SEPARABILITY_MOST:.0f})")
    return figure


DETECTABILITY_ROW = 0.0042  # height of a bar with its distance to the next [m]
LEAST = 1e-4  # share of the shortest bars
WORDS = 0.3  # of the width of the longest bar, for the words beside it


@dataclass(frozen=True)
class EffectVisibility:
    """One effect: its label, the share of the plausible range from which it is seen (None: never), words beside it."""

    label: str
    share: float | None
    words: str


@in_style
def detectability_figure(effects: Sequence[EffectVisibility]) -> Figure:
    """Draw a bar per effect up to the smallest amplitude that is seen, the most easily seen on top."""
    if not effects:
        raise ValueError("detectability: no effect to draw")
    shown = sorted(effects, key=lambda one: np.inf if one.share is None else one.share)
    figure = empty(DOUBLE, 0.014 + DETECTABILITY_ROW * len(shown))
    axes = figure.subplots()
    rows = np.arange(len(shown))
    widths = [1.0 if one.share is None else max(one.share, LEAST) for one in shown]
    colours = [GREY if one.share is None else PALETTE[0] for one in shown]
    axes.barh(rows, widths, color=colours, height=0.7)
    for row, (one, width) in enumerate(zip(shown, widths, strict=True)):
        axes.text(1.15 * width, row, plain(one.words, 60), va="center", fontsize=6.0)
    axes.set_xscale("log")
    axes.set_xlim(0.5 * LEAST, max(widths) * (2.0 * max(widths) / LEAST) ** WORDS)
    axes.set_ylim(len(shown) - 0.4, -0.6)
    axes.set_yticks(rows, [plain(one.label, 40) for one in shown], fontsize=6.0)
    axes.set_xlabel("smallest amplitude that is seen, share of the plausible range [–]")
    return figure


REDUCTIONS_ROW = 0.022  # height of a channel [m]
HIGH = 0.34  # of a bar, of a channel's height
FAINT = 0.05  # of the error before, below which a floor is not drawn


@in_style
def reductions_figure(gaps: Mapping[str, ChannelGap], quantities: Sequence[Quantity], effect: str = "") -> Figure:
    """Draw the root mean square errors on held-out trials, each channel in per cent of its error before.

    The whisker is the 95 % interval of what stays on fresh trials of the same kind; the dashed line is the noise floor,
    below which no model gets.

    Parameters
    ----------
    gaps
        By channel, SI units.
    quantities
        How each channel is printed, in their order.
    effect
        Name of what was added; "" where nothing was: then there is nothing but the errors before.
    """
    if len(gaps) != len(quantities):
        raise ValueError(f"quantities: {len(quantities)} for {len(gaps)} channels")
    figure = empty(DOUBLE, 0.02 + REDUCTIONS_ROW * len(gaps))
    axes = figure.subplots()
    rows, named = np.arange(len(gaps)), bool(effect)
    for row, (gap, quantity) in enumerate(zip(gaps.values(), quantities, strict=True)):
        whole = gap.rmse_before or 1.0
        told = [("before", row - HIGH / 2.0 if named else float(row), gap.rmse_before, PALETTE[1])]
        told += [("after", row + HIGH / 2.0, gap.rmse_after, PALETTE[0])] if named else []
        for what, place, size, colour in told:
            part, printed = 100.0 * size / whole, number(float(quantity.shown(np.array(size))))
            label = f"with {plain(effect, 40)}" if what == "after" else "base model"
            axes.barh(place, part, height=HIGH, color=colour, label=label if row == 0 else None)
            beside = axes.get_yaxis_transform()
            axes.text(1.01, place, f"{printed} {quantity.unit}", va="center", fontsize=SMALL, transform=beside)
        if named:
            low, high = (100.0 * (1.0 - edge) for edge in reversed(gap.ci95))
            axes.plot([low, high], [row + HIGH / 2.0] * 2, color=BLACK, lw=1.0, marker="|", markersize=6.0)
        floor = 100.0 * gap.noise_floor / whole
        if floor > 100.0 * FAINT:
            line = axes.plot([floor] * 2, [row - HIGH, row + HIGH], color=GREY, ls="--", lw=1.0)[0]
            if row == 0:
                line.set_label("noise floor")
    axes.set_yticks(rows, [plain(name, 24) for name in gaps])
    axes.invert_yaxis()
    axes.set_xlim(0.0, None)
    axes.set_xlabel("error on held-out trials, root mean square [% of the base model's]")
    figure.legend(loc="outside upper left", ncols=3)
    return figure


@dataclass(frozen=True)
class Stated:
    """Stated probabilities in bins.

    Parameters
    ----------
    stated, came_true
        Mean of each bin, and the share that came true.
    low, high
        Interval of that share.
    count
        How many.
    """

    stated: Float[np.ndarray, " b"]
    came_true: Float[np.ndarray, " b"]
    low: Float[np.ndarray, " b"]
    high: Float[np.ndarray, " b"]
    count: Sequence[int]


@in_style
def reliability_figure(answerers: Mapping[str, Stated]) -> Figure:
    """Draw came true over stated; the first of several carries its counts, the others stand a little to the right."""
    if not answerers:
        raise ValueError("answerers: no answer was stated")
    figure = empty(SINGLE, SINGLE)
    axes = figure.subplots()
    axes.plot([0.0, 1.0], [0.0, 1.0], color=GREY, lw=0.6)
    entries: list[tuple[Artist | tuple[Artist, ...], str]] = []
    for k, (name, one) in enumerate(answerers.items()):
        reach = np.clip([one.came_true - one.low, one.high - one.came_true], 0.0, None)
        place, width = one.stated + 0.012 * k, 0.8 if k == 0 else 0.5
        drawn = axes.errorbar(
            place, one.came_true, reach, elinewidth=0.6, lw=width, ms=3.5, color=PALETTE[k], marker=MARKERS[k]
        )
        entries.append((drawn[0], name))
        for x, y, n in zip(place, one.came_true, one.count, strict=True):
            if k == 0:
                axes.annotate(str(n), (x, y), (3, 3), textcoords="offset points", fontsize=6.0, color=PALETTE[0])
    axes.set(xlim=(-0.02, 1.05), ylim=(-0.02, 1.06), xlabel="probability stated", ylabel="share that came true")
    legend(axes, entries)
    return figure
