"""What a fitted cylinder, sphere, plane or circle makes least, beside loops over plain numbers.

Distances are written out point by point from what is told of the shape: a point and a direction, or a centre, and a
radius. No shape beside the one that was found has less of Σ r², or of Tukey's Σ 1 - (1 - (r/c)²)³ within c.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, hypot, pi, sin, sqrt

import numpy as np
import pytest
import scipy.optimize

from geocontact.geometry.fit.circle import fit_circle
from geocontact.geometry.fit.cylinder import fit_cylinder
from geocontact.geometry.fit.found import ShapeFit
from geocontact.geometry.fit.plane import fit_plane
from geocontact.geometry.fit.sphere import fit_sphere

Places = list[tuple[float, float, float]]


def wall(point: np.ndarray, axis: np.ndarray, radius: float, places: Places) -> list[float]:
    """Distance of each place from the axis less the radius, by |d x u| / |u|."""
    found = []
    for place in places:
        d = [place[k] - point[k] for k in range(3)]
        cross = [d[1] * axis[2] - d[2] * axis[1], d[2] * axis[0] - d[0] * axis[2], d[0] * axis[1] - d[1] * axis[0]]
        size = sqrt(sum(a * a for a in axis))
        found.append(sqrt(sum(c * c for c in cross)) / size - radius)
    return found


def ball(centre: np.ndarray, radius: float, places: Places) -> list[float]:
    return [sqrt(sum((place[k] - centre[k]) ** 2 for k in range(3))) - radius for place in places]


def level(point: np.ndarray, normal: np.ndarray, places: Places) -> list[float]:
    size = sqrt(sum(a * a for a in normal))
    return [sum((place[k] - point[k]) * normal[k] for k in range(3)) / size for place in places]


def cloud(kind: str) -> Places:
    """Some 200 places [m] on a part of each shape, out of the origin, off by a millimetre, a tenth by up to 12 mm."""
    rng, places = np.random.default_rng(3), []
    for _ in range(220):
        a, b = rng.uniform(-0.9, 1.3), rng.uniform(-0.5, 0.5)
        off = 1e-3 * rng.normal() + (rng.uniform(4e-3, 12e-3) if rng.uniform() < 0.1 else 0.0)
        if kind == "cylinder":
            r = 0.037 + off
            place = (r * cos(a), 0.06 * b + 0.3 * r * sin(a), r * sin(a) - 0.02 * b)
        elif kind == "sphere":
            r = 0.024 + off
            place = (r * cos(a) * cos(2 * b), r * sin(a) * cos(2 * b), r * sin(2 * b))
        else:
            place = (0.1 * a, 0.04 * b, 0.03 * a - 0.02 * b + off)
        places.append((place[0] + 0.4, place[1] - 1.1, place[2] + 0.8))
    return places


FIT = {"cylinder": fit_cylinder, "sphere": fit_sphere, "plane": fit_plane}


def numbers(found: ShapeFit) -> np.ndarray:
    """Point, direction and radius of what was found, as far as it has them."""
    axis = [] if found.axis is None else list(found.axis)
    return np.array([*found.point, *axis, *([] if found.radius is None else [found.radius])])


def distances(kind: str, x: np.ndarray, places: Places) -> list[float]:
    if kind == "cylinder":
        return wall(x[:3], x[3:6], float(x[6]), places)
    return ball(x[:3], float(x[3]), places) if kind == "sphere" else level(x[:3], x[3:6], places)


def squares(off: list[float]) -> float:
    return sum(r * r for r in off)


def biweight(c: float) -> Callable[[list[float]], float]:
    return lambda off: sum(1.0 - (1.0 - (r / c) ** 2) ** 3 if abs(r) < c else 1.0 for r in off)


STEP = 2e-5
"""m, and parts of a direction."""


def require_least(
    kind: str, x: np.ndarray, places: Places, cost: Callable[[list[float]], float], off: float = 1e-8
) -> None:
    """No shape beside it has less; along every number the least lies within `off`, by a parabola through three."""
    here = cost(distances(kind, x, places))
    for step in STEP * np.eye(len(x)):
        ahead, behind = (cost(distances(kind, x + way * step, places)) for way in (1.0, -1.0))
        bend = ahead + behind - 2.0 * here
        if bend > 1e-9 * here:  # along an axis, in a plane, and by the length of a direction nothing changes
            assert 0.5 * STEP * abs(ahead - behind) / bend < off
    rng = np.random.default_rng(0)
    for size in (1e-4, 1e-3, 1e-2):
        for _ in range(20):
            assert cost(distances(kind, x + size * 0.05 * rng.normal(size=len(x)), places)) >= here * (1.0 - 1e-12)


@pytest.mark.parametrize("kind", list(FIT))
def test_squares_by_hand(kind: str) -> None:
    places = cloud(kind)
    found = FIT[kind](np.array(places), robust=False)
    off = distances(kind, numbers(found), places)
    np.testing.assert_allclose(found.quality.residual, off, atol=1e-12)
    assert found.rms == pytest.approx(sqrt(squares(off) / len(off)), rel=1e-9)
    require_least(kind, numbers(found), places, squares)


@pytest.mark.parametrize("kind", list(FIT))
def test_biweight_by_hand(kind: str) -> None:
    """c is 4.685 standard deviations, each 1.4826 times the median distance, of what was found itself."""
    places = cloud(kind)
    found = FIT[kind](np.array(places))
    off = distances(kind, numbers(found), places)
    np.testing.assert_allclose(found.quality.residual, off, atol=1e-12)
    c = 4.685 * 1.4826 * float(np.median(np.abs(off)))
    assert found.quality.noise == pytest.approx(c / 4.685, rel=1e-9)
    require_least(kind, numbers(found), places, biweight(c), 2e-6)  # its scale ends within a thousandth
    assert squares(off) > squares(distances(kind, numbers(FIT[kind](np.array(places), robust=False)), places))


def test_a_circle_by_hand() -> None:
    rng, places = np.random.default_rng(1), []
    for _ in range(90):
        a, r = rng.uniform(0.2, 1.9), 0.05 + 2e-4 * rng.normal()
        places.append((0.3 + r * cos(a), -0.7 + r * sin(a)))
    found = fit_circle(np.array(places), robust=False)

    def cost(p: float, q: float, radius: float) -> float:
        return sum((hypot(x - p, y - q) - radius) ** 2 for x, y in places)

    x = np.array([*found.centre, found.radius])
    here = cost(*x)
    for k in range(3):
        step = 1e-6 * np.eye(3)[k]
        ahead, behind = cost(*(x + step)), cost(*(x - step))
        assert ahead > here < behind
        assert abs(ahead - behind) < 0.02 * (ahead + behind - 2.0 * here)


@pytest.mark.parametrize("robust", [True, False])
@pytest.mark.parametrize("kind", list(FIT))
def test_what_is_searched_is_the_sum_of_the_formula(kind: str, robust: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Half c² Σ ρ((r/c)²) as SciPy adds it up, in the search that ends: ρ(z) = z, log(1 + z), (1 - (1 - z)³)/3."""
    ended: list[tuple[str, float, float, np.ndarray]] = []
    real = scipy.optimize.least_squares

    def seen(*arguments: object, **options: object) -> object:
        found = real(*arguments, **options)
        name = getattr(options["loss"], "__name__", options["loss"])
        ended.append((str(name), float(options["f_scale"]), float(found.cost), found.fun))  # type: ignore[arg-type]
        return found

    monkeypatch.setattr(scipy.optimize, "least_squares", seen)
    FIT[kind](np.array(cloud(kind)), robust=robust)
    assert {name for name, *_ in ended} == ({"cauchy", "biweight"} if robust else {"linear"})
    for name, c, cost, off in ended:
        total = 0.0
        for r in off:
            z = (r / c) ** 2
            if name == "biweight":
                total += (1.0 - (1.0 - z) ** 3 if z < 1.0 else 1.0) / 3.0
            else:
                total += np.log(1.0 + z) if name == "cauchy" else z
        assert cost == pytest.approx(0.5 * c * c * total, rel=1e-12), name


def test_an_arc_of_all_points_is_the_whole_turn() -> None:
    """Of a ring of places the arc that holds 98 % of them, over 0.98."""
    ring: Places = [(0.1 * cos(2 * pi * k / 100), 0.1 * sin(2 * pi * k / 100), 0.02 * (k % 7)) for k in range(100)]
    found = fit_cylinder(np.array(ring))
    assert found.arc == pytest.approx(2.0 * pi * 97 / 100 / 0.98, rel=1e-6)
