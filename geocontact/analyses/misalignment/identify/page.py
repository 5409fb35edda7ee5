"""The page of an identification: numbers with their intervals, and what the data do not tell."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd

from geocontact.analyses.finished_page import INPUTS, OPTIONS
from geocontact.analyses.misalignment.identify.arm_drawing import arm_drawing
from geocontact.analyses.misalignment.identify.fitted import Fitted
from geocontact.analyses.misalignment.identify.free_joint import Free
from geocontact.analyses.misalignment.identify.sentences import answer, explained
from geocontact.analyses.misalignment.page import NOT_IN_THE_NUMBERS, elbow_page
from geocontact.analyses.page_words import counted
from geocontact.analyses.run_record import Record
from geocontact.view.page.content import Curve, Curves, Page, Picture, Section, Words
from geocontact.view.page.tables import frame_table

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
PICTURES = {
    "forces": ("Force over the angle", FORCES),
    "identifiability": ("What the recordings tell apart", TOLD),
    "residuals": ("Residuals", RESIDUALS),
    "conditions": ("Joint locked and free", CONDITIONS),
}
"""Title and words of each figure."""


def fit_page(
    record: Record,
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
        Words("What the data tell", [record.spell(line) for line in explained(found, free)]),
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
        title, subtitle, angle, "angle [deg]", answer(found), facts, sections, record, start_frame=len(angle) // 2
    )
