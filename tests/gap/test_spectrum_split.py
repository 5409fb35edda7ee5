"""A spectrum taken apart: levels found again, and no search that ends short of the best. All spectra are synthetic."""

from __future__ import annotations

import numpy as np
import pytest
from jaxtyping import Float
from scipy.optimize import minimize

from geocontact.gap.input_spectrum import Spectrum
from geocontact.gap.spectrum_split import TAIL, TAILED, Parts, split
from geocontact.identify.low_pass import LowPass

STEP = 0.01
FREQUENCY = np.tile(np.linspace(0.4, 49.0, 120), 3)
CORNERS = np.geomspace(3.0, 30.0, 9)
FILTERS = [*(LowPass(f, STEP) for f in CORNERS), LowPass.none(STEP)]


def movement(slow: float) -> Float[np.ndarray, " f"]:
    """Power of a movement that falls off."""
    return np.asarray(np.exp(-((FREQUENCY / slow) ** 1.2)) * 10.0)


def drawn(expected: Float[np.ndarray, " f"], seed: int = 1) -> Spectrum:
    """Independent exponential values around what is expected."""
    rng = np.random.default_rng(seed)
    return Spectrum(FREQUENCY, expected * rng.exponential(size=len(FREQUENCY)), 1.0, 1e-5)


def noise(through: LowPass, sd: float) -> Float[np.ndarray, " f"]:
    """Power of noise that has this standard deviation after the filter."""
    part = through.power(np.linspace(0.0, 0.5 / STEP, 400)).mean()
    return np.asarray(sd**2 / part * through.power(FREQUENCY))


@pytest.mark.parametrize("sd", [0.001, 0.01])
@pytest.mark.parametrize("through", [FILTERS[5], FILTERS[-1]])
def test_the_level_of_the_noise_is_found(through: LowPass, sd: float) -> None:
    seen = drawn(movement(0.5) + noise(through, sd) + 1e-10)
    assert split(seen, [through]).noise[0] == pytest.approx(sd, rel=0.2)


def test_the_filter_that_noise_came_through_is_likeliest() -> None:
    for k in (3, 6, 9):
        seen = drawn(movement(0.5) + noise(FILTERS[k], 0.005) + 1e-10)
        assert int(np.argmin(split(seen, FILTERS).unlikely)) == k


@pytest.mark.parametrize("seed", [1, 2])
def test_no_other_start_finds_anything_likelier(seed: int) -> None:
    """Fifty random ones, each taken downhill by scipy."""
    seen = drawn(movement(0.5) + 3e-2 / (1.0 + (FREQUENCY / TAIL) ** 4) ** 2 + noise(FILTERS[4], 0.004) + 1e-9, seed)
    through = FILTERS[4]
    parts = Parts.of(seen, [through])
    rng = np.random.default_rng(seed)
    top = float(np.log(seen.power.max()))

    def cost(x: Float[np.ndarray, " p"]) -> tuple[float, Float[np.ndarray, " p"]]:
        value, slope, _ = parts.scored(x[None], np.zeros(1, dtype=int))
        return float(value[0]), slope[0]

    others = []
    for count, price in ((5, 0.0), (6, TAILED)):
        low = np.array([top - 20.0, np.log(0.02), np.log(0.7), top - 60.0, top - 80.0, top - 60.0])[:count]
        high = np.array([top + 40.0, np.log(20.0), np.log(3.0), top + 2.0, top, top + 20.0])[:count]
        for _ in range(25):
            start = rng.uniform(np.maximum(low, [top - 5, -2, -0.3, top - 25, top - 30, top - 10][:count]), high)
            best = minimize(cost, start, jac=True, method="L-BFGS-B", bounds=list(zip(low, high, strict=True)))
            others.append(float(best.fun) + price)
    assert split(seen, [through]).unlikely[0] <= min(others) + 1e-3


def test_a_tail_of_the_movement_is_not_taken_for_noise() -> None:
    """It is 300 times the noise at 5 Hz, where a filter of 3 Hz would let noise through."""
    tail = 1e-2 / (1.0 + (FREQUENCY / TAIL) ** 4) ** 2
    seen = drawn(movement(0.3) + tail + noise(FILTERS[-1], 5e-4) + 1e-12)
    answer = split(seen, FILTERS)
    assert int(np.argmin(answer.unlikely)) == len(FILTERS) - 1
    assert answer.noise[-1] == pytest.approx(5e-4, rel=0.3)


def test_gradients_are_those_of_the_values() -> None:
    parts = Parts.of(drawn(movement(0.5) + noise(FILTERS[4], 0.004) + 1e-9), FILTERS)
    x = np.array([[2.0, -0.5, 0.2, -11.0, -18.0, -4.0], [1.0, 0.3, 0.5, -9.0, -22.0, -8.0]])
    which = np.array([4, 9])
    _, slope, curved = parts.scored(x, which)
    for k in range(6):
        off = 1e-6 * (np.arange(6) == k)
        differs = (parts.scored(x + off, which)[0] - parts.scored(x - off, which)[0]) / 2e-6
        assert slope[:, k] == pytest.approx(differs, rel=1e-5, abs=1e-5)
    assert (np.linalg.eigvalsh(curved) > -1e-9).all()
