"""The simulation of a large study against what can be said without it."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.study.plan import RETURNS, Cluster, simulated

NONE = np.zeros(2000, bool)


def test_without_failures_the_work_is_shared_evenly() -> None:
    found = simulated(np.full(2000, 3.0), NONE, NONE, Cluster(8, 0.0, 0.0, 0.0, 120.0), 1)
    assert found["hours"] * 3600.0 == pytest.approx(120.0 + 2000 * 3.0 / 8) and found["lost_cpu_hours"] == 0.0
    slow = simulated(np.full(2000, 3.0), NONE, NONE, Cluster(400, 0.0, 0.0, 0.1, 0.0), 1)
    assert slow["hours"] * 3600.0 == pytest.approx(1999 * 0.1 + 3.0), (
        "what is given out one after the other is the limit"
    )


def test_set_aside_by_chance_is_three_ends_in_a_row() -> None:
    """A worker ends within a trial with q = 1 - exp(-rate x time): of 2000 trials q^3 are set aside, ± 4 SD."""
    ends, seconds = 600.0, 3.0
    found = simulated(np.full(2000, seconds), NONE, NONE, Cluster(8, ends, 0.0, 0.0, 0.0), 2)
    q = 1.0 - np.exp(-ends * seconds / 3600.0)
    assert found["set_aside"] == found["set_aside_innocent"]
    assert abs(found["set_aside"] - 2000 * q**3) < 4.0 * np.sqrt(2000 * q**3)
    busy = found["hours"] * 3600.0 * 8
    assert busy > 2000 * seconds + 0.9 * RETURNS * 2000 * q, "every end costs the worker's return"


def test_who_kills_is_set_aside_and_what_is_stopped_is_done_again() -> None:
    kills = np.arange(2000) % 100 == 0
    found = simulated(np.full(2000, 3.0), ~kills, kills, Cluster(8, 0.0, 200.0, 0.0, 10.0), 3)
    assert (found["set_aside"], found["set_aside_innocent"], found["failed"]) == (20, 0, 1980)
    assert found["started_again"] >= 1 and found["lost_cpu_hours"] > 0.0
