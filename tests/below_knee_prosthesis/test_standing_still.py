"""Standing still: the foot flat on the floor at the start, whoever's leg it is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from geocontact.below_knee_prosthesis.leg_tree import recorded_tree
from geocontact.below_knee_prosthesis.standing_still import standing_motion
from tests.below_knee_prosthesis.model.legs import a_leg


@pytest.mark.parametrize("tilted", [0.0, 7.0, -4.0])
def test_the_sole_is_level_and_on_the_floor(tilted: float) -> None:
    """Also where the shank leaned while the person stood: the keel is turned on it."""
    leg, spheres = a_leg(), vsf_foot().sole.spheres
    leg = replace(leg, turn=leg.turn * Rotation.from_euler("z", tilted, degrees=True))
    motion = standing_motion(leg, spheres, 2.0)
    poses = recorded_tree(leg).poses(motion.values[:1])["shank"] * RigidTransform.from_components(leg.keel, leg.turn)
    heights = np.array([poses.apply(centre)[0, 1] for centre in spheres.centre]) - spheres.radius
    assert abs(poses.rotation.apply([1.0, 0.0, 0.0])[0, 1]) < 1e-12
    assert heights.min() == pytest.approx(0.0, abs=1e-12)
    assert np.ptp(motion.values, axis=0).max() == 0.0 and motion.time[-1] == 2.0
