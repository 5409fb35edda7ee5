"""Figures of a drape, by hand on two cells."""

import numpy as np
import pytest

from geocontact.geometry.drape.cells import Drape


def drape(normal=(0.0, 0.0, 1.0), distortion=(0.0, 0.0), covered=(True, True)):
    """Cells at x = -1 and x = 1, the first one's normal mirrored."""
    centre = np.array([[[-1.0, 0, 0], [1.0, 0, 0]]])
    x, y, z = normal
    return Drape(
        nodes=np.zeros((2, 3, 3)),
        centre=centre,
        normal=np.array([[[-x, y, z], [x, y, z]]]),
        area=np.ones((1, 2)),
        covered=np.array([covered]),
        distortion=np.array([distortion]),
        stretch=np.zeros((1, 2, 2)),
        folded=np.zeros((1, 2), bool),
        misses=np.zeros(0),
    )


@pytest.mark.parametrize("cosine", [1.0, 0.5, 0.0, -0.6])
def test_bulge_is_the_cosine_between_normals_and_the_way_from_the_middle(cosine):
    assert drape((cosine, 0.0, np.sqrt(1.0 - cosine**2))).bulge == pytest.approx(cosine)


def test_one_cell_has_no_bulge():
    assert drape((1.0, 0.0, 0.0), covered=(True, False)).bulge == 0.0


def test_distortion_counts_covered_cells_that_are_asked_for():
    both = drape(distortion=(-0.4, 0.3))
    assert both.distortion_of(np.array([[True, True]])) == pytest.approx((0.4, np.sqrt(0.125)))
    assert both.distortion_of(np.array([[False, True]])) == pytest.approx((0.3, 0.3))
    assert np.isnan(drape(covered=(True, False)).distortion_of(np.array([[False, True]]))).all()
