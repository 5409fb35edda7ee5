"""Terms of the laws against closed forms: Maxwell branch, Dahl friction, play, slip, spring in series."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from geocontact.chain.contact_law import CONTACT_LAW, contact_force
from geocontact.chain.interface_law import INTERFACE_LAW, MEMORY, interface_force
from geocontact.chain.terms import (
    beyond_play,
    branch_force,
    direction_factor,
    friction_state,
    power_damping,
    slipped,
    stiffening_factor,
    stop_force,
    strap_tension,
    transmitted,
)


def along(time: np.ndarray, u: np.ndarray, **numbers: float) -> np.ndarray:
    """Force of the interface law along a deflection; underscores stand for the points of the slots' names."""
    sources = {next(n for n in INTERFACE_LAW.neutral if n.replace(".", "_") == key): v for key, v in numbers.items()}
    law = INTERFACE_LAW.having(sources).numbers({})
    old, new = np.zeros(MEMORY), np.zeros(MEMORY)
    rate = np.gradient(u, time)
    out = np.empty(u.size)
    for i in range(u.size):
        out[i] = interface_force(u[i], rate[i], time[i] - time[i - 1] if i else 0.0, law, old, new)
        old, new = new, old
    return out


@pytest.mark.parametrize("step", [0.5, 0.1, 0.013])
def test_maxwell_branch_is_exact_on_a_ramp_whatever_the_step(step: float) -> None:
    time = np.append(np.arange(0.0, 2.0, step), 2.0)
    got = along(time, 0.01 * time, k=200.0, relaxation_ratio=0.7, relaxation_tau=0.3)
    want = 200.0 * 0.01 * (time + 0.7 * 0.3 * (1.0 - np.exp(-time / 0.3)))
    np.testing.assert_allclose(got, want, rtol=1e-12, atol=1e-14)


def test_maxwell_branch_decays_after_a_step() -> None:
    time = np.concatenate(([0.0, 1e-9], np.linspace(0.1, 3.0, 30)))
    got = along(time, np.append(0.0, np.full(31, 0.02)), k=100.0, relaxation_ratio=0.5, relaxation_tau=0.8)
    np.testing.assert_allclose(got[1:], 2.0 * (1.0 + 0.5 * np.exp(-time[1:] / 0.8)), rtol=1e-7)


def maxwell_error(count: int) -> float:
    """Against the closed form for a sine, which is not linear between samples."""
    time = np.linspace(0.0, 4.0, count)
    tau, omega = 0.4, 3.0
    got = along(time, np.sin(omega * time), k=1.0, relaxation_ratio=1.0, relaxation_tau=tau) - np.sin(omega * time)
    a = (omega * tau) ** 2
    want = (omega * tau * np.cos(omega * time) + a * np.sin(omega * time)) / (1 + a)
    want -= omega * tau / (1 + a) * np.exp(-time / tau)
    return float(np.abs(got - want).max())


def test_maxwell_branch_is_of_second_order_on_a_sine() -> None:
    counts = np.array([41, 81, 161, 321])
    order = -np.polyfit(np.log(counts - 1.0), np.log([maxwell_error(n) for n in counts]), 1)[0]
    assert order == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("count", [9, 200])
def test_area_of_the_friction_loop(count: int) -> None:
    # Settled Dahl loop of amplitude A: z = 1 - c e^(-s/r), c = 2/(1 + e^(-2A/r)); area 2 F (2A - c r (1 - e^(-2A/r)))
    limit, reach, a = 3.0, 0.02, 0.05
    stroke = np.linspace(-a, a, count)
    path = np.concatenate([stroke, stroke[::-1][1:]] * 6)
    time = np.arange(path.size) * 0.1
    force = along(time, path, dry_friction_stroke_limit=limit, dry_friction_stroke_reach=reach)
    up, down = force[-2 * count + 1 : -count + 1], force[-count:]
    fades = np.exp(-2 * a / reach)
    c = 2.0 / (1.0 + fades)
    exact = limit * (1.0 - c * np.exp(-(stroke + a) / reach))
    np.testing.assert_allclose(up, exact, rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(down, -exact, rtol=1e-6, atol=1e-6)
    area = np.trapezoid(up, stroke) + np.trapezoid(down, stroke[::-1])
    if count > 100:
        assert area == pytest.approx(2 * limit * (2 * a - c * reach * (1 - fades)), rel=1e-3)


def test_friction_of_a_fast_motion_is_coulombs() -> None:
    time = np.linspace(0.0, 1.0, 11)
    force = along(time, 0.1 * time, dry_friction_rate_limit=2.0, dry_friction_rate_turning=0.002)
    np.testing.assert_allclose(force, 2.0, rtol=1e-12)
    slow = along(time, -0.001 * time, dry_friction_rate_limit=2.0, dry_friction_rate_turning=0.002)
    np.testing.assert_allclose(slow, -2.0 * np.tanh(0.5), rtol=1e-12)


def test_friction_of_a_long_stroke_is_coulombs() -> None:
    assert friction_state(-1.0, 5.0, 0.01) == pytest.approx(1.0, abs=1e-15)
    assert friction_state(0.3, 0.0, 0.01) == 0.3
    assert friction_state(0.0, -0.01, 0.01) == pytest.approx(-(1.0 - np.exp(-1.0)))


@pytest.mark.parametrize(("u", "want"), [(0.0, 0.0), (0.007, 0.0), (0.010, 0.002), (-0.002, 0.0), (-0.005, -0.003)])
def test_play_lies_where_its_share_puts_it(u: float, want: float) -> None:
    assert beyond_play(u, 0.010, 0.8) == pytest.approx(want, abs=1e-15)


def test_inside_the_play_nothing_acts() -> None:
    time = np.linspace(0.0, 1.0, 50)
    u = 0.004 * np.sin(9.0 * time)
    got = along(time, u, k=500.0, damping_b=50.0, dead_zone_width=0.01)
    np.testing.assert_array_equal(got, 0.0)


def test_an_open_contact_carries_nothing_before_its_gap_is_closed() -> None:
    time = np.linspace(0.0, 2.0, 201)
    u = 0.012 * np.sin(4.0 * time)
    got = along(time, u, k=5000.0, contact_loss_opening=20.0)
    np.testing.assert_allclose(got, 5000.0 * np.maximum(u - 0.004, 0.0), rtol=1e-12, atol=1e-12)
    other = along(time, -u, k=5000.0, contact_loss_opening=20.0, contact_loss_side=-1.0)
    np.testing.assert_allclose(other, -got, rtol=1e-12)


def test_a_contact_that_parts_fast_is_not_held_back_by_its_dashpot() -> None:
    time = np.linspace(0.0, 1.0, 1001)
    u = 0.01 - 0.02 * time
    got = along(time, u, k=1000.0, b=100.0, contact_loss_opening=0.0)
    np.testing.assert_allclose(got, np.maximum(1000.0 * u - 2.0, 0.0), atol=1e-12)
    assert along(time, u, k=1000.0, b=100.0)[-1] == pytest.approx(-12.0)  # the same, glued


def test_a_rounded_contact_closes_gradually() -> None:
    force = np.linspace(-20.0, 20.0, 401)
    got = np.array([transmitted(float(each), 5.0, 2.0, 1.0) for each in force])
    np.testing.assert_allclose(got * (got - (force - 5.0)), 0.25 * 2.0**2, rtol=1e-9)  # F (F - x) = r²/4
    assert (got > 0.0).all()
    sides = [transmitted(each, 1.0, 0.0, side) for each in (3.0, -3.0) for side in (1.0, -1.0)]
    assert sides == [2.0, 0.0, 0.0, -2.0]


def test_terms_by_hand() -> None:
    assert stiffening_factor(-0.02, 0.5, 2.0, 0.04) == pytest.approx(1.125)
    assert stop_force(0.05, 1000.0, 0.03, 1.0, 1.0, 1.0) == pytest.approx(20.0)
    assert stop_force(0.02, 1000.0, 0.03, 1.0, 1.0, 1.0) == 0.0
    assert stop_force(0.02, 1000.0, 0.03, -1.0, 1.0, 1.0) == pytest.approx(-10.0)
    assert stop_force(0.05, 1000.0, 0.03, 1.0, 1.5, 0.08) == pytest.approx(1000.0 * 0.08 * 0.25**1.5)
    assert stop_force(0.02, 1000.0, 0.03, 1.0, 1.5, 0.08) == 0.0
    assert power_damping(-0.3, 20.0, 1.0, 0.1) == pytest.approx(-6.0)
    assert power_damping(-0.4, 20.0, 0.5, 0.1) == pytest.approx(-4.0)  # linear at the reference, half of it at 4 times
    assert [strap_tension(u, 5.0, 100.0) for u in (0.1, 0.0, -0.005, -0.02)] == pytest.approx([5.0, 5.0, 2.5, 0.0])
    assert direction_factor(0.2, 0.1, 0.01) == pytest.approx(1.1)
    assert direction_factor(-0.2, 0.1, 0.01) == pytest.approx(0.9)
    assert branch_force(2.0, 0.0, 0.0, 1.0, 1.0) == 2.0


def creep(t: float, s: np.ndarray, k: float, mobility: float, limit: float) -> np.ndarray:
    force = k * (0.1 * np.sin(2.0 * t) - s)
    return mobility * np.sign(force) * np.maximum(np.abs(force) - limit, 0.0)


@pytest.mark.parametrize("mobility", [1e-4, 1e-2])
def test_slip_follows_its_differential_equation(mobility: float) -> None:
    k, limit = 300.0, 8.0
    right = partial(creep, k=k, mobility=mobility, limit=limit)
    exact = solve_ivp(right, (0.0, 6.0), [0.0], rtol=1e-9, atol=1e-12, max_step=0.005, method="LSODA")
    errors = []
    for count in (151, 301, 601):
        time = np.linspace(0.0, 6.0, count)
        u = 0.1 * np.sin(2.0 * time)
        s = 0.0
        for i in range(1, count):
            s = slipped(s, u[i - 1], u[i], time[i] - time[i - 1], k, mobility, limit)
        errors.append(abs(s - exact.y[0, -1]))
    assert errors[-1] < 2e-5
    assert errors[2] < 0.5 * errors[0]


def test_what_slips_freely_carries_no_more_than_its_limit_and_stays() -> None:
    time = np.linspace(0.0, 2.0, 401)
    force = along(time, 0.1 * np.minimum(time, 2.0 - time), k=300.0, slip_mobility=1e3, slip_limit=6.0)
    assert force.max() == pytest.approx(6.0, rel=1e-3)
    assert force.min() == pytest.approx(-6.0, rel=1e-3)  # slid along by 0.08 m, it pulls on the way back


def test_what_slides_is_not_damped() -> None:
    time = np.linspace(0.0, 2.0, 401)
    force = along(time, 0.1 * time, k=300.0, slip_mobility=1e3, slip_limit=6.0, damping_b=100.0)
    assert force[10] == pytest.approx(300.0 * 0.1 * time[10] + 10.0, rel=1e-9)
    assert force[-1] == pytest.approx(6.0, rel=1e-3)


def test_a_sphere_never_pulls() -> None:
    law = CONTACT_LAW.having({"n": 1.0, "delta_full": 0.002, "damping.b": 500.0, "damping.reference": 0.01}).numbers({})
    pressed, _, _ = contact_force(0.004, -0.2, 0.01, 1e4, 0.0, law, 0.0, 0.0)
    assert pressed == 0.0  # 40 N of spring, 100 N of damper
    pressed, _, _ = contact_force(0.004, 0.2, 0.01, 1e4, 0.0, law, 0.0, 0.0)
    assert pressed == pytest.approx(140.0)


def test_damping_under_a_sphere_grows_with_depth_by_its_exponent() -> None:
    numbers = {"n": 1.0, "delta_full": 0.002, "damping.b": 500.0, "damping.exponent": 1.5, "damping.reference": 0.01}
    law = CONTACT_LAW.having(numbers).numbers({})
    pressed, _, _ = contact_force(0.004, 0.2, 0.01, 0.0, 0.0, law, 0.0, 0.0)
    assert pressed == pytest.approx(100.0 * 0.4**1.5)


@given(st.floats(-0.1, 0.1), st.floats(-0.1, 0.1), st.floats(-0.02, 0.02), st.floats(1e-6, 1e3), st.floats(0.5, 10.0))
def test_slip_in_two_half_steps_is_slip_in_one(
    before: float, u: float, slip: float, mobility: float, limit: float
) -> None:
    middle = 0.5 * (before + u)
    whole = slipped(slip, before, u, 0.1, 300.0, mobility, limit)
    half = slipped(slipped(slip, before, middle, 0.05, 300.0, mobility, limit), middle, u, 0.05, 300.0, mobility, limit)
    both_ways = abs(u - before) > 2.0 * limit / 300.0 and (before - slip) * (u - before) < 0.0
    assert both_ways or half == pytest.approx(whole, abs=1e-9)
