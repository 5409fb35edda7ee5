"""The pages of the elbow: recordings that were made, numbers that were identified, a model beside a measurement."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.page_words import NOT_A_DEVICE
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.view.page.content import Curve, Curves, Page, Picture, Readout, Row, Section, Table, Words
from geocontact.view.page.write import write_page

FRAMES = 601  # samples that a page shows at most
SURFACES = (
    "Displacement of the attachment along the limb over the angle and one offset, the other being 0; blue and red are "
    "its two directions. Offsets may have either sign."
)
SYNTHETIC = "These recordings are synthetic: the explicit model with the numbers below, and noise. Nobody was measured."
LAW = (
    "One rigid link, one spring along the limb, both axes fixed: no friction, no slip of the cuff, no give of the "
    "upper arm's fixation, no axis that wanders. What differs between donnings is in the residuals, and intervals by "
    "stretches of time do not hold it: look at the trials that were not used."
)
TOLD = (
    "Left: the direction in the logarithms of k and the lengths that the recordings tell least; (−1, 1, 1, 1, 1) is "
    "the scale. Middle: R² along k/s, s × lengths, where it does not change, and where k changes alone. Right: how far "
    "the sum of squares rises when a number is held beside its best value; an interval of 95 % ends at 1. Where "
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
COMPARED = "Means over bins of the angle: measured as marks, the model as lines, a colour per trial."


def write_simulation_report(
    path: Path, made: Sequence[ElbowRecording], drawing: bytes, tables: Sequence[Table], warnings: Sequence[str]
) -> int:
    """Write the page of a simulation, its first trial over time; returns its size in bytes."""
    first = made[0]
    every = -(-len(first.time) // FRAMES)
    shown = slice(None, None, every)
    degrees, force = np.degrees(first.beta[shown]), first.force[shown]
    rows = [Row("angle", "deg", [f"{v:.1f}" for v in degrees]), Row("force", "N", [f"{v:.2f}" for v in force])]
    sections: list[Section] = [
        Readout(rows),
        Curves(f"Angle, {first.name} (synthetic)", "deg", [Curve("beta", degrees)]),
        Curves(f"Constraint force, {first.name} (synthetic)", "N", [Curve("force", force)]),
        *_free_trial(made),
        Words("What this is", [SYNTHETIC]),
        Picture("Displacement over angle and offset", SURFACES, drawing, wide=True),
        *tables,
        Words("What the numbers do not contain", [LAW, NOT_A_DEVICE]),
    ]
    headline = [(r.name, f"{r.force.min():.1f} … {r.force.max():.1f} N") for r in made]
    return _written(path, "Synthetic recordings of an elbow exoskeleton", "Explicit model of constraint forces",
                    first.time[shown], "time [s]", headline, sections, warnings)  # fmt: skip


def _free_trial(made: Sequence[ElbowRecording]) -> list[Section]:
    """Force and displacement of the first trial with a free joint, over its time; none without."""
    for r in made:
        if r.displacement is not None and r is not made[0] and len(r.time) == len(made[0].time):
            every = slice(None, None, -(-len(r.time) // FRAMES))
            return [
                Curves(f"Constraint force, {r.name} (synthetic)", "N", [Curve("force", r.force[every])]),
                Curves(f"Displacement of the joint, {r.name} (synthetic)", "mm",
                       [Curve("displacement", r.displacement[every] * 1e3)]),
            ]  # fmt: skip
    return []


def write_fit_report(
    path: Path,
    title: str,
    beta: Float[np.ndarray, " b"],
    measured: Float[np.ndarray, " b"],
    fitted: Float[np.ndarray, " b"],
    headline: Sequence[tuple[str, str]],
    told: Sequence[str],
    drawings: Sequence[tuple[str, str, bytes]],
    tables: Sequence[Table],
    warnings: Sequence[str],
) -> int:
    """Write the page of an identification over the angle [rad]; returns its size in bytes.

    Parameters
    ----------
    measured, fitted
        Force of each bin [N].
    told
        Sentences on what the data tell and what they do not.
    drawings
        Title, words and SVG of each figure.
    """
    rows = [
        Row("measured", "N", [f"{v:.2f}" for v in measured]),
        Row("by the model", "N", [f"{v:.2f}" for v in fitted]),
    ]
    curves = [Curve("measured", measured), Curve("by the model", fitted)]
    sections: list[Section] = [
        Readout(rows, "This bin"),
        Curves("Constraint force", "N", curves),
        Words("What the data tell", list(told)),
        *(Picture(name, words, svg, wide=True) for name, words, svg in drawings),
        *tables,
        Words("What the numbers do not contain", [LAW, NOT_A_DEVICE]),
    ]
    return _written(path, title, "Constraint force of a misaligned elbow exoskeleton by the explicit model",
                    np.degrees(beta), "angle [deg]", headline, sections, warnings)  # fmt: skip


def write_comparison_report(
    path: Path,
    title: str,
    time: Float[np.ndarray, " t"],
    measured: Float[np.ndarray, " t"],
    model: Float[np.ndarray, " t"],
    headline: Sequence[tuple[str, str]],
    drawings: Sequence[tuple[str, bytes]],
    tables: Sequence[Table],
    warnings: Sequence[str],
) -> int:
    """Write the page of a comparison, the first trial's force over time; returns its size in bytes."""
    shown = slice(None, None, -(-len(time) // FRAMES))
    curves = [Curve("measured", measured[shown]), Curve("model", model[shown])]
    rows = [Row(c.name, "N", [f"{v:.2f}" for v in c.values]) for c in curves]
    sections: list[Section] = [
        Readout(rows),
        Curves("Constraint force of the first trial", "N", curves),
        *(Picture(name, COMPARED, svg, wide=True) for name, svg in drawings),
        *tables,
        Words("What the numbers do not contain", [LAW, NOT_A_DEVICE]),
    ]
    return _written(path, title, "Model and measurement of an elbow exoskeleton", time[shown], "time [s]", headline,
                    sections, warnings)  # fmt: skip


def _written(
    path: Path,
    title: str,
    subtitle: str,
    time: Float[np.ndarray, " t"],
    label: str,
    headline: Sequence[tuple[str, str]],
    sections: list[Section],
    warnings: Sequence[str],
) -> int:
    if warnings:
        sections.append(Words("Reservations of this run", list(warnings)))
    return write_page(Page(title, subtitle, time, label, headline, 0, tuple(sections)), path)
