"""The elastic foundation: its laws against each other and against the sphere on a layer in closed form."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.optimize import brentq

from geocontact.contact.elastic_foundation import (
    FULL,
    linear_energy,
    linear_pair_pressure,
    linear_pressure,
    linear_stiffness,
    logarithmic_energy,
    logarithmic_pair_pressure,
    logarithmic_pressure,
    logarithmic_stiffness,
)
from geocontact.geometry.shapes import Sphere
from geocontact.loads.pressure_load import PressureLoad, compartment_loads, pressure_load
from tests.contact.sphere_on_layer import linear_force, logarithmic_force

R, H, M, D = 20e-3, 5e-3, 8e8, 0.3e-3
strains, thicknesses = st.floats(1e-6, 0.9), st.floats(1e-3, 2e-2)
moduli = st.floats(6.0, 9.0).map(lambda power: 10.0**power)
Law = Callable[..., np.ndarray]


def triangles(edge: float, reach: float, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Centroids and areas of an irregular triangulation of the plane z = 0, finer in the middle, |x|, |y| < reach.

    On a mesh that is alike everywhere the error would fall faster than with the square of the edge: its leading term is
    the integral of edge^2 times the Laplacian of the pressure, which vanishes where the edge is constant.
    """
    rng = np.random.default_rng(seed)
    s = np.linspace(-1.0, 1.0, 2 * round(reach / edge) + 1)
    s[1:-1] += rng.uniform(-0.2, 0.2, len(s) - 2) * (s[1] - s[0])
    x = reach * s * (0.4 + 0.6 * s**2)
    grid = np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1)
    a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    corners = np.concatenate([np.stack(t, axis=-2).reshape(-1, 3, 2) for t in ((a, b, c), (a, c, d))])
    one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = 0.5 * np.abs(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0])
    return np.column_stack([corners.mean(axis=1), np.zeros(len(corners))]), area


def pressed(law: Law, edge: float, seed: int = 0) -> PressureLoad:
    """Load of a sphere sunk D into a layer z <= 0."""
    point, area = triangles(edge, 1.2 * np.sqrt(2.0 * R * D), seed)
    depth = -Sphere((0.0, 0.0, R - D), R).proximity(point).distance
    up = np.tile([0.0, 0.0, 1.0], (len(point), 1))
    return pressure_load(law(depth, H, M), area, up, point, "layer")


@given(strains, thicknesses, moduli)
def test_small_strains_are_linear_and_large_ones_stiffer(strain: float, h: float, m: float) -> None:
    linear, full = linear_pressure(strain * h, h, m), logarithmic_pressure(strain * h, h, m)
    assert linear == pytest.approx(m * strain, rel=1e-12)
    assert full == pytest.approx(-m * np.log1p(-strain), rel=1e-9)
    assert full >= linear * (1.0 - 1e-9)


@given(strains, thicknesses, moduli)
def test_two_equal_layers_are_one_of_double_thickness(strain: float, h: float, m: float) -> None:
    depth = strain * 2.0 * h
    assert linear_pair_pressure(depth, h, m, h, m) == pytest.approx(linear_pressure(depth, 2 * h, m), rel=1e-12)
    both = logarithmic_pair_pressure(depth, h, m, h, m)
    assert both == pytest.approx(logarithmic_pressure(depth, 2 * h, m), rel=1e-10)


@given(st.floats(1e-3, 0.9), thicknesses, moduli, thicknesses, moduli)
def test_two_layers_give_way_by_the_depth(strain: float, h: float, m: float, other: float, n: float) -> None:
    """Newton's answer against a bracketed root, moduli up to 1000 times apart."""
    depth = strain * (h + other)

    def off(p: float) -> float:
        return float(-h * np.expm1(-p / m) - other * np.expm1(-p / n) - depth)

    root = brentq(off, 0.0, 50.0 * max(m, n), xtol=1e-9, rtol=1e-14, maxiter=500)
    assert logarithmic_pair_pressure(depth, h, m, other, n) == pytest.approx(root, rel=1e-8)


def test_a_stiff_second_layer_is_not_there() -> None:
    depth = np.linspace(0.0, 0.8, 9) * H
    for pair, one in ((linear_pair_pressure, linear_pressure), (logarithmic_pair_pressure, logarithmic_pressure)):
        np.testing.assert_allclose(pair(depth, H, M, H, 1e6 * M), one(depth, H, M), rtol=1e-5)


def test_absurd_depths_stay_finite_and_without_a_kink() -> None:
    at, step = FULL * H, 1e-9
    for law, numbers in ((logarithmic_pressure, (H, M)), (logarithmic_pair_pressure, (H / 2, M, H / 2, M))):
        slopes = [(law(x + step, *numbers) - law(x, *numbers)) / step for x in (at - 2 * step, at + step)]
        assert slopes[1] == pytest.approx(slopes[0], rel=1e-4)
        assert np.isfinite(law(10.0 * H, *numbers))


def by_rings(law: Law) -> float:
    """The same force as an integral over rings of the plane."""
    far = np.sqrt(R**2 - (R - D) ** 2)
    return quad(lambda q: 2.0 * np.pi * q * law(R - np.hypot(q, R - D), H, M), 0.0, far, epsabs=1e-10)[0]


def test_closed_forms_are_the_integrals() -> None:
    assert linear_force(R, D, H, M) == pytest.approx(by_rings(linear_pressure), rel=1e-10)
    assert logarithmic_force(R, D, H, M) == pytest.approx(by_rings(logarithmic_pressure), rel=1e-10)
    assert linear_force(R, 1e-6, H, M) == pytest.approx(np.pi * R * 1e-12 * M / H, rel=1e-4), "Johnson, eq. 4.58"


@pytest.mark.parametrize(
    ("law", "closed"), [(linear_pressure, linear_force), (logarithmic_pressure, logarithmic_force)]
)
def test_sphere_on_a_layer_converges_at_second_order(law: Law, closed: Callable[..., float]) -> None:
    edge = np.array([8e-4, 4e-4, 2e-4, 1e-4, 5e-5])
    exact = closed(R, D, H, M)
    error = [np.sqrt(np.mean([(pressed(law, e, seed).pressing / exact - 1.0) ** 2 for seed in range(8)])) for e in edge]
    order = np.polyfit(np.log(edge), np.log(error), 1)[0]
    assert order == pytest.approx(2.0, abs=0.35), f"observed order {order:.2f}, errors {error}"
    assert error[2] < 2e-3, "0.2 mm edges on a patch of 3.5 mm radius"


def test_centre_and_moment_of_a_sphere_beside_the_origin() -> None:
    load = pressed(linear_pressure, 1e-4)
    np.testing.assert_allclose(load.centre, 0.0, atol=2e-6)
    np.testing.assert_allclose(load.wrench.force, [0.0, 0.0, -load.pressing], rtol=1e-12)
    np.testing.assert_allclose(load.wrench.moment, 0.0, atol=2e-6 * load.pressing)
    assert load.peak == pytest.approx(linear_pressure(D, H, M), rel=1e-3)
    assert load.area == pytest.approx(np.pi * (R**2 - (R - D) ** 2), rel=0.01)


def test_compartments_add_up_and_balance_about_the_common_centre() -> None:
    rng = np.random.default_rng(5)
    point, area = rng.normal(size=(400, 3)), rng.uniform(0.1, 1.0, 400)
    normal = rng.normal(size=(400, 3))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    pressure = np.maximum(rng.normal(size=400), 0.0)
    medial = point[:, 2] < 0.3
    whole = pressure_load(pressure, area, normal, point, "insert")
    parts = compartment_loads(pressure, area, normal, point, "insert", {"medial": medial, "lateral": ~medial})
    both = list(parts.values())
    assert sum(p.pressing for p in both) == pytest.approx(whole.pressing, rel=1e-12)
    np.testing.assert_allclose(sum(p.wrench.force for p in both), whole.wrench.force, rtol=1e-9)
    np.testing.assert_allclose(sum(p.wrench.moment for p in both), whole.wrench.moment, rtol=1e-9)
    centre = sum(p.pressing * p.centre for p in both) / whole.pressing
    np.testing.assert_allclose(centre, whole.centre, rtol=1e-9)
    assert parts["medial"].centre[2] < 0.3 < parts["lateral"].centre[2]


def test_nothing_presses() -> None:
    none = pressure_load(np.zeros(3), np.ones(3), np.eye(3), np.eye(3), "insert")
    assert (none.pressing, none.area, none.peak) == (0.0, 0.0, 0.0) and np.isnan(none.centre).all()


@pytest.mark.parametrize("strain", [1e-4, 0.3, 0.9, 1.2])
@pytest.mark.parametrize(
    ("pressure", "energy", "stiffness"),
    [
        (linear_pressure, linear_energy, linear_stiffness),
        (logarithmic_pressure, logarithmic_energy, logarithmic_stiffness),
    ],
)
def test_pressure_is_the_slope_of_the_energy_and_stiffness_that_of_the_pressure(
    pressure: Law, energy: Law, stiffness: Law, strain: float
) -> None:
    depth, step = strain * H, 1e-6 * strain * H
    stored = quad(lambda d: float(pressure(d, H, M)), 0.0, depth, points=[min(FULL * H, depth)], epsrel=1e-11)[0]
    assert energy(depth, H, M) == pytest.approx(stored, rel=1e-8)
    slope = (pressure(depth + step, H, M) - pressure(depth - step, H, M)) / (2.0 * step)
    assert stiffness(depth, H, M) == pytest.approx(slope, rel=1e-7)
    assert energy(-depth, H, M) == stiffness(-depth, H, M) == 0.0
