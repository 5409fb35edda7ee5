"""Mats on a whole body of real size: a seat mat on the thigh, a belt around the waist, a scan of a part found again."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.geometry.drape.lay import lay
from geocontact.geometry.drape.mat import Mat
from geocontact.geometry.drape.spread import Anchor, Geodesics
from geocontact.geometry.register.icp import icp
from geocontact.geometry.surface import Surface
from geocontact.io.mesh.meshes import read_mesh

SIDE = np.sqrt(2e-4)


@pytest.fixture(scope="module", params=["human_man.obj", "human_woman.obj"])
def body(data_dir, request):
    return Surface.of(read_mesh(data_dir / "body_meshes" / request.param, "m"))


def front_of_thigh(body):
    """A point on the front of one thigh; y is up and z ahead."""
    low, high = body.vertices.min(axis=0), body.vertices.max(axis=0)
    height = low[1] + 0.38 * (high[1] - low[1])
    slab = body.vertices[np.abs(body.vertices[:, 1] - height) < 0.02]
    leg = slab[(slab[:, 0] > 0.0) & (slab[:, 0] < 0.25)]
    return leg[np.argmax(leg[:, 2])]


def test_cells_keep_their_size_on_a_thigh(body):
    sheet = Geodesics(body)
    anchor = Anchor.at(sheet, front_of_thigh(body), np.array([0.0, -1.0, 0.0]))
    found = lay(sheet, Mat(16, 8, (SIDE, SIDE)), anchor)
    assert found.covered.all() and not found.folded.any()
    assert np.abs(found.distortion).max() < 0.06
    assert np.sqrt(np.mean(found.distortion**2)) < 0.02
    assert found.area.sum() == pytest.approx(128 * 2e-4, rel=0.01)


def test_a_scan_of_a_thigh_is_found_on_the_body(body):
    centre = front_of_thigh(body)
    middle = body.vertices[body.faces].mean(axis=1)
    leg = (np.abs(middle[:, 1] - centre[1]) < 0.18) & (middle[:, 0] > 0.0) & (middle[:, 0] < 0.3)
    part = Surface(body.vertices, np.ascontiguousarray(body.faces[leg]), "scan of a thigh")
    turn = Rotation.from_rotvec(np.radians([4.0, -3.0, 5.0]))
    start = RigidTransform.from_components(centre - turn.apply(centre) + [0.006, -0.008, 0.005], turn)
    found = icp(part, body, start)
    assert np.linalg.norm(found.pose.apply(centre) - centre) < 1e-5
    assert found.overlap == 1.0
