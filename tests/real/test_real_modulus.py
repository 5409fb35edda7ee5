"""E* on the workshop's trial og1: area by its simulated poses, force by the instrumented implant, in pound-force."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.calls import Call, area, call, done

WORKSHOP = "gc4_jw_predsim_workshop"
PAPER = {"E": 4.67e9, "nu": 0.25}


@pytest.fixture(scope="module")
def og1(data_dir: Path, tmp_path_factory: pytest.TempPathFactory) -> Call:
    folder, out = data_dir / WORKSHOP, tmp_path_factory.mktemp("og1")
    joint = ("--osim", folder / "KneeProsthesis.osim", "--joint", "knee_joint", "--angles", "deg", "--moving", "parent")
    bodies = {
        "moving": folder / "Femoral_Component_simpler.stl",
        "fixed": folder / "Tibial_Insert_simpler_superior.stl",
    }
    options = (*joint, "--split", "z", "--medial", "+", "--threshold", "1,2,3,4,5")
    areas = done(area(out / "area", *options, **bodies, motion=folder / "KneeProsthesis.mot", unit="m"))
    force = folder / "KCF_ref.mot"
    arguments = ["--area", areas.folder / "area.csv", "--force", force, "--unit", "lbf", "--radius-mm", 37]
    return done(call("modulus", *arguments, "--length-mm", 60, "--out", out / "m", folder=out / "m"))


def test_modulus_of_the_instrumented_knee(og1: Call) -> None:
    """E* is some 1.5 MPa in the reading "disc", three thousand times below what the paper's 4.67 GPa and 0.25 make."""
    m = json.loads((og1.folder / "modulus.json").read_text(encoding="utf-8"))
    paper = PAPER["E"] / (1.0 - PAPER["nu"] ** 2)
    assert m["frames"] == 41
    assert m["E_star_Pa"] == pytest.approx(1.53e6, rel=0.02)
    low, high = m["E_star_ci95_Pa"]
    assert 0.5e6 < low < 1.2e6 and 1.8e6 < high < 3.0e6
    assert 3000.0 < paper / m["E_star_Pa"] < 3500.0
    assert m["rmse_N"] == pytest.approx(437.0, abs=5.0) and m["r2"] == pytest.approx(0.30, abs=0.02)
    assert m["compartments"]["medial"]["E_star_Pa"] == pytest.approx(2.50e6, rel=0.02)
    assert m["compartments"]["lateral"]["E_star_Pa"] == pytest.approx(1.76e6, rel=0.02)
    assert m["identifiability"]["E, nu"]["verdict"] == "one number"
    assert any("intervals are approximate" in line for line in og1.warnings)
    said = (og1.folder / "run.json").read_text(encoding="utf-8")
    assert "R² is" in said and "the area grows with the threshold" not in said, "4 mm reach the edges of the insert"


def test_no_reading_and_no_threshold_gives_the_papers_modulus(og1: Call) -> None:
    table = og1.table("sensitivity.csv")
    total = table[table["side"] == "total"]
    assert set(total["reading"]) == {"disc", "discs", "strip", "cap", "threshold"}
    assert total["E_star [Pa]"].max() < 0.01 * PAPER["E"]
    assert total["r2 [-]"].max() < 0.5, "the area alone explains less than half of the force's variance"


def test_the_load_of_a_knee_shows_no_work_of_adhesion(og1: Call, data_dir: Path, tmp_path: Path) -> None:
    """The area varies little and the force tenfold: the pull runs to its bound, and is called no work of adhesion."""
    force = data_dir / WORKSHOP / "KCF_ref.mot"
    arguments = ["--area", og1.folder.parent / "area" / "area.csv", "--force", force, "--unit", "lbf"]
    sticks = ["--radius-mm", 37, "--adhesion", "dmt", "--free", "work", "--bootstrap", 0]
    found = done(call("modulus", *arguments, *sticks, "--out", tmp_path / "m", folder=tmp_path / "m"))
    surface = json.loads((found.folder / "modulus.json").read_text(encoding="utf-8"))["surface_energy"]
    assert surface["verdict"] == "not separable" and surface["work_ci95_J_per_m2"][1] == pytest.approx(1e3)
