"""A spectrum taken apart: levels found again, and no search that ends short of the best. All spectra are synthetic."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from jaxtyping import Float
from scipy.optimize import minimize

from geocontact.gap.inputs.spectrum import Spectrum
from geocontact.gap.inputs.spectrum_components import BROADEST, FLATTEST, SLOWEST, STEEPEST, TAIL, Parts, split
from geocontact.gap.levels import SURE
from geocontact.identify.signals.low_pass import LowPass

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


def tail(height: float) -> Float[np.ndarray, " f"]:
    """Power of a movement in pieces."""
    return np.asarray(height / (1.0 + (FREQUENCY * STEP / TAIL) ** 4) ** 2)


def spread(height: float) -> Float[np.ndarray, " f"]:
    """Power of a movement that fills the spectrum."""
    return np.asarray(height * np.exp(-((FREQUENCY / 15.0) ** 0.8)))


@pytest.mark.parametrize(
    "expected",
    [
        movement(0.5) + noise(FILTERS[4], 0.004) + 1e-9,
        movement(0.1) + tail(10.0) + noise(FILTERS[4], 1e-4) + 1e-12,
        spread(1e-2) + noise(FILTERS[4], 1e-3) + 1e-12,
    ],
)
def test_no_other_start_finds_anything_likelier(expected: Float[np.ndarray, " f"]) -> None:
    """Fifty random ones, half of them with a tail, each taken downhill by scipy."""
    seen, through = drawn(expected), FILTERS[4]
    parts = Parts.of(seen, [through])
    rng = np.random.default_rng(1)
    top = float(np.log(seen.power.max()))

    def cost(x: Float[np.ndarray, " p"]) -> tuple[float, Float[np.ndarray, " p"]]:
        value, slope, _ = parts.scored(x[None], np.zeros(1, dtype=int), with_tail=len(x) > 5)
        return float(value[0]), slope[0]

    others = []
    for count, price in ((5, 0.0), (6, 0.5 * SURE)):
        low = np.array([top - 20.0, SLOWEST, FLATTEST, top - 60.0, top - 80.0, top - 60.0])[:count]
        high = np.array([top + 40.0, BROADEST, STEEPEST, top + 2.0, top, top + 20.0])[:count]
        for _ in range(25):
            start = rng.uniform(np.maximum(low, [top - 5, -8, -0.3, top - 25, top - 30, top - 10][:count]), high)
            best = minimize(cost, start, jac=True, method="L-BFGS-B", bounds=list(zip(low, high, strict=True)))
            others.append(float(best.fun) + price)
    assert split(seen, [through]).unlikely[0] <= min(others) + 1e-3


@pytest.mark.parametrize(("slow", "sd"), [(0.1, 1e-4), (2.0, 1e-2)])
def test_what_falls_behind_would_have_come_to_nothing_better(
    slow: float, sd: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every filter is as likely as with all searches gone on to the end; after one step some would be given up."""
    seen = drawn(movement(slow) + noise(FILTERS[8], sd) + 1e-10, seed=2)
    told = split(seen, FILTERS).unlikely
    monkeypatch.setattr("geocontact.gap.inputs.spectrum_components.LEADING", 99)
    assert told == pytest.approx(split(seen, FILTERS).unlikely, abs=0.1)


def test_few_values_that_a_quick_movement_explains() -> None:
    """White on the whole, with one quiet value: under a filter only a movement as quick as may be explains it."""
    power = np.array([1.69e-5, 2.14e-7, 2.47e-6, 7.45e-6, 1.36e-6, 1.89e-6, 1.33e-7, 6.1e-6])
    seen = Spectrum(6.125 * np.arange(1.0, 9.0), power, 1.0, 1e-5)
    filters = [LowPass(f, STEP) for f in np.geomspace(2.5, 40.0, 17)]
    assert split(seen, filters).unlikely.max() < -85.0


def test_a_tail_of_the_movement_is_not_taken_for_noise(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without it, noise of a low corner is what explains best what the movement leaves."""
    seen = drawn(movement(0.1) + tail(10.0) + noise(FILTERS[-1], 1e-4) + 1e-12)
    answer = split(seen, FILTERS)
    assert int(np.argmin(answer.unlikely)) == len(FILTERS) - 1
    assert answer.noise[-1] == pytest.approx(1e-4, rel=0.3)
    monkeypatch.setattr("geocontact.gap.inputs.spectrum_components.SURE", 1e9)
    assert int(np.argmin(split(seen, FILTERS).unlikely)) < 5


def test_many_values_are_pooled() -> None:
    """A thousand seconds at 100 Hz: what is found, and how much better than the others it is, stays."""
    frequency = np.linspace(0.05, 49.9, 40000)
    rng = np.random.default_rng(2)
    part = FILTERS[5].power(np.linspace(0.0, 0.5 / STEP, 400)).mean()
    power = 10.0 * np.exp(-((frequency / 0.5) ** 1.2)) + 1e-4**2 / part * FILTERS[5].power(frequency) + 1e-12
    seen = Spectrum(frequency, power * rng.exponential(size=len(frequency)), 1.0, 1e-5)
    parts = Parts.of(seen, FILTERS)
    assert len(parts.power) < 450 and parts.count.sum() == len(frequency)
    assert parts.count @ parts.power == pytest.approx(seen.power.sum())
    answer = split(seen, FILTERS)
    assert int(np.argmin(answer.unlikely)) == 5
    assert answer.noise[5] == pytest.approx(1e-4, rel=0.05)
    truth = np.array([[np.log(10.0), np.log(0.5 * STEP), np.log(1.2), np.log(1e-8 / part), np.log(1e-12)]])
    (exact,) = Whole.of(seen, FILTERS[5]).scored(truth, np.zeros(1, dtype=int), with_tail=False)[0]
    (pooled,) = parts.scored(truth, np.array([5]), with_tail=False)[0]
    assert pooled == pytest.approx(exact, abs=60.0), "of 40 000 values"


class Whole:
    """The parts of a spectrum of which nothing is pooled."""

    @staticmethod
    def of(seen: Spectrum, through: LowPass) -> Parts:
        usual = Parts.of(seen, [through])
        passed = through.power(seen.frequency)[None]
        whole = {"frequency": seen.frequency * STEP, "power": seen.power, "count": np.ones(len(seen.power))}
        return replace(usual, passed=passed, **whole)


def test_gradients_are_those_of_the_values() -> None:
    parts = Parts.of(drawn(movement(0.5) + noise(FILTERS[4], 0.004) + 1e-9), FILTERS)
    x = np.array([[2.0, -0.5, 0.2, -11.0, -18.0, -4.0], [1.0, 0.3, 0.5, -9.0, -22.0, -8.0]])
    which = np.array([4, 9])
    _, slope, curved = parts.scored(x, which, with_tail=True)

    def scored(at: Float[np.ndarray, "b p"]) -> Float[np.ndarray, " b"]:
        return parts.scored(at, which, with_tail=True)[0]

    for k in range(6):
        off = 1e-6 * (np.arange(6) == k)
        differs = (scored(x + off) - scored(x - off)) / 2e-6
        assert slope[:, k] == pytest.approx(differs, rel=1e-5, abs=1e-5)
    assert (np.linalg.eigvalsh(curved) > -1e-9).all()


def test_curvatures_are_those_of_the_values_where_what_is_expected_is_met() -> None:
    parts = Parts.of(drawn(movement(0.5) + noise(FILTERS[4], 0.004) + 1e-9), FILTERS)
    x, which = np.array([[2.0, -0.5 + np.log(STEP), 0.2, -11.0, -18.0, -4.0]]), np.array([4])
    fall = (FREQUENCY / np.exp(-0.5)) ** np.exp(0.2)
    expected = np.exp(2.0 - fall) + np.exp(-11.0) * FILTERS[4].power(FREQUENCY) + np.exp(-18.0) + tail(np.exp(-4.0))
    met = replace(parts, power=expected[np.argsort(FREQUENCY, kind="stable")])
    _, _, curved = met.scored(x, which, with_tail=True)

    def slopes(at: Float[np.ndarray, "one p"]) -> Float[np.ndarray, " p"]:
        return met.scored(at, which, with_tail=True)[1][0]

    for k in range(6):
        off = 1e-5 * (np.arange(6) == k)
        bent = (slopes(x + off) - slopes(x - off)) / 2e-5
        assert curved[0, k] == pytest.approx(bent, rel=1e-4, abs=1e-4)
