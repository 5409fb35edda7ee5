"""Intervals of the radius: how often they hold it, for independent noise and for errors that neighbours share."""

import multiprocessing
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pytest

from geocontact.geometry.fit.cylinder import fit_cylinder
from geocontact.geometry.fit.found import cells, covariance, half_width
from tests.geometry.fit.clouds import CLOUDS, RADIUS, wall


def fitted(kind, runs):
    """Radius, interval and half-width of every run."""
    fits = [fit_cylinder(CLOUDS[kind](seed)) for seed in range(runs)]
    return [(fit.radius, fit.radius_interval, fit.quality.half_widths[-1]) for fit in fits]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "runs", "least"),
    [(next(iter(CLOUDS)), 30, 25), *(pytest.param(each, 60, 52, marks=pytest.mark.long) for each in CLOUDS)],
)
def test_the_interval_holds_the_radius_as_often_as_it_says(kind, runs, least):
    """Of 60 runs at least 52: 57 expected, three standard errors of the binomial are 5; of 30 25, since they are 3.6.

    In a process of its own, where shapes are not checked at every call.
    """
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        radius, interval, half = zip(*pool.submit(fitted, kind, runs).result(), strict=True)
    held = sum(low <= RADIUS <= high for low, high in interval)
    assert held >= least, held
    assert np.median(half) / np.std(radius) == pytest.approx(2.0, rel=0.35)


@pytest.mark.slow
def test_a_finer_mesh_does_not_narrow_the_interval_of_a_wrong_shape():
    """An ellipse of half-axes 36 and 38 mm; independent points would promise half the width with four times as many."""
    wide = []
    for count in (2000, 32_000):
        angle, height = wall(120, count)
        way = RADIUS * np.column_stack([np.cos(angle) * 36 / 37, np.sin(angle) * 38 / 37, height / RADIUS])
        wide.append(fit_cylinder(way).quality.half_widths[-1])
    assert wide[1] / wide[0] == pytest.approx(1.0, rel=0.25)


def test_cells_are_compact_and_even():
    cloud = np.random.default_rng(0).uniform(size=(4000, 3)) * [4.0, 1.0, 0.01]
    cell = cells(cloud)
    count = np.bincount(cell)
    assert len(count) == 16 and count.min() == count.max() == 250
    size = [np.ptp(cloud[cell == k, :2], axis=0).max() for k in range(16)]
    assert max(size) < 0.62, "sixteen squares of half a unit"
    np.testing.assert_array_equal(cells(cloud[:200]), np.arange(200))


def test_what_the_points_do_not_tell_is_infinitely_uncertain():
    """Two columns of the Jacobian are the same: only their sum is determined."""
    rng = np.random.default_rng(2)
    column = rng.normal(size=(2000, 1))
    cell = cells(rng.uniform(size=(2000, 3)))
    unknown = covariance(rng.normal(size=2000), np.hstack([column, column]), None, cell)
    assert np.isinf(unknown).all() and np.isinf(half_width(float(unknown[0, 0]), cell, 2))
    known = covariance(rng.normal(size=2000), column, None, cell)
    assert known[0, 0] == pytest.approx(1.0 / 2000.0, rel=0.5)
