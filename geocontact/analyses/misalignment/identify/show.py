"""What is shown of an identification: the arm as it is drawn, and the page."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import spelled
from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import counted
from geocontact.analyses.misalignment.identify.curves import direction_bars
from geocontact.analyses.misalignment.identify.fitted import Fitted, Free
from geocontact.analyses.misalignment.identify.sentences import answer, explained
from geocontact.analyses.misalignment.page import NOT_IN_THE_NUMBERS, elbow_page
from geocontact.axis_misalignment.explicit import displacement
from geocontact.axis_misalignment.law import offsets_of
from geocontact.view.curves.declared import CurveSheet
from geocontact.view.page.content import Length, Mark, Page, Plan, Section, Track, Words
from geocontact.view.page.tables import frame_table

WORDS = (
    "To scale, in the plane of the motion, at the middle of the angles that were reached: grey, the upper arm from the "
    "left and the forearm. The exoskeleton's axis lies x and y off the joint's; its link l reaches the attachment, "
    "which is z away from the forearm's line."
)
IDENTIFIED_BY = "What each set of sensors identifies"
OF_TASK = {
    "tracking": "Tracking error and force of each trial",
    "tracking_conditions": "Tracking error, scores and force by condition, mean and SD over trials",
    "performance": "What goes with force and pressure over trials",
}
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


def fit_page(
    found: Fitted,
    free: Free | None,
    tables: Mapping[str, pd.DataFrame],
    sheets: Mapping[str, CurveSheet],
) -> Page:
    """The page of an identification over the angle.

    Parameters
    ----------
    tables
        By name, as they are written.
    sheets
        Curves by the names of their figures, the force over the angle first.
    """
    angle = tables["bins"].dropna(subset="mean [N]")["beta [deg]"].to_numpy()
    sections: list[Section] = [
        arm_drawing(found, np.radians(angle)),
        *sheets["forces"].panels,
        Words("What the data identify", [spelled(line) for line in explained(found, free)]),
        *([frame_table(IDENTIFIED_BY, tables["identifiability"])] if "identifiability" in tables else []),
        *sheets.get("beside_force", CurveSheet([])).panels,
        *sheets.get("conditions", CurveSheet([])).panels,
        direction_bars(found.all_directions),
        *sheets["identifiability"].panels,
        *sheets["residuals"].panels,
        frame_table("What was identified", tables["intervals"].dropna(axis="columns", how="all")),
        frame_table("Force that was not used", tables["held_out"]),
        *(frame_table(title, tables[name]) for name, title in OF_TASK.items() if name in tables and len(tables[name])),
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
