"""Bushing: closed forms of the socket, energy, the site law of sit to stand, symbols beside numbers."""

from __future__ import annotations

import casadi
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from geocontact.chain.differentiated_inputs import recorded
from geocontact.contact.bushing import PISTONING, PRINTED, SOCKET, Bushing
from geocontact.systems.sit_to_stand import SITES
from tests.systems.examples import LEVERS, SITES_CONSTANTS, STIFFNESS, example


def test_50_newton_metres_turn_the_socket_by_5_degrees_and_the_printed_one_by_87_radians() -> None:
    for socket, turned in ((SOCKET, np.radians(5.0)), (PRINTED, 87.3)):
        torque = socket.load(np.array([0.0, 0.0, turned, 0.0, 0.0, 0.0]), np.zeros(6))[2]
        assert torque == pytest.approx(-50.0, rel=1e-3)


def test_900_newton_push_the_limb_34_mm_deep_in_seven_tenths_of_a_second() -> None:
    """F/k (1 - exp(-k t / c)), by integration of a limb of 1 g on the law."""

    def rate(_: float, state: np.ndarray) -> list[float]:
        q, u = np.zeros(6), np.zeros(6)
        q[4], u[4] = state
        return [state[1], (900.0 + SOCKET.load(q, u)[4]) / 1e-3]

    deep = solve_ivp(rate, (0.0, 0.7), [0.0, 0.0], method="Radau", rtol=1e-9, atol=1e-12).y[0, -1]
    assert deep == pytest.approx(900.0 / 20e3 * (1.0 - np.exp(-0.7 * 20e3 / 10e3)), rel=1e-6)
    assert deep == pytest.approx(34e-3, abs=0.2e-3)


def test_springs_do_the_work_that_they_store() -> None:
    """Along any way, large angles among them; the dashpots take c q'² besides."""
    t = np.linspace(0.0, 1.0, 4001)
    size = np.array([0.9, -0.4, 1.2, 0.02, -0.03, 0.01])[:, None]
    q, u = size * np.sin(3.0 * t + np.arange(6)[:, None]), 3.0 * size * np.cos(3.0 * t + np.arange(6)[:, None])
    springs = Bushing(SOCKET.stiffness, (0.0,) * 6)
    stored = springs.energy(q)
    work = sum(np.trapezoid(force * rate, t) for force, rate in zip(springs.load(q, u), u, strict=True))
    assert work == pytest.approx(stored[0] - stored[-1], rel=1e-6)
    lost = sum(np.trapezoid(force * rate, t) for force, rate in zip(SOCKET.load(q, u), u, strict=True)) - work
    assert lost == pytest.approx(-sum(np.trapezoid(c * r**2, t) for c, r in zip(SOCKET.damping, u, strict=True)))


def test_its_normal_part_is_the_site_law_of_sit_to_stand() -> None:
    """u = normal + rho rotation, F = k u + b u' at every site."""
    system, trials = example("sit_to_stand")
    forces = system.simulate(trials[0], system.start)
    moved = recorded(trials[0].signals, system.inputs)
    zero = np.zeros(len(trials[0]))
    for column, site in enumerate(SITES):
        normal, rotation = moved.row(f"{site}_normal"), moved.row(f"{site}_rotation")
        deep, rate = (each[normal] + LEVERS[site] * each[rotation] for each in (moved.position, moved.rate))
        damping = SITES_CONSTANTS["b"]
        strap = Bushing((0.0,) * 4 + (STIFFNESS[site], 0.0), (0.0,) * 4 + (damping, 0.0))
        ours = strap.load([zero] * 4 + [deep, zero], [zero] * 4 + [rate, zero])[4]
        size = np.abs(forces[:, column]).max()
        np.testing.assert_allclose(-ours, forces[:, column], rtol=1e-12, atol=1e-12 * size)


def test_limits_are_told_in_both_senses() -> None:
    far, fast = PISTONING.beyond(np.array([0.0, -36e-3, 36e-3]), np.array([0.11, -0.09, -0.11]))
    assert far.tolist() == [False, True, True] and fast.tolist() == [True, False, True]


def test_symbols_and_numbers_agree() -> None:
    q, u = casadi.SX.sym("q", 6), casadi.SX.sym("u", 6)
    at = casadi.Function("bushing", [q, u], [casadi.vertcat(*SOCKET.load(q, u))])
    values, rates = np.linspace(-0.1, 0.1, 6), np.linspace(0.3, -0.2, 6)
    np.testing.assert_allclose(np.array(at(values, rates)).ravel(), SOCKET.load(values, rates), rtol=1e-14)


@pytest.mark.parametrize("wrong", [-1.0, np.nan, np.inf])
def test_impossible_numbers_are_refused(wrong: float) -> None:
    with pytest.raises(ValueError, match="finite and not negative"):
        Bushing((wrong,) + (1.0,) * 5, (1.0,) * 6)
