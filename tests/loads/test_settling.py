"""Contact equilibrium on an elastic foundation: derivatives, a ball on a layer in closed form, what is not held."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from unittest.mock import Mock

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from geocontact.geometry.curvature import corner_normals, phong_offset
from geocontact.geometry.surface import Surface
from geocontact.geometry.surface_quadrature import surface_quadrature, thickness_below
from geocontact.io.mesh.meshes import read_mesh
from geocontact.loads import settling as energy_balance_room
from geocontact.loads import settling_potential
from geocontact.loads.foundation import LAWS, FoundationState, Layer, layer_loads
from geocontact.loads.settling import energy_balance, equilibrium, not_held, settle_along
from geocontact.loads.settling_potential import NAMES, AxialLoad, Bed, coordinates_of, placed_at, poses_of, total_at
from geocontact.loads.start_pose import lowest_places, pressing
from tests.cli.calls import FEMUR, INSERT
from tests.contact.sphere_on_layer import linear_force, logarithmic_force
from tests.geometry.bodies import cube, joined, surface
from tests.loads.test_foundation import R, ball, slab

M, H = 8e8, 5e-3
LAW = {"linear": linear_force, "logarithmic": logarithmic_force}
FREE = {name: np.isin(NAMES, name.split("+")) for name in ("axial", "axial+rotation")}
KNEE = np.array([name != "flexion" for name in NAMES])


def bed(fixed: Surface, moving: Surface, edge: float, law: str = "linear", region: float = 0.25) -> Bed:
    """Moving over the top of a body, with rays for the thickness and smooth facets."""
    pieces = surface_quadrature(fixed, edge, fixed.face_normal[:, 1] > region)
    height = phong_offset(fixed, corner_normals(fixed), pieces.face, pieces.point)
    halves = {"medial": pieces.point[:, 2] < 0.0, "lateral": pieces.point[:, 2] >= 0.0}
    layer = Layer(pieces, thickness_below(fixed, pieces.point, pieces.normal), M, law, halves, height)
    return Bed(layer, moving, corner_normals(moving), np.zeros(3))


@cache
def knee() -> tuple[Bed, Surface]:
    """The shipped pair, coarse."""
    moving, fixed = (Surface.of(read_mesh(file, "mm")) for file in (FEMUR, INSERT))
    return bed(fixed, moving, 0.5e-3), fixed


AT = np.array([-3.0e-3, 30.35e-3, 0.05e-3, -0.03, 0.01, 0.12])
"""Close to the first frame of the shipped cycle, a tenth of a millimetre deeper."""


@pytest.mark.parametrize("law", ["linear", "logarithmic"])
def test_forces_and_stiffness_are_derivatives_of_the_energy(law: str) -> None:
    """Central differences in all six coordinates; what is left are slopes that jump at the facets."""
    given, _ = knee()
    given = replace(given, layer=replace(given.layer, law=law))
    pull = AxialLoad(1000.0, np.array([2e4, 1e4, 1e4, 20.0, 20.0, 20.0]), AT + 1e-3)
    here = total_at(given, pull, AT)
    step = np.array([1e-6, 1e-6, 1e-6, 5e-5, 5e-5, 5e-5])
    ends = [[total_at(given, pull, AT + sign * step * unit) for sign in (1.0, -1.0)] for unit in np.eye(6)]
    slope = np.array([(a.potential - b.potential) for a, b in ends]) / (2.0 * step)
    bend = np.array([(a.slope - b.slope) for a, b in ends]) / (2.0 * step[:, None])
    scale = np.sqrt(np.abs(np.diag(here.stiffness)))
    np.testing.assert_allclose(here.slope, slope, atol=2e-3 * float(np.abs(slope).max()))
    np.testing.assert_allclose(here.stiffness / np.outer(scale, scale), bend / np.outer(scale, scale), atol=0.02)


@pytest.mark.parametrize("law", ["linear", "logarithmic"])
def test_a_ball_sinks_as_deep_as_the_closed_form_and_stores_the_work(law: str) -> None:
    """The energy is that of all points, so the force is 2 pi c w(d), c = R - d: less than along the layer's normals."""
    given, force = bed(slab(), ball(40), 0.25e-3, law), 1500.0
    deep = brentq(lambda d: _force(law, d) - force, 1e-6, 2e-3)
    assert _force(law, deep) == pytest.approx(LAW[law](R, deep, H, M), rel=0.015)
    high = np.array([0.0, R + 5e-3, 0.0, 0.0, 0.0, 0.0])
    pull = AxialLoad(force, np.zeros(6), high)
    at = pressing(given, high, slab())
    assert at is not None
    rest = equilibrium(given, pull, at, FREE["axial"])
    assert rest.converged and rest.residual < 1e-6 * force
    assert R - rest.total.values[1] == pytest.approx(deep, rel=2e-3)
    assert layer_loads(given.layer, rest.total.foundation)["total"].wrench.force[1] == pytest.approx(-force, rel=1e-6)
    balance = energy_balance(given, pull, rest, FREE["axial"])
    assert balance is not None and balance.difference < 2e-3
    assert balance.work == pytest.approx(_work(law, deep), rel=5e-3)
    assert not_held(rest.total.stiffness, FREE["axial+rotation"], force) == ("rotation",)
    assert not_held(rest.total.stiffness + np.diag([0, 0, 0, 20.0, 0, 0]), FREE["axial+rotation"], force) == ()


def test_where_lighter_loads_have_no_rest_the_axial_way_is_balanced(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is held does no work; springs of what is held are left out."""
    given, force = bed(slab(), ball(20), 0.5e-3), 800.0
    high = np.array([1e-3, R + 5e-3, 0.0, 0.0, 0.0, 0.0])
    free = np.isin(NAMES, ("axial", "anterior"))
    pull = AxialLoad(force, np.array([1e4, 0.0, 0.0, 0.0, 0.0, 0.0]), high)
    at = pressing(given, high, slab())
    assert at is not None
    rest = equilibrium(given, pull, at, free)
    along = energy_balance(given, pull, rest, free)
    lighter = energy_balance_room.equilibrium
    monkeypatch.setattr(
        energy_balance_room,
        "equilibrium",
        lambda *a: replace(lighter(*a), converged=False) if a[3].sum() > 1 else lighter(*a),
    )
    alone = energy_balance(given, pull, rest, free)
    assert along is not None and not along.alone and along.difference < 5e-3
    assert alone is not None and alone.alone and alone.difference < 5e-3
    assert alone.work == pytest.approx(along.work, rel=0.01)


def test_a_component_starts_where_it_lies_lowest() -> None:
    """A ball over a gap of 16 mm between two plates of other widths: in its middle, sqrt(R² - 8²) above their tops."""
    left, right = cube((-16.0, -2.5, 0.0), (8.0, 2.5, 12.0)), cube((14.0, -2.5, 0.0), (6.0, 2.5, 12.0))
    plates = surface(joined(left, right))
    found = lowest_places(bed(plates, ball(40), 2e-3), plates, np.array([0.0, 0.5]))
    np.testing.assert_allclose(found[:, 0], 0.0, atol=0.2e-3)
    np.testing.assert_allclose(found[:, 1], np.sqrt(R**2 - 8e-3**2), atol=0.1e-3)
    np.testing.assert_allclose(found[:, 3:], [[0.0, 0.0, 0.0], [0.0, 0.0, 0.5]], atol=1e-12)


def _force(law: str, deep: float) -> float:
    energy, _, _ = LAWS[law]
    return float(2.0 * np.pi * (R - deep) * energy(deep, H, M))


def _work(law: str, deep: float) -> float:
    return float(quad(lambda d: _force(law, d), 0.0, deep)[0])


def test_the_knee_finds_its_rest_wherever_it_starts() -> None:
    """Five free coordinates: no force left, both sides loaded, the same place from three starts; stiff springs hold."""
    given, fixed = knee()
    wanted, load = np.array([AT, AT, AT]), np.full(3, 1500.0)
    wanted[1] += [2e-3, 4e-3, -1e-3, 0.05, 0.03, 0.0]
    wanted[2, 1] += 0.2
    first, second, third = settle_along(given, fixed, wanted, load, np.zeros(6), KNEE, lambda _: None)
    for frame in (first, second, third):
        assert frame.rest is not None and frame.converged
        assert not_held(frame.rest.total.stiffness, KNEE, 1500.0) == ()
        loads = layer_loads(given.layer, frame.rest.total.foundation)
        np.testing.assert_allclose(loads["total"].wrench.force, [0.0, -1500.0, 0.0], atol=2.0)
        assert min(loads[side].pressing for side in ("medial", "lateral")) > 300.0
        np.testing.assert_allclose(frame.rest.total.values[:3], first.rest.total.values[:3], atol=2e-5)  # type: ignore[union-attr]
    stiff = np.full(6, 1e9)
    (held,) = settle_along(given, fixed, wanted[:1], load[:1], stiff * [1, 0, 1, 1, 1, 1], KNEE, lambda _: None)
    assert held.rest is not None
    np.testing.assert_allclose(held.rest.total.values[[0, 2, 3, 4]], AT[[0, 2, 3, 4]], atol=1e-5)


def test_coordinates_are_poses_and_back() -> None:
    values = np.array([AT, AT + np.array([1e-3, -2e-3, 3e-3, 0.2, -0.3, 1.5])])
    point = np.array([1e-3, 2e-3, -3e-3])
    np.testing.assert_allclose(coordinates_of(poses_of(values, point), point), values, atol=1e-12)
    turn = Rotation.from_euler("Y", values[1, 3]) * Rotation.from_euler("X", values[1, 4])
    expected = turn * Rotation.from_euler("Z", values[1, 5])
    assert (poses_of(values, point)[1].rotation.inv() * expected).magnitude() < 1e-12


def test_the_state_of_the_last_place_is_kept_and_no_other(monkeypatch: pytest.MonkeyPatch) -> None:
    """Searches begin where the one before ended; a place that differs in one digit is computed."""
    layer, places = bed(slab(), ball(4), 2e-3), []
    monkeypatch.setattr(
        settling_potential, "foundation_state", lambda *given: places.append(given) or Mock(FoundationState)
    )
    here, there = (placed_at(np.array([0.0, R - depth, 0.0, 0.0, 0.0, 0.0]), layer.point) for depth in (1e-4, 1.1e-4))
    first = layer.state(here)
    assert layer.state(here) is first and len(places) == 1
    assert layer.state(there) is not first and len(places) == 2
    assert layer.state(here) is not first and len(places) == 3
