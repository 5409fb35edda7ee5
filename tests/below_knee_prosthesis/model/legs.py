"""A leg of a person of 77 kg, and an invented motion of it."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from geocontact.below_knee_prosthesis.leg import Leg, Person
from geocontact.below_knee_prosthesis.leg_tree import RECORDED, LegMotion


def a_leg(mass: float = 77.3) -> Leg:
    turn = Rotation.from_euler("xyz", [0.02, 0.1, -0.03])
    ankle = np.array([0.0, -0.42, 0.01])
    return Leg(Person(mass), np.array([-0.04, -0.08, 0.09]), 0.43, ankle, 0.055, np.array([-0.06, -0.45, 0.005]), turn)


def a_motion(leg: Leg) -> LegMotion:
    time = np.arange(0.0, 0.4, 0.01)
    rng = np.random.default_rng(3)
    waves = [
        a * np.sin(w * time + f)
        for a, w, f in zip(rng.uniform(0.05, 0.4, 10), rng.uniform(2, 8, 10), range(10), strict=True)
    ]
    values = np.column_stack(waves)
    values[:, RECORDED.index("pelvis_ty")] += 0.95
    return LegMotion(leg, time, values)
