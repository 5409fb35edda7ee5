"""Pieces of a trial: those that thinning has marked, whatever its steps."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.data.motion import Signals
from geocontact.data.trial import Trial


def trial(time: np.ndarray, pieces: tuple[tuple[float, float], ...] = ()) -> Trial:
    return Trial("t", Signals(time, np.zeros((len(time), 1)), ("u",), ("rad",)), pieces=pieces)


@pytest.mark.parametrize(
    "time",
    [
        np.concatenate([0.001 * np.arange(600), 0.6 + 0.02 * np.arange(500)]),  # two rates
        np.delete(0.02 * np.arange(100), slice(30, 60)),
        np.cumsum(np.random.default_rng(0).exponential(0.01, 300)),
        np.zeros(1),
    ],
)
def test_a_trial_as_it_was_recorded_is_one(time: np.ndarray) -> None:
    """Uneven steps are no pauses: a recording is used as it is."""
    assert trial(time).runs == [slice(0, len(time))]


def test_pieces_are_rows_between_their_times() -> None:
    time = np.concatenate([0.02 * np.arange(100), [5.0], 9.0 + 0.02 * np.arange(50)])
    assert trial(time, ((0.0, time[99]), (9.0, time[-1]))).runs == [slice(0, 100), slice(101, 151)]
