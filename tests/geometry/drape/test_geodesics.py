"""Straightest lines: great circles, helices, there and back again, across corners and faces without area."""

import numpy as np
import pytest

from geocontact.geometry.drape.spread import Geodesics, SurfacePoints
from geocontact.geometry.surface import Surface
from geocontact.geometry.topology import neighbours
from tests.geometry.drape.sheets import over, plane, sphere, thigh, tube


def angle_at_centre(a, b):
    return np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), (a * b).sum(axis=-1))


def test_neighbours_share_the_edge_turned_over():
    _, faces = sphere(n=4)
    across = neighbours(faces)
    assert (across >= 0).all()
    for f in range(len(faces)):
        for k in range(3):
            other = faces[across[f, k]]
            a, b = faces[f, k], faces[f, (k + 1) % 3]
            assert any(other[m] == b and other[(m + 1) % 3] == a for m in range(3))


def test_the_surface_ends_where_faces_do_not_agree():
    faces = np.array([[0, 1, 2], [0, 1, 3]])  # both run from 0 to 1
    assert (neighbours(faces) == -1).all()
    fan = np.array([[0, 1, 2], [1, 0, 3], [1, 0, 4]])
    assert (neighbours(fan) == -1).all()
    pair = np.array([[0, 1, 2], [1, 0, 3], [1, 1, 0]])  # the third has no area and is no part
    assert neighbours(pair)[:2, 0].tolist() == [1, 0]


def test_a_line_on_a_plane_is_straight():
    sheet = over(plane())
    start = sheet.nearest(np.array([[0.01, -0.02, 0.0]]))
    way = np.array([np.cos(0.7), np.sin(0.7), 0.0])
    stations = np.linspace(-0.2, 0.2, 41)
    places, headings = sheet.along(start, way[None], stations)
    assert places.point[0] == pytest.approx(start.point + stations[:, None] * way, abs=1e-15)
    assert headings[0] == pytest.approx(np.tile(way, (41, 1)), abs=1e-14)


def test_along_the_lines_of_a_mesh_through_its_corners():
    """An exact grid: every station of a line through corners is met, whichever face it is in."""
    x, y = np.meshgrid(np.arange(9.0), np.arange(9.0), indexing="ij")
    body = np.column_stack([x.ravel(), y.ravel(), 0 * x.ravel()]), plane(n=8)[1]
    sheet = over(body)
    for way in ([1.0, 0, 0], [0, 1.0, 0], [1.0, 1.0, 0], [1.0, -1.0, 0], [2.0, 1.0, 0]):
        start = sheet.nearest(np.array([[4.0, 4.0, 0.0]]))
        unit = np.array(way) / np.linalg.norm(way)
        places, _ = sheet.along(start, unit[None], np.linspace(-3, 3, 13))
        assert places.point[0] == pytest.approx(start.point + np.linspace(-3, 3, 13)[:, None] * unit, abs=1e-13)


def test_beyond_the_rim_there_is_nothing():
    sheet = over(plane(size=0.5))
    start = sheet.nearest(np.array([[0.0, 0.0, 0.0]]))
    places, _ = sheet.along(start, np.array([[1.0, 0, 0]]), np.array([-0.3, -0.2, 0.2, 0.249, 0.251, 0.4]))
    assert places.on[0].tolist() == [False, True, True, True, False, False]
    assert np.isnan(places.point[0, -1]).all()


def test_great_circles_close():
    errors, edges = [], []
    for n in (10, 20, 40):
        sheet = over(sphere(1.0, n))
        start = sheet.nearest(np.array([[0.3, 0.5, 0.8]]))
        places, _ = sheet.along(start, np.array([[1.0, 0.2, 0.0]]), np.array([np.pi, 2 * np.pi]))
        errors.append(np.linalg.norm(places.point[0, 1] - start.point[0]))
        edges.append(1.0 / n)
    assert errors[-1] < 5e-3, errors
    assert np.polyfit(np.log(edges), np.log(errors), 1)[0] > 1.5, errors


def test_lines_between_places_of_a_sphere_are_as_long_as_arcs():
    sheet, rng = over(sphere(1.0, 60)), np.random.default_rng(0)
    a = sheet.nearest(rng.normal(size=(300, 3)))
    b = sheet.nearest(a.point + 0.1 * rng.normal(size=(300, 3)))
    found = sheet.joined(a, b)
    assert found.length == pytest.approx(angle_at_centre(a.point, b.point), rel=3e-4)
    assert (found.miss < 1e-12).mean() > 0.99
    assert found.miss.max() < 1e-3


@pytest.mark.parametrize(
    "body", [plane(), tube(), thigh(40), sphere(0.1, 12)], ids=["plane", "tube", "thigh", "sphere"]
)
def test_there_and_back(body):
    """A place moved by a shift is joined by a line of the shift's length, which arrives as it left."""
    sheet, rng = over(body), np.random.default_rng(1)
    points = body[0][body[1]].mean(axis=1)
    inner = points[np.argsort(np.linalg.norm(points - points.mean(axis=0), axis=1))][:200]
    a = sheet.nearest(inner)
    normal = sheet.normal(a)
    shift = np.cross(normal, rng.normal(size=normal.shape))
    shift *= 0.015 / np.linalg.norm(shift, axis=1, keepdims=True)
    b = sheet.moved(a, shift)
    found = sheet.joined(a, b)
    good = (found.miss < 1e-12) & b.on
    assert good.mean() > 0.95
    assert found.length[good].max() < 0.015 * 1.02, "hardly longer than the way taken"
    assert np.median(np.abs(found.length[good] - 0.015)) < 1e-12
    back = sheet.joined(b, a)
    both = good & (back.miss < 1e-12)
    assert np.median(np.abs(back.leaving[both] + found.arriving[both])) < 1e-10


def test_a_screw_line_on_a_tube():
    """On the prism of a tube, straight in its development: z and the way around grow in proportion."""
    n, sheet = 60, over(tube(n=60))
    girth = 2 * 60 * 0.06 * np.sin(np.pi / n)
    start = sheet.nearest(np.array([[0.06, 0.0, 0.1]]))
    slope = np.arctan2(0.1, girth)
    out = sheet.normal(start)[0]
    around = np.cross([0, 0, 1.0], out)
    way = np.cos(slope) * around + np.sin(slope) * np.array([0, 0, 1.0])
    places, _ = sheet.along(start, way[None], np.array([np.hypot(0.1, girth)]))
    assert places.point[0, 0] == pytest.approx(start.point[0] + [0, 0, 0.1], abs=1e-13)


def test_faces_without_area_are_crossed():
    """A corner on the side of a large triangle, with the collinear face that closes the seam."""
    vertices = np.array([[0, 0, 0], [2, 0, 0], [1, 2, 0], [1, 0, 0], [1, -2, 0.0]])
    faces = np.array([[0, 1, 2], [0, 3, 1], [0, 4, 3], [3, 4, 1]])
    sheet = Geodesics(Surface(vertices, faces))
    start = sheet.nearest(np.array([[0.9, 0.5, 0.0]]))
    places, headings = sheet.along(start, np.array([[0.3, -1.0, 0.0]]), np.array([1.0]))
    way = np.array([0.3, -1.0, 0.0]) / np.hypot(0.3, 1.0)
    assert places.point[0, 0] == pytest.approx(start.point[0] + way, abs=1e-14)
    assert headings[0, 0] == pytest.approx(way, abs=1e-14)


def test_refused():
    sheet = over(plane())
    start = sheet.nearest(np.zeros((1, 3)))
    with pytest.raises(ValueError, match="stands upright"):
        sheet.along(start, np.array([[0, 0, 1.0]]), np.array([0.1]))
    flat = Geodesics(Surface(np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0.0]]), np.array([[0, 1, 2]]), "seam"))
    with pytest.raises(ValueError, match="seam: no face has an area"):
        flat.nearest(np.zeros((1, 3)))


def test_places_off_the_surface_stay_off():
    sheet = over(plane())
    lost = SurfacePoints(np.array([-1]), np.full((1, 3), np.nan))
    assert not sheet.moved(lost, np.ones((1, 3))).on[0]
    assert np.isnan(sheet.joined(lost, sheet.nearest(np.zeros((1, 3)))).length[0])
