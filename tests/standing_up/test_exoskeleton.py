"""Two chains and straps: forces are the derivatives of an energy, action is reaction, and one leg sees half."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.standing_up.chain import EVERY_PLANTED, PLANTED, Subject
from geocontact.standing_up.exoskeleton import (
    LEGS,
    STRAP_PARAMETERS,
    STRAP_PLANTED,
    strapped,
    two_chains,
    with_exoskeleton,
)
from geocontact.standing_up.phases import phase_b
from geocontact.standing_up.strap_sites import STRAP_SITES
from geocontact.standing_up.trials import StandingNoise, StandingTrial

SUBJECT = Subject()
P = np.r_[PLANTED, STRAP_PLANTED]
HIGH = np.array([0.1, 3.0, 0.2, -0.3, 0.9, -0.7, -0.25, 0.8, -0.6])


def test_straps_pull_as_the_derivative_of_their_energy() -> None:
    """In air and at rest: what the springs add to the balance is -dV/dq, V of both legs and of one pelvis."""
    from casadi import Function, gradient, sumsqr

    model = strapped(SUBJECT, [replace(site, damping=0.0) for site in STRAP_SITES])
    e = model.equations
    every = np.r_[P, STRAP_PLANTED[:3], 0.3, STRAP_PLANTED[:3], 0.1]
    energy = model.energy + model.normal_energy
    count = np.array([LEGS, LEGS, 1.0])
    normal = sumsqr(model.straps * np.sqrt(count)) / (2.0 * STRAP_PARAMETERS[0].usual * np.exp(STRAP_PLANTED[0]))
    outputs = [e.balance, gradient(energy, e.q), energy, normal, model.normal_energy]
    both = Function("both", [e.q, e.u, e.a, e.w, e.p], outputs)
    still = np.zeros(9)
    soft = every.copy()
    soft[[7, 8, 9, 11, 12, 13, 15, 16, 17]] = -40.0
    at = (HIGH, still, still, np.zeros(6))
    with_strap, slope, stored, of_one_leg, of_both = (each.full().ravel() for each in both(*at, every))
    without, _, none, _, _ = (each.full().ravel() for each in both(*at, soft))
    assert stored[0] > 0.1 and none[0] < 1e-12
    np.testing.assert_allclose(of_one_leg, of_both, rtol=1e-12)
    np.testing.assert_allclose(with_strap - without, -slope, rtol=1e-9, atol=1e-9)


def test_straps_are_within_the_two_chains() -> None:
    """All of the weight along the foot's places, whatever the strap does; nothing is displaced upright."""
    from casadi import Function

    model = with_exoskeleton(SUBJECT)
    e = model.equations
    seen = Function("seen", [e.q, e.u, e.a, e.w, e.p], [e.balance, model.strap, model.energy])
    rng = np.random.default_rng(3)
    balance, strap, _ = (each.full().ravel() for each in seen(HIGH, rng.normal(size=9), np.zeros(9), np.zeros(6), P))
    stiff = P.copy()
    stiff[7:10] += 2.0
    other = seen(HIGH, rng.normal(size=9) * 0.0, np.zeros(9), np.zeros(6), stiff)[0].full().ravel()
    still = seen(HIGH, np.zeros(9), np.zeros(9), np.zeros(6), P)[0].full().ravel()
    weight = two_chains(SUBJECT).mass * 9.81
    assert weight == pytest.approx((70.0 + 14.0) * 9.81)
    np.testing.assert_allclose([still[:2], other[:2]], [[0.0, -weight]] * 2, atol=1e-6)
    assert abs(strap[0]) > 1.0 and np.isfinite(balance).all()
    upright = np.r_[0.0, 3.0, np.zeros(7)]
    _, none, energy = seen(upright, np.zeros(9), np.zeros(9), np.zeros(6), P)
    assert float(none) == pytest.approx(0.0, abs=1e-12) and float(energy) == pytest.approx(0.0, abs=1e-12)


def test_only_recorded_straps_count() -> None:
    """A trial with the pelvis alone: the cost of its strap channel is that of one deviation, whatever the others do."""
    from casadi import Function, symvar, vertcat

    model, noise, time = strapped(SUBJECT, STRAP_SITES), StandingNoise(), np.linspace(0.0, 1.0, 51)
    lost, none = np.full(51, np.nan), np.zeros((51, 9))
    none[:, 1] = 0.09
    sites = {"shank": lost, "pelvis": np.full(51, 7.0)}
    rest = (np.zeros((51, 2)), np.zeros(51), "T1", np.zeros((51, 6)), lost)
    trial = StandingTrial(time, none, 0.0 * none, *rest, elsewhere=sites)
    free = tuple(name for site in STRAP_SITES for name in site.names)
    phase = phase_b(model, SUBJECT, [trial], noise, EVERY_PLANTED, free=free)
    data = phase.control.trials[0].inputs(np.array([0.5]))[0]
    assert np.isfinite(data).all()
    e, term = model.equations, phase.terms["strap"]
    seen = [each for each in symvar(term) if each.name().split("_")[0] in ("values", "recorded", "share")]
    at = {each.name(): value for each, value in zip(symvar(phase.control.system.w), data, strict=True)}
    cost = Function("cost", [e.q, e.u, e.p, vertcat(*seen)], [term, model.straps])
    p = np.r_[EVERY_PLANTED, STRAP_PLANTED, STRAP_PLANTED[:3], 0.3, STRAP_PLANTED[:3], 0.1]
    found, straps = cost(HIGH, np.zeros(9), p, [at[each.name()] for each in seen])
    pelvis = float(straps.full().ravel()[2])
    assert abs(pelvis) > 5.0
    assert float(found) == pytest.approx(0.5 * ((pelvis - 7.0) / noise.strap) ** 2, rel=1e-9)
