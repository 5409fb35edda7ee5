"""Tables as Parquet and netCDF: the same numbers, with units and coordinates."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.io import netcdf_file

from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.options import declared
from geocontact.analyses.frame.table_forms import TableForms
from geocontact.data.errors import InputError
from geocontact.io.results import coordinates_of, write_netcdf
from tests.analyses.jobs import JOBS

GRID = pd.DataFrame(
    {
        "time [s]": np.repeat([0.0, 0.1, 0.2], 2),
        "threshold [mm]": np.tile([1.0, 4.0], 3),
        "area_fixed [mm^2]": np.arange(6.0) * 1.1,
        "frames [-]": np.arange(6),
        "angle [deg]": [0.0, np.nan, 2.0, 3.0, 4.0, 5.0],
        "signed": ["both", "none", "both", "", "ja ≤", "both"],
        "kept": [True, False, True, True, False, True],
    }
)


@pytest.fixture
def written(tmp_path: Path) -> netcdf_file:
    write_netcdf(GRID, tmp_path / "grid.nc", {"title": "areas"})
    with netcdf_file(str(tmp_path / "grid.nc"), mmap=False) as found:
        yield found


def test_a_column_is_a_variable_over_its_coordinates(written: netcdf_file) -> None:
    v = written.variables
    assert {name: n for name, n in written.dimensions.items() if "characters" not in name} == {
        "time": 3,
        "threshold": 2,
    }
    np.testing.assert_array_equal(v["time"][:], [0.0, 0.1, 0.2])
    np.testing.assert_array_equal(v["threshold"][:], [1.0, 4.0])
    for column, name in (
        ("area_fixed [mm^2]", "area_fixed"),
        ("frames [-]", "frames"),
        ("kept", "kept"),
        ("angle [deg]", "angle"),
    ):
        assert v[name].dimensions == ("time", "threshold")
        np.testing.assert_array_equal(v[name][:].ravel(), GRID[column].to_numpy(float))
    text = [b"".join(cell).rstrip(b"\0").decode() for cell in v["signed"][:].reshape(6, -1)]
    assert text == list(GRID["signed"])


def test_units_are_attributes_as_cf_writes_them(written: netcdf_file) -> None:
    v = written.variables
    units = {name: v[name].units.decode() for name in ("time", "threshold", "area_fixed", "frames", "angle")}
    assert units == {"time": "s", "threshold": "mm", "area_fixed": "mm^2", "frames": "1", "angle": "degree"}
    assert v["area_fixed"].long_name == b"area_fixed [mm^2]" and not hasattr(v["signed"], "units")
    assert (written.title, written.Conventions) == (b"areas", b"CF-1.11")


def test_a_table_without_columns_has_no_file(tmp_path: Path) -> None:
    """As its .csv: `shoulder optimise` has no scales where all factors are the same, and nobody held out of one."""
    tables = {"grid": GRID, "scales": pd.DataFrame([])}
    TableForms(parquet=True, netcdf=True).write(tables, tmp_path, "shoulder optimise")
    assert sorted(file.name for file in tmp_path.iterdir()) == ["grid.nc", "grid.parquet"]


def test_rows_that_are_no_grid_are_numbered(tmp_path: Path) -> None:
    holes = GRID.drop(index=3)
    assert coordinates_of(GRID) == ("time [s]", "threshold [mm]") and coordinates_of(holes) == ()
    write_netcdf(holes, tmp_path / "holes.nc", {})
    with netcdf_file(str(tmp_path / "holes.nc"), mmap=False) as found:
        assert found.variables["time"].dimensions == ("row",)
        np.testing.assert_array_equal(found.variables["area_fixed"][:], holes["area_fixed [mm^2]"])


def test_columns_that_only_the_unit_tells_apart_keep_it(tmp_path: Path) -> None:
    table = pd.DataFrame(
        {"time [s]": [0.0, 1.0], "x [mm]": [1.0, 2.0], "x [deg]": [3.0, 4.0], "a/b c [N m]": [5.0, 6.0]}
    )
    write_netcdf(table, tmp_path / "t.nc", {})
    with netcdf_file(str(tmp_path / "t.nc"), mmap=False) as found:
        assert set(found.variables) == {"time", "x__mm_", "x__deg_", "a_b_c"}


def test_parquet_keeps_names_digits_and_folders(tmp_path: Path) -> None:
    TableForms(parquet=True).write({"area": GRID, "slow/area": GRID}, tmp_path, "area")
    for name in ("area", "slow/area"):
        pd.testing.assert_frame_equal(pd.read_parquet(tmp_path / f"{name}.parquet"), GRID, check_exact=True)


def test_netcdf_without_a_table_over_time_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="`netcdf`: fit has no table over time; leave it out"):
        TableForms(netcdf=True).write({"fit": GRID[["kept"]]}, tmp_path, "fit")


@pytest.mark.parametrize("job", JOBS, ids=lambda job: job.command)
def test_no_analysis_has_forms_of_its_own(job: Job) -> None:
    assert not {"parquet", "netcdf", "overwrite"} & {one.name for one in declared(job.options)}
