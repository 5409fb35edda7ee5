"""Force plates under a foot and loads of a knee's sides, gathered into gap cases. All recordings here are synthetic."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.loads.centre_of_pressure import centre_in_foot
from geocontact.systems.catalogue import system_of
from tests.cli.calls import written

TIME = np.linspace(1.0, 1.8, 81)
FIRST = {"t01": 0, "t02": 1}
"""Row that a trial begins at: two trials with the same samples are refused as copies."""
BELT, GROUND = 1.2, -0.0075  # m/s, m
PARAMETERS = "".join(
    f'[parameters.{name}_all]\nstart = {start}\nlower = 0.0\nupper = 1e6\nunit = "{unit}"\n'
    for name, start, unit in (("k", 3e4, "N/m^n"), ("b", 150.0, "N s/m"))
)
FOOT = f"""format = 1
system = "foot"
calibration = ["t01"]
evaluation = ["t02"]
spheres = "spheres.csv"
[constants]
n = 1.2
delta_full = 0.002
mu_s = 0.9
mu_k = 0.7
v_th = 0.25
{PARAMETERS}
"""
PLATES = "".join(
    f'[from.{name}]\ninputs = "{name}.csv"\nplates = "grf.mot"\nplate = "ground_force_r"\nbelt = {BELT}\n'
    for name in ("t01", "t02")
)
KNEE = """format = 1
system = "knee"
calibration = ["t01"]
evaluation = ["t02"]
[constants]
R = 0.037
[parameters.E_star]
start = 1e7
lower = 1e5
upper = 1e9
unit = "Pa"
"""
SIDES = "".join(
    f'[from.{name}]\ninputs = "{name}.csv"\nforces = "forces.mot"\nforce_unit = "lbf"\n'
    'areas = "area.csv"\nthreshold = 0.002\n'
    for name in ("t01", "t02")
)


@pytest.fixture(scope="module")
def foot(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Recordings of the model itself: reactions at the contacts in the laboratory, the belt running backwards."""
    folder = tmp_path_factory.mktemp("foot")
    spheres = "px [m],py [m],radius [m],zone\n0.0,0.015,0.02,all\n0.1,0.016,0.02,all\n0.2,0.017,0.02,all\n"
    written(folder / "spheres.csv", spheres)
    s = (TIME - TIME[0]) / np.ptp(TIME)
    along = 0.3 + 0.02 * s  # on the belt
    pose = {"x [m]": along, "y [m]": 0.004 - 0.02 * s * (1.0 - s), "pitch [rad]": 0.25 - 0.5 * s}
    table = pd.DataFrame({"time [s]": TIME} | pose)
    channels = ("force_x [N]", "force_y [N]", "cop_x [m]")
    empty = table.assign(**dict.fromkeys(channels, 1.0 + s))
    (folder / "true" / "trials").mkdir(parents=True)
    for name in ("t01", "t02"):
        empty.to_csv(folder / "true" / "trials" / f"{name}.csv", index=False)
        laboratory = table.assign(**{"x [m]": along - BELT * TIME})
        laboratory.iloc[FIRST[name] :].to_csv(folder / f"{name}.csv", index=False, float_format="%.12g")
    written(folder / "true" / "spheres.csv", spheres)
    written(folder / "true" / "case.toml", FOOT)
    case = read_gap_case(folder / "true")
    system = system_of(case)
    said = system.simulate(case.calibration[0], system.start)
    np.savetxt(folder / "said.csv", said)
    cop = np.nan_to_num(said[:, 2])
    pitch = pose["pitch [rad]"]
    centre = along - BELT * TIME + (cop + pose["y [m]"] * np.sin(pitch)) / np.cos(pitch)
    rows = np.zeros((len(TIME), 10))
    rows[:, 0], rows[:, 1:3], rows[:, 4], rows[:, 5] = TIME, said[:, :2], centre, GROUND
    names = [f"ground_force_r_{kind}{axis}" for kind in "vp" for axis in "xyz"]
    names += [f"ground_torque_r_{axis}" for axis in "xyz"]
    other = [name.replace("_r_", "_l_") for name in names]
    rows = np.column_stack([rows, np.tile(rows[:, 1:] * 2.0, 1)])
    head = ["grf", "version=1", f"nRows={len(rows)}", f"nColumns={rows.shape[1]}", "inDegrees=no", "endheader"]
    lines = ["\t".join(["time", *names, *other]), *("\t".join(f"{v:.12g}" for v in row) for row in rows)]
    written(folder / "grf.mot", "\n".join([*head, *lines]) + "\n")
    return folder


def plan(folder: Path, text: str, name: str = "gather.toml") -> Path:
    return written(folder / name, text)


def test_a_plate_gives_what_the_model_predicts_in_the_foots_frame(foot: Path, tmp_path: Path) -> None:
    """Round trip: forces and centre as simulated, sent through a laboratory with a belt and a plate's own height."""
    with pytest.warns(gc.InputWarning, match="at the same times"):  # both trials are of one recording
        result = gc.gather(plan(foot, FOOT + PLATES))
    trial = read_gap_case(result.write(tmp_path / "case")).calibration[0]
    pd.testing.assert_series_equal(
        result.table()["cop_x [m]"], pd.Series(result.case.calibration[0].column("cop_x"), name="cop_x [m]")
    )
    said = np.loadtxt(foot / "said.csv")
    loaded = said[:, 1] >= 20.0
    assert 20 < loaded.sum() < len(TIME)
    np.testing.assert_allclose(trial.column("force_x"), said[:, 0], atol=1e-6)
    np.testing.assert_allclose(trial.column("force_y"), said[:, 1], atol=1e-6)
    assert np.isfinite(trial.column("cop_x")).tolist() == loaded.tolist()
    np.testing.assert_allclose(trial.column("cop_x")[loaded], said[loaded, 2], atol=1e-8)
    np.testing.assert_allclose(trial.column("x"), 0.3 + 0.02 * (TIME - 1.0) / 0.8, atol=1e-8)


def test_a_point_of_the_ground_turns_with_the_foot() -> None:
    """Closed form: the ground point of the foot's own place (a, b) has its a again, whatever the pose."""
    a, b, x, pitch = 0.12, -0.03, 0.4, np.linspace(-0.8, 0.5, 7)
    y = -(a * np.sin(pitch) + b * np.cos(pitch))  # so that (a, b) is on the ground
    ground = x + a * np.cos(pitch) - b * np.sin(pitch)
    np.testing.assert_allclose(centre_in_foot(ground, np.full(7, x), y, pitch), a, atol=1e-15)


@pytest.fixture(scope="module")
def knee(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("knee")
    frames = np.linspace(0.9, 1.9, 41)
    rows = [
        {
            "time [s]": t, "threshold [mm]": mm, "area_fixed [mm^2]": 100.0 * mm * t,
            "area_fixed_medial [mm^2]": 60.0 * mm * t, "area_fixed_lateral [mm^2]": 40.0 * mm * t,
        }
        for t in frames for mm in (1.0, 2.0)
    ]  # fmt: skip
    pd.DataFrame(rows).to_csv(folder / "area.csv", index=False)
    clock = np.linspace(0.95, 1.7, 91)
    lines = "\n".join(f"{t}\t{100.0 * t}\t{50.0 * t}" for t in clock)
    head = "forces\nversion=1\nnRows=91\nnColumns=3\ninDegrees=no\nendheader\ntime\tmedial\tlateral"
    written(folder / "forces.mot", f"{head}\n{lines}\n")
    angles = {"flexion [deg]": 30.0 * TIME, "adduction [deg]": 0.1 * TIME}
    for name in ("t01", "t02"):
        pd.DataFrame({"time [s]": TIME} | angles).iloc[FIRST[name] :].to_csv(folder / f"{name}.csv", index=False)
    return folder


def test_a_knee_gets_areas_and_forces_of_its_sides(knee: Path, tmp_path: Path) -> None:
    """Linear courses are met exactly; forces end before the trial does."""
    with pytest.warns(gc.InputWarning, match="at the same times"):  # both trials are of one recording
        gathered = gc.gather(plan(knee, KNEE + SIDES))
    trial = read_gap_case(gathered.write(tmp_path / "case")).calibration[0]
    np.testing.assert_allclose(trial.column("area_medial"), 120e-6 * TIME, rtol=1e-8)
    np.testing.assert_allclose(trial.column("area_lateral"), 80e-6 * TIME, rtol=1e-8)
    inside = TIME <= 1.7
    np.testing.assert_allclose(trial.column("force_medial")[inside], 444.82216 * TIME[inside], rtol=1e-7)
    assert np.isnan(trial.column("force_lateral")[~inside]).all() and not inside.all()


@pytest.mark.parametrize(
    ("what", "change", "message"),
    [
        ("foot", lambda t: t.replace('plate = "ground_force_r"\n', ""), "holds 2 plates: ground_force_r, ground_force"),
        ("foot", lambda t: t.replace("force_r", "force_x"), "no plate 'ground_force_x'; plates are: ground_force_r"),
        ("foot", lambda t: t.replace("belt = 1.2", "belt = true"), "[from.t01] belt: True is not a finite number"),
        ("foot", lambda t: t.replace('plates = "grf.mot"\n', ""), "plate: has no meaning without plates"),
        ("foot", lambda t: t.replace('"t02.csv"', '"bare.csv"'), "bare.csv line 1: no column 'pitch' in rad"),
        ("foot", lambda t: t.replace('"t02.csv"', '"late.csv"'), "ground_force_r in grf.mot from 1 to 1.8 s"),
        ("knee", lambda t: t.replace("threshold = 0.002\n", ""), "holds thresholds of 0.001, 0.002 m; name one"),
        ("knee", lambda t: t.replace("0.002", "0.004"), "no area at 0.004 m; thresholds are 0.001, 0.002 m"),
        ("knee", lambda t: t.replace('forces = "forces.mot"\n', ""), "areas: has no meaning without forces"),
        ("knee", lambda t: t.replace('"area.csv"', '"whole.csv"'), "whole.csv: has no area of the medial side"),
        ("knee", lambda t: t.replace('force_unit = "lbf"\n', ""), "forces.mot"),
        ("knee", lambda t: t.replace('"t02.csv"', '"full.csv"'), "has a column 'area_medial' already; delete it"),
    ],
)
def test_what_cannot_be_gathered_is_refused(
    foot: Path, knee: Path, what: str, change: Callable[[str], str], message: str
) -> None:
    folder, text = (foot, FOOT + PLATES) if what == "foot" else (knee, KNEE + SIDES)
    table = pd.read_csv(folder / "t02.csv")
    table.drop(columns="pitch [rad]", errors="ignore").to_csv(folder / "bare.csv", index=False)
    table.assign(**{"time [s]": table["time [s]"] + 0.7}).to_csv(folder / "late.csv", index=False)
    table.assign(**{"area_medial [m^2]": table["time [s]"]}).to_csv(folder / "full.csv", index=False)
    if what == "knee":
        areas = pd.read_csv(folder / "area.csv")
        areas.drop(columns="area_fixed_medial [mm^2]").to_csv(folder / "whole.csv", index=False)
    with pytest.raises(gc.InputError, match=re.escape(message)):
        gc.gather(plan(folder, change(text), "wrong.toml"))
