"""Meshes in the frame of their body: affine maps, faces kept outwards, units."""

import numpy as np
import pytest
import trimesh

from geocontact.data.mesh import Mesh
from geocontact.geometry.placement import placed
from geocontact.geometry.topology import signed_volume
from meshes.simple_shapes import torus
from tests.geometry.bodies import MM, turned

VERTICES, FACES = torus(25.0, 8.0, 12)
MESH = Mesh(VERTICES * MM, np.asarray(FACES, np.int64), "ring.stl", "mm", "abc")


def affine(linear, shift=(0.0, 0.0, 0.0)):
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = linear, shift
    return matrix


POSE = affine(turned(10, -50, 200).as_matrix(), [0.1, -0.2, 0.3])
SHEARED = affine([[1.5, 0.3, 0.0], [0.0, 0.7, -0.2], [0.1, 0.0, 2.0]], [0.01, 0.02, -0.03])
MIRROR = affine(np.diag([1.0, 1.0, -1.0]), [0.0, 0.0, 0.05])
EACH = {"pose": POSE, "shear": SHEARED, "mirror": MIRROR, "mirrored pose": MIRROR @ POSE}


@pytest.mark.parametrize("matrix", EACH.values(), ids=EACH)
def test_the_map_is_that_of_trimesh(matrix):
    """Vertices, volume and the way the faces look; trimesh turns mirrored faces over as well."""
    there = placed(MESH, matrix)
    other = trimesh.Trimesh(MESH.vertices, MESH.faces, process=False).apply_transform(matrix)
    np.testing.assert_allclose(there.vertices, other.vertices, atol=1e-15)
    assert signed_volume(there.vertices, there.faces) == pytest.approx(other.volume, rel=1e-12)
    assert other.volume == pytest.approx(
        abs(np.linalg.det(matrix)) * signed_volume(MESH.vertices, MESH.faces), rel=1e-9
    )
    np.testing.assert_array_equal(np.sort(there.faces, axis=1), np.sort(MESH.faces, axis=1), "face i is face i")


def test_faces_of_a_mirrored_mesh_keep_their_normals_mirrored():
    """Each face's normal is the mirror image of what it was: it points outwards still."""
    there = placed(MESH, MIRROR)
    normals = [np.cross(c[:, 1] - c[:, 0], c[:, 2] - c[:, 0]) for c in (m.vertices[m.faces] for m in (MESH, there))]
    np.testing.assert_allclose(normals[1], normals[0] * [1, 1, -1], atol=1e-18)
    assert there.faces.flags.c_contiguous


def test_placing_twice_is_placing_by_the_product():
    twice, once = placed(placed(MESH, POSE), MIRROR @ SHEARED), placed(MESH, MIRROR @ SHEARED @ POSE)
    np.testing.assert_allclose(twice.vertices, once.vertices, atol=1e-15)
    np.testing.assert_array_equal(twice.faces, once.faces)


@pytest.mark.parametrize("matrix", [POSE, MIRROR])
def test_the_inverse_brings_it_back(matrix):
    back = placed(placed(MESH, matrix), np.linalg.inv(matrix))
    np.testing.assert_allclose(back.vertices, MESH.vertices, atol=1e-15)
    np.testing.assert_array_equal(back.faces, MESH.faces)


def test_scale_factors_of_a_model_act_on_the_numbers_in_the_file():
    """A file in mm in a model that scales by 0.001 and shifts by metres; a file in metres needs no scale."""
    shift = np.array([0.5, 0.0, -0.25])
    scaled = placed(MESH, affine(1e-3 * np.eye(3), shift), 1e-3)
    np.testing.assert_allclose(scaled.vertices, VERTICES * 1e-3 + shift, atol=1e-16)
    np.testing.assert_array_equal(placed(MESH, affine(np.eye(3), shift)).vertices, scaled.vertices)


def test_the_rest_stays_as_it_was():
    vertices, faces = MESH.vertices.copy(), MESH.faces.copy()
    there = placed(MESH, MIRROR)
    assert (there.name, there.unit, there.sha256) == ("ring.stl", "mm", "abc")
    np.testing.assert_array_equal(MESH.vertices, vertices)
    np.testing.assert_array_equal(MESH.faces, faces)


@pytest.mark.parametrize(
    "matrix",
    [affine(np.diag([1.0, 1.0, 0.0])), affine(np.zeros((3, 3))), affine(np.full((3, 3), np.nan))]
    + [affine(np.eye(3), [0.0, bad, 0.0]) for bad in (np.nan, np.inf)],
)
def test_what_flattens_or_loses_the_mesh_is_refused(matrix):
    with pytest.raises(ValueError, match="singular or not finite"):
        placed(MESH, matrix)
