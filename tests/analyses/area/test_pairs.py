"""Several pairs of bodies in one motion: the numbers of single runs to the last digit, sums, loads, and refusals."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

import geocontact as gc
from geocontact.analyses.area.pairs.result import PairsResult
from geocontact.data.errors import InputError, InputWarning
from tests.analyses.area.calls import area
from tests.cli.calls import FEMUR, INSERT, MESHES, PLATE, SPHERE, written
from tests.closed_forms import sphere_plane_on_plane, sphere_plane_on_sphere

PATELLA = MESHES / "patella_right_coarse.stl"
FRAMES = [0, 14, 72]


def few(folder: Path, name: str) -> Path:
    """Some rows of a shipped motion."""
    lines = (MESHES / name).read_text("utf-8").splitlines()
    return written(folder / name, "\n".join([lines[0], *(lines[1 + k] for k in FRAMES)]) + "\n")


def described(folder: Path, text: str) -> Path:
    return written(folder / "pairs.toml", text)


def knee(folder: Path, more: str = "") -> Path:
    """The shipped description with three frames, beside its meshes."""
    text = (MESHES / "knee_pairs.toml").read_text("utf-8")
    for name in ("gait.csv", "gait_patella.csv"):
        text = text.replace(name, few(folder, name).as_posix())
    for mesh in (FEMUR, INSERT, PATELLA):
        text = text.replace(f'"{mesh.name}"', f'"{mesh.as_posix()}"')
    return described(folder, text + more)


def run(file: Path, **options: Any) -> PairsResult:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        return gc.area_pairs(file, **{"threshold": (1e-3, 4e-3), "workers": 1, **options})


def same(one: pd.DataFrame, other: pd.DataFrame) -> None:
    pd.testing.assert_frame_equal(one, other, check_exact=True)


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> PairsResult:
    return run(knee(tmp_path_factory.mktemp("pairs")))


def test_each_pair_is_its_single_run_to_the_last_digit(found: PairsResult, tmp_path: Path) -> None:
    femur, patella = few(tmp_path, "gait.csv"), few(tmp_path, "gait_patella.csv")
    given: dict[str, Any] = {"threshold": (1e-3, 4e-3), "workers": 1}
    medial = area(FEMUR, INSERT, femur, region="z < 0", **given).table()
    lateral = area(FEMUR, INSERT, femur, region="z > 0", **given).table()
    behind = area(PATELLA, FEMUR, patella, motion_fixed=str(femur), **given).table()
    for name, alone in (("medial", medial), ("lateral", lateral), ("patellofemoral", behind)):
        same(found.table(f"{name}/area"), alone)
        rows = found.table("pairs")
        same(rows[rows["pair"] == name].drop(columns="pair").reset_index(drop=True), alone)
    totals = found.table()
    np.testing.assert_array_equal(totals["area_medial [mm^2]"], medial["area_fixed [mm^2]"])
    three = medial["area_fixed [mm^2]"] + lateral["area_fixed [mm^2]"] + behind["area_fixed [mm^2]"]
    np.testing.assert_allclose(totals["area_total [mm^2]"], three, rtol=1e-14)
    least = np.minimum(
        np.minimum(medial["min_distance [mm]"], lateral["min_distance [mm]"]), behind["min_distance [mm]"]
    )
    np.testing.assert_array_equal(totals["min_distance [mm]"], least)
    assert behind["area_fixed [mm^2]"].min() > 50.0, "the button lies in the groove in every frame"
