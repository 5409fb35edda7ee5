"""What is shown of an identification: forces over the angle, what the data tell, residuals, the arm as it is drawn,
page.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import spelled
from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import counted
from geocontact.analyses.misalignment.identify.fitted import Fitted, Free
from geocontact.analyses.misalignment.identify.sentences import answer, explained
from geocontact.analyses.misalignment.page import ANGLE, CONSTRAINT, NOT_IN_THE_NUMBERS, elbow_page
from geocontact.axis_misalignment.compensation import BinMeans, RecordedStroke
from geocontact.axis_misalignment.explicit import displacement
from geocontact.axis_misalignment.law import offsets_of
from geocontact.axis_misalignment.uncertainty import Direction
from geocontact.identify.intervals.profile_likelihood import Profile
from geocontact.view.curves.quantity import Quantity
from geocontact.view.curves.residuals import residual_histogram, residual_quantiles
from geocontact.view.curves.style import BLACK, DOUBLE, GREY, LINES, MARKERS, PALETTE, SMALL, in_style, legend, panels
from geocontact.view.page.content import Curve, Curves, Length, Mark, Page, Picture, Plan, Section, Track, Words
from geocontact.view.page.tables import frame_table

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.figure import Figure


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
    right.set_title("samples: 5, 25, 50, 75, 95 %", fontsize=SMALL)
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
    """Draw the least identified direction (a), R² along the scale line and along k alone (b), profiles (c).

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
    bars.set_xticks(range(len(directions.names)), list(directions.names))
    bars.axhline(0.0, color=GREY, lw=0.6)
    bars.set_ylabel("least known direction, in logarithms")
    ratio = directions.singular_values[-1] / directions.singular_values[0]
    bars.set_title(f"singular value {ratio:.0e} of the largest", fontsize=SMALL)
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
            drawn = shape.plot(p.values / p.best, p.rise, color=PALETTE[k % len(PALETTE)], ls=LINES[k % len(LINES)])  # noqa: PD011
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
    spread.set_title("samples: 5, 25, 50, 75, 95 %", fontsize=SMALL)
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
            fontsize=SMALL,
        )
    below.set_xlabel(ANGLE)
    below.set_ylabel("displacement of the joint [mm]")
    return figure


WORDS = (
    "To scale, in the plane of the motion, at the middle of the angles that were reached: grey, the upper arm from the "
    "left and the forearm. The exoskeleton's axis lies x and y off the joint's; its link l reaches the attachment, "
    "which is z away from the forearm's line."
)
ARM = 0.7, 1.25
"""How long the upper arm is drawn over the link, and the forearm over its length to the attachment."""


def arm_drawing(found: Fitted, beta: Float[np.ndarray, " b"]) -> Plan:
    """Arm and exoskeleton at the middle one of the angles `beta` [rad], and the way of the attachment along them.

    Lengths are in mm, or in l where nothing sets their scale.
    """
    o = offsets_of(found.estimate.theta)
    free = found.estimate.problem.scale_free
    unit, per = ("l", 1.0 / o.l) if free else ("mm", 1e3)
    l, z, x, y = (per * each for each in (o.l, o.z, o.x, o.y))
    attached = np.column_stack([y + l * np.cos(beta), l * np.sin(beta) - x])  # the limb's direction to the right
    middle = len(beta) // 2
    alpha = float(displacement(beta[middle : middle + 1], o).alpha[0])
    forearm = np.array([np.cos(alpha), np.sin(alpha)])
    joint, axis, end = np.zeros(2), np.array([y, -x]), attached[middle]
    cuff = end + z * np.array([-forearm[1], forearm[0]])
    told = {"l": "1, the unit"} if free else {}
    told |= {each.words.removesuffix("/l"): each.shown for each in found.intervals}
    ends = {"x": (np.array([y, 0.0]), axis), "y": (joint, np.array([y, 0.0])), "l": (axis, end), "z": (end, cuff)}
    sizes = {"x": x, "y": y, "l": l, "z": z}
    return Plan(
        "Exoskeleton and arm",
        unit,
        "y, along the upper arm",
        "−x",
        lines=[np.array([[-ARM[0] * l, 0.0], joint]), np.array([joint, ARM[1] * float(np.hypot(*end)) * forearm])],
        tracks=[Track("way of the attachment", attached)],
        marks=[Mark("joint", (0.0, 0.0)), Mark("exoskeleton's axis", (float(axis[0]), float(axis[1])))],
        lengths=[
            Length(
                name,
                told.get(name) or _given(sizes[name], unit),
                (float(a[0]), float(a[1])),
                (float(b[0]), float(b[1])),
            )
            for name, (a, b) in ends.items()
            if sizes[name] != 0.0
        ],
        words=WORDS,
    )


def _given(size: float, unit: str) -> str:
    return f"{size:.4g} {unit} (given)"


Entries = list[tuple["Artist | tuple[Artist, ...]", str]]
TOLD = (
    "Left: the direction in the logarithms of k and the lengths that is identified least; (−1, 1, 1, 1, 1) is "
    "the scale. Middle: R² along k/s, s × lengths, where it does not change, and where k changes alone. Right: how far "
    "the sum of squares rises when a number is held away from its best value; an interval of 95 % ends at 1. Where "
    "nothing sets the scale these are the ratios that no scale changes."
)
FORCES = "Left: bin means of every trial and the explicit model. Right: spread of the samples in wider bins."
RESIDUALS = (
    "Measured less fitted mean force of each bin, all trials together: over the angle; over the standard deviation of "
    "the bin's mean as histogram and quantiles, with the p of Lilliefors' test."
)
CONDITIONS = (
    "Force with the compensation joint locked and free, the free joint's displacement, and the spread of both forces "
    "in wider bins, side by side. Shaded: the joint stands at an end of its stroke, and force builds up."
)
PICTURES = {
    "forces": ("Force over the angle", FORCES),
    "identifiability": ("What the recordings separate", TOLD),
    "residuals": ("Residuals", RESIDUALS),
    "conditions": ("Joint locked and free", CONDITIONS),
}
"""Title and words of each figure."""


def fit_page(
    found: Fitted,
    free: Free | None,
    tables: Mapping[str, pd.DataFrame],
    drawings: Mapping[str, bytes],
) -> Page:
    """The page of an identification over the angle.

    Parameters
    ----------
    tables
        By name, as they are written.
    drawings
        SVG of each figure, by the names of `PICTURES`.
    """
    bins = tables["bins"].dropna(subset="mean [N]")
    force = {"measured": bins["mean [N]"].to_numpy(), "by the model": bins["fitted [N]"].to_numpy()}
    angle = bins["beta [deg]"].to_numpy()
    sections: list[Section] = [
        arm_drawing(found, np.radians(angle)),
        Curves("Constraint force", "N", [Curve(name, values) for name, values in force.items()]),
        Words("What the data identify", [spelled(line) for line in explained(found, free)]),
        *(Picture(*PICTURES[name], svg, wide=True) for name, svg in drawings.items()),
        frame_table("What was identified", tables["intervals"].dropna(axis="columns", how="all")),
        frame_table("Force that was not used", tables["held_out"]),
        frame_table("Along the scale: numbers that give the same force", tables["scale_line"].iloc[::5]),
        INPUTS,
        OPTIONS,
        NOT_IN_THE_NUMBERS,
    ]
    title = f"Offsets and stiffness at an elbow from {counted(len(found.recordings), 'recording')}"
    subtitle = "Constraint force of a misaligned elbow exoskeleton by the explicit model"
    facts = [("R² of bin means", f"{found.r2:.3f}")]
    if found.held:
        facts.append(("R² of trials not used", f"{min(each.r2 for each in found.held):.3f} at least"))
    return elbow_page(
        title, subtitle, angle, "angle [deg]", answer(found), facts, sections, start_frame=len(angle) // 2
    )
