"""Markers of a .csv table, and what is no such table."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputError
from geocontact.io.mocap.markers import read_markers


def table(folder: Path, text: str) -> Path:
    file = folder / "markers.csv"
    file.write_text(text, encoding="utf-8")
    return file


def test_units_and_gaps(tmp_path: Path) -> None:
    text = "time [s],A_x [mm],A_y [mm],A_z [mm],event [-],B_x [m],B_y [m],B_z [m]\n0,1,2,3,0,1,1,1\n0.1,,,,1,2,2,2\n"
    seen = read_markers(table(tmp_path, text))
    assert seen.names == ("A", "B")
    np.testing.assert_allclose(seen.positions[0], [[1e-3, 2e-3, 3e-3], [1.0, 1.0, 1.0]])
    assert np.isnan(seen.positions[1, 0]).all() and np.all(seen.positions[1, 1] == 2.0)


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("time [s],angle [deg]\n0,1\n1,2\n", "holds no marker; name three columns NAME_x"),
        ("time [s],A_x [mm],A_y [mm]\n0,1,2\n1,2,3\n", "no column 'A_z'; every marker needs x, y and z once"),
        ("time [s],A_x,A_y,A_z\n0,1,2,3\n1,2,3,4\n", "column 'A_x': unit is ''; write one of m, cm, mm"),
        (
            "time [%],A_x [m],A_y [m],A_z [m]\n0,1,2,3\n1,2,3,4\n",
            "time is in per cent of a cycle; markers need seconds",
        ),
    ],
)
def test_refused(tmp_path: Path, text: str, what: str) -> None:
    with pytest.raises(InputError) as error:
        read_markers(table(tmp_path, text))
    assert what in str(error.value)
