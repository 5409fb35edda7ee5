"""Hertz: numbers from a textbook, closed forms, and the integral equation that they solve."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.special import ellipkm1

from geocontact.contact.elasticity import layer_modulus, plane_modulus
from geocontact.contact.hertz import (
    ellipse_force,
    ellipse_half_axis,
    ellipse_peak_pressure,
    ellipse_shape,
    line_half_width,
    line_load,
    line_peak_pressure,
    point_force,
    point_peak_pressure,
    point_radius,
)
from tests.contact.half_space import by_root, displacement, semi_ellipse

R, E, D = 37e-3, 1e9, 2e-4
ratios = st.floats(0.0, 8.0).map(lambda power: 10.0**power)


def test_moduli_of_bone_cement_and_steel() -> None:
    """A layer of nu = 0.46 is five times as stiff as a free strip of it."""
    assert plane_modulus(4.67e9, 0.25) == pytest.approx(4.67e9 / 0.9375, rel=1e-15)
    assert layer_modulus(5e8, 0.0) == 5e8
    assert layer_modulus(5e8, 0.46) == pytest.approx(0.54 * 5e8 / (1.46 * 0.08), rel=1e-14)


def test_point_contact_of_a_worked_example() -> None:
    """Ball of 10 mm radius on a flat, both of steel (210 GPa, 0.3), 100 N: a 0.187 mm, p0 1.37 GPa (by hand)."""
    modulus = 0.5 * plane_modulus(210e9, 0.3)  # 1/E* is the sum of both bodies' (1 - nu^2)/E
    a, p0 = point_radius(100.0, 10e-3, modulus), point_peak_pressure(100.0, 10e-3, modulus)
    assert a == pytest.approx((3 * 100.0 * 10e-3 / (4 * 210e9 / 1.82)) ** (1 / 3), rel=1e-14)
    assert (a, p0) == (pytest.approx(0.1866e-3, rel=1e-3), pytest.approx(1.371e9, rel=1e-3))


@given(st.floats(1e-6, 1e-3), st.floats(1e-3, 0.1), st.floats(1e5, 1e11))
def test_point_laws_belong_together(depth: float, radius: float, modulus: float) -> None:
    force = point_force(depth, radius, modulus)
    a, p0 = point_radius(force, radius, modulus), point_peak_pressure(force, radius, modulus)
    assert a**2 / radius == pytest.approx(depth, rel=1e-12)
    assert p0 == pytest.approx(1.5 * force / (np.pi * a**2), rel=1e-12)
    carried = quad(lambda t: a * np.sin(t) * semi_ellipse(a * np.sin(t), a, p0) * a * np.cos(t), 0.0, np.pi / 2)[0]
    assert 2.0 * np.pi * carried == pytest.approx(force, rel=1e-9)


def test_point_pressure_makes_the_surface_meet_the_sphere() -> None:
    """d - r^2/(2R) in the whole patch: the condition that Hertz solved."""
    force = point_force(D, R, E)
    a, p0 = point_radius(force, R, E), point_peak_pressure(force, R, E)
    for share in (0.0, 0.3, 0.9):
        assert displacement(share * a, 0.0, a, a, p0, E) == pytest.approx(D - (share * a) ** 2 / (2 * R), rel=1e-10)


@given(st.floats(1.0, 1e6), st.floats(1e-3, 0.1), st.floats(1e5, 1e11))
def test_line_laws_belong_together(load: float, radius: float, modulus: float) -> None:
    b, p0 = line_half_width(load, radius, modulus), line_peak_pressure(load, radius, modulus)
    assert line_load(b, radius, modulus) == pytest.approx(load, rel=1e-12)
    assert 0.5 * np.pi * b * p0 == pytest.approx(load, rel=1e-12)


def test_line_pressure_bends_the_surface_as_the_cylinder_is_bent() -> None:
    """Slope of the half-space under p is -2/(pi E*) times the principal value of p(s)/(x - s): here x/R, by hand.

    With p = p0 sqrt(1 - s^2/b^2) the principal value is pi p0 x / b, so 2 p0 / (E* b) = 1/R.
    """
    load = 4e4
    b, p0 = line_half_width(load, R, E), line_peak_pressure(load, R, E)
    x = 0.4 * b

    def regular(s: float) -> float:
        return float((semi_ellipse(s, b, p0) - semi_ellipse(x, b, p0)) / (x - s)) if s != x else 0.0

    whole = quad(regular, -b, b, points=[x], limit=400)[0] + semi_ellipse(x, b, p0) * np.log((b + x) / (b - x))
    assert 2.0 / (np.pi * E) * whole == pytest.approx(x / R, rel=1e-6)


@pytest.mark.parametrize("ratio", [1.01, 1.5, 3.0, 10.0, 100.0, 1e4])
def test_ellipse_is_the_exact_solution(ratio: float) -> None:
    ours, exact = ellipse_shape(ratio), by_root(ratio)
    np.testing.assert_allclose(ours, exact, rtol=1e-10)


@given(ratios)
def test_axis_ratio_solves_its_equation(ratio: float) -> None:
    q, k, s = ellipse_shape(ratio)
    assert (1.0 - s) / (q * q * s) == pytest.approx(ratio, rel=1e-12)
    assert k == pytest.approx(float(ellipkm1(q * q)), rel=1e-12)
    assert 0.5 <= s < 1.0 and 0.0 < q <= 1.0


def test_ellipse_of_equal_curvatures_is_the_circle() -> None:
    q, k, s = ellipse_shape(1.0)
    assert (q, k, s) == (1.0, pytest.approx(np.pi / 2, rel=1e-15), 0.5)
    assert ellipse_force(D, 0.5 / R, E, k, s) == pytest.approx(point_force(D, R, E), rel=1e-14)


@pytest.mark.parametrize("ratio", [1.0, 2.0, 25.0])
def test_elliptical_pressure_makes_the_surfaces_meet(ratio: float) -> None:
    """d - A x^2 - B y^2 in the whole patch, by Boussinesq's integral: independent of Johnson's formulas."""
    flatter = 4.0
    q, k, s = ellipse_shape(ratio)
    a = ellipse_half_axis(D, flatter, s)
    p0 = ellipse_peak_pressure(D, a, q, k, E)
    for x, y in ((0.0, 0.0), (0.5, 0.0), (0.0, 0.7), (0.6, -0.5)):
        there = displacement(x * a, y * q * a, a, q * a, p0, E)
        assert there == pytest.approx(D - flatter * (x * a) ** 2 - ratio * flatter * (y * q * a) ** 2, rel=1e-8)
    assert ellipse_force(D, flatter, E, k, s) == pytest.approx(2.0 / 3.0 * np.pi * a * q * a * p0, rel=1e-13)
