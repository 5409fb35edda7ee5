"""A case that was written and read again is the case."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputWarning
from geocontact.data.gap_case import GapCase
from geocontact.data.gap_cells import CellChannels, CellTrial
from geocontact.data.trial import Trial
from geocontact.gap_benchmark.synthetic import synthetic_case
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.io.cases.gap_case_writer import DIGITS, write_gap_case
from tests.io.gap_case_files import case_in


@cache
def planted(system: str) -> GapCase:
    return synthetic_case(system, "none", 5).case


def again(case: GapCase, folder: Path, **options) -> GapCase:
    write_gap_case(case, folder / case.name, **options)
    return read_gap_case(folder / case.name)


def alike(one: GapCase, other: GapCase, relative: float) -> None:
    """Words and settings exactly, columns to the digits printed, empty cells where they were."""
    assert (one.name, one.system, one.parameters) == (other.name, other.system, other.parameters)
    assert dict(one.constants) == dict(other.constants)
    assert dict(one.noise) == pytest.approx(dict(other.noise), rel=1e-14)
    assert [t.name for t in one.calibration] == [t.name for t in other.calibration]
    assert [t.name for t in one.evaluation] == [t.name for t in other.evaluation]
    for here, there in zip((*one.calibration, *one.evaluation), (*other.calibration, *other.evaluation), strict=True):
        trials_alike(here, there, relative)
    assert set(one.tables) == set(other.tables)
    for key, table in one.tables.items():
        assert table.equals(other.tables[key]), key


def trials_alike(here: Trial, there: Trial, relative: float) -> None:
    assert (dict(here.covariates), dict(here.labels)) == (dict(there.covariates), dict(there.labels))
    assert (here.signals.channels, here.signals.units) == (there.signals.channels, there.signals.units)
    np.testing.assert_allclose(here.time, there.time, rtol=relative)
    np.testing.assert_allclose(here.signals.values, there.signals.values, rtol=relative, atol=0.0, equal_nan=True)


@pytest.mark.parametrize("system", ["elbow", "foot"])
def test_planted_cases_survive(tmp_path: Path, system: str) -> None:
    case = planted(system)
    alike(again(case, tmp_path), case, 0.51 * 10.0 ** (1 - DIGITS))


def test_every_part_of_a_case_survives(tmp_path: Path) -> None:
    """Fixed parameters, bounds at infinity, covariates and labels, tables with words that are digits."""
    case = read_gap_case(case_in(tmp_path / "given"))
    odd = replace(case.parameters[0], name="k of zone 1", lower=-np.inf, upper=np.inf)
    case = replace(case, parameters=(*case.parameters, odd))
    alike(again(case, tmp_path, digits=17), case, 1e-15)


def test_cells_survive(tmp_path: Path) -> None:
    case = planted("elbow")
    rng = np.random.default_rng(1)
    there = {t.name: CellTrial(t.time[::3], rng.uniform(0.0, 9e3, (len(t.time[::3]), 2))) for t in case.evaluation}
    mat = CellChannels("force", ("c0", "c7"), rng.uniform(size=(2, 3)), np.array([1e-4, 2e-4]), there)
    with pytest.warns(InputWarning, match="cells of cuff are not used there"):
        found = again(replace(case, cells={"cuff": mat}), tmp_path).cells["cuff"]
    assert (found.channel, found.ids, set(found.trials)) == (mat.channel, mat.ids, set(there))
    np.testing.assert_array_equal([*found.place.T, found.area], [*mat.place.T, mat.area])
    for name, own in there.items():
        np.testing.assert_allclose(found.trials[name].time, own.time, rtol=1e-8)
        np.testing.assert_allclose(found.trials[name].pressure, own.pressure, rtol=1e-8)


def test_other_units_mean_the_same(tmp_path: Path) -> None:
    case = replace(planted("foot"), noise={"force_y": 6.0, "cop_x": 0.001})
    units = {"pitch": "deg", "force_y": "kN", "cop_x": "mm"}
    found = again(case, tmp_path, units=units, digits=17)
    header = (tmp_path / case.name / "trials" / f"{case.calibration[0].name}.csv").read_text("utf-8").splitlines()[0]
    assert all(f"{name} [{unit}]" in header for name, unit in units.items())
    alike(found, case, 1e-14)


def test_a_unit_of_another_dimension_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="beta is in 'rad', which is not written as 'mm'"):
        write_gap_case(planted("elbow"), tmp_path, {"beta": "mm"})


def test_files_do_not_tell_the_name_of_the_case(tmp_path: Path) -> None:
    case = replace(planted("foot"), name="told_nowhere")
    write_gap_case(case, tmp_path / "case")
    assert not [f for f in (tmp_path / "case").rglob("*.*") if "told_nowhere" in f.read_text("utf-8") + f.name]
