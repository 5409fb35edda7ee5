"""A work of adhesion beside E*: found where forces near zero show it, else said not to be separable."""

from __future__ import annotations

import json
import warnings
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from geocontact.analyses.modulus.result import ModulusResult, modulus
from geocontact.data.errors import InputError, InputWarning

RADIUS, TRUE = 0.037, 20e3  # m, Pa: a gel
WORK = 0.5  # J/m^2


def bench(folder: Path, law: str, work: float, noise: float, largest: float = 15e-3, rate: float = 81.0) -> list[Path]:
    """Loading and unloading of a soft sphere: patches and forces by the laws' formulas, white noise of the force."""
    time = np.arange(0.0, 1.0, 1.0 / rate)
    least = (9.0 * np.pi * work * RADIUS**2 / (8.0 * TRUE)) ** (1.0 / 3.0) if law == "jkr" else 1e-4
    patch = least + largest * np.sin(np.pi * time) ** 2
    pull = np.sqrt(8.0 * np.pi * work * TRUE * patch**3) if law == "jkr" else 2.0 * np.pi * work * RADIUS
    force = 4.0 * TRUE * patch**3 / (3.0 * RADIUS) - pull
    force += noise * np.random.default_rng(3).normal(size=len(time))
    area = {"time [s]": time, "threshold [mm]": 0.0, "area_fixed [mm^2]": 1e6 * np.pi * patch**2}
    files = [folder / "area.csv", folder / "force.csv"]
    pd.DataFrame(area).to_csv(files[0], index=False)
    pd.DataFrame({"time [s]": time, "total [N]": force}).to_csv(files[1], index=False)
    return files


def found(files: list[Path], law: str, **options: object) -> ModulusResult:
    """E* and the work of adhesion of such a bench."""
    return modulus(files[0], files[1], radius=RADIUS, adhesion=law, free={"work": None}, bootstrap=0, **options)


def numbers(result: ModulusResult, folder: Path) -> dict[str, object]:
    """What modulus.json has of the surface."""
    result.write_files(folder)
    told: dict[str, object] = json.loads((folder / "modulus.json").read_text(encoding="utf-8"))["surface_energy"]
    return told


@pytest.mark.slow
def test_a_gel_shows_its_work_of_adhesion_and_the_pull_off_force(tmp_path: Path) -> None:
    """By hand: -3/2 π w R."""
    files = bench(tmp_path, "jkr", WORK, 0.001)
    with pytest.warns(InputWarning, match="an error of the force's zero acts as the work of adhesion does"):
        result = found(files, "jkr")
    told = numbers(result, tmp_path)
    assert told["verdict"] == "separable" and told["work_J_per_m2"] == pytest.approx(WORK, rel=0.03)
    low, high = told["work_ci95_J_per_m2"]  # type: ignore[misc]
    assert low < WORK < high and high - low < 0.1 * WORK
    assert told["pull_off_N"] == pytest.approx(-1.5 * np.pi * told["work_J_per_m2"] * RADIUS, rel=1e-9)
    assert told["pull_off_ci95_N"] == pytest.approx([-1.5 * np.pi * w * RADIUS for w in (high, low)], rel=1e-9)
    assert result.modulus == pytest.approx(TRUE, rel=0.02)
    assert any("they come apart at" in line for line in result.sentences)


@pytest.mark.parametrize(("work", "off"), [(WORK, 0.0), (0.0, 0.1)])
def test_a_constant_pull_is_not_separable_from_an_error_of_zero(tmp_path: Path, work: float, off: float) -> None:
    """DMT on one radius pulls by 2 π w R in every frame: bodies that stick, and ones that do not, 0.1 N off zero."""
    files = bench(tmp_path, "dmt", work, 0.001)
    table = pd.read_csv(files[1])
    table["total [N]"] -= off
    table.to_csv(files[1], index=False)
    result = found(files, "dmt")
    told = numbers(result, tmp_path)
    assert told["verdict"] == "not separable"
    assert told["cosine_with_an_error_of_zero"] == pytest.approx(1.0, abs=1e-6)
    assert told["mean_pull_N"] == pytest.approx(2.0 * np.pi * told["work_J_per_m2"] * RADIUS, rel=1e-9)
    assert told["mean_pull_N"] == pytest.approx(2.0 * np.pi * work * RADIUS + off, rel=0.01)
    line = next(line for line in result.sentences if "work of adhesion" in line)
    assert "is not separable from an error of the force's zero (cosine 1.00)" in line and "95 %" not in line
    assert not any("they come apart" in line for line in result.sentences)
    assert "work" not in json.loads((tmp_path / "modulus.json").read_text(encoding="utf-8"))["identifiable"]


@pytest.mark.slow
@pytest.mark.parametrize("law", ["jkr", "dmt"])
def test_the_estimate_is_that_of_a_fine_grid(tmp_path: Path, law: str) -> None:
    """Second derivation: least squares over a grid of w, E* in closed form (DMT) or by a root of the same cubic."""
    files = bench(tmp_path, law, WORK, 0.005)
    force = pd.read_csv(files[1])["total [N]"].to_numpy()
    cubed = (pd.read_csv(files[0])["area_fixed [mm^2]"].to_numpy() * 1e-6 / np.pi) ** 1.5
    unit = 4.0 * cubed / (3.0 * RADIUS)

    def least(work: float) -> float:
        if law == "dmt":
            whole = force + 2.0 * np.pi * work * RADIUS
            return float(np.square(unit * (whole @ unit) / (unit @ unit) - whole).sum())
        roots = np.linspace(100.0, 200.0, 3001)[:, None]  # sqrt(Pa)
        return float(np.square(roots**2 * unit - roots * np.sqrt(8.0 * np.pi * work * cubed) - force).sum(axis=1).min())

    grid = np.linspace(0.4, 0.6, 201)
    best = grid[int(np.argmin([least(work) for work in grid]))]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        result = found(files, law)
    assert numbers(result, tmp_path)["work_J_per_m2"] == pytest.approx(best, abs=0.0011)


@pytest.mark.parametrize("law", ["jkr", "dmt"])
def test_bodies_that_do_not_stick_have_no_work_of_adhesion(tmp_path: Path, law: str) -> None:
    """Forces of Hertz's law: an interval without a lower end, no number of it in the sentences."""
    with pytest.warns(InputWarning, match="the data do not limit work within its bounds"):
        result = found(bench(tmp_path, "dmt", 0.0, 0.01), law)
    told = numbers(result, tmp_path)
    assert told["verdict"] == "not separable" and told["work_ci95_J_per_m2"][0] == pytest.approx(1e-6)  # type: ignore[index]
    assert any("the work of adhesion is not separable from none" in line for line in result.sentences)
    assert any("work of adhesion is not separable" in line for line in result.not_identifiable)
    assert not any("they come apart" in line for line in result.sentences)
    assert "work" not in json.loads((tmp_path / "modulus.json").read_text(encoding="utf-8"))["identifiable"]


def test_the_load_of_a_joint_hides_the_work_of_adhesion_of_its_surfaces(tmp_path: Path) -> None:
    """0.05 J/m² of polymers pulls by 12 mN; 10 N of noise of a load cell hides it."""
    with pytest.warns(InputWarning, match="the data do not limit work within its bounds"):
        result = found(bench(tmp_path, "dmt", 0.05, 10.0, 40e-3), "dmt")
    assert numbers(result, tmp_path)["verdict"] == "not separable"


def test_what_is_asked_for_must_go_together(tmp_path: Path) -> None:
    files = bench(tmp_path, "jkr", WORK, 0.01)
    with pytest.raises(InputError, match="work needs `adhesion`"):
        modulus(files[0], files[1], radius=RADIUS, free={"work": None}, bootstrap=0)
    with pytest.raises(InputError, match="needs `work_of_adhesion`"):
        modulus(files[0], files[1], radius=RADIUS, adhesion="jkr", bootstrap=0)
    with pytest.raises(InputError, match=r"0 J/m.2 cannot be the work of adhesion"):
        modulus(files[0], files[1], radius=RADIUS, adhesion="jkr", free={"work": (0.0, 1.0)}, bootstrap=0)


def test_a_pull_that_no_surface_has_is_not_called_a_work_of_adhesion(tmp_path: Path) -> None:
    """Forces less a constant of 60 N, as of a cell that was zeroed under load: w runs to its bound."""
    files = bench(tmp_path, "dmt", 0.0, 0.001, 60e-3)
    table = pd.read_csv(files[1])
    table["total [N]"] -= 60.0
    table.to_csv(files[1], index=False)
    options = {"radius": RADIUS, "adhesion": "dmt", "bootstrap": 0}
    with pytest.warns(InputWarning, match="do not limit work"):
        result = modulus(*files, free={"work": (1e-3, 1.0)}, **options)
    assert any("is not limited below 1 J/m²" in line for line in result.sentences)
    with pytest.warns(InputWarning) as said:
        wide = modulus(*files, free={"work": None}, **options)
    assert any("which mostly is 0.001 to 1 J/m^2" in str(each.message) for each in said)
    assert numbers(wide, tmp_path)["work_J_per_m2"] == pytest.approx(60.0 / (2.0 * np.pi * RADIUS), rel=1e-3)
