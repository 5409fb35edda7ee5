"""The order of convergence that the accuracy table states, on meshes small enough for a test."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.area.accuracy import Case, cases, centres, errors, order, root_mean_square, threshold_of
from geocontact.geometry.contact_area.area import CLIP, REFINED

SPHERES = {case.name: case for case in cases()}


def levels(case: Case, rule: str, cells: Sequence[int]) -> tuple[np.ndarray, np.ndarray]:
    """Numbers of faces and errors of every level, on the moving and on the fixed surface."""
    found = [errors(case, n, rule) for n in cells]
    faces = np.array([counts for counts, _ in found], dtype=float).T
    return faces, np.array([root_mean_square(error) for _, error in found]).T


@pytest.mark.slow
@pytest.mark.parametrize("rule", [CLIP, pytest.param(REFINED, marks=pytest.mark.long)])  # see tests/geometry/test_area
@pytest.mark.parametrize("name", SPHERES)
def test_areas_of_sphere_pairs_converge_at_second_order(name: str, rule: str) -> None:
    observed = [order(faces, error) for faces, error in zip(*levels(SPHERES[name], rule, (8, 12, 16)), strict=True)]
    assert observed == pytest.approx([2.0, 2.0], abs=0.2)


@pytest.mark.slow
@pytest.mark.long
def test_on_the_axis_of_the_cup_the_order_means_nothing() -> None:
    """The edge of the patch lies along the rings of the cup's mesh there, and the error with them."""
    on_axis = replace(SPHERES["sphere in cup"], tilt=0.0)
    for faces, error in zip(*levels(on_axis, REFINED, (8, 12, 16)), strict=True):
        assert order(faces[:2], error[:2]) > 2.2
        assert order(faces[1:], error[1:]) < 1.2


def test_patch_stays_inside_the_cup_however_the_ball_is_moved() -> None:
    """Farthest point of the patch from the cup's pole: around the ball's own direction, plus that direction's tilt."""
    case = SPHERES["sphere in cup"]
    radius, ball, off = 24.0, 23.0, -case.height
    within = threshold_of(case)
    around = np.arccos((radius**2 + off**2 - (ball + within) ** 2) / (2 * radius * off))
    tilt = np.arccos(np.clip(-centres(case)[:, 1] / off, -1.0, 1.0)).max()
    assert tilt <= case.tilt
    assert np.degrees(around + tilt) < 85.0
