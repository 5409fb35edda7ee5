"""The studies beside the guide run as they are: on the samples here, on public data in tests/real."""

from __future__ import annotations

import json
import tomllib
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
        ("knee", ["markers", "scale", "ik", "id", "contact", "press", "modulus"]),
        ("prosthesis", ["scale", "ik", "id", *["prosthesis_simulate"] * 3]),
    ],
)
def test_every_step_of_a_shipped_study_is_planned(name: str, steps: list[str]) -> None:
    assert [run.step for run in runs_of(read_study_file(STUDIES / f"{name}.toml", MESHES))] == steps


def test_parts_of_the_prosthesis_are_of_one_person_and_said_to_stand_beside_each_other() -> None:
    """Nothing of the model of both legs goes into the stance; the mass is typed twice."""
    file = STUDIES / "prosthesis.toml"
    study = tomllib.loads(file.read_text(encoding="utf-8"))
    assert study["options"]["mass"] == study["steps"]["scale"]["options"]["mass"]
    taken = any("{scale:" in str(value) or "{ik:" in str(value) for value in study["options"].values())
    assert taken != ("nothing of that model" in file.read_text(encoding="utf-8"))


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
def test_the_samples_of_a_leg_an_implant_and_a_ball(tmp_path: Path) -> None:
    """Markers were made of the model: its angles come back. E* of the ball is that of the layer's closed form.

    A ball d deep in a layer of modulus K, thin as it is against the patch, bears K pi R d^2 / h (Winkler, Johnson 1985,
    4.3); E* is the least squares of that on Hertz's 4/3 sqrt(R) d^1.5. Facets of 2 mm cost 6 %.
    """
    out = tmp_path / "out"
    words = ("cohort", STUDIES / "knee.toml", "--folder", MESHES, "--workers", "1", "--out", out)
    made = call(*words, folder=out)
    assert made.code == 0, made.err
    folder = {step: out / place for step, place in results(out).items()}
    assert set(folder) == {"markers", "scale", "ik", "id", "contact", "press", "modulus"}
    angles, known = moved(folder["ik"] / "ik.mot"), moved(MESHES / "leg_swing.mot")
    for name in ("hip_z", "knee", "ankle"):
        np.testing.assert_allclose(angles[name], known[name], atol=0.05)
    force = pd.read_csv(folder["contact"] / "pressure.csv", comment="#")["force [N]"]
    assert len(force) == 101 and 1.0 < force.max() < 100.0
    young, nu, radius, thick = 5e6, 0.46, 0.020, 0.012
    deep = 1e-3 * np.linspace(0.2, 0.9, 21)
    layer = (1.0 - nu) * young / ((1.0 + nu) * (1.0 - 2.0 * nu)) * np.pi * radius * deep**2 / thick
    hertz = 4.0 / 3.0 * np.sqrt(radius) * deep**1.5
    wanted = float((hertz * layer).sum() / (hertz * hertz).sum())
    found = json.loads((folder["modulus"] / "modulus.json").read_text(encoding="utf-8"))
    total = found["E_star_Pa"]
    assert total == pytest.approx(wanted, rel=0.08)
    assert total > 2.5 * young / (1.0 - nu**2), "a thin layer on a rigid base is no half-space of its material"
    header = (STUDIES / "knee.toml").read_text(encoding="utf-8")
    assert f"E* = {total / 1e6:.0f} MPa of the half-space law is not" in header
    assert f"= {young / (1.0 - nu**2) / 1e6:.1f} MPa" in header


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
