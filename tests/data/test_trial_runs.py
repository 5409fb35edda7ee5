"""Where a recording pauses."""

from __future__ import annotations

import numpy as np

from geocontact.data.trial import runs


def test_a_trial_is_cut_at_pauses_and_not_where_a_few_samples_are_missing() -> None:
    time = 0.02 * np.arange(100)
    assert runs(time) == [slice(0, 100)]
    assert runs(np.delete(time, slice(30, 38))) == [slice(0, 92)]
    assert runs(np.delete(time, slice(30, 42))) == [slice(0, 30), slice(30, 88)]
    lone = np.concatenate([time, [5.0], 9.0 + time])
    assert runs(lone) == [slice(0, 100), slice(100, 101), slice(101, 201)]
    assert runs(time[:1]) == [slice(0, 1)]
