"""Figures of an identification: forces over the angle, what data tell, residuals, both conditions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float

from geocontact.analyses.misalignment.labels import ANGLE, CONSTRAINT
from geocontact.axis_misalignment.end_stop import BinMeans, RecordedStroke
from geocontact.axis_misalignment.uncertainty import Direction
from geocontact.identify.intervals.profile_likelihood import Profile
from geocontact.view.curves.quantity import Quantity
from geocontact.view.curves.residuals import residual_histogram, residual_quantiles
from geocontact.view.curves.style import BLACK, DOUBLE, GREY, LINES, MARKERS, PALETTE, in_style, legend, panels

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.figure import Figure

Entries = list[tuple["Artist | tuple[Artist, ...]", str]]
STANDARD = Quantity("over its SD", "–")


@dataclass(frozen=True, eq=False)
class Boxes:
    """Samples of each bin: its middle [rad] and quantiles 5, 25, 50, 75, 95 % [N]."""

    centre: Float[np.ndarray, " b"]
    quantiles: Float[np.ndarray, "b 5"]
    width: float


@dataclass(frozen=True, eq=False)
class Over:
    """A fit over the angle: bin means of each trial, and the fitted curve."""

    beta: Float[np.ndarray, " n"]
    force: Float[np.ndarray, " n"]
    curve_beta: Float[np.ndarray, " m"]
    curve_force: Float[np.ndarray, " m"]


@in_style
def force_figure(over: Over, boxes: Boxes) -> Figure:
    """Draw bin means of every trial with the fitted curve (a), and the samples' spread in wider bins (b)."""
    figure, (left, right) = panels(1, 2, DOUBLE, 0.075)
    dots = left.plot(np.degrees(over.beta), over.force, ".", color=PALETTE[0], markersize=2.0, alpha=0.6)[0]
    line = left.plot(np.degrees(over.curve_beta), over.curve_force, color=BLACK)[0]
    legend(left, [(dots, "bin means of the trials"), (line, "explicit model")])
    _boxed(right, boxes, 0.0, 0.7, PALETTE[0])
    right.set_title("samples: 5, 25, 50, 75, 95 %", fontsize=7.0)
    for panel in (left, right):
        panel.axhline(0.0, color=GREY, lw=0.6)
        panel.set_xlabel(ANGLE)
        panel.set_ylabel(CONSTRAINT.label)
    return figure


@in_style
def told_figure(
    directions: Direction,
    line: Float[np.ndarray, "m 8"],
    line_r2: Float[np.ndarray, " m"],
    alone_r2: Float[np.ndarray, " m"],
    profiles: Mapping[str, Profile],
) -> Figure:
    """Draw the direction told least (a), R² along the scale line and along k alone (b), profiles (c).

    Parameters
    ----------
    line
        Numbers along the scale; the stiffness is the first column.
    alone_r2
        R² where k alone changes as it does along the line.
    profiles
        By what they are of, as the legend says: numbers, or ratios where nothing sets the scale; drawn over the best
        value of each.
    """
    figure, (bars, along, shape) = panels(1, 3, DOUBLE, 0.07)
    bars.bar(range(len(directions.names)), directions.least, color=PALETTE[0])
    bars.set_xticks(range(len(directions.names)), [f"log |{name}|" for name in directions.names], fontsize=6.0)
    bars.axhline(0.0, color=GREY, lw=0.6)
    bars.set_ylabel("direction told least")
    ratio = directions.singular_values[-1] / directions.singular_values[0]
    bars.set_title(f"singular value {ratio:.0e} of the largest", fontsize=7.0)
    flat = along.plot(line[:, 0], line_r2, color=PALETTE[0])[0]
    alone = along.plot(line[:, 0], np.maximum(alone_r2, -0.5), color=PALETTE[1], ls="--")[0]
    along.set_xscale("log")
    ticks = line[[0, len(line) // 2, -1], 0]
    along.set_xticks(ticks, [f"{k:.3g}" for k in ticks])
    along.minorticks_off()
    along.set_xlabel("k [N/m]")
    along.set_ylabel("R² of bin means")
    legend(along, [(flat, "k/s, s × lengths"), (alone, "k alone")])
    curves: Entries = []
    for k, (name, p) in enumerate(profiles.items()):
        if len(p.values) > 1 and p.best != 0.0:
            drawn = shape.plot(p.values / p.best, p.rise, color=PALETTE[k % len(PALETTE)], ls=LINES[k % len(LINES)])
            curves.append((drawn[0], name))
    shape.axhline(1.0, color=GREY, lw=0.6)
    shape.set_ylim(-0.1, 2.5)
    shape.set_xlabel("over the best value")
    shape.set_ylabel("rise of the profile / cut at 95 %")
    if curves:
        legend(shape, curves)
    return figure


@in_style
def residual_figure(
    beta: Float[np.ndarray, " b"], residual: Float[np.ndarray, " b"], standard: Float[np.ndarray, " b"], told: str
) -> Figure:
    """Draw residuals of bins over the angle (a), and in their SD: histogram (b), quantiles with the test `told` (c)."""
    figure, (over, histogram, quantiles) = panels(1, 3, DOUBLE, 0.075)
    over.plot(np.degrees(beta), residual, "o", color=PALETTE[0], markersize=2.5, markeredgewidth=0.0)
    over.axhline(0.0, color=GREY, lw=0.6)
    over.set_xlabel(ANGLE)
    over.set_ylabel("residual force [N]")
    residual_histogram(standard, STANDARD, histogram)
    residual_quantiles(standard, STANDARD, quantiles, told)
    return figure


def _boxed(panel: Any, boxes: Boxes, shift: float, share: float, colour: str) -> Artist:
    """Boxes of samples: `shift` and `share` of the bins' width say where they stand in a bin and how wide."""
    width = float(np.degrees(boxes.width))
    names = ("whislo", "q1", "med", "q3", "whishi")
    stats: list[dict[str, Any]] = [dict(zip(names, map(float, row), strict=True)) for row in boxes.quantiles]
    drawn = panel.bxp(
        stats,
        positions=list(np.degrees(boxes.centre) + shift * width),
        widths=share * width,
        showfliers=False,
        manage_ticks=False,
        boxprops={"color": colour},
        whiskerprops={"color": colour},
        capprops={"color": colour},
        medianprops={"color": BLACK},
    )
    first: Artist = drawn["boxes"][0]
    return first


@in_style
def conditions_figure(locked: BinMeans, stroke: RecordedStroke, locked_boxes: Boxes, free_boxes: Boxes) -> Figure:
    """Draw over the angle, with the joint locked and free: mean force (a), displacement of the free joint (b), the
    samples' spread in wider bins on one axis (c).
    """
    figure, (above, below, spread) = panels(3, 1, DOUBLE, 0.12)
    kinds = ((locked_boxes, -0.2, PALETTE[0], "locked"), (free_boxes, 0.2, PALETTE[1], "free"))
    legend(spread, [(_boxed(spread, boxes, shift, 0.3, colour), name) for boxes, shift, colour, name in kinds])
    spread.axhline(0.0, color=GREY, lw=0.6)
    spread.set_xlabel(ANGLE)
    spread.set_ylabel(CONSTRAINT.label)
    spread.set_title("samples: 5, 25, 50, 75, 95 %", fontsize=7.0)
    free = stroke.curve
    pairs: Entries = []
    for k, (curve, name) in enumerate(((locked, "joint locked"), (free, "joint free"))):
        dots = above.plot(np.degrees(curve.beta), curve.force, MARKERS[k], color=PALETTE[k], markersize=3.0)[0]
        pairs.append((dots, name))
    above.axhline(0.0, color=GREY, lw=0.6)
    above.set_ylabel(CONSTRAINT.label)
    legend(above, pairs)
    below.plot(np.degrees(free.beta), free.joint * 1e3, "x", color=PALETTE[1], markersize=3.0)
    for stop in stroke.stops:
        for panel in (above, below):
            panel.axvspan(np.degrees(stop.first), np.degrees(stop.last), color=GREY, alpha=0.15, lw=0)
        below.annotate(
            f"{stop.side} end",
            (np.degrees(stop.first), stop.position * 1e3),
            xytext=(4, 6),
            textcoords="offset points",
            fontsize=7.0,
        )
    below.set_xlabel(ANGLE)
    below.set_ylabel("displacement of the joint [mm]")
    return figure
