"""What is shown of a walk of both legs: the moving skeleton, forces beside the plates, joint moments."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import NOT_A_DEVICE, headline
from geocontact.analyses.motion.skeleton import scene_of, skeleton
from geocontact.below_knee_prosthesis.evaluation import PlateStance, at_times
from geocontact.data.motion import Course
from geocontact.data.multibody.model import Multibody
from geocontact.view.curves.declared import INK, Curve, Curves, CurveSheet
from geocontact.view.page.content import Page, Section, Words
from geocontact.view.page.tables import frame_table

FRAMES = 120
"""Most frames of the moving skeleton."""
WORDS = [
    "Angles of hips, knees, intact ankle and toes are as recorded, filtered; the pelvis moves forward and up freely.",
    "Markers on the socket move with it against the limb: that motion is in the knee's angle and again in the bushing.",
    "Trunk, head and arms are one rigid body with the pelvis: what a trunk does otherwise is in the pelvis' residuals.",
    "The metabolic proxy is the joints' work, positive over 0.25, negative over 1.2 (Margaria 1968): no measurement.",
]


def walk_curves(
    time: Float[np.ndarray, " t"],
    force: Float[np.ndarray, "t 3"],
    plate: PlateStance,
    weight: float,
    moments: Mapping[str, Float[np.ndarray, " t"]],
) -> CurveSheet:
    """Force of the prosthetic foot beside its plate's, and moments of the joints that bend."""
    seen = at_times(time, plate.time, plate.force) / weight
    panels = [
        Curves(
            title, "BW", [Curve("simulated", force[:, k] / weight, stroke=0), Curve("plate", seen[:, k], stroke=INK)]
        )
        for title, k in (("Vertical force on the prosthesis", 1), ("Fore-aft force, forward positive", 0))
    ]
    for joint in ("hip_flexion", "knee_flexion", "ankle"):
        own = {name: column for name, column in moments.items() if name.startswith(joint)}
        panels.append(
            Curves(
                f"Moment: {joint.replace('_', ' ')}",
                "N m",
                [Curve(_beside(joint, name), column) for name, column in own.items()],
            )
        )
    return CurveSheet(panels, Course("time", "s", time))


def in_body_weight(errors: pd.DataFrame) -> pd.DataFrame:
    """Errors with the word for what their file has as a share of body weight, without a unit."""
    return errors.assign(unit=errors["unit"].replace("-", "BW"))


SIDES = {"r": "right", "l": "left"}


def spoken(name: str) -> str:
    """A coordinate in words: "hip_flexion_r" as "hip flexion, right"."""
    words, _, side = name.rpartition("_")
    return f"{words.replace('_', ' ')}, {SIDES[side]}" if side in SIDES else name.replace("_", " ")


def _beside(joint: str, name: str) -> str:
    """The same in a panel that names the joint: "right", "inversion, left"."""
    return spoken(name).removeprefix(joint.replace("_", " ")).lstrip(", ")


def walk_page(
    title: str,
    model: Multibody,
    values: Float[np.ndarray, "t n"],
    curves: CurveSheet,
    tables: Mapping[str, pd.DataFrame],
    sentences: Sequence[str],
) -> Page:
    """The moving skeleton, curves and tables; `values` are of the model's coordinates at the times of the curves."""
    if curves.over is None:  # `walk_curves` has a time
        raise ValueError("curves without a time")
    time = curves.over.values  # noqa: PD011 of a course
    shown = np.unique(np.linspace(0, len(time) - 1, min(FRAMES, len(time))).astype(int))
    sections: list[Section] = [
        scene_of(model, [skeleton(model, values[shown])]),
        *curves.at(shown),
        frame_table("Forces beside the plate", in_body_weight(tables["errors"]), 3),
        frame_table("Moments of the joints", tables["moments"], 3),
        frame_table("Work of the joints", tables["work"], 3),
        INPUTS,
        OPTIONS,
        Words("What the numbers do not contain", [*WORDS, NOT_A_DEVICE]),
    ]
    return Page(
        title=title,
        subtitle="Both legs of a person with a below-knee prosthesis, walking",
        time=np.round(time[shown], 4),  # steps of an integrator have digits without end
        time_label="time [s]",
        headline=headline(sentences, most=2),
        facts=[],
        sections=tuple(sections),
        numbers=shown + 1,
        total=len(time),
    )
