"""The chain's inertia against closed sums, and phase A of one synthetic trial: certified, near what is planted."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.dynamics.collocation.certificate import Resimulation, certificate, resimulation
from geocontact.dynamics.collocation.motion import CollocatedMotion, scheme
from geocontact.dynamics.collocation.solve import SolverOptions, solve
from geocontact.dynamics.recorded_inputs import RecordedInputs
from geocontact.dynamics.simulate import Stepper
from geocontact.standing_up.chain import (
    EVERY_PLANTED,
    PLANTED,
    SOUGHT,
    SOUGHT_WORN,
    TURNING,
    Subject,
    feet_on_ground,
    leg_chain,
)
from geocontact.standing_up.contact_numbers import contact_numbers
from geocontact.standing_up.exoskeleton import STRAP_PLANTED, with_exoskeleton
from geocontact.standing_up.phases import phase_a
from geocontact.standing_up.trials import StandingNoise, recorded, seen_in, standing_up


def test_chain_weighs_what_the_subject_weighs() -> None:
    """In air, at rest: all of the weight upwards, none forwards; the whole mass along either axis."""
    from casadi import Function

    subject = Subject(82.0, 1.8)
    e = feet_on_ground(subject).equations
    balance = Function("b", [e.q, e.u, e.a, e.w, e.p], [e.balance])
    high, still = np.r_[0.0, 5.0, 0.0, 0.3, -0.4, 0.2], np.zeros(6)
    hanging = balance(high, still, still, np.zeros(3), PLANTED).full().ravel()
    moved = balance(high, still, np.eye(6)[0], np.zeros(3), PLANTED).full().ravel()
    np.testing.assert_allclose(hanging[:2], [0.0, -82.0 * 9.81], atol=1e-6)
    assert moved[0] - hanging[0] == pytest.approx(-82.0, rel=1e-9)
    assert sum(b.mass for b in leg_chain(subject).bodies) == pytest.approx(82.0, rel=1e-12)


def test_tangents_hold_where_feet_meet_the_ground() -> None:
    """A fall from 16 mm at 0.3 m/s: central differences of simulations, before, at and after touching."""
    stepper, radau = Stepper(feet_on_ground(Subject()).equations), scheme("radau", 4)
    breaks = np.linspace(0.0, 0.07, 8)
    start = np.r_[0.0, 0.111, 0.0, 0.02, -0.02, 0.02], np.r_[0.0, -0.3, np.zeros(4)], np.zeros(0)
    points = breaks[:-1, None] + 0.01 * np.r_[0.0, radau.points]
    time, inputs = np.unique(points.round(12)), RecordedInputs(breaks, np.zeros((7, 3, 6)))
    fall = stepper.simulate(start, time, inputs=inputs, parameters=PLANTED, tolerance=1e-9)
    x = np.hstack([fall.q, fall.u, np.zeros((len(time), 6)), fall.z])
    states = x[np.searchsorted(time, points.round(12))]
    motion = CollocatedMotion("fall", radau, breaks, states, np.zeros((7, 4, 3)), x[-1])
    again = Resimulation(stepper, motion, inputs, PLANTED)
    found, largest = again.tangents(), []
    for k, each in enumerate(again.states()[:-1]):
        span, steps = breaks[k : k + 2], 1e-6 * np.eye(12)
        columns = [again.after(each + h, span)[-1] - again.after(each - h, span)[-1] for h in steps]
        expected = np.stack(columns, axis=1) / 2e-6
        largest.append(np.abs(expected).max())
        np.testing.assert_allclose(found[k], expected, atol=1e-2 * largest[-1])
    assert max(largest) > 10.0 * largest[0], "hardly touched first, then pressed"


@pytest.mark.slow
def test_one_trial_gives_its_parameters_back() -> None:
    """Phase A on 50 intervals: solved, certified, each parameter nearer to the planted one than where it started."""
    subject, noise = Subject(), StandingNoise()
    feet = feet_on_ground(subject)
    _, truth = standing_up(feet, subject)
    problem = phase_a(feet, subject, [recorded(feet, truth.motions[0], truth.p, 100.0, noise, 34)], noise).control
    found = solve(problem, SolverOptions("radau", 4, 50, 1e-7))
    again = resimulation(Stepper(feet.equations), found.motions[0], found.p, lambda t: np.zeros((len(t), 0)), range(3))
    seen = certificate(found.solved, problem.system, problem.trials[0], again, TURNING)
    assert seen.converged, seen
    off = np.abs(found.p - PLANTED)
    assert (off[:3] < 0.1 * np.abs(problem.guess_p - PLANTED)[:3]).all(), off


@pytest.mark.slow
@pytest.mark.long  # with every change: the one above, and test_chair.py
def test_what_is_sought_holds_what_was_planted_where_nothing_is_noisy() -> None:
    """Both chains rise, seen exactly: all within two standard deviations; with the dissipation held elsewhere not."""
    subject, noise, planted = Subject(), StandingNoise(), np.r_[EVERY_PLANTED, STRAP_PLANTED]
    model = with_exoskeleton(subject)
    _, truth = standing_up(model, subject, planted=planted)
    trial = seen_in(model, truth.motions[0], truth.p, np.linspace(0.0, 1.5, 151), "T1")
    off = {}
    for free in (SOUGHT_WORN, SOUGHT):
        phase = phase_a(model, subject, [trial], noise, free=free)
        found = solve(phase.control, SolverOptions("radau", 4, 45, 1e-7))
        rows = zip(contact_numbers(phase, found).numbers, phase.parameters, planted, strict=True)
        off[free] = {n.name: (each.searched(n.value) - at) / n.after for n, each, at in rows if n.name in free}
    assert max(map(abs, off[SOUGHT_WORN].values())) < 2.0, off
    assert abs(off[SOUGHT]["bottom"]) > 3.0, off  # what is held without being known
