"""The page of a joint: both segments as they move, and the residual between them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial.transform import RigidTransform

from geocontact.analyses.frame.pages import INPUTS, OPTIONS, thinned
from geocontact.analyses.frame.words import NOT_A_DEVICE, headline
from geocontact.analyses.motion.functional_joint.read import MovedPair, Segment
from geocontact.analyses.motion.skeleton import JOINT, MARKER, RAY, scene_over
from geocontact.data.motion import Course
from geocontact.dynamics.functional_joint import JointPoints
from geocontact.view.curves.declared import Curve, Curves, CurveSheet
from geocontact.view.page.content import Linkage, Page, Scene, Section, Words
from geocontact.view.page.scene import Tone

SKIN = (
    "Segments are taken to be rigid. Skin slides over bone by centimetres at the thigh, smoothly and alike in every "
    "repetition: neither the standard error nor the halves of the trial include this."
)


def joint_page(
    title: str,
    sentences: Sequence[str],
    facts: Sequence[tuple[str, str]],
    pair: MovedPair,
    points: JointPoints,
    apart: Float[np.ndarray, " t"],
) -> Page:
    """The page of a joint: its answer, numbers of it with their names, and the distance `apart` over time [mm]."""
    shown = thinned(len(pair.time), [apart])
    sections: list[Section] = [
        _picture(pair, points, shown),
        *joint_curves(pair, apart).at(shown),
        INPUTS,
        OPTIONS,
        Words("What the numbers do not contain", [SKIN, NOT_A_DEVICE]),
    ]
    return Page(
        title=title,
        subtitle=f"{', '.join(pair.first.names)} against {', '.join(pair.second.names)}",
        time=pair.time[shown],
        time_label="time [s]",
        headline=headline(sentences),
        facts=facts,
        sections=tuple(sections),
        numbers=shown + 1,
        total=len(pair.time),
    )


def joint_curves(pair: MovedPair, apart: Float[np.ndarray, " t"]) -> CurveSheet:
    """Distance between what both segments say, over time; `apart` is in mm."""
    panel = Curves("Distance between the joint of one segment and of the other", "mm", [Curve("apart", apart)])
    return CurveSheet([panel], Course("time", "s", pair.time))


def _picture(pair: MovedPair, points: JointPoints, shown: Int[np.ndarray, " k"]) -> Scene:
    none = np.zeros((0, 2), dtype=np.int64)
    line = np.array([[0, 1]], dtype=np.int64) if len(points.first) == 2 else none
    first = Linkage(
        "first segment", _moved(pair.first_poses[shown], pair.first.template), _rays(pair.first), "bone", MARKER, RAY
    )
    second = Linkage(
        "second segment",
        _moved(pair.second_poses[shown], pair.second.template),
        _rays(pair.second),
        "seen",
        MARKER,
        RAY,
    )
    linkages = [first, second]
    joints: tuple[tuple[str, RigidTransform, Float[np.ndarray, "m 3"], Tone], ...] = (
        ("first", pair.first_poses, points.first, "model"),
        ("second", pair.second_poses, points.second, "force"),
    )
    for name, poses, joint, tone in joints:
        linkages.append(Linkage(f"joint of the {name} segment", _moved(poses[shown], joint), line, tone, JOINT, RAY))
    places = pair.shown.positions[np.isfinite(pair.shown.positions).all(axis=2)]
    upright = np.eye(3)[int(np.argmax(np.ptp(places, axis=0)))]  # for the picture only: people are taller than wide
    return scene_over(upright, linkages)


def _moved(poses: RigidTransform, points: Float[np.ndarray, "m 3"]) -> Float[np.ndarray, "t m 3"]:
    return np.stack([poses.apply(point) for point in points], axis=1)


def _rays(segment: Segment) -> Int[np.ndarray, "k 2"]:
    """Lines from each marker to the next, around."""
    count = len(segment.names)
    return np.column_stack([np.arange(count), (np.arange(count) + 1) % count])
