"""`numbers.csv` of a simulated elbow is what ran: it alone, with the angles of a trial, gives the trial's curves."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.misalignment.simulate.result import SimulateResult
from geocontact.io.text.results import write_table
from tests.analyses.misalignment.trials import STROKE, recorded

MMHG = 133.322387415
QUICK = {"seconds": 4.0, "rate": 50.0, "trials": 2}
OWN = {"k": 310.0, "y": 0.05, "b": 14.0, "s": 1e-5}


def tables(result: SimulateResult, folder: Path) -> tuple[dict[str, float], dict[str, pd.DataFrame]]:
    """What stands in files."""
    for name, table in result.tables().items():
        write_table(table, folder, name)
    with (folder / "numbers.csv").open(encoding="utf-8") as file:
        told = {row["number"]: float(row["value"]) for row in csv.DictReader(file)}
    return told, {each.name: pd.read_csv(folder / f"{each.name}.csv") for each in result.trials}


def total(beta: np.ndarray, told: dict[str, float], name: str) -> np.ndarray:
    """Displacement of the attachment by the formulas at the head of the law; of complex angles, too."""
    x, y, l, z = (told[f"{name} {number}"] for number in "xylz")
    s, c = np.sin(beta), np.cos(beta)
    straight = y + np.sqrt(l**2 - x**2) - np.sqrt((l * s - x) ** 2 + (y + l * c) ** 2)
    return np.asarray(straight - z * (x * c + y * s) / (l + y * c - x * s))


def curves(rows: pd.DataFrame, told: dict[str, float], name: str) -> dict[str, np.ndarray]:
    """Force and displacement, then the angle and the moment of the cuff."""
    time, beta = rows["time [s]"].to_numpy(), np.radians(rows["beta [deg]"].to_numpy())
    k, b = (told[f"{name} {number}"] for number in "kb")
    if "pressure [mmHg]" in rows:
        k = k * (1.0 + told[f"{name} s"] * (MMHG * rows["pressure [mmHg]"].to_numpy() - told[f"{name} mean_pressure"]))
    d = total(beta, told, name)
    if f"{name} stroke least" in told:
        joint = np.clip(d, told[f"{name} stroke least"], told[f"{name} stroke most"])
        force = k * (d - joint) + b * np.gradient(d - joint, time)
    else:
        slope = total(beta + 1e-20j, told, name).imag / 1e-20
        joint, force = np.zeros_like(d), k * d + b * slope * np.gradient(beta, time)
    x, y, l, z = (told[f"{name} {number}"] for number in "xylz")
    gamma = np.arctan((x * np.cos(beta) + y * np.sin(beta)) / (l + y * np.cos(beta) - x * np.sin(beta)))
    moment = told[f"{name} turning"] * gamma - rows["force [N]"].to_numpy() * z / np.cos(gamma) ** 2
    return {"force": force, "displacement": 1e3 * joint, "gamma": np.degrees(gamma), "moment": moment}


def test_the_table_alone_gives_the_same_curves(tmp_path: Path) -> None:
    """Locked and free, donned anew for each trial, under a pressure of its own; x and y of a trial were in no file."""
    options = {"stroke": STROKE, "pressure": gc.mmHg(10, 60), "donning": gc.mm(4), "turning": 2.0}
    told, trials = tables(gc.misalignment.simulate(**QUICK, **options, noise=0, bits=0, numbers=OWN), tmp_path)
    assert len({told[f"{name} x"] for name in trials}) == 4 and told["donning"] == 0.004
    for name, rows in trials.items():
        found = curves(rows, told, name)
        assert np.ptp(rows["force [N]"]) > 0.5
        np.testing.assert_allclose(found["force"], rows["force [N]"], rtol=1e-9, atol=1e-8)
        np.testing.assert_allclose(found["gamma"], rows["gamma [deg]"], rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(found["moment"], rows["cuff_moment [N m]"], rtol=1e-9, atol=1e-9)
        if "displacement [mm]" in rows:
            np.testing.assert_allclose(found["displacement"], rows["displacement [mm]"], rtol=1e-9, atol=1e-8)


def test_noise_and_converter_are_those_of_the_table(tmp_path: Path) -> None:
    """What the force is off has the told size and memory, and every value is a step of the told converter."""
    told, trials = tables(gc.misalignment.simulate(seconds=60.0, rate=100.0, trials=2, bits=16), tmp_path)
    assert (told["noise"], told["memory"], told["bits"], told["locked_1 k"]) == (0.8, 0.3, 16.0, 222.43)
    off = []
    for name, rows in trials.items():
        steps = rows["force [N]"] / (told["full_scale force"] / 2.0 ** told["bits"])
        np.testing.assert_allclose(steps, np.round(steps), atol=1e-6)
        off.append(rows["force [N]"].to_numpy() - curves(rows, told, name)["force"])
    of = np.concatenate(off)
    # 120 s have some 200 independent values: 5 % of the size
    assert of.std() == pytest.approx(told["noise"], rel=0.15)
    lag = round(told["memory"] * told["rate"])
    assert np.mean([np.mean(each[lag:] * each[:-lag]) / np.mean(each**2) for each in off]) == pytest.approx(
        np.exp(-1.0), abs=0.15
    )


def test_along_recorded_angles(tmp_path: Path) -> None:
    """No experiment then; k holds at the mean of the recorded pressure."""
    file = recorded(tmp_path, pressure=gc.mmHg(10, 60)) / "locked_1.csv"
    told, trials = tables(gc.misalignment.simulate((file,), numbers=OWN), tmp_path)
    (name,) = trials
    assert "noise" not in told and told[f"{name} mean_pressure"] > 10.0 * MMHG
    np.testing.assert_allclose(
        curves(trials[name], told, name)["force"], trials[name]["force [N]"], rtol=1e-8, atol=1e-8
    )
