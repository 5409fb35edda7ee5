"""The studies beside the guide run as they are: on the samples here, on public data in tests/real."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from geocontact.study.description import read_study_file
from geocontact.study.steps import runs_of
from meshes.stl import read_stl
from tests.cli.calls import call

ROOT = Path(__file__).parents[2]
STUDIES = ROOT / "docs" / "how-to" / "studies"
MESHES = ROOT / "meshes"


@pytest.mark.parametrize(
    ("name", "steps"),
    [
        ("knee", [name for name in ("markers", "scale", "ik", "id", "contact", "layer", "modulus") for _ in "12"]),
        ("prosthesis", ["scale", *["ik"] * 3, *["id"] * 3, *["simulate"] * 3, "prosthesis_compare"]),
    ],
)
def test_every_step_of_a_shipped_study_is_planned(name: str, steps: list[str]) -> None:
    assert [run.step for run in runs_of(read_study_file(STUDIES / f"{name}.toml", MESHES))] == steps


@pytest.mark.parametrize(("name", "last"), [("knee", "modulus"), ("prosthesis", "prosthesis_compare")])
def test_a_shipped_study_is_one_chain(name: str, last: str) -> None:
    """Every step but moments and the layer's law is behind the end, by what it takes; ik is behind all after it."""
    runs = runs_of(read_study_file(STUDIES / f"{name}.toml", MESHES))
    before: set[str] = {last}
    for run in reversed(runs):
        if run.step in before:
            before |= {*run.takes}
    assert {run.step for run in runs} - before <= {"id", "layer"}
    assert {"scale", "ik"} < before


def moved(file: Path) -> pd.DataFrame:
    """A .mot as a table."""
    lines = file.read_text(encoding="utf-8").splitlines()
    start = next(k for k, line in enumerate(lines) if line.strip() == "endheader") + 1
    rows = [line.split() for line in lines[start:] if line.strip()]
    return pd.DataFrame(np.array(rows[1:], float), columns=rows[0])


@pytest.mark.slow
def test_two_knees_from_markers_to_their_modulus(tmp_path: Path) -> None:
    """Against what the samples were made of, in closed form: sizes, angles, depths, caps, forces and E*.

    The area on the plate is the section of the ball's mesh by the plate's top, cut here edge by edge: 5 % less than the
    cap 2 pi R d at the largest depth (3 % by facets, 2 % as flat as it is), so that E* is 9 % more than what made the
    forces. A layer of oedometric modulus K, thin as it is against the patch, bears K pi R d^2 / h (Winkler; Johnson
    1985, 4.3), and its E* is the least squares of that on Hertz's 4/3 sqrt(R) d^1.5.
    """
    out = tmp_path / "out"
    words = ("cohort", STUDIES / "knee.toml", "--folder", MESHES, "--workers", "1", "--out", out)
    made = call(*words, folder=out)
    assert made.code == 0, made.err
    rows = pd.read_csv(out / "trials.csv", keep_default_na=False)
    assert set(rows["state"]) == {"done"} and len(rows) == 14
    header = (STUDIES / "knee.toml").read_text(encoding="utf-8")
    people = {
        "K1": (20.0, (0.2, 0.9), 15e6, 1.0, 1.0),
        "K2": (18.0, (0.3, 0.8), 22e6, 1.1, 0.95),
    }
    for name, (radius, (least, most), modulus, thigh, shank) in people.items():
        own = rows[rows["subject"] == name].set_index("step")["folder"]
        sizes = json.loads((out / own["scale"] / "scale.json").read_text(encoding="utf-8"))["factors"]
        assert sizes == {"femur_r": pytest.approx(thigh, abs=1e-6), "tibia_r": pytest.approx(shank, abs=1e-6)}
        angles, known = moved(out / own["ik"] / "ik.mot"), moved(MESHES / f"knee_leg_{name}" / "swing.mot")
        for each in ("hip_z", "knee", "ankle"):
            np.testing.assert_allclose(angles[each], known[each], atol=0.01)
        for each in ("knee_tx", "knee_ty", "knee_tz"):
            np.testing.assert_allclose(angles[each], known[each], atol=2e-6)
        turn = 2.0 * np.pi * np.linspace(0.0, 1.0, 61)
        deep = 1e-3 * (least + (most - least) * np.sin(0.5 * turn) ** 2)
        area = pd.read_csv(out / own["contact"] / "area.csv", comment="#")
        np.testing.assert_allclose(-1e-3 * area["min_distance [mm]"], deep, atol=0.05e-3)
        cut = section(radius, deep, np.radians(known["knee"].to_numpy()))
        np.testing.assert_allclose(1e-6 * area["area_fixed [mm^2]"], cut, rtol=5e-3)
        assert cut.max() == pytest.approx(0.95 * 2.0 * np.pi * 1e-3 * radius * deep.max(), rel=0.01)
        cells = pd.read_csv(MESHES / f"knee_leg_{name}" / "force.csv", comment="#")["total [N]"]
        hertz = 4.0 / 3.0 * np.sqrt(1e-3 * radius) * deep**1.5
        np.testing.assert_allclose(cells, modulus * hertz, rtol=1e-3)
        law = 4.0 / 3.0 * np.sqrt(1e-3 * radius) * (cut / (2.0 * np.pi * 1e-3 * radius)) ** 1.5
        by_hand = float((law * modulus * hertz).sum() / (law * law).sum())
        assert e_star(out / own["modulus"]) == pytest.approx(by_hand, rel=5e-3)
        assert by_hand == pytest.approx(modulus, rel=0.09)
        young, nu, thick = 5e6, 0.46, 0.012
        layer = (1.0 - nu) * young / ((1.0 + nu) * (1.0 - 2.0 * nu)) * np.pi * 1e-3 * radius * deep**2 / thick
        wanted = float((hertz * layer).sum() / (hertz * hertz).sum())
        found = e_star(out / own["layer"])
        assert found == pytest.approx(wanted, rel=0.08)
        assert found > 2.5 * young / (1.0 - nu**2), "a thin layer on a rigid base is no half-space of its material"
        assert f"{name} {modulus / 1e6:.0f} MPa" in header
        if name == "K1":
            assert f"E* = {found / 1e6:.0f} MPa of K1's layer" in header
            assert f"= {young / (1.0 - nu**2) / 1e6:.1f} MPa" in header


def section(radius: float, deep: np.ndarray, knee: np.ndarray) -> np.ndarray:
    """Areas [m^2] of the sample ball's mesh in the plane of the plate's top, the plate turned by the knee's angle."""
    vertices, faces = read_stl(MESHES / f"sphere_r{radius:.0f}.stl")
    edges = np.unique(np.sort(np.vstack([faces[:, pair] for pair in ([0, 1], [1, 2], [2, 0])]), axis=1), axis=0)
    found = []
    for depth, turn in zip(deep, knee, strict=True):
        places = vertices @ Rotation.from_euler("z", -turn).as_matrix().T
        level = 1e3 * depth - radius
        low, high = places[edges[:, 0]], places[edges[:, 1]]
        through = (low[:, 1] - level) * (high[:, 1] - level) < 0.0
        low, high = low[through], high[through]
        share = ((level - low[:, 1]) / (high[:, 1] - low[:, 1]))[:, None]
        found.append(1e-6 * ConvexHull(((1.0 - share) * low + share * high)[:, ::2]).volume)
    return np.array(found)


def e_star(folder: Path) -> float:
    return float(json.loads((folder / "modulus.json").read_text(encoding="utf-8"))["E_star_Pa"])


@pytest.mark.slow
@pytest.mark.long
def test_the_samples_of_a_prosthesis_at_its_settings(tmp_path: Path) -> None:
    """The stances that are compared are those that were simulated; the largest forces are the plates' within 15 %."""
    out = tmp_path / "out"
    words = ("cohort", STUDIES / "prosthesis.toml", "--folder", MESHES, "--workers", "1", "--out", out)
    made = call(*words, folder=out)
    assert made.code == 0, made.err
    rows = pd.read_csv(out / "trials.csv", keep_default_na=False)
    assert set(rows["state"]) == {"done"}
    of = rows[rows["step"] == "simulate"].set_index("setting")["folder"]
    compared = pd.read_csv(out / rows.set_index("step")["folder"]["prosthesis_compare"] / "errors.csv", comment="#")
    compared = compared.set_index(["setting", "quantity"])["rmse"]
    for setting, walk in (("low", "amputee_P1_low"), ("medium", "amputee_P1"), ("high", "amputee_P1_high")):
        own = pd.read_csv(out / of[setting] / "errors.csv", comment="#").set_index("quantity")["rmse"]
        for quantity in ("resultant", "vertical", "cop_ground"):
            assert compared[setting, quantity] == pytest.approx(own[quantity], rel=1e-6)
        stance = pd.read_csv(out / of[setting] / "stance.csv", comment="#")["force_y [N]"]
        plate = moved(MESHES / walk / "plates.mot")["own_force_vy"]
        assert stance.max() == pytest.approx(plate.max(), rel=0.15)
    moments = pd.read_parquet(out / "tables" / "id" / "forces.parquet")
    assert len(moments) > 300 and np.isfinite(moments.select_dtypes("number")).all().all()
