"""The four participants of the study, as far as its table 1 tells, and what was invented for them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from geocontact.below_knee_prosthesis.leg import Leg, Person, Side
from geocontact.data.body_segments import Sex, body_segments

STANCE = {"low": 0.68, "medium": 0.72, "high": 0.71}
"""s; means of the study by setting, sec. 4."""
SPEED = 1.2
"""m/s; of the study."""
THIGH, SHANK, ANKLE = 0.245, 0.246, 0.039
"""Lengths and the ankle's height over the stature (Drillis & Contini 1966, Body segment parameters)."""
HIP = np.array([-0.050, -0.082, 0.086])
"""In the pelvis' frame [m]; invented, some millimetres beside the regression."""
SPINES = {
    "RASI": (0.0, 0.0, 0.125),
    "LASI": (0.0, 0.0, -0.125),
    "RPSI": (-0.155, 0.0, 0.045),
    "LPSI": (-0.155, 0.0, -0.045),
}
"""In the pelvis' frame [m]; invented."""
KNEE_RADIUS, TOE_OUT, HEEL = 0.052, np.radians(6.0), 0.065
"""m, rad; half the distance of the epicondyles, turn of the foot, from the keel's end to below the ankle; invented."""


@dataclass(frozen=True)
class Walker:
    """One row of table 1."""

    name: str
    mass: float
    stature: float
    side: Side
    sex: Sex


PARTICIPANTS = (
    Walker("P1", 77.3, 1.81, "right", "male"),
    Walker("P2", 111.0, 1.75, "right", "male"),
    Walker("P3", 83.8, 1.80, "left", "male"),
    Walker("P4", 63.8, 1.63, "right", "female"),
)


def true_leg(person: Walker, below: float) -> Leg:
    """The leg as it is, which the markers only show; a left one as its mirror image.

    `below` is the height of the keel's axis above the sole [m].
    """
    long, high = SHANK * person.stature, ANKLE * person.stature
    turn = Rotation.from_euler("y", -TOE_OUT)
    ankle = np.array([0.0, -long, 0.0])
    keel = ankle + turn.apply([-HEEL, below - high, 0.0])
    return Leg(
        Person(person.mass, body_segments(person.sex)), HIP, THIGH * person.stature, ankle, KNEE_RADIUS, keel, turn
    )


def marker_places(leg: Leg, keel_length: float) -> dict[str, dict[str, Float[np.ndarray, " 3"]]]:
    """Where markers are in the frames of pelvis, thigh and shank [m]; the socket's are given in the shank's."""
    thigh, shank = leg.thigh, leg.shank
    toe = leg.keel + leg.turn.apply([keel_length, 0.0, 0.0])
    around = {"RSO1": (0.06, -0.12, 0.01), "RSO2": (0.01, -0.14, 0.062), "RSO3": (0.045, -0.62 * shank, 0.03)}
    rows = {
        "pelvis": SPINES,
        "thigh": {
            "RTH1": (0.075, -0.35 * thigh, 0.03),
            "RTH2": (0.02, -0.5 * thigh, 0.08),
            "RTH3": (0.065, -0.68 * thigh, 0.03),
            "RKNE": (0.0, -thigh, KNEE_RADIUS),
            "RKNM": (0.0, -thigh, -KNEE_RADIUS),
        },
        "shank": around
        | {
            "RANK": (0.0, -shank, 0.035),
            "RANM": (0.0, -shank, -0.035),
            "RHEE": tuple(leg.keel),
            "RTOE": tuple(toe),
        },
    }
    return {body: {name: np.array(place) for name, place in of.items()} for body, of in rows.items()}
