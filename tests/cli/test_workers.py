"""Work in other processes: every task is answered, with a result or with why there is none."""

from __future__ import annotations

import os

import pytest

from geocontact.analyses.frame.workers import each


def squared(value: int) -> int:
    """Ends its process at 3."""
    if value == 3:
        os._exit(7)
    return value * value


@pytest.mark.parametrize("jobs", [1, 2, None])
def test_every_task_has_its_result(jobs: int | None) -> None:
    assert dict(each(squared, [1, 2, 4], jobs)) == {1: 1, 2: 4, 4: 16}


def test_a_process_that_ends_is_told_and_costs_no_answer() -> None:
    became = dict(each(squared, [3, 5, 6, 7], 2))
    assert set(became) == {3, 5, 6, 7}
    assert isinstance(became[3], BaseException)
    assert all(isinstance(one, BaseException) or one == task**2 for task, one in became.items())
