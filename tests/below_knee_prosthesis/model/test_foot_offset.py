"""A foot beside its standing trial, by matrices alone."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance
from geocontact.below_knee_prosthesis.leg import AS_STOOD, FootOffset
from tests.below_knee_prosthesis.model.legs import a_leg
from tests.below_knee_prosthesis.socket_markers import shift, turn

OFFSET = FootOffset(0.8e-3, np.radians(0.57), 0.1e-3, np.radians(0.1))


def test_a_foot_is_raised_and_turned_about_the_middle_of_its_keel() -> None:
    """X_SK of the moved foot is X_SK T(0, h, 0) T(m) R T(-m), m 0.11 m along the keel; all else of the leg stays."""
    leg = a_leg()
    moved = leg.with_foot(OFFSET)
    middle, before = np.array([0.11, 0.0, 0.0]), np.eye(4)
    before[:3, :3] = leg.turn.as_matrix()
    wanted = shift(leg.keel) @ before @ shift(np.array([0.0, 0.8e-3, 0.0]))
    wanted = wanted @ shift(middle) @ turn("z", np.radians(0.57)) @ shift(-middle)
    np.testing.assert_allclose(moved.turn.as_matrix(), wanted[:3, :3], atol=1e-14)
    np.testing.assert_allclose(moved.keel, wanted[:3, 3], atol=1e-14)
    np.testing.assert_allclose([*moved.ankle, moved.thigh], [*leg.ankle, leg.thigh])
    toe, straight = (each.keel + each.turn.apply([0.229, 0.0, 0.0]) for each in (moved, leg))
    assert (toe - straight)[1] == pytest.approx(0.8e-3 + 0.119 * np.sin(np.radians(0.57)), abs=2e-5)  # the toes are up


def test_nothing_beside_the_standing_trial_changes_nothing_and_no_foot_is_moved_twice() -> None:
    leg = a_leg()
    assert not AS_STOOD.given and OFFSET.given
    np.testing.assert_array_equal(leg.with_foot(AS_STOOD).keel, leg.keel)
    with pytest.raises(ValueError, match="already"):
        leg.with_foot(OFFSET).with_foot(OFFSET)


def test_a_flat_foot_is_moved_as_a_calibration_moves_its_stance() -> None:
    """What `calibrate` finds of poses in the laboratory is what the leg takes over."""
    leg, n = a_leg(), 3
    socket = RigidTransform.from_components(np.array([0.2, 0.5, 0.1]), leg.turn.inv())  # the keel is level
    poses = socket * RigidTransform.from_components(leg.keel, leg.turn)
    repeated = RigidTransform.from_components(np.tile(poses.translation, (n, 1)), Rotation.identity(n))
    blank = np.zeros((n, 4, 4)), 0.1, np.zeros((n, 3)), np.zeros(n), 700.0
    seen = RecordedStance(np.arange(n) * 0.01, repeated, *blank).moved(OFFSET.height, OFFSET.pitch).poses[0]
    moved = leg.with_foot(OFFSET)
    taken = socket * RigidTransform.from_components(moved.keel, moved.turn)
    np.testing.assert_allclose(taken.as_matrix(), seen.as_matrix(), atol=1e-12)


def test_numbers_tell_it() -> None:
    rows = a_leg().with_foot(OFFSET).numbers()
    assert [rows[f"foot_{name}"].value for name in ("height", "height_sd", "pitch", "pitch_sd")] == [
        OFFSET.height,
        OFFSET.height_sd,
        OFFSET.pitch,
        OFFSET.pitch_sd,
    ]
    assert "leg keel" in rows["foot_pitch"].note and a_leg().numbers()["foot_pitch"].value == 0.0
