"""A walk of exact markers and made-up plates: the person of the first synthetic trial, far above the floor."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.evaluation import PlateStance
from geocontact.below_knee_prosthesis.from_markers import hip_by_regression
from geocontact.below_knee_prosthesis.leg import Leg
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY, RECORDED, recorded_tree
from geocontact.data.multibody.markers import MarkerTrajectories
from meshes.gait_persons import PARTICIPANTS, SPINES, true_leg
from tests.below_knee_prosthesis.from_markers.test_standing_and_walking import BELOW, seen

TIME = np.arange(0.0, 1.2, 0.02)
FULCRUM = 0.1174
HIGH = 2.0
"""m, of the pelvis: a foot that never reaches the floor has no clock to be compared with."""


def a_walker() -> Leg:
    """With the hip where the regression puts it, and the markers of a standing trial."""
    spines = {name: np.array(place) for name, place in SPINES.items()}
    return replace(true_leg(PARTICIPANTS[0], BELOW), hip=hip_by_regression(spines))


def standing_markers(leg: Leg) -> MarkerTrajectories:
    """Upright with the sole on the floor."""
    values = np.zeros((1, len(RECORDED)))
    values[0, RECORDED.index("pelvis_ty")] = BELOW - (leg.keel[1] - leg.thigh + leg.hip[1])
    return seen(leg, values, np.zeros(1))


def walking_values() -> np.ndarray:
    """Coordinates at `TIME`: waves, and 1.2 m/s forwards."""
    found = np.column_stack([0.1 * np.sin(4.0 * TIME + k) for k in range(len(RECORDED))])
    found[:, RECORDED.index("pelvis_tx")] += 1.2 * TIME
    found[:, RECORDED.index("pelvis_ty")] += HIGH
    return found


def keel_of(leg: Leg, values: np.ndarray) -> RigidTransform:
    """Poses of the keel's frame."""
    return recorded_tree(leg).poses(values)["shank"] * RigidTransform.from_components(leg.keel, leg.turn)


def plate(leg: Leg, begins: float, ends: float, centre: np.ndarray | None = None) -> PlateStance:
    """Loaded with the person's weight between two times [s]."""
    force = np.zeros((len(TIME), 3))
    force[(begins - 1e-9 < TIME) & (ends + 1e-9 > TIME), 1] = leg.person.mass * GRAVITY
    place = np.zeros((len(TIME), 3)) if centre is None else centre
    return PlateStance(TIME, force, np.where(force[:, 1:2] > 0.0, place, np.nan), "left", "plates.mot")
