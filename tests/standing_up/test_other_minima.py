"""Two minima of one cost: which is taken, when another is looked for, and what it leaves of an interval."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import norm

from benchmarks.standing.other_world import World, own_trials
from geocontact.dynamics.collocation.solve import SolverOptions
from geocontact.standing_up.calibrated_phase import (
    DOUBTFUL,
    PhaseSearch,
    beside_rivals,
    calibrated_phase,
    doubtful,
    ended,
    misfit,
    rivals,
)
from geocontact.standing_up.chain import FOOT_PARAMETERS, SOUGHT_WORN, Subject, feet_on_ground
from geocontact.standing_up.contact_numbers import (
    ContactNumber,
    ContactNumbers,
    held_covariance,
    prior_covariance,
)
from geocontact.standing_up.exoskeleton import with_exoskeleton
from geocontact.standing_up.phases import phase_a
from geocontact.standing_up.strap_sites import ContactParameter, searched
from geocontact.standing_up.trials import StandingNoise, StandingTrial, with_noise
from tests.unchecked import unchecked

BOTH = (
    ContactParameter("modulus", "Pa", 3e6, 1.0, 2.5e5, 6e7, logarithm=True),
    ContactParameter("heel", "m", -0.03, 0.02, -0.09, 0.02),
)


def phase(p: tuple[float, float] = (0.0, -0.03)) -> SimpleNamespace:
    """Of two numbers that are sought."""
    low, high = np.array([np.log(2.5e5 / 3e6), -0.09]), np.array([np.log(20.0), 0.02])
    control = SimpleNamespace(p=(low, high), guess_p=np.array(p))
    return SimpleNamespace(parameters=BOTH, control=control, terms={"force": 0, "centre": 0, "jerk": 0})


def end(objective: float, p: tuple[float, float], solved: bool = True) -> SimpleNamespace:
    return SimpleNamespace(objective=objective, p=np.array(p), solved=solved)


def numbers(sd: float, heel: str = "known") -> ContactNumbers:
    """The modulus at 2 times the usual one, the heel at -38 mm, told to 1 mm."""
    reach = norm.ppf(0.975)
    first = ContactNumber(
        "modulus", "Pa", 6e6, 6e6 * np.exp(-reach * sd), 6e6 * np.exp(reach * sd), 1.0, sd, "known", 0.5 * sd
    )
    second = ContactNumber("heel", "m", -0.038, -0.038 - reach * 1e-3, -0.038 + reach * 1e-3, 0.02, 1e-3, heel)  # type: ignore[arg-type]
    return ContactNumbers((first, second), ("modulus", "heel"), np.eye(2), None, np.ones(2))


def test_a_misfit_is_one_where_every_square_is_that_of_its_noise() -> None:
    """Two trials of 1 s and 2 s at 100 and 50 Hz: 3 squares a sample are 300 and 300, and the cost has a hundredth."""
    model, trials = feet_on_ground(Subject()), []
    for seconds, rate in ((1.0, 100.0), (2.0, 50.0)):
        time = np.linspace(0.0, seconds, round(seconds * rate) + 1)
        q = np.zeros((len(time), 6))
        trials.append(StandingTrial(time, q, q, q[:, :2], q[:, 0]))
    with unchecked():
        assert misfit(model, trials, phase(), end(6.0, (0.0, 0.0))) == pytest.approx(1.0)  # type: ignore[arg-type]
        assert misfit(model, trials, phase(), end(12.0, (0.0, 0.0))) == pytest.approx(2.0)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("p", "misfits", "asked"),
    [((0.0, -0.03), 0.8, False), ((0.0, -0.03), DOUBTFUL + 0.1, True), ((np.log(20.0), -0.03), 0.8, True)],
)
def test_another_start_is_asked_for_on_a_bound_or_where_the_model_does_not_fit(
    p: tuple[float, float], misfits: float, asked: bool
) -> None:
    with unchecked():
        assert doubtful(phase(), end(1.0, p), misfits) is asked  # type: ignore[arg-type]
        held = phase()
        held.control.p = held.control.guess_p, held.control.guess_p
        assert not doubtful(held, end(1.0, p), misfits)  # type: ignore[arg-type]


def test_a_minimum_that_costs_too_much_is_no_rival() -> None:
    """9.9 and 10.1 more in minus twice the log posterior; with a misfit of 2 both are half as much."""
    best = end(1.0, (0.7, -0.038))
    runs = [(None, each) for each in (best, end(1.099, (2.0, -0.05)), end(1.101, (2.5, -0.06)), end(1.0, best.p))]
    with unchecked():
        assert [p[0] for p in rivals(phase(), runs, best, 0.8)] == [2.0]  # type: ignore[arg-type]
        assert [p[0] for p in rivals(phase(), runs, best, 2.0)] == [2.0, 2.5]  # type: ignore[arg-type]
        assert [each.same for each in ended(phase(), runs, best)] == [True, False, False, True]  # type: ignore[arg-type]


def test_a_number_with_a_rival_outside_its_interval_is_not_separable() -> None:
    """In logarithms the other is 1.5 higher, 15 standard deviations; the heel's is half a millimetre off, inside."""
    at = np.array([np.log(2.0), -0.038])
    with unchecked():
        told = beside_rivals(numbers(0.1), phase(), at, [at + np.array([1.5, 5e-4])], 0.95)  # type: ignore[arg-type]
    modulus, heel = told.numbers
    half = norm.ppf(0.975) * 0.1
    assert modulus.verdict == "not separable" and modulus.value == 6e6
    assert modulus.lower == pytest.approx(6e6 * np.exp(-half)) and modulus.upper == pytest.approx(
        6e6 * np.exp(1.5 + half)
    )
    assert modulus.after == pytest.approx((0.75 + half) / norm.ppf(0.975))
    assert heel.verdict == "known" and heel.after == 1e-3
    # a phase that holds it takes it as wide
    assert held_covariance(told, BOTH)[0, 0] == pytest.approx(modulus.after**2)
    with unchecked():
        assert beside_rivals(numbers(0.1), phase(), at, [], 0.95).numbers == numbers(0.1).numbers  # type: ignore[arg-type]
        high = beside_rivals(numbers(0.1), phase(), at, [at + np.array([2.25, 0.0])], 0.95).numbers[0]  # type: ignore[arg-type]
        stays = beside_rivals(numbers(0.1, "on its bound"), phase(), at, [at + np.array([0.0, 0.05])], 0.95)  # type: ignore[arg-type]
    assert high.upper == pytest.approx(6e7) and high.lower == modulus.lower  # 57 MPa, 69 with half an interval
    assert stays.numbers[1].verdict == "on its bound"


@pytest.mark.slow
@pytest.mark.long  # with every change: the parts above; calibrations in tests/analyses/sit_to_stand
def test_trials_of_another_model_do_not_end_on_the_bound_of_the_modulus() -> None:
    """The search's own start ends with 60 MPa for 15 and 79.7 mm for 85: 40 standard deviations, once called known.

    The planted numbers are those of a simulation that shares no equations with the package.
    """
    world, noise = World(), StandingNoise()
    subject = Subject(world.mass, world.height)
    model = with_exoskeleton(subject)
    trials = [with_noise(each, model, noise, 102) for each in own_trials(world, [2])]
    search = PhaseSearch(SolverOptions("radau", 3, 1, 1e-7, 200, 120.0), nodes=10.0)
    believed = prior_covariance(model.parameters, ())
    found = calibrated_phase(
        "A",
        model,
        trials,
        noise,
        lambda given, start: phase_a(model, subject, given, noise, free=SOUGHT_WORN, start=start),
        search,
        held=believed,
    )
    assert [each.same for each in found.ends] == [False, True]
    assert found.misfit > DOUBTFUL
    numbers = (world.modulus, world.heel, world.toe, world.bottom, world.radius, world.dissipation, world.friction)
    at = searched(FOOT_PARAMETERS, numbers)
    off = {
        n.name: (of.searched(n.value) - planted) / n.after
        for n, of, planted in zip(found.numbers.numbers, FOOT_PARAMETERS, at, strict=False)
        if n.verdict == "known"
    }
    assert {"stiffness", "heel", "toe", "bottom"} <= set(off)
    assert max(map(abs, off.values())) < 1.96, off
