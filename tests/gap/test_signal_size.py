"""Noise that grows with the signal is found where it is there, is next to nothing where not, and names no effect.

All cases are synthetic.
"""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.gap.case.noise_sources import seen_growth, signal_size
from geocontact.gap.case.preparation import problem_of
from geocontact.identify.noise.noise_search import CostSurface
from geocontact.systems.catalogue import system_of
from tests.elsewhere import Elsewhere
from tests.gap.cases import NOISE, Change, diagnosis, elbow_case

DAMPED = {"damping.b": 6.0, "damping.exponent": 1.0}


def growing(slope: float, seed: int) -> Change:
    """Noise of the sensor that has this share of the force for its standard deviation."""
    rng = np.random.default_rng(seed)
    return lambda _, __, force: force + slope * force * rng.standard_normal(len(force))


def found_growth(slope: float, effect: str = "") -> tuple[float, float, float, float]:
    """Slope that is found, its interval of two standard deviations either way, and the noise at the largest force that
    it makes [N].
    """
    case = elbow_case(effect, DAMPED if effect else {}, 2, 8.0, recorded=growing(slope, 52))
    problem = problem_of(case, system_of(case))
    assert problem.noise is not None
    levels, beliefs = problem.noise.levels, problem.beliefs
    count = len(problem.calibration.trials)
    varied = [each * problem.noise.varies for each in problem.varied(problem.plain.jacobian)]
    surface = CostSurface.of(problem.calibration_layouts, problem.plain.residuals[:count], varied[:count], beliefs)
    spread = beliefs.factor @ np.linalg.inv(surface.information(surface.at(beliefs.point(levels)))) @ beliefs.factor.T
    own = levels.logarithms() == np.log(levels.growing[0])
    wide = np.exp(2.0 * np.sqrt(spread[own][0, own].item()))
    b = float(levels.growing[0])
    return b, b / wide, b * wide, b * problem.system.scale.of("force")


def answered(effect: str, slope: float) -> tuple[str, tuple[str, ...], tuple[str, ...]]:
    said = diagnosis(effect, DAMPED if effect else {}, 1, 8.0, recorded=growing(slope, 51))
    return said.verdict, said.effects, said.ambiguity


@pytest.mark.parametrize("effect", ["", "damping"])
def test_growth_that_is_there_is_found_within_its_interval(elsewhere: Elsewhere, effect: str) -> None:
    """Also where a damper is missing: what is smooth is no white noise."""
    b, low, high, _ = elsewhere(found_growth, 0.02, effect)
    assert low < 0.02 < high
    assert high < 1.5 * b


def test_growth_that_is_not_there_is_next_to_nothing(elsewhere: Elsewhere) -> None:
    *_, at_the_largest = elsewhere(found_growth, 0.0)
    assert at_the_largest < 0.4 * NOISE


@pytest.mark.slow
def test_growing_noise_names_nothing_and_hides_nothing(elsewhere: Elsewhere) -> None:
    """With noise as large everywhere saturation gained 50 nats in the first case, beside damping 386 in the second."""
    assert elsewhere(answered, "", 0.15) == ("no_gap", (), ())
    verdict, effects, ambiguity = elsewhere(answered, "damping", 0.05)
    assert (verdict, effects, ambiguity[0]) == ("explained", ("damping",), "damping")


def test_a_recording_shows_how_its_noise_grows_and_no_movement_is_taken_for_it() -> None:
    rng = np.random.default_rng(3)
    clean = [50.0 * np.sin(np.linspace(0.0, 30.0, 600) + each)[:, None] for each in range(5)]
    level = [np.ones_like(each) for each in clean]
    noisy = [y + 0.3 * rng.standard_normal(y.shape) for y in clean]
    more = [n + 0.02 * y * rng.standard_normal(y.shape) for n, y in zip(noisy, clean, strict=True)]
    more[0][40:60] = np.nan
    assert seen_growth(more, level) == pytest.approx([0.02], rel=0.15)
    assert seen_growth(noisy, level) == pytest.approx([0.0], abs=0.003)
    assert seen_growth(clean, level) == pytest.approx([0.0], abs=1e-4)


def test_the_size_of_a_signal_is_that_of_its_neighbourhood() -> None:
    values = np.array([[-2.0], [-2.0], [np.nan], [-2.0], [-2.0], [-2.0], *[[np.nan]] * 12])
    (size,) = signal_size([values])
    assert size[:9, 0] == pytest.approx(2.0)
    assert size[-1, 0] == 0.0
    noise = np.random.default_rng(0).standard_normal((900, 1))
    assert signal_size([10.0 + noise])[0].std() < 0.5 * noise.std()
