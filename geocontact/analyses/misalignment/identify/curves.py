"""Curves of an identification: forces over the angle, what the data identify, residuals, both states of the joint."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.axis_misalignment.compensation import BinMeans, RecordedStroke
from geocontact.axis_misalignment.uncertainty import Direction
from geocontact.data.motion import Course
from geocontact.identify.intervals.profile_likelihood import Profile
from geocontact.view.curves.declared import INK, Curve, Curves, CurveSheet, Limit, Points, Shade, stroke
from geocontact.view.curves.residuals import normal_quantiles
from geocontact.view.page.content import IntervalRow, Intervals

BETA = "exoskeleton angle β"
LOCKED, FREE = stroke(0), stroke(1, 1)
"""Strokes of both states of the joint."""
DENSE = 301
"""Places of the normal density."""
RISE = 2.5
"""Up to which the rise of a profile is drawn."""
LEAST_R2 = -0.5
"""Down to which R² is drawn."""


@dataclass(frozen=True, eq=False)
class Boxes:
    """Samples of each bin: its middle [rad] and quantiles 5, 25, 50, 75, 95 % [N]."""

    centre: Float[np.ndarray, " b"]
    quantiles: Float[np.ndarray, "b 5"]
    width: float


@dataclass(frozen=True, eq=False)
class Over:
    """A fit over the angle [rad]: bin means of each trial; of all, with the fitted curve, at the bins' middles [N]."""

    beta: Float[np.ndarray, " n"]
    force: Float[np.ndarray, " n"]
    middle: Float[np.ndarray, " b"]
    measured: Float[np.ndarray, " b"]
    fitted: Float[np.ndarray, " b"]


def force_curves(over: Over, boxes: Boxes) -> CurveSheet:
    """Bin means of every trial and the fitted curve, then the spread of the samples in wider bins."""
    trials = Points("bin means of the trials", np.degrees(over.beta), over.force)
    force = [
        Curve("mean of all trials", over.measured, stroke=INK),
        Curve("explicit model", over.fitted, stroke=stroke(0)),
    ]
    panels = [
        Curves("Constraint force over the angle", "N", force, points=[trials]),
        Curves(
            "Spread of the samples in wider bins",
            "N",
            _spread(boxes),
            over=_angles(boxes.centre),
            words=BANDS,
        ),
    ]
    return CurveSheet(panels, _angles(over.middle))


BANDS = "Medians; bands hold 25 to 75 % and 5 to 95 % of the samples."
ONE_BAND = "Medians; bands hold 5 to 95 % of the samples."


def _spread(boxes: Boxes) -> list[Curve]:
    least, lower, middle, upper, most = boxes.quantiles.T
    return [
        Curve("median, 25 to 75 %", middle, lower, upper, LOCKED),
        Curve("median, 5 to 95 %", middle, least, most, LOCKED),
    ]


def _angles(beta: Float[np.ndarray, " n"]) -> Course:
    return Course(BETA, "°", np.degrees(beta))


def direction_bars(directions: Direction) -> Intervals:
    """The direction in the logarithms of the numbers that is identified least."""
    ratio = directions.singular_values[-1] / directions.singular_values[0]
    rows = [IntervalRow(name, float(part)) for name, part in zip(directions.names, directions.least, strict=True)]
    words = f"{LEAST_KNOWN} Its singular value is {ratio:.0e} of the largest."
    return Intervals("Direction that is identified least, in logarithms", "–", rows, bars=True, words=words)


LEAST_KNOWN = "(−1, 1, 1, 1, 1) is the scale: k/s, s × lengths."
ALONG = "k/s, s × lengths does not change R² where nothing sets the scale; k alone does."
PROFILES = (
    "How far the sum of squares rises when a number is held away from its best value; an interval of 95 % ends at 1. "
    "Where nothing sets the scale these are the ratios that no scale changes."
)


def identified_curves(
    line: Float[np.ndarray, "m 8"],
    line_r2: Float[np.ndarray, " m"],
    alone_r2: Float[np.ndarray, " m"],
    profiles: Mapping[str, Profile],
) -> CurveSheet:
    """R² along the scale line and along k alone, then profiles over the best value of each.

    Parameters
    ----------
    line
        Numbers along the scale; the stiffness is the first column.
    alone_r2
        R² where k alone changes as it does along the line.
    profiles
        By what they are of: numbers, or ratios where nothing sets the scale.
    """
    order = np.argsort(line[:, 0])
    along = [
        Curve("k/s, s × lengths", line_r2[order], stroke=stroke(0)),
        Curve("k alone", np.maximum(alone_r2, LEAST_R2)[order], stroke=stroke(1, 1)),
    ]
    panels = [
        Curves("R² of bin means along the scale", "-", along, over=Course("k", "N/m", line[order, 0]), words=ALONG)
    ]
    curves = []
    for k, (name, p) in enumerate(profiles.items()):
        low = p.rise <= RISE
        if np.count_nonzero(low) > 1 and p.best != 0.0:
            curves.append(Points(name, p.values[low] / p.best, p.rise[low], stroke(k % 4, k), joined=True))
    if curves:
        ends = np.concatenate([each.time for each in curves])
        over = Course("over the best value", "-", np.array([ends.min(), ends.max()]))
        limit = [Limit("end of the 95 % interval", 1.0)]
        title = "Rise of the profile over the cut at 95 %"
        panels.append(Curves(title, "-", [], points=curves, limits=limit, over=over, words=PROFILES))
    return CurveSheet(panels)


def residual_curves(
    beta: Float[np.ndarray, " b"], residual: Float[np.ndarray, " b"], standard: Float[np.ndarray, " b"], test: str
) -> CurveSheet:
    """Residuals of bins over the angle, and in their SD: histogram, quantiles with the words of the `test`."""
    panels = [
        Curves(
            "Residual force: measured less fitted mean of each bin",
            "N",
            [],
            points=[Points("residual", np.degrees(beta), residual, stroke(0))],
            over=_angles(np.array([beta.min(), beta.max()])),
        )
    ]
    mean, sd = float(standard.mean()), float(standard.std(ddof=1))
    if not sd > 0.0:
        return CurveSheet(panels)
    edges = np.histogram_bin_edges(standard, "scott")
    density = np.histogram(standard, edges, density=True)[0]
    x = np.linspace(min(edges[0], mean - 3.5 * sd), max(edges[-1], mean + 3.5 * sd), DENSE)
    inside = np.clip(np.searchsorted(edges, x, side="right") - 1, 0, len(density) - 1)
    steps = np.where((x >= edges[0]) & (x <= edges[-1]), density[inside], 0.0)
    normal = np.exp(-0.5 * ((x - mean) / sd) ** 2) / (sd * np.sqrt(2.0 * np.pi))
    shapes = [
        Curve(f"residuals (n = {len(standard)})", steps, stroke=stroke(0)),
        Curve("normal, same mean and SD", normal, stroke=INK),
    ]
    panels.append(
        Curves("Density of the residuals over their SD", "-", shapes, over=Course("residual over its SD", "-", x))
    )
    q = normal_quantiles(standard)
    line = Curve("mean + SD × quantile, 95 % band", q.mean + q.sd * q.theoretical, q.lower, q.upper, INK)
    dots = Points("residuals", q.theoretical, q.ordered, stroke(0))
    over = Course("standard normal quantile", "-", q.theoretical)
    panels.append(Curves("Residual over its SD by normal quantiles", "-", [line], points=[dots], over=over, words=test))
    return CurveSheet(panels, columns=3)


def condition_curves(locked: BinMeans, recorded: RecordedStroke, locked_boxes: Boxes, free_boxes: Boxes) -> CurveSheet:
    """Over the angle, with the joint locked and free: mean force, displacement of the free joint, spread of samples."""
    free = recorded.curve
    stops = [
        Shade(f"{stop.side} end of the stroke", float(np.degrees(stop.first)), float(np.degrees(stop.last)))
        for stop in recorded.stops
    ]
    every = np.concatenate([locked.beta, free.beta])
    over = _angles(np.array([every.min(), every.max()]))
    means = [
        Points(name, np.degrees(each.beta), each.force, own)
        for name, each, own in (("joint locked", locked, LOCKED), ("joint free", free, FREE))
    ]
    slides = [Points("joint free", np.degrees(free.beta), 1e3 * free.joint, FREE)]
    both = np.unique(np.concatenate([locked_boxes.centre, free_boxes.centre]))
    spreads = [
        _range(f"joint {name}", boxes, both, own)
        for name, boxes, own in (("locked", locked_boxes, LOCKED), ("free", free_boxes, FREE))
    ]
    panels = [
        Curves("Mean force, joint locked and free", "N", [], points=means, spans=stops, over=over, words=STOPS),
        Curves("Displacement of the free joint", "mm", [], points=slides, spans=stops, over=over),
        Curves("Spread of the samples, joint locked and free", "N", spreads, over=_angles(both), words=ONE_BAND),
    ]
    return CurveSheet(panels, columns=1)


def _range(name: str, boxes: Boxes, at: Float[np.ndarray, " m"], own: int) -> Curve:
    """Median and 5 to 95 % of the samples at other angles [rad], linear between bins."""
    least, _, middle, _, most = (np.interp(at, boxes.centre, column, np.nan, np.nan) for column in boxes.quantiles.T)
    return Curve(name, middle, least, most, own)


STOPS = "Shaded: the joint stands at an end of its stroke, and force builds up."
