"""Which value of a foot is best, and an arc through a path, beside loops over plain numbers."""

from __future__ import annotations

from math import ceil, floor, hypot, sqrt

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.design.choice import choose
from geocontact.below_knee_prosthesis.design.outcomes import arc_through

VALUES = np.array([0.066, 0.081, 0.099, 0.118, 0.13, 0.151])
LEVEL, DRAWS = 0.9, 25


def middle(sample: list[float]) -> float:
    ordered = sorted(sample)
    return ordered[len(ordered) // 2]


def ends(sample: list[float]) -> tuple[float, float]:
    """The draws just outside of the middle 90 %."""
    ordered, most = sorted(sample), len(sample) - 1
    return ordered[floor(0.05 * most + 1e-9)], ordered[ceil(0.95 * most - 1e-9)]


def lines(place: float, seed: int) -> list[tuple[float, float]]:
    """Of each draw an outcome that rises from 3 at a place of its own by a slope of its own."""
    rng = np.random.default_rng(seed)
    return [(place + 2e-3 * rng.normal(), 20.0 + 6.0 * rng.normal()) for _ in range(DRAWS)]


def by_hand(drawn: list[tuple[float, float]], target: float | None, sense: str) -> list[list[float]]:
    """How far from what is wanted each draw is at each of 401 values."""
    fine = [0.066 + 0.085 * k / 400 for k in range(401)]
    rows = []
    for place, slope in drawn:
        outcome = [3.0 + slope * (value - place) for value in fine]
        rows.append([abs(y - target) if target is not None else y if sense == "least" else -y for y in outcome])
    return rows


@pytest.mark.parametrize(("sense", "target"), [("nearest", 3.0), ("nearest", 3.2), ("least", None), ("most", None)])
def test_a_choice_by_hand(sense: str, target: float | None) -> None:
    """Straight outcomes, which a monotone cubic leaves straight; three responses, of which two are judged."""
    responses = [lines(at, k) for k, at in enumerate((0.108, 0.112, 0.095))]
    drawn = np.array([[[3.0 + slope * (v - place) for v in VALUES] for place, slope in one] for one in responses])
    found = choose(VALUES, np.moveaxis(drawn, 0, 1), sense, target, 0.14, LEVEL)  # type: ignore[arg-type]
    fine = [0.066 + 0.085 * k / 400 for k in range(401)]
    wanted = {}
    for name, one, values in zip(("angles kept", "torque kept", "joint torques kept"), responses, drawn, strict=True):
        sizes = sorted(abs(float(y)) for y in values.ravel())
        size = 0.5 * (sizes[len(sizes) // 2] + sizes[len(sizes) // 2 - 1])
        firsts, lasts, bests = [], [], []
        for row in by_hand(one, target, sense):
            near = [k for k in range(401) if row[k] <= min(row) + 0.01 * size]
            firsts.append(fine[near[0]])
            lasts.append(fine[near[-1]])
            bests.append(fine[row.index(min(row))])
        side = found.sides[name]  # type: ignore[index]
        wanted[name] = middle(bests)
        assert side.best == pytest.approx(middle(bests), abs=1e-12)
        assert (side.lower, side.upper) == pytest.approx((ends(firsts)[0], ends(lasts)[1]), abs=1e-12)
        assert side.verdict == "identified"
    assert found.told
    best = 0.5 * (wanted["angles kept"] + wanted["torque kept"])
    assert found.best == pytest.approx(best, abs=1e-12)
    for name, one in zip(("angles kept", "torque kept", "joint torques kept"), responses, strict=True):
        gains = []
        for place, slope in one:
            away = []
            for value in (0.14, best):
                y = 3.0 + slope * (value - place)
                away.append(abs(y - target) if target is not None else y if sense == "least" else -y)
            gains.append(away[0] - away[1])
        lower, upper = ends(gains)
        assert found.gain[name] == pytest.approx((middle(gains), lower, upper), abs=1e-9)  # type: ignore[index]


def test_an_arc_by_hand() -> None:
    """Least Σ ((x - a)² + (y - b)² - R²)², by its normal equations; what is off is the distance from the circle."""
    rng = np.random.default_rng(4)
    path = [(0.02 * k - 0.07, 0.3 - sqrt(0.36**2 - (0.02 * k - 0.07) ** 2) + 1e-3 * rng.normal()) for k in range(9)]
    found = arc_through(np.array(path))
    (a, b), radius = found.middle, found.radius

    def squares(a: float, b: float, radius: float) -> float:
        return sum(((x - a) ** 2 + (y - b) ** 2 - radius**2) ** 2 for x, y in path)

    for step in 1e-5 * np.eye(3):
        ahead, behind = (squares(a + w * step[0], b + w * step[1], radius + w * step[2]) for w in (1.0, -1.0))
        here = squares(a, b, radius)
        assert ahead > here < behind and abs(ahead - behind) < 0.01 * (ahead + behind - 2.0 * here)
    off = sqrt(sum((hypot(x - a, y - b) - radius) ** 2 for x, y in path) / 9)
    assert found.off == pytest.approx(off, rel=1e-9)
