"""Predictions beside recordings: the nearest trial, found by its postures; the shipped one is beside its prediction."""

from __future__ import annotations

import numpy as np

from geocontact.standing_up.trials import StandingTrial
from geocontact.standing_up.trivial_trials import nearest_trial


def test_nearest_trial_is_so_by_its_first_and_last_angles() -> None:
    """Wherever the foot stands, and whatever happens between."""

    def trial(name: str, foot: float, first: float, middle: float) -> StandingTrial:
        q = np.zeros((3, 4))
        q[:, 0], q[:, 3] = foot, (first, middle, 0.0)
        return StandingTrial(np.arange(3.0), q, 0.0 * q, np.zeros((3, 2)), np.zeros(3), name)

    others = [trial("far", 0.0, 1.0, 0.5), trial("near", 5.0, 0.8, 9.0)]
    assert nearest_trial(others, trial("own", 0.0, 0.7, 0.5)).name == "near"
