"""DMT and JKR: pull-off, the patch under a force, energy, and Hertz's law where nothing sticks."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from geocontact.contact.adhesion import (
    dmt_force,
    dmt_patch,
    dmt_pull_off,
    jkr_depth,
    jkr_force,
    jkr_patch,
    jkr_pull_off,
    tabor_number,
)
from geocontact.contact.hertz import point_force, point_radius

R, E, W = 37e-3, 5e6, 0.05
forces, works = st.floats(-1e-3, 1e3), st.floats(1e-3, 1.0)


def test_the_least_force_is_the_pull_off_force() -> None:
    least = minimize_scalar(lambda a: jkr_force(a, R, E, W), bounds=(1e-6, 2e-3), options={"xatol": 1e-12})
    assert least.fun == pytest.approx(jkr_pull_off(R, W), rel=1e-9) == pytest.approx(-1.5 * np.pi * W * R)
    assert least.x == pytest.approx((9.0 * np.pi * W * R**2 / (8.0 * E)) ** (1.0 / 3.0), rel=1e-5)
    assert dmt_force(1e-9, R, E, W) == pytest.approx(dmt_pull_off(R, W)) == pytest.approx(-2.0 * np.pi * W * R)
    assert dmt_patch(1.001 * dmt_pull_off(R, W), R, E, W) == jkr_patch(1.001 * jkr_pull_off(R, W), R, E, W) == 0.0


@given(forces, works)
def test_the_patch_under_a_force_undoes_the_force_on_a_patch(force: float, work: float) -> None:
    assume(force > dmt_pull_off(R, work))
    assert dmt_force(dmt_patch(force, R, E, work), R, E, work) == pytest.approx(force, rel=1e-9, abs=1e-12)
    assume(force > jkr_pull_off(R, work))
    assert jkr_force(jkr_patch(force, R, E, work), R, E, work) == pytest.approx(force, rel=1e-9, abs=1e-9)


@given(st.floats(1e-5, 5e-3))
def test_without_work_of_adhesion_it_is_hertz(a: float) -> None:
    hertz = point_force(a**2 / R, R, E)
    assert jkr_force(a, R, E, 0.0) == pytest.approx(hertz) == pytest.approx(dmt_force(a, R, E, 0.0))
    assert jkr_patch(hertz, R, E, 0.0) == pytest.approx(point_radius(hertz, R, E)) == pytest.approx(a)
    assert jkr_depth(a, R, E, 0.0) == pytest.approx(a**2 / R)


def test_the_way_of_a_jkr_contact_stores_what_the_force_does_less_the_surface_energy() -> None:
    """At fixed depth dU/da = 2 pi a w (Griffith), so the work to a patch is strain energy less w pi a^2."""
    a, step = 2e-3, 1e-9

    def slope(x: float) -> float:
        return float((jkr_depth(x + step, R, E, W) - jkr_depth(x - step, R, E, W)) / (2.0 * step))

    work = quad(lambda x: jkr_force(x, R, E, W) * slope(x), 2e-8, a, epsrel=1e-9)[0]
    depth = jkr_depth(a, R, E, W)
    # a flat punch pulled back by `back` from Hertz's depth of this patch
    back = a**2 / R - depth
    strain = 8.0 * E * a**5 / (15.0 * R**2) - 4.0 / 3.0 * E * a**3 / R * back + E * a * back**2
    assert work == pytest.approx(strain - W * np.pi * a**2, rel=1e-5)


def test_the_tabor_number_tells_soft_and_large_from_stiff_and_small() -> None:
    assert tabor_number(R, E, W, 0.3e-9) > 5.0 > 0.1 > tabor_number(1e-8, 1e11, W, 0.3e-9)
