"""What places a mat and a rectangle on a scan, beside loops over plain numbers: marks in a plane, sides by Huber."""

from __future__ import annotations

from math import atan2, cos, sin

import numpy as np

from geocontact.geometry.drape.lay import anchored
from geocontact.geometry.drape.mat import Marks, Mat
from geocontact.geometry.drape.scan_difference import _lines
from tests.geometry.drape.sheets import over, plane

ROBUST = 1e-3
"""m; of Huber's loss, times the mean root of the lengths."""


def test_marks_on_a_plane_by_hand() -> None:
    """Least of Σ |place - mark|²: in the plane the turn is that of Σ a x b over Σ a · b, arms about the middles."""
    rng = np.random.default_rng(2)
    mat = Mat(8, 6, (0.02, 0.015))
    cells = np.array([[0.0, 0.0], [0.0, 6.0], [8.0, 6.0], [8.0, 0.0], [3.0, 2.0]])
    flat = [(0.02 * (row - 4.0), 0.015 * (column - 3.0)) for row, column in cells]
    marks = []
    for x, y in flat:
        there = 0.013 + cos(0.35) * x - sin(0.35) * y, -0.021 + sin(0.35) * x + cos(0.35) * y
        marks.append([there[0] + 2e-3 * rng.normal(), there[1] + 2e-3 * rng.normal(), 0.0])
    middles = [[sum(p[k] for p in points) / 5 for k in (0, 1)] for points in (flat, marks)]
    crossed = straight = 0.0
    for p, q in zip(flat, marks, strict=True):
        a, b = [[r[k] - m[k] for k in (0, 1)] for r, m in zip((p, q), middles, strict=True)]
        crossed += a[0] * b[1] - a[1] * b[0]
        straight += a[0] * b[0] + a[1] * b[1]
    turn = atan2(crossed, straight)
    (x, y), (u, v) = middles
    place = [u - cos(turn) * x + sin(turn) * y, v - sin(turn) * x - cos(turn) * y, 0.0]
    found = anchored(over(plane()), mat, Marks(cells, np.array(marks)))
    np.testing.assert_allclose(found.place.point[0], place, atol=2e-7)
    np.testing.assert_allclose(found.heading, [cos(turn), sin(turn), 0.0], atol=2e-6)


def huber(offset: float, slope: float, places: list[tuple[float, float, float]], scale: float) -> float:
    """Σ of r² within the scale, and of 2 c |r| - c² beyond, r = (offset + slope x - y) √length."""
    total = 0.0
    for x, y, length in places:
        r = abs(offset + slope * x - y) * length**0.5
        total += r * r if r < scale else 2.0 * scale * r - scale * scale
    return total


def test_sides_by_hand() -> None:
    """An outline of 0.30 x 0.18 m with lengths of which no two are alike, a hair standing off one side."""
    rng = np.random.default_rng(5)
    outline, length, belongs = [], [], []
    for side in range(4):
        for place in np.linspace(-0.98, 0.98, 40):
            along, across = (0.15, 0.09) if side % 2 else (0.09, 0.15)
            u, v = place * along, (1.0 if side >= 2 else -1.0) * across + 4e-4 * rng.normal() + 0.02 * place * 0.1
            if side == 3 and abs(place) < 0.1:
                v += 0.012
            outline.append((u, v) if side % 2 else (v, u))
            length.append(rng.uniform(1e-3, 9e-3))
            belongs.append(side)
    plane_of, sizes = np.array(outline), np.array(length)
    found = _lines(plane_of, sizes)
    low, high = (np.percentile(plane_of, share, axis=0) for share in (2.0, 98.0))
    for side, (axis, offset, slope) in enumerate(found):
        a = side % 2
        assert int(axis) == a
        other, margin = 1 - a, 0.08 * (high[1 - a] - low[1 - a])
        mine = [
            (outline[k][other], outline[k][a], length[k])
            for k in range(len(outline))
            if belongs[k] == side and low[other] + margin < outline[k][other] < high[other] - margin
        ]
        scale = ROBUST * sum(each[2] ** 0.5 for each in mine) / len(mine)
        here = huber(offset, slope, mine, scale)
        for by, step in (((1.0, 0.0), 1e-6), ((0.0, 1.0), 1e-5)):
            ahead, behind = (huber(offset + w * by[0] * step, slope + w * by[1] * step, mine, scale) for w in (1, -1))
            assert 0.5 * step * abs(ahead - behind) / (ahead + behind - 2.0 * here) < 2e-7, side
