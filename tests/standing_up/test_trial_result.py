"""A trial beside a motion that is known in closed form, and residuals at the recording's times."""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace

import numpy as np
import pytest

from geocontact.standing_up.phase import JudgedMotion
from geocontact.standing_up.trial_result import trial_result
from geocontact.standing_up.trials import StandingTrial
from tests.unchecked import unchecked

HELD = np.array([0.1, 0.4, 0.8])


@pytest.fixture(autouse=True)
def stand_ins() -> Iterator[None]:
    """Types are not checked: a motion in closed form stands in for a collocated one."""
    with unchecked():
        yield


def state(time: np.ndarray) -> np.ndarray:
    """Coordinates t^2 and t^3, their rates and accelerations."""
    return np.stack([time**2, time**3, 2.0 * time, 3.0 * time**2, 2.0 + 0.0 * time, 6.0 * time], axis=1)


def seen(time: np.ndarray) -> StandingTrial:
    x = state(time)
    return StandingTrial(time, x[:, :2], x[:, 2:4], np.zeros((len(time), 2)), 0.0 * time)


def test_channels_and_accelerations_are_those_of_the_motion() -> None:
    recorded = seen(np.linspace(0.0, 1.0, 5))
    judged = JudgedMotion(None, np.array([0.0, 0.1, 0.13, 0.9]), np.array([1.0, 2.0, 3.0, 4.0]), np.zeros(4))
    motion = SimpleNamespace(held_times=HELD, state=state)
    found = trial_result(recorded, motion, judged, seen)  # type: ignore[arg-type]
    np.testing.assert_array_equal(found.model.q, recorded.q)
    np.testing.assert_array_equal(found.points.time, HELD)
    np.testing.assert_allclose(found.acceleration, np.column_stack([[2.0, 2.0, 2.0], 6.0 * HELD]))
    # the largest nearest to 0, 0.25, 0.5, 0.75 and 1 s: 0.13 is nearer to 0.25
    np.testing.assert_array_equal(found.residual(judged.force), [2.0, 3.0, 0.0, 0.0, 4.0])
    assert not found.certified, "nothing was certified"
