"""Draws of markers' errors: their size, and the band that they make, by hand."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.leg_tree import GRAVITY
from geocontact.below_knee_prosthesis.marker_draws import curves_of, marker_band, with_errors
from geocontact.below_knee_prosthesis.simulate import Stance
from geocontact.data.multibody.markers import MarkerTrajectories
from tests.below_knee_prosthesis.stances import a_stance

TIME = np.arange(0.0, 0.6, 0.002)
WEIGHT = 77.3 * GRAVITY


def of_force(up: float) -> Stance:
    return a_stance(TIME, np.column_stack([0.0 * TIME, up + 0.0 * TIME, 0.0 * TIME]))


def test_errors_have_their_size_and_half_of_them_is_slow() -> None:
    time = np.arange(0.0, 40.0, 0.01)
    seen = MarkerTrajectories(time=time, names=("A", "B"), positions=np.zeros((len(time), 2, 3)))
    error = with_errors(seen, 2e-3, np.random.default_rng(1)).positions
    assert error.std() == pytest.approx(2e-3, rel=0.05)
    step = np.diff(error, axis=0)  # of the quick half alone, two independent samples: twice its variance
    assert step.std() == pytest.approx(2e-3, rel=0.05)


def test_the_band_is_as_wide_as_the_draws_are_away() -> None:
    """Forces of known size: 1.96 times their root mean square, about the stance itself."""
    off = np.array([30.0, -10.0, 20.0, 40.0])
    forces = iter(700.0 + off)
    mass = of_force(0.0).motion.leg.person.mass
    band = marker_band(of_force(700.0), lambda _: of_force(next(forces)), 4)
    by_hand = 1.959964 * np.sqrt(np.mean(off**2)) / (mass * GRAVITY)
    np.testing.assert_allclose(band.half["vertical"], by_hand, rtol=1e-6)
    np.testing.assert_allclose(band.curves["vertical"], 700.0 / (mass * GRAVITY))
    assert band.width("vertical") == pytest.approx(by_hand, rel=1e-6) and band.width("fore_aft") == 0.0
    half = np.where(TIME < 0.15, 1.01, 0.99) * by_hand
    assert band.inside("vertical", band.curves["vertical"] + half) == pytest.approx(0.75, abs=0.01)
    assert (band.drawn, band.lost) == (4, 0)
    assert set(curves_of(of_force(1.0))) == set(band.half)


def test_draws_that_cannot_be_simulated_are_counted_and_too_many_are_refused() -> None:
    def again(lost: set[int]) -> Stance:
        count[0] += 1
        if count[0] in lost:
            raise ArithmeticError("no step")
        return of_force(710.0)

    count = [0]
    assert marker_band(of_force(700.0), lambda _: again({2}), 4).lost == 1
    count = [0]
    with pytest.raises(ArithmeticError, match="3 of 4 draws"):
        marker_band(of_force(700.0), lambda _: again({1, 2, 3}), 4)


def test_a_draw_is_its_seeds() -> None:
    seen = list[float]()

    def again(rng: np.random.Generator) -> Stance:
        seen.append(float(rng.standard_normal()))
        return of_force(700.0)

    for seed in (3, 3, 4):
        marker_band(of_force(700.0), again, 4, seed=seed)
    assert seen[:4] == seen[4:8] != seen[8:] and len(set(seen[:4])) == 4
