"""What is believed of noise, and what limits it."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geocontact.identify.noise.noise_levels import BEYOND, NoiseLevels, NoisePriors

MIDDLE = NoiseLevels(
    np.array([0.3, 0.2]),
    np.array([[0.5, 0.1], [0.1, 0.2]]),
    np.full((2, 2), 0.1),
    np.array([0.01, 0.02]),
    np.array([0.04, 0.1]),
)
SIZE = len(MIDDLE.logarithms())
RNG = np.random.default_rng(0)
FACTOR = np.tril(0.3 * RNG.standard_normal((SIZE, SIZE))) + np.eye(SIZE)
LIMITED = NoisePriors(MIDDLE, FACTOR, np.array([0.5, np.inf]), np.array([0.02, np.inf]))


def points() -> list[np.ndarray]:
    return list(np.random.default_rng(1).standard_normal((8, SIZE)))


def test_without_limits_logarithms_are_linear() -> None:
    free = NoisePriors(MIDDLE, FACTOR, np.full(2, np.inf), np.full(2, np.inf))
    for x in points():
        assert_allclose(free.levels(x).logarithms(), MIDDLE.logarithms() + FACTOR @ x)


def test_what_exceeds_its_limit_hardly_does_and_the_rest_is_as_it_was() -> None:
    free = NoisePriors(MIDDLE, FACTOR, np.full(2, np.inf), np.full(2, np.inf))
    over = 0
    for x in points():
        held, loose = LIMITED.levels(x), free.levels(x)
        assert held.sensors[0] < 0.5 * np.exp(BEYOND)
        assert held.inputs[0] < 0.02 * np.exp(BEYOND)
        assert_allclose(held.white[1], loose.white[1])
        assert_allclose(held.inputs[1], loose.inputs[1])
        assert_allclose(held.memory, loose.memory)
        assert_allclose(held.coloured[:, 0] / held.white[0], loose.coloured[:, 0] / loose.white[0])
        if loose.sensors[0] <= 0.5:
            assert held.sensors[0] == pytest.approx(loose.sensors[0])
        over += loose.sensors[0] > 0.5
    assert over


def test_the_slope_is_that_of_the_levels() -> None:
    pull = np.random.default_rng(2).standard_normal(SIZE)
    for x in points():
        numeric = np.zeros(SIZE)
        for k in range(SIZE):
            step = np.zeros(SIZE)
            step[k] = 1e-6
            up, down = LIMITED.levels(x + step).logarithms(), LIMITED.levels(x - step).logarithms()
            numeric[k] = pull @ (up - down) / 2e-6
        assert_allclose(LIMITED.slope(x, pull), numeric, rtol=1e-5, atol=1e-7)


def test_levels_are_found_where_they_came_from() -> None:
    for x in 0.5 * np.array(points()):
        assert_allclose(LIMITED.levels(LIMITED.point(LIMITED.levels(x))).logarithms(), LIMITED.levels(x).logarithms())


def test_levels_that_cannot_be_reached_are_taken_as_just_within() -> None:
    found = LIMITED.levels(LIMITED.point(MIDDLE.times(np.full(2, 30.0), np.full(2, 30.0))))
    assert_allclose(found.sensors[0], 0.5 * np.exp(BEYOND), rtol=1e-3)
    assert_allclose(found.inputs[0], 0.02 * np.exp(BEYOND), rtol=1e-3)
    assert_allclose(found.inputs[1], 3.0)
