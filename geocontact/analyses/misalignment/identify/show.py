"""The page of an identification: the arm as it is drawn, force over the angle, what the data tell."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.finished_page import INPUTS, OPTIONS
from geocontact.analyses.misalignment.identify.fitted import Fitted
from geocontact.analyses.misalignment.identify.free_joint import Free
from geocontact.analyses.misalignment.identify.sentences import answer, explained
from geocontact.analyses.misalignment.page import NOT_IN_THE_NUMBERS, elbow_page
from geocontact.analyses.page_words import counted
from geocontact.analyses.run_record import Record
from geocontact.axis_misalignment.explicit import displacement
from geocontact.axis_misalignment.law import offsets_of
from geocontact.view.page.content import Curve, Curves, Length, Mark, Page, Picture, Plan, Section, Track, Words
from geocontact.view.page.tables import frame_table

if TYPE_CHECKING:
    from matplotlib.artist import Artist


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
