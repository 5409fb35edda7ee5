"""The exoskeleton beside the arm, drawn to scale with what was identified."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.analyses.misalignment.identify.fitted import Fitted
from geocontact.axis_misalignment.explicit import displacement
from geocontact.axis_misalignment.law import offsets_of
from geocontact.view.page.content import Length, Mark, Plan, Track

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
