"""Load on an elastic layer over a motion: a ball that is pressed into a floor and lifted again."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform

from geocontact.data.motion import Motion
from geocontact.geometry.curvature import corner_normals
from geocontact.geometry.plane import Plane
from geocontact.geometry.surface import Surface
from geocontact.geometry.surface_quadrature import surface_quadrature
from geocontact.loads.foundation import Layer, Skin, layer_on
from geocontact.loads.pressure_evolution import pressure_evolution
from meshes.simple_shapes import block, sphere
from tests.contact.sphere_on_layer import linear_force

R, H, M = 20e-3, 12e-3, 2e9
DEPTHS = np.array([0.1, 0.3, -0.5]) * 1e-3
BALL, FLOOR = (
    Surface(v * 1e-3, f, name) for (v, f), name in ((sphere(20.0, 40), "ball"), (block(24.0, 24.0, 12.0, 12), "floor"))
)


def layer(edge: float, faces: np.ndarray | None = None) -> Layer:
    """Of the same thickness everywhere; z below 0 is medial."""
    pieces = surface_quadrature(FLOOR, edge, faces)
    return layer_on(FLOOR, pieces, np.full(len(pieces.area), H), M, sides=(Plane.across("z"), -1))


def test_each_frame_has_the_closed_form_and_the_largest_force_its_map() -> None:
    top = float(FLOOR.vertices[:, 1].max())
    shift = np.column_stack([np.zeros(3), top + R - DEPTHS, np.zeros(3)])
    motion = Motion(0.1 * np.arange(3), RigidTransform.from_translation(shift))
    marked: list[np.ndarray] = []

    def finer(faces: np.ndarray) -> Layer:
        marked.append(faces)
        return layer(0.5e-3, faces)

    steps: list[int] = []
    skin = Skin(corner_normals(BALL))
    found = pressure_evolution(layer(1e-3), FLOOR, BALL, motion, skin, (0,), finer, 1, lambda: steps.append(1))
    expected = [linear_force(R, depth, H, M) for depth in DEPTHS[:2]]
    np.testing.assert_allclose(found.pressing[:2], expected, rtol=0.02)
    assert found.pressing[2] == 0.0 and len(steps) == 3
    assert found.heaviest == 1 and found.frames == [0, 1]
    assert found.finer == pytest.approx(expected[1], rel=0.01)
    assert found.strain == pytest.approx(0.3e-3 / H, rel=0.02)
    assert found.thickness == (H, H)
    pressed, near = found.maps[1] > 0.0, marked[0]
    assert near[pressed].all() and pressed.sum() < near.sum() < len(near)
    halves = [found.parts[side][1].pressing for side in ("medial", "lateral")]
    np.testing.assert_allclose(halves, 0.5 * found.pressing[1], rtol=0.02)
    table = found.table(motion.time)
    np.testing.assert_allclose(table["force_y [N]"], -found.pressing, atol=1e-6)
    beside = M / H * (0.5e-3) ** 2 / (2.0 * R) * 1e-6  # the deepest place lies up to half an edge beside a middle
    np.testing.assert_allclose(table["peak [MPa]"][:2], M * DEPTHS[:2] / H * 1e-6, atol=beside)
    np.testing.assert_allclose(table["cop_z [mm]"][:2], 0.0, atol=0.1)
    assert np.isnan(table["cop_x [mm]"][2])
    assert (table["cop_medial_z [mm]"][:2] < 0.0).all()


def test_triangles_taken_as_they_are_have_no_height_and_one_part() -> None:
    pieces = surface_quadrature(FLOOR, 2e-3)
    flat = layer_on(FLOOR, pieces, np.full(len(pieces.area), H), M, "logarithmic", smooth=False)
    assert flat.height is None and flat.parts == {} and flat.law == "logarithmic"
    with pytest.raises(ValueError, match="must be positive"):
        layer_on(FLOOR, pieces, np.zeros(len(pieces.area)), M)
