"""The plain projection: what it loses on a steep side, and what the drape does not."""

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.geometry.drape.closest_point import project
from geocontact.geometry.drape.lay import lay
from geocontact.geometry.drape.mat import Marks, Mat
from geocontact.geometry.drape.spread import Anchor
from tests.geometry.drape.sheets import over, plane, tube

SIDE = np.sqrt(2e-4)
MAT = Mat(16, 8, (SIDE, SIDE))
ONTO_X = Rotation.from_matrix(np.array([[0, 0, 1.0], [0, -1, 0], [1, 0, 0]]))  # rows along z, outside along x


def test_on_a_plane_both_are_the_same():
    sheet = over(plane())
    flat = project(sheet, MAT, RigidTransform.from_components([0.01, 0.02, 0.005], Rotation.identity()))
    laid = lay(sheet, MAT, Anchor.at(sheet, np.array([0.01, 0.02, 0.0]), np.array([1.0, 0, 0])))
    assert flat.nodes == pytest.approx(laid.nodes, abs=1e-14)
    assert flat.area == pytest.approx(laid.area, rel=1e-12)
    assert flat.covered.all()


def test_on_the_side_of_a_tube_cells_shrink_as_the_closed_form_says_and_draped_ones_do_not():
    radius, sheet = 0.06, over(tube(0.06, n=360))
    found = project(sheet, MAT, RigidTransform.from_components([radius, 0, 0.25], ONTO_X))
    y = (np.arange(9) - 4) * SIDE
    share = radius * np.diff(np.arctan(y / radius)) / SIDE
    assert found.area / MAT.cell_area == pytest.approx(np.broadcast_to(share, (16, 8)), rel=5e-3)
    assert share.min() < 0.6
    laid = lay(sheet, MAT, Anchor.at(sheet, np.array([radius, 0, 0.25]), np.array([0, 0, 1.0])))
    assert np.abs(laid.distortion).max() < 1e-9


def test_marks_place_the_flat_mat():
    radius, sheet = 0.06, over(tube(0.06, n=120))
    pose = RigidTransform.from_components([radius + 0.002, 0, 0.25], ONTO_X)
    cells = np.array([[1.0, 1.0], [15.0, 2.0], [8.0, 7.5], [3.0, 6.0]])
    ahead, aside = MAT.away(cells).T
    marks = Marks(cells, pose.apply(np.column_stack([ahead, aside, 0 * ahead])))
    assert project(sheet, MAT, marks).nodes == pytest.approx(project(sheet, MAT, pose).nodes, abs=1e-12)
    assert len(project(sheet, MAT, marks).misses) == 4


def test_what_overhangs_is_not_covered():
    sheet = over(plane(0.5))
    found = project(sheet, MAT, RigidTransform.from_components([0.2, 0, 0.01], Rotation.from_rotvec([0, 0, 0.0])))
    inside = np.abs(found.nodes[..., 0]) < 0.25
    assert found.covered.any() and not found.covered.all()
    assert np.array_equal(found.covered, inside[:-1, :-1] & inside[1:, 1:])
    assert found.area[found.covered] == pytest.approx(np.full(found.covered.sum(), 2e-4), rel=1e-12)


def test_folds_are_told():
    """A mat put across a tube half its width sends both halves down the same sides, where they end on one another."""
    sheet = over(tube(0.01, n=60))
    found = project(sheet, Mat(4, 40, (SIDE, SIDE)), RigidTransform.from_components([0.01, 0, 0.25], ONTO_X))
    assert found.folded[:, 0].all() and found.folded[:, -1].all()
