"""Parameters that trials identify together: by closed forms, by all subsets, and on a shipped trial."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from geocontact.standing_up.selection import LEAST, selected

NAMES = ("a", "b", "c", "d")


def least_of(information: np.ndarray, chosen: tuple[int, ...]) -> float:
    """Least of what is known of each of a subset: 1 over the largest variance, by the inverse."""
    return float(1.0 / np.diag(np.linalg.inv(information[np.ix_(chosen, chosen)])).max())


def test_independent_parameters_are_taken_by_what_is_known_of_them() -> None:
    """The prior's deviation is halved by 3 times its information."""
    rows = selected(NAMES, np.diag([50.0, 2.9, 400.0, 3.1]))
    assert LEAST == 3.0 and [(row.name, row.turn, row.outcome) for row in rows] == [
        ("c", 1, "identified"),
        ("a", 2, "identified"),
        ("d", 3, "identified"),
        ("b", 0, "not identified"),
    ]
    assert [row.alone for row in rows] == [400.0, 50.0, 3.1, 2.9]


def test_two_numbers_that_act_as_one_are_coupled() -> None:
    """Correlation r of the recordings' slopes leaves (1 - r²) of what is known of the second."""
    r = 0.999
    information = np.array([[900.0, r * 30.0 * 20.0, 0.0], [r * 30.0 * 20.0, 400.0, 0.0], [0.0, 0.0, 10.0]])
    rows = {row.name: row for row in selected(("height", "radius", "heel"), information)}
    assert rows["height"].turn == 1 and rows["heel"].turn == 2
    assert (rows["radius"].outcome, rows["radius"].partner) == ("coupled", "height")
    assert rows["radius"].beside == pytest.approx(400.0 * (1.0 - r**2), rel=1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_what_is_taken_is_identified_and_nothing_can_be_added(seed: int) -> None:
    """By the inverses of all subsets: every number of the set is known, and with any further one some is not."""
    rng = np.random.default_rng(seed)
    slopes = rng.normal(size=(40, 4)) @ np.diag([3.0, 1.0, 0.3, 2.0]) @ rng.normal(size=(4, 4))
    information = slopes.T @ slopes / 20.0
    taken = tuple(NAMES.index(row.name) for row in selected(NAMES, information) if row.turn)
    assert taken and least_of(information, taken) >= LEAST
    for k in set(range(4)) - set(taken):
        assert least_of(information, (*taken, k)) < LEAST
    fit = [s for n in range(1, 5) for s in combinations(range(4), n) if least_of(information, s) >= LEAST]
    assert tuple(sorted(taken)) in fit


def test_trials_that_say_nothing_identify_nothing() -> None:
    rows = selected(NAMES, 0.1 * np.eye(4))
    assert all(row.outcome == "not identified" and row.turn == 0 for row in rows)
