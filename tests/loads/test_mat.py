"""Pressure mats on surfaces whose loads are known in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.geometry.register.quality import PoseCovariance
from geocontact.geometry.surface import Surface
from geocontact.loads.mat_load import MatErrors, mat_load, segment_loads, unloaded, wrench_covariance
from geocontact.loads.mat_map import MatMap, mat_map

HALF = 0.6  # rad, of the cylinder and the cap that the mat spans
RADIUS, LENGTH = 0.08, 0.2


def sheet(u: np.ndarray, v: np.ndarray, place, name: str) -> Surface:
    """A grid of triangles over parameters; `place(u, v)` gives points, outward where u × v points outward."""
    a, b = np.meshgrid(u, v, indexing="ij")
    vertices = place(a, b).reshape(-1, 3)
    k = np.arange(len(u) * len(v)).reshape(len(u), len(v))
    one = np.stack([k[:-1, :-1], k[1:, :-1], k[1:, 1:]], axis=-1).reshape(-1, 3)
    two = np.stack([k[:-1, :-1], k[1:, 1:], k[:-1, 1:]], axis=-1).reshape(-1, 3)
    return Surface(vertices, np.concatenate([one, two]), name)


def on_cylinder(x: np.ndarray, angle: np.ndarray) -> np.ndarray:
    return np.stack([x, RADIUS * np.sin(angle), RADIUS * np.cos(angle)], axis=-1)


def cylinder(n: int) -> Surface:
    return sheet(np.linspace(-0.12, 0.12, n), np.linspace(-0.9, 0.9, 2 * n), on_cylinder, "cylinder")


def nodes_on_cylinder(rows: int, columns: int) -> np.ndarray:
    x, angle = np.meshgrid(np.linspace(-0.1, 0.1, rows + 1), np.linspace(-HALF, HALF, columns + 1), indexing="ij")
    return on_cylinder(x, angle)


def everywhere(rows: int, columns: int, area: float) -> tuple[np.ndarray, np.ndarray]:
    return np.ones((rows, columns), bool), np.full((rows, columns), area)


def cylinder_map(n: int, rows: int = 8, columns: int = 6, parts: int | None = None) -> MatMap:
    area = LENGTH * 2.0 * HALF * RADIUS / (rows * columns)
    return mat_map(cylinder(n), nodes_on_cylinder(rows, columns), *everywhere(rows, columns, area), parts=parts)


def test_uniform_pressure_on_a_plane_is_exact() -> None:
    flat = sheet(np.linspace(0.0, 0.3, 7), np.linspace(0.0, 0.2, 5), lambda a, b: np.stack([a, b, 0.0 * a], -1), "p")
    x, y = np.meshgrid(np.linspace(0.05, 0.25, 5), np.linspace(0.02, 0.18, 9), indexing="ij")
    placed = mat_map(flat, np.stack([x, y, 0.0 * x], -1), *everywhere(4, 8, 0.2 * 0.16 / 32))
    load = mat_load(placed, np.full((1, 32), 5e3), np.array([0.1, 0.0, 0.3]), "plane")
    np.testing.assert_allclose(load.wrench.force, [[0.0, 0.0, -5e3 * 0.032]], atol=1e-9)
    np.testing.assert_allclose(load.wrench.moment, [np.cross([0.05, 0.1, -0.3], [0.0, 0.0, -160.0])], atol=1e-9)
    np.testing.assert_allclose(load.centre, [[0.15, 0.1, 0.0]], atol=1e-12)
    assert load.pressing[0] == pytest.approx(160.0) and load.perpendicular[0] == pytest.approx(160.0)
    assert load.area[0] == pytest.approx(0.032) and load.peak[0] == 5e3 and load.mean[0] == pytest.approx(5e3)


@pytest.mark.parametrize("n", [12, 24, 48])
def test_uniform_pressure_on_a_cylinder_hardly_feels_the_facets(n: int) -> None:
    # force of pressure p on |angle| <= HALF: p L int R cos = 2 p R L sin(HALF), downwards; no moment about the axis
    exact = 2.0 * RADIUS * LENGTH * np.sin(HALF)
    load = mat_load(cylinder_map(n, parts=8), np.full((1, 48), 1.0), np.zeros(3), "cylinder")
    assert -load.wrench.force[0, 2] == pytest.approx(exact, rel=1e-4)
    assert abs(load.wrench.force[0, 1]) < 1e-9 and abs(load.wrench.moment[0]).max() < 1e-6
    assert load.pressing[0] == pytest.approx(2.0 * RADIUS * LENGTH * HALF)


@pytest.mark.slow
def test_parts_of_a_cell_converge_at_second_order() -> None:
    exact = 2.0 * RADIUS * LENGTH * np.sin(HALF)
    fine, parts = cylinder(400), np.array([1, 2, 4, 8])
    area = LENGTH * 2.0 * HALF * RADIUS / 4
    off = []
    for n in parts:
        placed = mat_map(fine, nodes_on_cylinder(2, 2), *everywhere(2, 2, area), parts=int(n))
        off.append(abs(-placed.force.sum(axis=0)[2] - exact) / exact)
    order = -np.polyfit(np.log(parts), np.log(off), 1)[0]
    assert order == pytest.approx(2.0, abs=0.3), f"observed order {order:.2f}, errors {off}"


def cap(n: int) -> Surface:
    def place(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return 0.1 * np.stack([np.sin(a) * np.cos(b), np.sin(b), np.cos(a) * np.cos(b)], axis=-1)

    return sheet(np.linspace(-0.9, 0.9, n), np.linspace(-0.9, 0.9, n), place, "sphere")


def cap_nodes(count: int, half: float) -> np.ndarray:
    a, b = np.meshgrid(np.linspace(-half, half, count + 1), np.linspace(-half, half, count + 1), indexing="ij")
    return 0.1 * np.stack([np.sin(a) * np.cos(b), np.sin(b), np.cos(a) * np.cos(b)], axis=-1)


def hertz(point: np.ndarray, radius: float, peak: float) -> np.ndarray:
    """p0 sqrt(1 - (r/a)^2) with r the distance from the axis z."""
    r2 = (point[..., 0] ** 2 + point[..., 1] ** 2) / radius**2
    return peak * np.sqrt(np.maximum(1.0 - r2, 0.0))


def test_hertz_pressure_on_a_sphere_gives_force_centre_and_moment() -> None:
    # vertical force: the projection of dA is dx dy, so it is 2/3 p0 pi a^2 exactly; by symmetry no moment about the top
    a, peak = 0.03, 2e4
    exact = 2.0 / 3.0 * peak * np.pi * a**2
    counts, off = np.array([16, 32, 64]), []
    surface = cap(160)
    for count in counts:
        nodes = cap_nodes(int(count), 0.45)
        b = np.linspace(-0.45, 0.45, int(count) + 1)
        area = np.tile(0.01 * (0.9 / count) * np.diff(np.sin(b)), (int(count), 1))
        placed = mat_map(surface, nodes, np.ones((count, count), bool), area)
        load = mat_load(placed, hertz(placed.centre, a, peak)[None], np.array([0.0, 0.0, 0.1]), "sphere")
        off.append(abs(-load.wrench.force[0, 2] - exact) / exact)
        np.testing.assert_allclose(load.wrench.moment[0], 0.0, atol=2e-4)
        np.testing.assert_allclose(load.centre[0, :2], 0.0, atol=1e-5)
        about = mat_load(placed, hertz(placed.centre, a, peak)[None], np.array([0.02, 0.0, 0.1]), "sphere")
        assert about.wrench.moment[0, 1] == pytest.approx(-0.02 * exact, rel=0.02)
    assert off[-1] < 2e-3 and off[-1] < off[0], off


def test_pressing_is_conserved_on_the_faces() -> None:
    surface = cylinder(40)
    placed = mat_map(surface, nodes_on_cylinder(8, 6), *everywhere(8, 6, 2e-4))
    pressure = np.random.default_rng(0).uniform(0.0, 3e4, (20, 48))
    on_faces = placed.face_pressure(pressure, surface.face_area)
    np.testing.assert_allclose(on_faces @ surface.face_area, (pressure * 2e-4).sum(axis=1), rtol=1e-12)


def test_uniform_pressure_is_about_uniform_on_the_faces_inside() -> None:
    surface = cylinder(40)
    area = LENGTH * 2.0 * HALF * RADIUS / 48
    placed = mat_map(surface, nodes_on_cylinder(8, 6), *everywhere(8, 6, area))
    on_faces = placed.face_pressure(np.ones((1, 48)), surface.face_area)[0]
    middle = surface.vertices[surface.faces].mean(axis=1)
    inside = (np.abs(middle[:, 0]) < 0.08) & (np.abs(np.arctan2(middle[:, 1], middle[:, 2])) < 0.5)
    assert on_faces[inside].mean() == pytest.approx(1.0, abs=0.02)
    assert on_faces[inside].std() < 0.05 and on_faces.max() < 1.02
    outside = (np.abs(middle[:, 0]) > 0.11) | (np.abs(np.arctan2(middle[:, 1], middle[:, 2])) > 0.7)
    assert (on_faces[outside] == 0.0).all()


def test_segments_add_up_and_dead_or_hanging_cells_are_left_out() -> None:
    nodes = nodes_on_cylinder(8, 6)
    nodes[-1, :] = np.nan  # the last row hangs over
    valid, area = everywhere(8, 6, 2e-4)
    valid[2, 3] = False
    placed = mat_map(cylinder(40), nodes, valid, area)
    assert len(placed.cell) == 7 * 6 - 1
    assert placed.left_out.sum() == 6 and placed.left_out[7].all()
    pressure = np.random.default_rng(1).uniform(0.0, 2e4, (5, 8, 6))
    pressure[:, 2, 3] = np.nan
    of = placed.of(pressure)
    upper = placed.cell[:, 0] < 4
    parts = segment_loads(placed, of, np.zeros(3), "c", {"upper": upper, "lower": ~upper})
    whole = mat_load(placed, of, np.zeros(3), "c")
    np.testing.assert_allclose(
        parts["upper"].wrench.moment + parts["lower"].wrench.moment, whole.wrench.moment, atol=1e-12
    )
    np.testing.assert_allclose(parts["upper"].pressing + parts["lower"].pressing, whole.pressing)
    with pytest.raises(ValueError, match="no cell of the mat lies"):
        mat_map(cylinder(40), np.full((9, 7, 3), np.nan), valid, area)


def test_the_load_moves_with_the_body() -> None:
    pose = RigidTransform.from_components([0.3, -0.2, 0.5], Rotation.from_rotvec([0.4, -0.7, 1.1]))
    surface = cylinder(30)
    moved = Surface(pose.apply(surface.vertices), surface.faces, "moved")
    nodes = nodes_on_cylinder(8, 6)
    valid, area = everywhere(8, 6, 2e-4)
    pressure = np.random.default_rng(2).uniform(0.0, 2e4, (3, 48))
    here = mat_load(mat_map(surface, nodes, valid, area), pressure, np.array([0.01, 0.02, 0.0]), "a")
    there = mat_load(
        mat_map(moved, pose.apply(nodes.reshape(-1, 3)).reshape(nodes.shape), valid, area),
        pressure,
        pose.apply(np.array([0.01, 0.02, 0.0])),
        "b",
    )
    np.testing.assert_allclose(pose.rotation.apply(here.wrench.force), there.wrench.force, rtol=1e-9)
    np.testing.assert_allclose(pose.rotation.apply(here.wrench.moment), there.wrench.moment, rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(pose.apply(here.centre), there.centre, atol=1e-12)


def test_an_inside_out_scan_is_pressed_from_its_other_side() -> None:
    surface = cylinder(30)
    turned = Surface(surface.vertices, surface.faces[:, ::-1], "turned")
    nodes, (valid, area) = nodes_on_cylinder(8, 6), everywhere(8, 6, 2e-4)
    here, there = (mat_map(each, nodes, valid, area) for each in (surface, turned))
    np.testing.assert_allclose(here.force, -there.force, atol=1e-12)


@pytest.mark.parametrize("kind", ["cell", "gain", "shift", "turn"])
def test_covariance_of_the_wrench_is_that_of_drawn_errors(kind: str) -> None:
    surface, nodes, (valid, area) = cylinder(30), nodes_on_cylinder(8, 6), everywhere(8, 6, 2e-4)
    placed, origin = mat_map(surface, nodes, valid, area), np.array([0.05, 0.03, -0.1])
    rng = np.random.default_rng(4)
    pressure = rng.uniform(0.0, 2e4, (1, 48))
    load = mat_load(placed, pressure, origin, "a")
    size = {"cell": 0.15, "gain": 0.1, "shift": 1e-3, "turn": np.radians(2.0)}[kind]
    stated = wrench_covariance(placed, pressure, load.wrench, MatErrors(**{kind: size}))[0]
    middle = (placed.area @ placed.centre) / placed.area.sum()
    drawn = []
    for _ in range(4000):
        p, force, moment, c = pressure, placed.force, placed.moment, origin
        if kind == "cell":
            p = pressure * (1.0 + size * rng.standard_normal(48))
        elif kind == "gain":
            p = pressure * (1.0 + size * rng.standard_normal())
        total, about = (p @ force)[0], (p @ moment)[0]
        if kind == "shift":
            about = about + np.cross(size * rng.standard_normal(3), total)
        if kind == "turn":
            turn = Rotation.from_rotvec(size * rng.standard_normal(3))
            about = turn.apply(about - np.cross(middle, total))
            total = turn.apply(total)
            about = about + np.cross(middle, total)
        drawn.append(np.concatenate([total, about - np.cross(c, total)]))
    seen = np.cov(np.array(drawn).T)
    force, moment = np.sqrt(np.diag(seen)[:3].max()), np.sqrt(np.diag(seen)[3:].max())
    scale = np.repeat([max(force, 1e-9), moment], 3)  # what is quadratic in the errors is left out
    np.testing.assert_allclose(stated / np.outer(scale, scale), seen / np.outer(scale, scale), atol=0.08)


def test_offset_and_drift_are_taken_off() -> None:
    time = np.arange(0.0, 4.0, 0.02)
    rng = np.random.default_rng(5)
    offset, drift = rng.uniform(0.0, 300.0, (4, 3)), rng.uniform(-50.0, 50.0, (4, 3))
    pressure = offset + drift * time[:, None, None]
    found = unloaded(time, pressure, [(0.0, 0.3), (3.7, 4.0)])
    np.testing.assert_allclose(found.at(time), pressure, rtol=1e-9, atol=1e-9)
    one = unloaded(time, pressure, [(0.0, 0.3)])
    assert (one.drift == 0.0).all()
    with pytest.raises(ValueError, match="holds 0 frames"):
        unloaded(time, pressure, [(9.0, 10.0)])


def test_covariance_of_a_registration_is_carried_to_the_wrench() -> None:
    """Alike in all directions about the mat's middle it is the one that was stated; else that of drawn motions."""
    surface, nodes, (valid, area) = cylinder(30), nodes_on_cylinder(8, 6), everywhere(8, 6, 2e-4)
    placed, origin = mat_map(surface, nodes, valid, area), np.array([0.05, 0.03, -0.1])
    pressure = np.random.default_rng(4).uniform(0.0, 2e4, (1, 48))
    load = mat_load(placed, pressure, origin, "a")
    middle = (placed.area @ placed.centre) / placed.area.sum()
    alike = PoseCovariance(middle, np.diag([1e-3] * 3 + [0.03] * 3) ** 2, 6.0)
    told, stated = (
        wrench_covariance(placed, pressure, load.wrench, errors)
        for errors in (MatErrors(pose=alike), MatErrors(shift=1e-3, turn=0.03))
    )
    np.testing.assert_allclose(told, stated, rtol=1e-12)
    rng, about = np.random.default_rng(5), np.array([0.3, -0.2, 0.1])
    root = np.diag([1e-3, 2e-3, 0.5e-3, 0.01, 0.02, 0.005]) @ (np.eye(6) + 0.3 * rng.standard_normal((6, 6)))
    told = wrench_covariance(placed, pressure, load.wrench, MatErrors(pose=PoseCovariance(about, root @ root.T, 6.0)))
    drawn = []
    for _ in range(6000):
        motion = root @ rng.standard_normal(6)
        turn = Rotation.from_rotvec(motion[3:])
        force = turn.apply(load.wrench.force[0])
        point = about + motion[:3] + turn.apply(origin - about)
        drawn.append(np.concatenate([force, turn.apply(load.wrench.moment[0]) + np.cross(point - origin, force)]))
    seen = np.cov(np.array(drawn).T)
    scale = np.repeat([np.sqrt(np.diag(seen)[:3].max()), np.sqrt(np.diag(seen)[3:].max())], 3)
    np.testing.assert_allclose(told[0] / np.outer(scale, scale), seen / np.outer(scale, scale), atol=0.06)


def two_cells() -> MatMap:
    """Cells of 0.1 x 0.1 m and 0.1 x 0.2 m side by side along y on a plane of faces 0.05 m wide."""
    flat = sheet(np.linspace(0.0, 0.2, 5), np.linspace(0.0, 0.4, 9), lambda a, b: np.stack([a, b, 0.0 * a], -1), "p")
    x, y = np.meshgrid([0.05, 0.15], [0.05, 0.15, 0.35], indexing="ij")
    nodes = np.stack([x, y, 0.0 * x], -1)
    return mat_map(flat, nodes, np.ones((1, 2), bool), np.array([[0.01, 0.02]]))


def test_the_middle_of_a_mat_weighs_cells_with_their_area() -> None:
    # centres at y = 0.1 and 0.25
    np.testing.assert_allclose(two_cells().middle, [0.1, (0.01 * 0.1 + 0.02 * 0.25) / 0.03, 0.0], atol=1e-12)


def test_cells_lie_on_the_faces_that_carry_half_of_them() -> None:
    # by y: the first cell lies below 0.15; of the second one a quarter lies below 0.2, and half below 0.25
    flat = sheet(np.linspace(0.0, 0.2, 5), np.linspace(0.0, 0.4, 9), lambda a, b: np.stack([a, b, 0.0 * a], -1), "p")
    y = flat.vertices[flat.faces, 1].mean(axis=1)
    placed = two_cells()
    assert placed.lying_on(y < 0.15).tolist() == [True, False]
    assert placed.lying_on(y < 0.2).tolist() == [True, False]
    assert placed.lying_on(y < 0.3).tolist() == [True, True]
    assert placed.lying_on(y > 0.2).tolist() == [False, True]
