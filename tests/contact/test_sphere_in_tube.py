"""A sphere in a tube: closed forms, the kink on the axis, directions, symbols, and the tube's own distance."""

from __future__ import annotations

from dataclasses import replace

import casadi
import numpy as np
import pytest

from geocontact.contact.sphere_foot import friction_coefficient
from geocontact.contact.sphere_in_tube import TubeLaw, tube_contact
from geocontact.dynamics.symbols import apply_numpy
from geocontact.geometry.shapes import Tube

LAW = TubeLaw(1e3, 10.0, 1e-3, 0.01, 1.0, 0.8, 5e-5)
ALONG = (1.0, 0.0, 0.0)
STILL = (0.0, 0.0, 0.0)


def test_a_sphere_at_rest_is_pressed_to_the_axis_by_a_linear_spring() -> None:
    found = tube_contact((0.03, 0.004, -0.003), STILL, ALONG, LAW)
    np.testing.assert_allclose(found.normal, (0.0, -4.0, 3.0), atol=1e-12)
    np.testing.assert_allclose(found.friction, 0.0)
    assert found.along == 0.03
    assert found.pressing == pytest.approx(1e3 * (np.hypot(0.005, 5e-5) - 5e-5))


def test_damping_acts_while_it_goes_outwards_only() -> None:
    out, back = (tube_contact((0.0, 0.005, 0.0), (0.0, v, 0.0), ALONG, LAW) for v in (0.2, -0.2))
    assert out.normal[1] == pytest.approx(-5.0 - 2.0, rel=1e-4)
    assert back.normal[1] == pytest.approx(-5.0, rel=1e-4)


@pytest.mark.parametrize("speed", [0.002, 0.01, 0.012, 0.05])
def test_friction_is_that_of_the_table_against_the_sliding(speed: float) -> None:
    """Along the tube and around it: what goes outwards does not count."""
    way = np.array([0.6, 0.0, 0.8])
    found = tube_contact((0.0, 0.02, 0.0), tuple(speed * way + [0.0, -0.3, 0.0]), ALONG, replace(LAW, rounding=1e-7))
    wanted = -friction_coefficient(speed, LAW.v_th, LAW.mu_s, LAW.mu_k) * 20.0 * way
    np.testing.assert_allclose(found.friction, wanted, rtol=1e-4, atol=1e-4)


def test_rounding_the_kink_costs_at_most_its_width() -> None:
    """Friction of the rounded law beside that of the kink, over the axis: the promised 0.05 N, and smooth."""
    across = np.linspace(-2e-3, 2e-3, 4001)
    zero = np.zeros_like(across)
    found = tube_contact((zero, across, zero), (zero + 0.01, zero, zero), ALONG, LAW)
    off = np.abs(-found.friction[0] - 1e3 * np.abs(across))
    assert 0.045 < off.max() <= 0.05
    slope = np.gradient(found.friction[0], across)
    assert np.abs(np.diff(slope)).max() < 25.0  # 2000 at the kink


def test_nothing_turns_with_the_axes() -> None:
    """Forces turn with tube, offset and velocity."""
    from scipy.spatial.transform import Rotation

    rng = np.random.default_rng(1)
    for _ in range(20):
        turn = Rotation.random(random_state=rng)
        offset, velocity = rng.normal(size=3) * 0.01, rng.normal(size=3) * 0.02
        here = tube_contact(tuple(offset), tuple(velocity), ALONG, LAW)
        there = tube_contact(tuple(turn.apply(offset)), tuple(turn.apply(velocity)), tuple(turn.apply(ALONG)), LAW)
        np.testing.assert_allclose(there.normal, turn.apply(here.normal), atol=1e-12)
        np.testing.assert_allclose(there.friction, turn.apply(here.friction), atol=1e-12)


def test_it_never_feeds_energy_beyond_its_spring() -> None:
    rng = np.random.default_rng(2)
    offset, velocity = rng.normal(size=(3, 500)) * 0.01, rng.normal(size=(3, 500)) * 0.05
    found = tube_contact(tuple(offset), tuple(velocity), ALONG, LAW)
    spring = -1e3 * np.array([np.zeros(500), offset[1], offset[2]])
    power = ((np.array(found.normal) - spring + np.array(found.friction)) * velocity).sum(axis=0)
    assert power.max() < 0.0


def test_symbols_and_numbers_agree_and_the_tube_knows_the_depth() -> None:
    apply_numpy()
    x = casadi.SX.sym("x", 6)
    law = replace(LAW, rounding=1e-9)
    made = tube_contact(tuple(x[i] for i in range(3)), tuple(x[i] for i in range(3, 6)), ALONG, law)
    run = casadi.Function("f", [x], [casadi.vertcat(made.pressing, *made.normal, *made.friction)])
    rng = np.random.default_rng(3)
    tube = Tube((0.0, 0.0, 0.0), (2.0, 0.0, 0.0), 0.05)
    for _ in range(20):
        offset, velocity = rng.normal(size=3) * 0.01, rng.normal(size=3) * 0.02
        numbers = tube_contact(tuple(offset), tuple(velocity), ALONG, law)
        wanted = [numbers.pressing, *numbers.normal, *numbers.friction]
        np.testing.assert_allclose(np.array(run([*offset, *velocity])).ravel(), wanted, rtol=1e-9, atol=1e-12)
        depth = 0.05 - tube.proximity(offset[None]).distance[0]  # of a sphere with the tube's radius
        still = tube_contact(tuple(offset), STILL, ALONG, law)
        assert still.pressing == pytest.approx(1e3 * depth, abs=2e-6)


@pytest.mark.parametrize("strap", [-3e-3, -6e-3, 2e-3, 1.5e-2])
def test_a_strap_and_a_play_are_a_ring_of_springs(strap: float) -> None:
    """Closed forms beside 4000 springs around the tube: force, what presses, and energy, whose slope is the force."""
    law, r, h = replace(LAW, rounding=1e-9, strap=strap, b=0.0), 5e-3, 1e-6
    found, more = (tube_contact((0.0, 0.6 * x, 0.8 * x), STILL, ALONG, law) for x in (r, r + h))
    angle = 2.0 * np.pi * (np.arange(4000) + 0.5) / 4000
    depth = np.maximum(r * np.cos(angle) + strap, 0.0)
    springs = 2.0 * law.k / np.pi * depth * 2.0 * np.pi / 4000
    assert np.linalg.norm(found.normal) == pytest.approx((springs * np.cos(angle)).sum(), rel=1e-5, abs=1e-5)
    assert found.normal[2] == pytest.approx(-0.8 * np.linalg.norm(found.normal), abs=1e-9)
    assert found.pressing == pytest.approx(0.25 * np.pi * springs.sum(), rel=1e-5, abs=1e-5)
    assert found.stored == pytest.approx(0.5 * (springs * depth).sum(), rel=1e-5, abs=1e-9)
    assert (more.stored - found.stored) / h == pytest.approx(np.linalg.norm(found.normal), rel=1e-3, abs=1e-5)
