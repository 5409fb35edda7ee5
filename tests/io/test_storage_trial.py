"""Trials out of `ik.mot` and `id.sto`: what columns are is told, and held against the file."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputError
from geocontact.io.cases.gathering import Columns, StorageColumn, read_storage_trial
from geocontact.io.documents import checked
from geocontact.io.opensim.storage_writer import write_storage

TIME = np.linspace(0.0, 1.0, 11)
COLUMNS = {"angle [deg]": "knee_angle_r", "height [m]": "pelvis_ty", "torque [N m]": "knee_angle_r_moment"}


def columns_of(given: object) -> tuple[StorageColumn, ...]:
    """`[columns]` of a gather.toml."""
    found: tuple[StorageColumn, ...] = checked(Path("gather.toml"), Columns, given)
    return found


def ik(folder: Path, degrees: bool = True, name: str = "knee_angle_r") -> Path:
    """As `geocontact ik` writes it."""
    values = np.column_stack([60.0 * TIME, 0.9 + 0.1 * TIME])
    write_storage(folder / "ik.mot", TIME, (name, "pelvis_ty"), values, title="Coordinates", degrees=degrees)
    return folder / "ik.mot"


def test_coordinates_come_in_si_units_and_other_columns_are_left_out(tmp_path: Path) -> None:
    table = read_storage_trial(ik(tmp_path), columns_of(COLUMNS))
    assert table.signals.channels == ("angle", "height") and table.signals.units == ("rad", "m")
    np.testing.assert_allclose(table.signals.column("angle"), np.radians(60.0 * TIME), rtol=1e-9)
    np.testing.assert_allclose(table.signals.column("height"), 0.9 + 0.1 * TIME, rtol=1e-9)
    assert (table.column("angle").unit, table.column("angle").factor) == ("deg", np.pi / 180.0)


def test_a_coordinate_may_be_named_by_its_path(tmp_path: Path) -> None:
    file = ik(tmp_path, name="/jointset/knee_r/knee_angle_r/value")
    columns = columns_of({"angle [deg]": "/jointset/knee_r/knee_angle_r/value"})
    assert read_storage_trial(file, columns).signals.channels == ("angle",)


def test_a_header_that_contradicts_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"angles are in deg by the header, \[columns\] has angle in rad"):
        read_storage_trial(ik(tmp_path), columns_of({"angle [rad]": "knee_angle_r"}))
    with pytest.raises(InputError, match="angles are in rad by the header"):
        read_storage_trial(ik(tmp_path, degrees=False), columns_of({"angle [deg]": "knee_angle_r"}))


def test_degrees_under_a_flag_of_radians_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"column 'knee_angle_r' reaches 60, too much for the radians .*angle \[deg\]"):
        read_storage_trial(ik(tmp_path, degrees=False), columns_of({"angle [rad]": "knee_angle_r"}))


def test_a_file_without_any_of_the_columns_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="holds none of knee_angle_l; columns are: knee_angle_r, pelvis_ty"):
        read_storage_trial(ik(tmp_path), columns_of({"angle [deg]": "knee_angle_l"}))


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"angle": "knee_angle_r"}, "is not a channel with a known unit"),
        ({"angle [furlong]": "knee_angle_r"}, "is not a channel with a known unit"),
        ({"an angle [deg]": "knee_angle_r"}, "is not a channel with a known unit"),
        ({"angle [deg]": 3}, "is 3; write the name of a column in quotes"),
        ({"height [mm]": "pelvis_ty"}, "is in 'mm'; OpenSim's tables are in m; write "),
        ({"torque [N]": "knee_angle_r_moment"}, "column 'knee_angle_r_moment' is in N m by its name"),
        ({"push [N m]": "pelvis_ty_force"}, "column 'pelvis_ty_force' is in N by its name"),
        ("knee", "is not a table"),
    ],
)
def test_what_columns_are_is_told_or_refused(given: object, message: str) -> None:
    with pytest.raises(InputError, match=re.escape(message)):
        columns_of(given)
