"""Ankle moment by a plate, predictors without a model, and what counts as an outlier."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.evaluation import (
    ANOTHER,
    MEAN,
    MeasuredCurve,
    PlateStance,
    plate_ankle_moment,
    trivial_curves,
)
from geocontact.below_knee_prosthesis.leg_tree import recorded_tree
from geocontact.below_knee_prosthesis.outliers import oddness
from tests.below_knee_prosthesis.model.legs import a_leg, a_motion


def test_ankle_moment_is_arm_times_force_in_the_foots_own_plane() -> None:
    leg = a_leg()
    motion = a_motion(leg)
    shank = recorded_tree(leg).poses(motion.values)["shank"]
    keel = shank * RigidTransform.from_components(leg.keel, leg.turn)
    arm, along, across = 0.09, 500.0, 80.0
    centre = shank.apply(leg.ankle) + keel.rotation.apply([arm, -0.05, 0.0])
    force = keel.rotation.apply([0.0, along, across])  # a force across the plane has no moment in it
    centre[::7] = np.nan
    found = plate_ankle_moment(PlateStance(motion.time, force, centre), motion)
    wanted = np.full(len(found), arm * along)
    wanted[::7] = 0.0
    np.testing.assert_allclose(found, wanted, atol=1e-9)


def test_the_studys_rule_is_silent_for_few_trials_and_the_median_is_not() -> None:
    """One error of n that differs is (n - 1)/sqrt(n) standard deviations beyond the mean, whatever it is."""
    for n in (8, 10, 12):
        errors = {f"trial {k}": 0.05 + 1e-3 * k for k in range(n - 1)} | {"odd": 50.0}
        found = oddness(errors)
        assert found["odd"].by_study == pytest.approx((n - 1) / np.sqrt(n), rel=1e-4)
        assert (found["odd"].by_study > 3.0) == (n > 10)
        assert found["odd"].outlier and not any(found[name].outlier for name in errors if name != "odd")


def test_predictors_without_a_model_know_nothing_of_the_trial_itself() -> None:
    rows = (("a", "P", "low", 1.0), ("b", "P", "low", 2.0), ("c", "P", "high", 6.0), ("d", "Q", "low", 9.0))
    stances = [MeasuredCurve(*of, np.full(3, value)) for *of, value in rows]
    told = trivial_curves(stances, stances[0])
    np.testing.assert_allclose(told[MEAN], 4.0)  # of b and c: d is another person
    np.testing.assert_allclose(told[ANOTHER], 6.0)
    alone = trivial_curves(stances, stances[3])
    np.testing.assert_allclose(alone[MEAN], 3.0)
    assert ANOTHER not in alone
