"""Areas beside measured ones, by hand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from geocontact.data.errors import InputError
from geocontact.geometry.contact_area.comparison import Compared, compared, largest_difference

FILE = Path("measured.csv")
OURS = pd.DataFrame(
    {
        "time [s]": [0.0, 0.0, 1.0, 1.0],
        "threshold [mm]": [1.0, 4.0, 1.0, 4.0],
        "area_fixed [mm^2]": [10.0, 100.0, 30.0, 200.0],
    }
)


def measured(**columns: list[float]) -> pd.DataFrame:
    names = {
        "time": "time [s]",
        "threshold": "threshold [mm]",
        "area": "area_fixed [mm^2]",
        "other": "area_moving [mm^2]",
    }
    return pd.DataFrame({names[name]: values for name, values in columns.items()})


def test_ours_is_linear_between_frames() -> None:
    rows = compared(OURS, measured(time=[0.25, 1.0], threshold=[4.0, 1.0], area=[100.0, 40.0]), FILE)
    assert rows["ours [mm^2]"].tolist() == [125.0, 30.0]
    assert rows["difference [mm^2]"].tolist() == [25.0, -10.0]
    assert rows["relative [-]"].tolist() == [0.25, -0.25]
    assert largest_difference(rows) == 0.25
    assert Compared(rows, 0.25).accepted and not Compared(rows, 0.24).accepted


def test_where_nothing_was_measured_any_area_is_infinitely_off() -> None:
    rows = compared(OURS, measured(time=[0.0, 1.0], threshold=[1.0, 1.0], area=[0.0, np.nan]), FILE)
    assert rows["relative [-]"].tolist() == [np.inf]


@pytest.mark.parametrize(
    ("columns", "what"),
    [
        ({"time": [0.0], "area": [1.0]}, "which threshold"),
        ({"time": [2.0], "threshold": [1.0], "area": [1.0]}, "lies outside"),
        ({"time": [0.0], "threshold": [2.0], "area": [1.0]}, "was not evaluated"),
        ({"time": [0.0], "threshold": [1.0], "other": [1.0]}, "not among our columns"),
        ({"time": [0.0], "threshold": [1.0], "area": [np.nan]}, "no area in it is a number"),
    ],
)
def test_what_cannot_be_compared_is_refused(columns: dict[str, list[float]], what: str) -> None:
    with pytest.raises(InputError, match=what):
        compared(OURS, measured(**columns), FILE)
