"""The studies beside the guide run as they are: on the samples here, on public data in tests/real."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from geocontact.study.description import read_study_file
from geocontact.study.steps import runs_of
from tests.cli.calls import call

ROOT = Path(__file__).parents[2]
STUDIES = ROOT / "docs" / "how-to" / "studies"
MESHES = ROOT / "meshes"


@pytest.mark.parametrize(
    ("name", "steps"),
    [
        ("knee", ["markers", "scale", "ik", "id", "contact", "modulus"]),
        ("prosthesis", ["scale", "ik", "id", *["prosthesis_simulate"] * 3]),
    ],
)
def test_every_step_of_a_shipped_study_is_planned(name: str, steps: list[str]) -> None:
    assert [run.step for run in runs_of(read_study_file(STUDIES / f"{name}.toml", MESHES))] == steps


def results(out: Path) -> pd.Series:
    """Folder of the results of each evaluation that is done."""
    rows = pd.read_csv(out / "trials.csv", keep_default_na=False)
    return rows[rows["state"] == "done"].groupby("step")["folder"].first()


def moved(file: Path) -> pd.DataFrame:
    """A .mot as a table."""
    lines = file.read_text(encoding="utf-8").splitlines()
    start = next(k for k, line in enumerate(lines) if line.strip() == "endheader") + 1
    rows = [line.split() for line in lines[start:] if line.strip()]
    return pd.DataFrame(np.array(rows[1:], float), columns=rows[0])


@pytest.mark.slow
def test_the_samples_from_markers_to_a_modulus(tmp_path: Path) -> None:
    """Markers were made of the model: its angles come back. E* is the least squares of F on 4/3 a^3/R."""
    out = tmp_path / "out"
    words = ("cohort", STUDIES / "knee.toml", "--folder", MESHES, "--workers", "1", "--out", out)
    made = call(*words, folder=out)
    assert made.code in (0, 1), made.err
    folder = {step: out / place for step, place in results(out).items()}
    assert set(folder) == {"markers", "scale", "ik", "id", "contact", "modulus"}
    angles, known = moved(folder["ik"] / "ik.mot"), moved(MESHES / "leg_swing.mot")
    for name in ("hip_z", "knee", "ankle"):
        np.testing.assert_allclose(angles[name], known[name], atol=0.05)
    area = pd.read_csv(folder["contact"] / "area.csv", comment="#")
    force = pd.read_csv(folder["contact"] / "pressure.csv", comment="#")["force [N]"].to_numpy()
    law = 4.0 / 3.0 * (1e-6 * area["area_fixed [mm^2]"].to_numpy() / np.pi) ** 1.5 / 0.032
    wanted = float((law * force).sum() / (law * law).sum())
    found = json.loads((folder["modulus"] / "modulus.json").read_text(encoding="utf-8"))
    assert found["E_star_Pa"] == pytest.approx(wanted, rel=1e-6)


@pytest.mark.slow
def test_the_samples_of_a_prosthesis_at_one_setting(tmp_path: Path) -> None:
    """Scaled, its angles and moments, and a simulated stance whose largest force is the plate's within 15 %."""
    out = tmp_path / "out"
    words = ("cohort", STUDIES / "prosthesis.toml", "--folder", MESHES, "--workers", "1", "--out", out)
    made = call(*words, "--only", "setting=low", folder=out)
    assert made.code == 0, made.err
    rows = pd.read_csv(out / "trials.csv", keep_default_na=False)
    assert list(rows["state"]) == ["done", "done", "done", "not asked for", "done", "not asked for"]
    stance = pd.read_parquet(out / "tables" / "prosthesis_simulate" / "stance.parquet")
    plate = moved(MESHES / "gait_P1_low_1" / "plates.mot")["own_force_vy"]
    assert set(stance["setting"]) == {"low"} and stance["force_y [N]"].max() == pytest.approx(plate.max(), rel=0.15)
    moments = pd.read_parquet(out / "tables" / "id" / "forces.parquet")
    assert len(moments) > 100 and np.isfinite(moments.select_dtypes("number")).all().all()
