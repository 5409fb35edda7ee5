"""Wrenches of mats against closed forms, with the order at which they converge as cells and meshes are refined."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.data.wrench import Wrench
from geocontact.loads.mat_load import mat_load
from geocontact.loads.mat_map import mat_map
from tests.loads.test_mat import cap, cylinder, hertz, on_cylinder, sheet

R, TUBE = 0.1, 0.08  # m, of the sphere and of the cylinder in test_mat
TOP = np.array([0.0, 0.0, R])


def order(sizes: np.ndarray, errors: list[float]) -> float:
    """Slope of the errors over the size."""
    return float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])


def on_sphere(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return R * np.stack([np.sin(a) * np.cos(b), np.sin(b), np.cos(a) * np.cos(b)], axis=-1)


def sphere_cells(count: int, a: tuple[float, float], b: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Corners of count x count cells between longitudes a and latitudes b, and the cells' areas on the sphere."""
    u, v = np.linspace(*a, count + 1), np.linspace(*b, count + 1)
    nodes = on_sphere(*np.meshgrid(u, v, indexing="ij"))
    return nodes, R**2 * np.outer(np.diff(u), np.diff(np.sin(v)))


def wrench(surface, nodes, area, pressure, origin) -> tuple[Wrench, np.ndarray]:
    """Wrench and centre of one frame; `pressure` is a function of points."""
    placed = mat_map(surface, nodes, np.ones(area.shape, bool), area)
    load = mat_load(placed, pressure(placed.centre)[None], origin, "closed form")
    return load.wrench, load.centre[0]


def gauss(low: float, high: float, count: int = 200) -> tuple[np.ndarray, np.ndarray]:
    """Points and weights of Gauss' rule between two ends."""
    x, w = np.polynomial.legendre.leggauss(count)
    return 0.5 * (low + high) + 0.5 * (high - low) * x, 0.5 * (high - low) * w


def test_uniform_pressure_on_a_patch_of_the_sphere_converges_at_second_order_of_the_cells() -> None:
    """F = -p int n dA over longitudes a and latitudes b; n dA = R^2 n cos b da db. Arms from the top."""
    a, b, p = (0.05, 0.65), (-0.2, 0.5), 1e4
    (u, wu), (v, wv) = gauss(*a), gauss(*b)
    weight = R**2 * np.outer(wu, wv * np.cos(v))
    points = on_sphere(*np.meshgrid(u, v, indexing="ij"))
    push = -p * weight[..., None] * points / R
    force, moment = push.sum(axis=(0, 1)), np.cross(points - TOP, push).sum(axis=(0, 1))
    centre = np.einsum("ij,ijk->k", weight, points) / weight.sum()
    # closed: int cos^2 b db and sin a between the ends
    square = 0.5 * (b[1] - b[0] + 0.5 * (np.sin(2 * b[1]) - np.sin(2 * b[0])))
    closed = -p * R**2 * (np.sin(a[1]) - np.sin(a[0])) * square
    assert force[2] == pytest.approx(closed, rel=1e-12)
    surface, counts, errors = cap(300), np.array([2, 4, 8]), []
    for count in counts:
        found, at = wrench(surface, *sphere_cells(int(count), a, b), lambda x: np.full(len(x), p), TOP)
        errors.append(
            (
                np.linalg.norm(found.force[0] - force) / np.linalg.norm(force),
                np.linalg.norm(found.moment[0] - moment) / np.linalg.norm(moment),
                np.linalg.norm(at - centre) / R,
            )
        )
    assert np.max(errors[-1]) < 1e-3, errors
    for k, what in enumerate(("force", "moment", "centre")):
        fall = [each[k] for each in errors]
        assert order(1.0 / counts, fall) > 1.6 or max(fall) < 1e-4, f"{what}: {fall}"


@pytest.mark.parametrize("tilt", [0.0, 0.25], ids=["on top", "off centre"])
def test_hertz_pressure_on_a_sphere_converges_in_force_centre_and_moment(tilt: float) -> None:
    """p0 sqrt(1 - (r/a)^2), r from the axis c: 2/3 pi a^2 p0 against c exactly (dA projects onto the disc), no moment
    about the sphere's middle; the centre by quadrature over the cap."""
    a, peak = 0.03, 2e4
    axis = np.array([np.sin(tilt), 0.0, np.cos(tilt)])
    side = np.array([np.cos(tilt), 0.0, -np.sin(tilt)])

    def pressure(x: np.ndarray) -> np.ndarray:
        return hertz(np.column_stack([x @ side, x[:, 1]]), a, peak)

    force = -2.0 / 3.0 * np.pi * a**2 * peak * axis
    r, w = gauss(0.0, 1.0)
    r, w = a * np.sqrt(1.0 - r**2), w * r * a**2  # r dr over the disc, the root taken out
    height = np.sqrt(R**2 - r**2)
    load = peak * np.sqrt(1.0 - (r / a) ** 2) * R / height * w
    centre = axis * float(load @ height / load.sum())
    origin = np.array([0.02, -0.01, 0.0])
    moment = np.cross(-origin, force)
    counts, errors = np.array([12, 24, 48]), []
    for count in counts:
        nodes, area = sphere_cells(int(count), (tilt - 0.37, tilt + 0.37), (-0.37, 0.37))
        found, at = wrench(cap(240), nodes, area, pressure, origin)
        errors.append(
            [
                np.linalg.norm(found.force[0] - force) / np.linalg.norm(force),
                np.linalg.norm(found.moment[0] - moment) / np.linalg.norm(moment),
                np.linalg.norm(at - centre) / R,
            ]
        )
    assert np.max(errors[-1]) < 1.5e-3, errors
    for k, what in enumerate(("force", "moment")):
        fall = [each[k] for each in errors]
        # the root at the edge leaves 3/2 of the order 2 of a smooth pressure
        assert order(1.0 / counts, fall) > 1.3, f"{what}: {fall}"


def test_facets_of_a_cylinder_cost_force_and_moment_at_second_order_of_their_edges() -> None:
    """Fine cells on coarse meshes: what is left is what the mesh lacks. Uniform p on |angle| <= 0.6, 0.12 m long."""
    half, low, high, p = 0.6, -0.02, 0.1, 1e4
    force = np.array([0.0, 0.0, -2.0 * p * TUBE * (high - low) * np.sin(half)])
    origin = np.array([0.0, 0.03, 0.0])
    moment = np.cross([0.5 * (low + high), 0.0, 0.0] - origin, force)  # it acts through the axis
    x, angle = np.meshgrid(np.linspace(low, high, 13), np.linspace(-half, half, 25), indexing="ij")
    nodes, area = on_cylinder(x, angle), np.full((12, 24), (high - low) * 2.0 * half * TUBE / (12 * 24))
    sizes, errors = np.array([6, 12, 24]), []
    for n in sizes:
        found, _ = wrench(cylinder(int(n)), nodes, area, lambda y: np.full(len(y), p), origin)
        errors.append(np.linalg.norm(np.concatenate([found.force[0] - force, (found.moment[0] - moment) / 0.08])))
    assert errors[-1] < 5e-4 * np.linalg.norm(force), errors
    assert order(1.0 / sizes, errors) > 1.6, errors


def test_a_linear_pressure_on_a_plane_converges_at_second_order_in_moment_and_centre() -> None:
    """p = c x on 0.05 <= x <= 0.25, 0.02 <= y <= 0.18: F = c w (x2^2 - x1^2)/2 downwards; M_y = c w (x2^3 - x1^3)/3."""
    c, x1, x2, y1, y2 = 4e4, 0.05, 0.25, 0.02, 0.18
    flat = sheet(np.linspace(0.0, 0.3, 7), np.linspace(0.0, 0.2, 5), lambda a, b: np.stack([a, b, 0.0 * a], -1), "p")
    force = c * (y2 - y1) * (x2**2 - x1**2) / 2.0
    moment = np.array([-0.5 * (y1 + y2) * force, c * (y2 - y1) * (x2**3 - x1**3) / 3.0, 0.0])
    counts, errors = np.array([2, 4, 8, 16]), []
    for count in counts:
        x, y = np.meshgrid(np.linspace(x1, x2, count + 1), np.linspace(y1, y2, count + 1), indexing="ij")
        area = np.full((count, count), (x2 - x1) * (y2 - y1) / count**2)
        nodes = np.stack([x, y, 0.0 * x], -1)
        found, at = wrench(flat, nodes, area, lambda z: c * z[:, 0], np.zeros(3))
        assert found.force[0] == pytest.approx([0.0, 0.0, -force], abs=1e-9 * force)
        errors.append((np.linalg.norm(found.moment[0] - moment), abs(at[0] - moment[1] / force)))
    for k in range(2):
        fall = [each[k] for each in errors]
        assert order(1.0 / counts, fall) == pytest.approx(2.0, abs=0.02), fall
