"""Areas and forces that tell nothing of a number: one line that says so, or a result without it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from geocontact.analyses.modulus.result import modulus
from geocontact.data.errors import InputError, InputWarning
from tests.analyses.modulus.synthetic_step import LATERAL, MEDIAL, WHOLE, areas, forces
from tests.identify.synthetic_contact import TRUE

AREAS = [MEDIAL, LATERAL, WHOLE]


def found(folder: Path, area: pd.DataFrame, force: pd.DataFrame | None = None, **options: Any) -> Any:
    """The identification of these tables, the forces of a step unless others are given."""
    area.to_csv(folder / "given_area.csv", index=False)
    file = forces(folder, sides=False)
    if force is not None:
        force.to_csv(file, index=False)
    return modulus(folder / "given_area.csv", file, radius=0.037, **{"bootstrap": 100, **options})


def step(folder: Path) -> pd.DataFrame:
    return pd.read_csv(areas(folder))


def alike(table: pd.DataFrame) -> pd.DataFrame:
    """Every threshold has the areas of the fourth."""
    by_time = table.groupby("time [s]")
    return table.assign(**{name: by_time[name].transform(lambda each: each.iloc[3]) for name in AREAS})


def saturated(table: pd.DataFrame) -> pd.DataFrame:
    """All of the surface lies within every threshold in every frame."""
    return table.assign(**{name: table[name].max() for name in AREAS})


def constant(table: pd.DataFrame) -> pd.DataFrame:
    """The same area in every frame."""
    by_threshold = table.groupby("threshold [mm]")
    return table.assign(**{name: by_threshold[name].transform("mean") for name in AREAS})


@pytest.mark.parametrize(
    ("changed", "free"), [(alike, "threshold"), (saturated, "threshold"), (saturated, "lag"), (constant, "lag")]
)
def test_a_number_that_changes_nothing_is_refused_by_name(tmp_path: Path, changed: Any, free: str) -> None:
    said = f"given_area.csv: total: {free} is not identifiable: the areas do not change with it at the best fit"
    with pytest.raises(InputError, match=said):
        found(tmp_path, changed(step(tmp_path)), free={free: None})


def test_areas_alike_at_every_threshold_are_doubted(tmp_path: Path) -> None:
    with pytest.warns(InputWarning, match="areas are the same at every threshold"):
        assert found(tmp_path, alike(step(tmp_path))).modulus == pytest.approx(TRUE, rel=1e-5)


def test_a_constant_area_tests_no_law(tmp_path: Path) -> None:
    with pytest.warns(InputWarning, match="total: the area is the same in every frame: the law cannot be checked"):
        found(tmp_path, constant(step(tmp_path)), bootstrap=0)


@pytest.mark.parametrize("times", [0.0, -1.0])
def test_forces_that_press_nowhere_are_refused(tmp_path: Path, times: float) -> None:
    force = pd.read_csv(forces(tmp_path, sides=False))
    force["total [N]"] *= times
    with pytest.raises(
        InputError, match=r"total: the force is never above 0 N .*; is the right column named\? see `map`"
    ):
        found(tmp_path, step(tmp_path), force)


@pytest.mark.filterwarnings("ignore:.*the area grows with the threshold")  # of a part that R does not make alone
@pytest.mark.parametrize("area", [False, True])
def test_an_unloaded_side_is_left_out_and_told(tmp_path: Path, area: bool) -> None:
    table, force = step(tmp_path), pd.read_csv(forces(tmp_path))
    force["medial [N]"] = 0.0
    if area:
        table = table.assign(**{MEDIAL: 0.0, WHOLE: table[LATERAL]})
    with pytest.warns(InputWarning, match="medial: .*: this side is left out"):
        result = found(tmp_path, table, force)
    assert list(result.sides) == ["total", "lateral"]
    assert result.sides["lateral"].modulus == pytest.approx(TRUE, rel=1e-5)


def test_frames_in_a_gap_of_the_forces_are_not_used(tmp_path: Path) -> None:
    force = pd.read_csv(forces(tmp_path, sides=False))
    kept = force[~force["time [s]"].between(0.3, 0.6)]
    with pytest.warns(InputWarning, match="frames of the area in there are not used"):
        result = found(tmp_path, step(tmp_path), kept)
    assert len(result.sides["total"].measured) == len(kept)
    np.testing.assert_allclose(result.modulus, TRUE, rtol=1e-5)
