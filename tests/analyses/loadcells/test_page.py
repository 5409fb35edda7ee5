"""The page of a load-cell recording: tray, single cycles, body weight, gaps."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from geocontact.analyses.loadcells.result import ROWS, load_cells
from geocontact.analyses.loadcells.show import SINGLE, loadcell_page, samples, some_cycles, tray_plan
from geocontact.data.errors import InputError
from geocontact.view.page.content import Curves, Page, Plan
from geocontact.view.page.tables import frame_table
from geocontact.view.page.write import write_page
from tests.analyses.loadcells.synthetic_walk import HEAD, gait, recorded


def page_of(file: Path, **options: Any) -> Page:
    result = load_cells(file, unit="N", **options)
    (each,) = result.recordings
    return loadcell_page(each, result.regression, result.cuts, result._ensemble, result.options.body_weight)


def test_the_tray_shows_where_each_side_bears() -> None:
    """Three quarters in front; a side that bears nothing has no centre; nor has one whose cells pull."""
    cells = {"PM": [100.0, 0.0, -50.0], "AM": [300.0, 0.0, 400.0], "AL": [150.0, 400.0, 5.0], "PL": [50.0, 0.0, 5.0]}
    plan = tray_plan({name: np.array(values) for name, values in cells.items()})
    assert plan is not None
    medial, lateral, whole = (track.points for track in plan.tracks)
    np.testing.assert_allclose(medial, [[-1.0, 0.5], [np.nan] * 2, [np.nan] * 2])
    np.testing.assert_allclose(lateral, [[1.0, 0.5], [1.0, 1.0], [np.nan] * 2])
    np.testing.assert_allclose(whole[:2], [[-1.0 / 3.0, 0.5], [1.0, 1.0]])
    assert tray_plan({"medial": np.ones(3), "lateral": np.ones(3)}) is None, "places of other cells are not known"


def test_single_cycles_stand_beside_their_mean(tmp_path: Path) -> None:
    page = page_of(recorded(tmp_path), cycles="0.2:1.3,1.3:2.4,2.4:3.5")
    (panel,) = [s for s in page.sections if isinstance(s, Curves) and "each cycle and the mean" in s.title]
    own, mean = panel.curves
    inside = (page.time > 0.25) & (page.time < 3.45)
    np.testing.assert_allclose(mean.values[inside], own.values[inside], atol=15.0)
    assert np.isnan(mean.values[page.time > 3.51]).all() and mean.lower is not None
    assert any(isinstance(s, Plan) for s in page.sections) and page.leads == range(1)


def test_forces_can_be_read_in_body_weight(tmp_path: Path) -> None:
    page = page_of(recorded(tmp_path), body_mass=70.0)
    assert page.choices is not None and page.choices.own == "N"
    (other,) = page.choices.others
    ours, theirs = page.sections[0], other.instead[0]
    assert isinstance(ours, Curves) and isinstance(theirs, Curves) and theirs.unit == "% of body weight"
    np.testing.assert_allclose(theirs.curves[2].values, ours.curves[2].values * 100.0 / (70.0 * 9.80665))
    assert "% of body weight" in other.headline[0] and page_of(recorded(tmp_path)).choices is None


@pytest.mark.parametrize("mass", [0.05, 72600.0, -70.0, float("nan")])
def test_a_mass_that_no_body_has_is_refused(tmp_path: Path, mass: float) -> None:
    with pytest.raises(InputError, match=r"`body_mass`: .* (cannot be the mass of a person|is not a finite number)"):
        load_cells(recorded(tmp_path), unit="N", body_mass=mass)


def test_curves_are_broken_where_samples_are_missing() -> None:
    time = np.arange(0.0, 5.0, 0.01)
    time = time[(time < 2.0) | (time > 2.395)]
    shown = samples(time)
    values = shown.of(np.ones(len(time)))
    (at,) = np.flatnonzero(np.isnan(values))
    assert 2.0 < shown.time[at] < 2.395
    assert (np.diff(shown.numbers) > 0).all() and shown.numbers[-1] == shown.total == 500, "numbers go with the clock"
    long = samples(np.delete(np.arange(0.0, 50.0, 0.01), np.arange(2501, 2550)))
    assert len(long.kept) < 1300 and np.isnan(long.of(np.ones(len(long.given)))).sum() == 1


@pytest.mark.slow
@pytest.mark.drawn
def test_the_page_of_a_long_recording_stays_below_a_megabyte(tmp_path: Path) -> None:
    """1e5 samples, 908 strides; the one sample of the largest force, far from any other, is on the page."""
    rows = 100_000
    time = 0.01 * np.arange(rows)
    cells = gait(time) + np.random.default_rng(0).normal(0.0, 2.0, (rows, 4))
    cells[54_321] = 1200.0
    cells[65_432, 2] = 0.5
    table = np.column_stack([time, cells])
    np.savetxt(tmp_path / "long.csv", table, fmt="%.6g", delimiter=",", header=HEAD, comments="")
    result = load_cells(tmp_path / "long.csv", unit="N", cycles="stride", level=300.0)
    (each,) = result.recordings
    page = loadcell_page(each, result.regression, result.cuts, lambda _: None)
    force, cell = (s for s in page.sections if isinstance(s, Curves) and s.title in ("Contact force", "Load cells"))
    assert max(np.nanmax(curve.values) for curve in force.curves) == 4800.0
    assert min(np.nanmin(curve.values) for curve in cell.curves) == 0.5
    for stretch in range(20):
        inside, all_of_it = (
            (page.time >= 50 * stretch) & (page.time < 50 * (stretch + 1)),
            slice(5000 * stretch, 5000 * (stretch + 1)),
        )
        highest = table[all_of_it, 1:].sum(axis=1).max()
        assert np.nanmax(force.curves[-1].values[inside]) == pytest.approx(highest, rel=1e-5)
    result.write_page(tmp_path / "report.html")
    assert (tmp_path / "report.html").stat().st_size < 1_000_000
    listed = frame_table("Cycles", result.table("cycles"), 5, ROWS)
    assert len(listed.rows) == ROWS and listed.title == "Cycles, 100 of 908 rows"
    in_both_units = loadcell_page(each, result.regression, result.cuts, result._ensemble, 70.0 * 9.80665, [listed])
    assert write_page(in_both_units, tmp_path / "report.html") < 1_000_000


def test_of_many_cycles_the_highest_and_the_lowest_are_drawn() -> None:
    trials = np.sin(np.linspace(0.0, np.pi, 101)) * np.random.default_rng(3).permutation(np.arange(1.0, 101.0))[:, None]
    drawn = some_cycles(trials)
    assert len(drawn) == SINGLE and drawn.max() == 100.0 and drawn.max(axis=1).min() == pytest.approx(1.0)
    assert some_cycles(trials[:3]) is not None and len(some_cycles(trials[:3])) == 3
