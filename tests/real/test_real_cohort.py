"""Studies of real recordings: the subtalar joints of two people, and a knee implant at two thresholds."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from geocontact.io.mocap.markers import read_markers
from tests.cli.calls import call, done, written

STANCE = {"Norm_01": (10, 133), "Norm_03": (17, 177)}
"""Frames of heel strike and toe-off, as *_Event.xlsx has them; both recordings end before toe-off."""
SHARE, STEP = 0.85, 24
ANKLES = """
analysis = "area"
title = "Subtalar joints over stance"
files = "{{subject}}_Talus.txt"
[options]
moving = "{data}/{{subject}}/{{subject}}_Talus.stl"
fixed = "{data}/{{subject}}/{{subject}}_Calcaneus_Right.stl"
unit = "mm"
motion = "{{file}}"
motion_fixed = "{{subject}}_Calcaneus.txt"
rate = 1
threshold = 4
congruence = 4
[summary]
columns = ["area_fixed [mm^2]", "min_distance [mm]", "congruence_index [1/mm]"]
"""


@pytest.mark.slow
def test_subtalar_joints_of_two_people_over_stance(data_dir: Path, tmp_path: Path) -> None:
    """Every 24th frame of the first 85 % of stance; coverage below 4 mm is 900 to 1700 mm^2, congruence beside it."""
    data = data_dir / "jma_ankles"
    for person, (strike, off) in STANCE.items():
        for bone in ("Talus", "Calcaneus"):
            rows = (data / person / f"{person}_Walk_{bone}.txt").read_text(encoding="utf-8").split()
            part = rows[strike - 1 : strike + int(SHARE * (off - strike)) : STEP]
            written(tmp_path / f"{person}_{bone}.txt", "\n".join(part) + "\n")
    study = written(tmp_path / "ankles.toml", ANKLES.format(data=data))
    out = tmp_path / "out"
    made = done(call("cohort", study, "--workers", "1", "--out", out, folder=out))
    assert "2 of 2 trials of area have results" in made.out
    table = pd.read_parquet(out / "tables" / "area.parquet")
    assert table.groupby("subject").size().to_dict() == {"Norm_01": 5, "Norm_03": 6}
    assert table["area_fixed [mm^2]"].between(900.0, 1700.0).all() and (table["signed"] == "both").all()
    assert table["congruence_index [1/mm]"].between(0.02, 0.2).all() and (table["congruence_share [-]"] > 0.6).all()
    ensemble = made.table("ensemble.csv")
    assert len(ensemble[ensemble["quantity"] == "congruence_index"]) == 101
    area = ensemble[ensemble["quantity"] == "area_fixed"]
    assert len(area) == 101 and (area["subjects [-]"] == 2).all()
    ends = table.groupby("subject")["area_fixed [mm^2]"].first().mean()
    assert area["mean"].iloc[0] == pytest.approx(ends, rel=1e-9)


KNEE = """
analysis = "area"
[options]
moving = "{data}/stl/Femoral Component contact.stl"
fixed = "{data}/stl/Tibial Insert contact.stl"
unit = "m"
motion = "{data}/fluoroscopy/Fluoroscopic Gait Data.sto"
map = "rx=knee_flex_r,ry=knee_add_r,rz=knee_rot_r,tx=knee_ant_r,ty=knee_sup_r,tz=knee_lat_r"
angles = "rad"
[sweep]
threshold = [2, 4]
"""


@pytest.mark.slow
def test_a_knee_implant_at_two_thresholds(data_dir: Path, tmp_path: Path) -> None:
    """101 frames of DM; the area below 2 mm is a part of that below 4 mm, and each threshold has its mean curve."""
    study = written(tmp_path / "knee.toml", KNEE.format(data=data_dir / "gc6_dm_knee"))
    out = tmp_path / "out"
    made = done(call("cohort", study, "--workers", "1", "--out", out, folder=out))
    table = pd.read_parquet(out / "tables" / "area.parquet")
    narrow, wide = (table[table["threshold"] == each]["area_fixed [mm^2]"].to_numpy() for each in ("2", "4"))
    assert len(narrow) == len(wide) == 101 and (narrow < wide).all() and (narrow > 0.3 * wide).all()
    assert set(made.table("values.csv")["condition"]) == {"threshold 2", "threshold 4"}
    assert made.table("trials.csv")["warnings [-]"].min() >= 2, "open surfaces are named for each trial"


PEOPLE = """
analysis = "area"
[options]
unit = "m"
threshold = 4
[[trials]]
subject = "JW"
[trials.options]
moving = "{data}/gc4_jw_predsim_workshop/Femoral_Component_simpler.stl"
fixed = "{data}/gc4_jw_predsim_workshop/Tibial_Insert_simpler_superior.stl"
motion = "{data}/gc4_jw_predsim_workshop/KneeProsthesis.mot"
osim = "{data}/gc4_jw_predsim_workshop/KneeProsthesis.osim"
joint = "knee_joint"
moving_body = "parent"
angles = "deg"
[[trials]]
subject = "DM"
[trials.options]
moving = "{data}/gc6_dm_knee/stl/Femoral Component contact.stl"
fixed = "{data}/gc6_dm_knee/stl/Tibial Insert contact.stl"
motion = "{data}/gc6_dm_knee/fluoroscopy/Fluoroscopic Gait Data.sto"
map = "rx=knee_flex_r,ry=knee_add_r,rz=knee_rot_r,tx=knee_ant_r,ty=knee_sup_r,tz=knee_lat_r"
angles = "rad"
"""


@pytest.mark.slow
def test_knees_of_two_laboratories_have_options_of_their_own(data_dir: Path, tmp_path: Path) -> None:
    """JW by the joint of a model in degrees, DM by a map in radians; both areas are those of a knee implant."""
    study = written(tmp_path / "knees.toml", PEOPLE.format(data=data_dir))
    out = tmp_path / "out"
    made = done(call("cohort", study, "--workers", "1", "--out", out, folder=out))
    assert "2 of 2 trials of area have results" in made.out
    table = pd.read_parquet(out / "tables" / "area.parquet")
    assert table.groupby("subject").size().to_dict() == {"JW": 41, "DM": 101}
    assert table["area_fixed [mm^2]"].between(300.0, 3500.0).all()
    assert len(made.table("ensemble.csv")["condition"].unique()) == 1


STUDIES = Path(__file__).parents[2] / "docs" / "how-to" / "studies"


@pytest.mark.filterwarnings("ignore:.*taken as not seen")
def test_missing_links_of_real_knees_are_named_by_a_dry_run(data_dir: Path, tmp_path: Path) -> None:
    """What they need is not there; and no marker at a knee or ankle of either walk is seen in any frame."""
    study = STUDIES / "real_knees.toml"
    planned = call("cohort", study, "--folder", data_dir, "--dry-run", "--out", tmp_path / "out", folder=tmp_path)
    assert planned.code == 0
    for line in (
        "scale of JW: needs gc4_jw_knee/c3d/jw_static.c3d, which is not there",
        "scale of DM: needs gc6_dm_knee/gait/DM_static.trc, which is not there",
        "id of DM: needs ik of DM",
        "poses_og3 of JW: needs gc4_jw_knee/poses/jw_ngait_og3.csv, which is not there",
        "modulus_og3 of JW: needs poses_og3 of JW",
        "modulus_DM of DM: needs gc6_dm_knee/knee_forces/DM_fluoroscopy_knee_forces.csv, which is not there",
    ):
        assert line in planned.err
    for name, count in (("gc4_jw_knee/c3d/jw_ngait_og3.c3d", 0), ("gc6_dm_knee/gait/DM_ngait_og1_new.trc", 8)):
        seen = read_markers(data_dir / name)
        joints = [k for k, each in enumerate(seen.names) if re.search("knee|ankle", each, re.IGNORECASE)]
        assert len(joints) == count and not np.isfinite(seen.positions[:, joints]).any()


@pytest.mark.slow
def test_two_real_knees_and_a_walk_in_one_study(data_dir: Path, tmp_path: Path) -> None:
    """What recordings have is evaluated, the rest is left out by name.

    E* of JW is that of the same files typed one after the other, and the least squares of force on a^3.
    """
    out = tmp_path / "out"
    study = STUDIES / "real_knees.toml"
    made = done(call("cohort", study, "--folder", data_dir, "--workers", "1", "--out", out, folder=out))
    rows = made.table("trials.csv").set_index("step")
    state = made.table("trials.csv").set_index(["step", "name"])["state"]
    done_steps = {("cells", "JW"), ("poses", "JW"), ("modulus", "JW"), ("pressure", "DM")}
    done_steps |= {(step, "subject01") for step in ("scale", "ik", "id")}
    assert {*state[state == "done"].index} == done_steps and set(state) == {"done", "without input"}
    rows = rows[rows["state"] == "done"]
    found = json.loads((out / rows["folder"]["modulus"] / "modulus.json").read_text(encoding="utf-8"))
    assert found["E_star_Pa"] == pytest.approx(1.53e6, rel=0.02)
    area = pd.read_parquet(out / "tables" / "poses" / "area.parquet")
    area = area[area["threshold [mm]"] == 4.0]
    lines = (data_dir / "gc4_jw_predsim_workshop" / "KCF_ref.mot").read_text(encoding="utf-8").splitlines()
    force = np.array([line.split() for line in lines[6:] if line.strip()], float)
    measured = 4.4482216 * np.interp(area["time [s]"], force[:, 0], force[:, 1] + force[:, 2])
    law = 4.0 / 3.0 * (1e-6 * area["area_fixed [mm^2]"].to_numpy() / np.pi) ** 1.5 / 0.037
    assert found["E_star_Pa"] == pytest.approx((law * measured).sum() / (law * law).sum(), rel=1e-6)
    markers = pd.read_parquet(out / "tables" / "ik" / "markers.parquet")
    assert len(markers) > 30, "the walk of subject01"
    assert pd.read_parquet(out / "tables" / "pressure" / "pressure.parquet")["peak [MPa]"].max() > 50.0, "DM overlaps"
