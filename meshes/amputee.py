"""A participant with both legs, and what cameras see of one who stands and who moves joint after joint.

The intact leg is invented like the prosthetic one (`persons`). Markers of its knee and ankle do not lie where the axes
are, as a hand puts them; those of the prosthetic side do.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from zlib import crc32

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from geocontact.below_knee_prosthesis.both_sides.amputee import Amputee
from geocontact.below_knee_prosthesis.both_sides.amputee_tree import amputee_tree
from geocontact.below_knee_prosthesis.both_sides.intact_leg import IntactLeg
from geocontact.below_knee_prosthesis.from_markers import BODIES, INTACT_BODIES
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.sole import numbers as sole_numbers
from geocontact.below_knee_prosthesis.leg import Person
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Marker, Multibody
from meshes.gait_persons import (
    ANKLE,
    HIP,
    KNEE_RADIUS,
    SHANK,
    THIGH,
    TOE_OUT,
    Walker,
    marker_places,
    true_leg,
)
from meshes.gait_trial import CAMERA_NOISE, STANDING_FRAMES, skin_error

ANKLE_RADIUS, FOOT = 0.036, 0.152
"""m; half the distance of the malleoli; length of the foot over the stature (Drillis & Contini 1966)."""
BACK, BALL, APART, KNUCKLE = 0.26, 0.73, 0.05, 0.035
"""Shares of the foot's length from heel to below the ankle and to the metatarsal heads; m, half their distance and
their height; invented."""
HAND = {
    "LKNE": (0.006, -0.003, 0.0),
    "LKNM": (0.002, 0.004, 0.0),
    "LANK": (0.003, -0.004, 0.0),
    "LANM": (0.0, -0.003, 0.0),
}
"""m; by which markers of the intact knee and ankle lie beside the axes, in the segment's frame."""
FRAME_RATE, LASTING = 10.0, 8.0
"""Hz, and s that each joint is moved."""
DEFORMED = 0.3
"""Of the skin's error that differs from marker to marker of a segment; the rest moves them together."""
MOVES: tuple[tuple[dict[str, tuple[float, float, float]], str], ...] = (
    ({"hip_flexion": (20.0, 25.0, 0.0), "hip_adduction": (-15.0, 20.0, 0.25), "hip_rotation": (0.0, 15.0, 0.1)}, "_r"),
    ({"knee_flexion": (40.0, 32.0, 0.0), "hip_flexion": (25.0, 5.0, 0.3)}, "_r"),
    ({"hip_flexion": (20.0, 25.0, 0.0), "hip_adduction": (-15.0, 20.0, 0.25), "hip_rotation": (0.0, 15.0, 0.1)}, "_l"),
    ({"knee_flexion": (40.0, 32.0, 0.0), "hip_flexion": (25.0, 5.0, 0.3)}, "_l"),
    ({"ankle_flexion": (-5.0, 20.0, 0.0), "ankle_inversion": (0.0, 18.0, 0.25), "hip_flexion": (25.0, 3.0, 0.1)}, "_l"),
)
"""Mean, amplitude [deg] and phase of what moves, one after the other; sides as of a right prosthesis."""
STILL = {"pelvis_tilt": 7.0, "hip_flexion": -5.0, "knee_flexion": 2.0, "ankle_flexion": 0.0}
"""deg; while standing, until the feet are flat."""


@dataclass(frozen=True, eq=False)
class StandingTrials:
    """What cameras saw of a person, and who it was, as of a right prosthesis.

    Parameters
    ----------
    truth
        With markers where they lie.
    standing, functional
        In the laboratory: x forward, y up, z to the right.
    """

    truth: Amputee
    standing: MarkerTrajectories
    functional: MarkerTrajectories


def true_amputee(person: Walker, foot: VariableStiffnessFoot, fulcrum: float) -> Amputee:
    """Both legs as they are, with their markers."""
    own = true_leg(person, sole_numbers()["below"].value)
    places = marker_places(own, foot.keel.length)
    tracked = {body: {name: places[body][name] for name in names} for body, names in BODIES.items()}
    own = replace(own, markers=_markers(tracked))
    intact = true_intact(person, own.person)
    seen = intact_places(intact)
    kept = {body: {name: seen[body][name] for name in names} for body, names in INTACT_BODIES.items()}
    upright = Rotation.from_euler("z", -STILL["pelvis_tilt"], degrees=True)
    return Amputee(own, replace(intact, markers=_markers(kept)), person.stature, upright, foot, fulcrum)


def true_intact(person: Walker, of: Person) -> IntactLeg:
    """The intact leg as it is, which the markers only show."""
    long, high, foot = SHANK * person.stature, ANKLE * person.stature, FOOT * person.stature
    heel = np.array([-BACK * foot, 0.03 - high, 0.0])
    ball = np.array([heel[0] + BALL * foot, KNUCKLE - high, 0.0])
    skew = np.array([0.012, 0.0, APART])
    return IntactLeg(
        of,
        HIP * np.array([1.0, 1.0, -1.0]),
        THIGH * person.stature,
        np.array([0.0, -long, 0.0]),
        KNEE_RADIUS,
        ANKLE_RADIUS,
        heel,
        (ball + skew, ball - skew),
        np.array([heel[0] + foot, 0.02 - high, 0.5 * APART]),
        high,
    )


def intact_places(leg: IntactLeg) -> dict[str, dict[str, Float[np.ndarray, " 3"]]]:
    """Where markers are in the frames of thigh, shank, foot and toes [m]."""
    thigh, shank = leg.thigh, leg.shank
    rows: dict[str, dict[str, tuple[float, float, float] | Float[np.ndarray, " 3"]]] = {
        "intact_thigh": {
            "LTH1": (0.075, -0.35 * thigh, -0.03),
            "LTH2": (0.02, -0.5 * thigh, -0.08),
            "LTH3": (0.065, -0.68 * thigh, -0.03),
            "LKNE": (0.0, -thigh, -KNEE_RADIUS),
            "LKNM": (0.0, -thigh, KNEE_RADIUS),
        },
        "intact_shank": {
            "LSH1": (0.055, -0.25 * shank, -0.01),
            "LSH2": (0.01, -0.45 * shank, -0.055),
            "LSH3": (0.045, -0.7 * shank, -0.01),
            "LANK": (0.0, -shank, -ANKLE_RADIUS),
            "LANM": (0.0, -shank, ANKLE_RADIUS),
        },
        "intact_foot": dict(zip(("LHEE", "LMT1", "LMT5"), (leg.heel, *leg.metatarsals), strict=True)),
        "intact_toes": {"LHLX": leg.hallux - leg.toe_joint},
    }
    return {
        body: {name: np.array(place) + np.array(HAND.get(name, (0.0, 0.0, 0.0))) for name, place in of.items()}
        for body, of in rows.items()
    }


def standing_trials(
    person: Walker, foot: VariableStiffnessFoot, fulcrum: float, *, errors: float = 1.0
) -> StandingTrials:
    """Of one person; the same numbers every time. `errors` is a factor on those of skin and cameras."""
    rng = np.random.default_rng(crc32(f"{person.name} standing".encode()))
    truth = true_amputee(person, foot, fulcrum)
    return StandingTrials(truth, _standing(truth, errors, rng), _functional(truth, errors, rng))


def fully_marked(truth: Amputee) -> Amputee:
    """With the markers that only a standing trial needs as well."""
    places = marker_places(truth.prosthetic, truth.foot.keel.length) | intact_places(truth.intact)
    prosthetic = {body: places[body] for body in BODIES}
    others = {body: places[body] for body in INTACT_BODIES}
    return replace(
        truth,
        prosthetic=replace(truth.prosthetic, markers=_markers(prosthetic)),
        intact=replace(truth.intact, markers=_markers(others)),
    )


def _standing(truth: Amputee, errors: float, rng: np.random.Generator) -> MarkerTrajectories:
    """Upright, both soles on the floor, with the markers that only a standing trial has."""
    model = amputee_tree(fully_marked(truth), held=True)
    still = model.marker_places(standing_values(model))[0]
    time = np.arange(STANDING_FRAMES) / FRAME_RATE
    seen = still + errors * rng.normal(0.0, CAMERA_NOISE, (len(time), *still.shape))
    return MarkerTrajectories(time, seen, tuple(m.name for m in model.markers), "synthetic standing")


def standing_values(model: Multibody) -> Float[np.ndarray, "1 n"]:
    """Coordinates of a person who stands upright with both soles flat on the floor [rad, m]."""
    values = {name: np.radians(angle) for name, angle in STILL.items()}
    names = [c.name for c in model.coordinates]
    found = np.zeros((1, len(names)))
    for k, name in enumerate(names):
        found[0, k] = values.get(name.removesuffix("_r").removesuffix("_l"), 0.0)
    found[0, names.index("ankle_rotation_l")] = -TOE_OUT
    keel = model.poses(found)["calcn_r"].translation[0]
    found[0, names.index("pelvis_ty")] = sole_numbers()["below"].value - keel[1]
    return found


def _functional(truth: Amputee, errors: float, rng: np.random.Generator) -> MarkerTrajectories:
    """Standing on the other leg; each joint in turn."""
    model = amputee_tree(truth, held=True)
    names = [c.name for c in model.coordinates]
    count = round(LASTING * FRAME_RATE)
    time = np.arange(count * len(MOVES)) / FRAME_RATE
    values = np.repeat(standing_values(model), len(time), axis=0)
    for k, (moves, side) in enumerate(MOVES):
        frames = slice(k * count, (k + 1) * count)
        for name, (mean, amplitude, phase) in moves.items():
            turn = 2.0 * np.pi * (np.arange(count) / count + phase)
            values[frames, names.index(f"{name}{side}")] = np.radians(mean + amplitude * np.sin(turn))
    places = model.marker_places(values)
    step = 1.0 / FRAME_RATE
    own = BODIES | INTACT_BODIES
    for body, tracked in own.items():
        whole = skin_error(body, len(time), step, rng)
        for k, m in enumerate(model.markers):
            if m.name in tracked:
                places[:, k] += errors * (whole + DEFORMED * skin_error(body, len(time), step, rng))
    return MarkerTrajectories(time, places, tuple(m.name for m in model.markers), "synthetic functional")


def _markers(places: dict[str, dict[str, Float[np.ndarray, " 3"]]]) -> tuple[Marker, ...]:
    return tuple(Marker(name, body, place) for body, of in places.items() for name, place in of.items())
