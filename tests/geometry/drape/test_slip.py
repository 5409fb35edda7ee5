"""How far a mat may lie elsewhere, told by its marks: closed forms, and intervals that hold the truth."""

import numpy as np
import pytest
from scipy.stats import t as student

from geocontact.geometry.drape.lay import lay
from geocontact.geometry.drape.mat import Marks, Mat
from geocontact.geometry.drape.slip import slip_covariance
from geocontact.geometry.drape.spread import Anchor
from tests.geometry.drape.sheets import over, plane, sphere, tube

SIDE = np.sqrt(2e-4)
MAT = Mat(16, 8, (SIDE, SIDE))
CORNERS = np.array([[0.0, 0], [0, 8], [16, 0], [16, 8]])


def laid_at(sheet, point, heading, mat=MAT, belt=None):
    return lay(sheet, mat, Anchor.at(sheet, np.array(point, float), np.array(heading, float)), belt=belt)


def corners(laid):
    return np.array([laid.nodes[int(i), int(j)] for i, j in CORNERS])


@pytest.mark.slow
def test_on_a_plane_it_is_the_rigid_fit_in_the_plane():
    """Four corners pulled apart by e along the rows: nothing moves, s^2 = 4 e^2 / 5; above the skin they may be."""
    e = 1e-3
    laid = laid_at(over(plane()), [0, 0, 0], [1, 0, 0])
    points = corners(laid) + np.array([[-e, 0, 0.01], [-e, 0, 0.01], [e, 0, 0.01], [e, 0, 0.01]])
    found = slip_covariance(MAT, laid, Marks(CORNERS, points))
    variance, arms = 0.8 * e**2, np.hypot(8 * SIDE, 4 * SIDE)
    expected = np.diag([variance / 4, variance / 4, 0, 0, 0, variance / (4 * arms**2)])
    assert found.freedom == 5.0
    assert found.about == pytest.approx(np.zeros(3), abs=1e-12)
    assert found.matrix == pytest.approx(expected, rel=1e-9, abs=1e-18)


@pytest.mark.slow
def test_a_mat_shifted_around_a_tube_is_turned_about_its_axis():
    """Corners that contradict each other along it. By d around it the mat turns by d / R, along it not at all."""
    radius = 0.06
    laid = laid_at(over(tube(radius, n=240)), [radius, 0, 0.25], [0, 0, 1])
    points = corners(laid) + np.array([[0, 0, -1e-3], [0, 0, -1e-3], [0, 0, 1e-3], [0, 0, 1e-3]])
    found = slip_covariance(MAT, laid, Marks(CORNERS, points))
    axis = np.array([0.0, 0.0, found.about[2]])
    on_axis = np.sqrt(np.diag(found.at(axis)))
    shift = np.sqrt(0.8e-6 / 4)
    assert on_axis[5] == pytest.approx(shift / radius, rel=0.01), "turned about the axis"
    assert on_axis[2] == pytest.approx(shift, rel=0.01), "shifted along it"
    turned = np.sqrt(0.8e-6 / (4 * ((8 * SIDE) ** 2 + (4 * SIDE) ** 2)))
    out = laid.centre.reshape(-1, 3).mean(axis=0) * [1, 1, 0]
    out /= np.linalg.norm(out)
    assert np.sqrt(out @ found.matrix[3:, 3:] @ out) == pytest.approx(turned, rel=0.25), "about the outward normal"


@pytest.mark.slow
def test_a_belt_is_rolled_and_tilted():
    """Four marks at quarters, pulled up and down in turns by e: no ring does that; 8 - 4 degrees of freedom."""
    radius, e = 0.06, 1e-3
    mat = Mat(4, 32, (SIDE, 2 * np.pi * radius / 32))
    laid = laid_at(over(tube(radius, n=240)), [radius, 0, 0.25], [0, 0, 1], mat, "columns")
    cells = np.array([[2.0, 0], [2, 8], [2, 16], [2, 24]])
    points = np.array([laid.nodes[2, j] for j in (0, 8, 16, 24)]) + np.array([[0, 0, e], [0, 0, -e]] * 2)
    found = slip_covariance(mat, laid, Marks(cells, points), "columns")
    assert found.freedom == 4.0
    sd = np.sqrt(np.diag(found.at(np.array([0, 0, found.about[2]]))))
    assert sd[2] == pytest.approx(0.5 * e, rel=0.01), "along the tube: s^2 / 4 with s^2 = e^2"
    assert sd[5] == pytest.approx(0.5 * e / radius, rel=0.01), "about it"
    # each tilt is told by two of the four; narrow as it is, the belt as a whole nearly turns with it
    assert sd[3:5] == pytest.approx(np.full(2, np.sqrt(0.5) * e / radius), rel=0.4)


def test_marks_that_leave_nothing_over_tell_nothing():
    laid = laid_at(over(plane()), [0, 0, 0], [1, 0, 0])
    two = Marks(CORNERS[:2], corners(laid)[:2] * 1.1)
    assert slip_covariance(MAT, laid, two).freedom == 1.0
    assert slip_covariance(MAT, laid, Marks(CORNERS[:1], corners(laid)[:1])) is None
    mat = Mat(4, 32, (SIDE, 2 * np.pi * 0.06 / 32))
    belt = laid_at(over(tube()), [0.06, 0, 0.25], [0, 0, 1], mat, "columns")
    pair = Marks(np.array([[2.0, 0], [2, 16]]), belt.nodes[2, [0, 16]] + 1e-3)
    assert slip_covariance(mat, belt, pair, "columns") is None


@pytest.mark.slow
@pytest.mark.parametrize(
    ("body", "point", "heading", "draws"),
    [
        pytest.param(tube(n=40), [0.06, 0, 0.25], [0, 0.3, 1], 120, marks=pytest.mark.long),
        (sphere(0.12, 14), [0.02, 0.01, 0.1], [0, 1, 0.3], 40),
    ],
    ids=["tube", "sphere"],
)
def test_intervals_hold_the_truth(body, point, heading, draws):
    """Four marks off by 1 mm along the skin each, synthetic draws: where two of the mat's corners come to lie."""
    sheet, mat = over(body), Mat(6, 4, (SIDE, SIDE))
    cells = np.array([[0.0, 0], [0, 4], [6, 0], [6, 4]])
    truth = laid_at(sheet, point, heading, mat)
    places = np.array([truth.nodes[int(i), int(j)] for i, j in cells])
    normal = sheet.normal(sheet.nearest(places))
    rng, hits = np.random.default_rng(5), []
    for _ in range(draws):
        noise = rng.normal(0.0, 1e-3, (4, 3))
        noise -= np.einsum("ki,ki->k", noise, normal)[:, None] * normal
        marks = Marks(cells, places + noise)
        found = lay(sheet, mat, marks)
        covariance = slip_covariance(mat, found, marks)
        n = np.cross(found.nodes[3, 3] - found.nodes[2, 2], found.nodes[2, 3] - found.nodes[3, 2])
        along = np.cross(n, [1.0, 0, 0]) / np.linalg.norm(np.cross(n, [1.0, 0, 0]))
        for i, j in ((3, 2), (0, 0)):
            sd = np.sqrt(along @ covariance.at(found.nodes[i, j])[:3, :3] @ along)
            hits.append(abs(along @ (truth.nodes[i, j] - found.nodes[i, j])) < student.ppf(0.975, 5.0) * sd)
    assert np.mean(hits) == pytest.approx(0.95, abs=0.4 / np.sqrt(draws)), np.mean(hits)
