"""Meshes pressed into layers: the sphere's closed form, any pose, compartments, refinement of real shapes."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from benchmarks.pairs import PAIRS
from geocontact.geometry.curvature import corner_normals, phong_offset
from geocontact.geometry.surface import Surface
from geocontact.geometry.surface_quadrature import surface_quadrature, thickness_below
from geocontact.io.mesh.meshes import read_mesh
from geocontact.loads.foundation import Layer, Pressed, Skin, pressed
from meshes import simple_shapes
from tests.cli.calls import MESHES
from tests.contact.sphere_on_layer import linear_force, logarithmic_force
from tests.geometry.bodies import MM, cube, surface, turned

R, D, M = 20e-3, 0.4e-3, 8e8
CLOSED = {"linear": linear_force, "logarithmic": logarithmic_force}


@cache
def ball(n: int) -> Surface:
    """Sphere of radius R with 20 n^2 faces."""
    return surface(simple_shapes.sphere(R / MM, n))


@cache
def sample(name: str) -> Surface:
    return Surface.of(read_mesh(MESHES / name, "mm"))


def layer(body: Surface, edge: float, law: str = "linear", up: int = 1) -> Layer:
    """The top of a body, with the thickness that rays find."""
    pieces = surface_quadrature(body, edge, body.face_normal[:, up] > 0.25)
    halves = {"medial": pieces.point[:, 2] < 0.0, "lateral": pieces.point[:, 2] >= 0.0}
    return Layer(pieces, thickness_below(body, pieces.point, pieces.normal), M, law, halves)


def slab() -> Surface:
    """Plate 5 mm thick, its top at y = 0."""
    return surface(cube((0.0, -2.5, 0.0), (12.0, 2.5, 12.0)))


@pytest.mark.parametrize("law", ["linear", "logarithmic"])
def test_a_ball_on_a_plate_is_the_closed_form(law: str) -> None:
    """Rays find 5 mm; what is left are the facets of the ball, which are up to 0.001 mm inside it."""
    bed = layer(slab(), 0.2e-3, law)
    np.testing.assert_allclose(bed.thickness, 5e-3, rtol=1e-12)
    found = pressed(bed, ball(100), np.eye(3), np.array([0.0, R - D, 0.0]))
    assert found.load.pressing == pytest.approx(CLOSED[law](R, D, 5e-3, M), rel=0.005)
    np.testing.assert_allclose(found.load.wrench.force, [0.0, -found.load.pressing, 0.0], atol=1e-9)
    np.testing.assert_allclose(found.load.centre, 0.0, atol=3e-5)
    assert found.strain == pytest.approx(D / 5e-3, rel=0.01)
    halves = [found.parts[name].pressing for name in ("medial", "lateral")]
    assert halves == pytest.approx([0.5 * found.load.pressing] * 2, rel=0.01)


def test_a_common_motion_of_both_bodies_moves_the_load_along() -> None:
    turn, shift = turned(40, -20, 100), np.array([0.3, -0.2, 0.1])
    body = slab()
    there = Surface(turn.apply(body.vertices) + shift, body.faces)
    pieces = surface_quadrature(there, 0.5e-3, layer_faces(body))
    moved = Layer(pieces, thickness_below(there, pieces.point, pieces.normal), M)
    offset = np.array([1e-3, R - D, -2e-3])
    first = pressed(layer(body, 0.5e-3), ball(40), np.eye(3), offset)
    again = pressed(moved, ball(40), turn.as_matrix(), turn.apply(offset) + shift)
    assert again.load.pressing == pytest.approx(first.load.pressing, rel=1e-6)
    np.testing.assert_allclose(again.load.centre, turn.apply(first.load.centre) + shift, atol=1e-8)
    np.testing.assert_allclose(again.load.wrench.force, turn.apply(first.load.wrench.force), rtol=1e-6, atol=1e-6)


def layer_faces(body: Surface) -> np.ndarray:
    return body.face_normal[:, 1] > 0.25


def knee(edge: float) -> Pressed:
    """The sample knee in the middle of its gait, sunk 1.2 mm further, which loads both sides."""
    femur, insert = sample("femoral_component_right_medium.stl"), sample("tibial_insert_right_medium.stl")
    row = np.loadtxt(MESHES / "gait.csv", delimiter=",", skiprows=51, max_rows=1)
    rotation = Rotation.from_quat(row[[5, 6, 7, 4]]).as_matrix()
    return pressed(layer(insert, edge), femur, rotation, row[1:4] * MM - [0.0, 1.2 * MM, 0.0])


@pytest.mark.slow
def test_force_on_the_sample_knee_is_within_one_per_cent_of_refined_pieces() -> None:
    coarse, fine = knee(0.5e-3), knee(0.1e-3)
    assert coarse.load.pressing == pytest.approx(fine.load.pressing, rel=0.01)
    np.testing.assert_allclose(coarse.load.centre, fine.load.centre, atol=0.1e-3)
    for name in ("medial", "lateral"):
        assert coarse.parts[name].pressing == pytest.approx(fine.parts[name].pressing, rel=0.01)
    assert min(part.pressing for part in fine.parts.values()) > 500.0
    assert sum(p.pressing for p in coarse.parts.values()) == pytest.approx(coarse.load.pressing, rel=1e-12)


def smooth_knee(faces: int) -> tuple[float, float]:
    """Force on a synthetic knee of about so many faces a body, sunk 0.3 mm, with smooth facets and with flat ones."""
    pair = PAIRS["knee"](faces, 3)
    bed = layer(pair.fixed, np.inf)
    heights = phong_offset(pair.fixed, corner_normals(pair.fixed), bed.pieces.face, bed.pieces.point)
    at = pair.rotation[1], pair.translation[1] - [0.0, 0.3 * MM, 0.0]
    smooth = pressed(replace(bed, height=heights), pair.moving, *at, Skin(corner_normals(pair.moving)))
    return smooth.load.pressing, pressed(bed, pair.moving, *at).load.pressing


@pytest.mark.slow
def test_smooth_facets_give_the_force_of_a_mesh_refined_eight_times() -> None:
    smooth, flat = smooth_knee(10_000)
    fine, _ = smooth_knee(80_000)
    assert smooth == pytest.approx(fine, rel=0.01)
    assert flat < 0.95 * fine


def test_a_layer_of_its_own_gives_way_with_the_other() -> None:
    bed, at = layer(slab(), 0.5e-3), (np.eye(3), np.array([0.0, R - D, 0.0]))
    alone = pressed(bed, ball(40), *at)
    thickness = np.full(len(ball(40).faces), 10e-3)
    both = pressed(bed, ball(40), *at, Skin(thickness=thickness, modulus=M))
    assert both.load.pressing == pytest.approx(alone.load.pressing / 3.0, rel=1e-9)
    assert both.strain == pytest.approx(alone.strain / 3.0, rel=1e-9)
    hard = pressed(bed, ball(40), *at, Skin(thickness=thickness, modulus=1e6 * M))
    assert hard.load.pressing == pytest.approx(alone.load.pressing, rel=1e-5)


def test_no_overlap_no_pressure() -> None:
    found = pressed(layer(slab(), 1e-3), ball(10), np.eye(3), np.array([0.0, R + 1e-6, 0.0]))
    assert (found.load.pressing, found.strain) == (0.0, 0.0) and np.isnan(found.load.centre).all()


def test_deep_overlap_is_measured_in_full() -> None:
    """3 mm, beyond the first query's limit."""
    found = pressed(layer(slab(), 0.5e-3), ball(80), np.eye(3), np.array([0.0, R - 3e-3, 0.0]))
    assert found.strain == pytest.approx(0.6, rel=0.01)
    assert found.load.pressing == pytest.approx(linear_force(R, 3e-3, 5e-3, M), rel=0.02)


def test_the_far_side_of_something_thin_is_not_pressed() -> None:
    """A wafer 0.2 mm thin in the ball's skin: its underside is inside the ball as well, but looks away."""
    wafer = surface(cube((0.0, -0.1, 0.0), (2.0, 0.1, 2.0)))
    pieces = surface_quadrature(wafer, 0.2e-3)
    bed = Layer(pieces, np.full(len(pieces.area), 5e-3), M)
    found = pressed(bed, ball(80), np.eye(3), np.array([0.0, R - 1.5e-3, 0.0]))
    assert (found.pressure[pieces.normal[:, 1] > 0.5] > 0.0).all()
    assert (found.pressure[pieces.normal[:, 1] < -0.5] == 0.0).all()


def test_refusals() -> None:
    bed = layer(slab(), 1e-3)
    open_ball = Surface(ball(4).vertices, ball(4).faces[1:])
    with pytest.raises(ValueError, match="without an inside there is no depth"):
        pressed(bed, open_ball, np.eye(3), np.zeros(3))
    with pytest.raises(ValueError, match="linear or logarithmic, not 'stiff'"):
        Layer(bed.pieces, bed.thickness, M, "stiff")
    with pytest.raises(ValueError, match="must be positive"):
        Layer(bed.pieces, 0.0 * bed.thickness, M)
