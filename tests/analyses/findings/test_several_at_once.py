"""Wrong inputs where several bodies, trials or plates are given, silent in a sixth round; right ones are not."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.frame.collector import collecting
from geocontact.analyses.frame.record import Record
from geocontact.analyses.sit_to_stand.recorded_beside import doubt_bending
from geocontact.analyses.sit_to_stand.trial_recordings import strap_force
from geocontact.standing_up.chain import Subject, leg_chain
from tests.analyses.findings.heard import Finding, Lines, as_parameters, heard
from tests.analyses.findings.test_left_out_commands import as_it_is, risen, table, untouched
from tests.analyses.findings.test_new_commands import settled
from tests.analyses.modulus.synthetic_step import areas, forces
from tests.cli.calls import MESHES
from tests.trial_checks.damage import Damage, columns_changed

Attempt = Callable[[Path], Lines]
PARTS = ("femoral_component_right_coarse.stl", "tibial_insert_right_coarse.stl", "patella_right_coarse.stl")
POSES = ("gait.csv", "gait_patella.csv")


def pairs(old: str = "", new: str = "") -> Attempt:
    """The shipped pairs in three frames, with words of their description replaced."""

    def attempt(folder: Path) -> Lines:
        for name in PARTS:
            shutil.copy(MESHES / name, folder / name)
        for name in POSES:
            shutil.copy(MESHES / name, folder / name)
            table(folder / name, lambda found: found.iloc[[0, 40, 80]])
        text = (MESHES / "knee_pairs.toml").read_text()
        assert old in text
        (folder / "pairs.toml").write_text(text.replace(old, new))
        return heard(gc.area_pairs, folder / "pairs.toml", rule="clip")

    return attempt


BALL = "time [s],tx [mm],ty [mm],tz [mm],rx [deg],ry [deg],rz [deg]\n"
STUDY = """analysis = "area"
files = "ball_{subject}.csv"
pages = false
figures = false
[options]
moving = "sphere_r20.stl"
fixed = "plate_80x80x12.stl"
unit = "mm"
motion = "{file}"
order = "XYZ"
threshold = 8
"""


def study(second: float, rows: int = 6) -> Attempt:
    """Two trials of a ball over a plate, up to their evaluation, the second 41 mm high, or elsewhere."""

    def attempt(folder: Path) -> Lines:
        for name in ("sphere_r20.stl", "plate_80x80x12.stl"):
            shutil.copy(MESHES / name, folder / name)
        for subject, high in (("A", 41.0), ("B", second)):
            (folder / f"ball_{subject}.csv").write_text(BALL + "".join(f"{k},0,{high},0,0,0,0\n" for k in range(rows)))
        (folder / "study.toml").write_text(STUDY)
        return heard(gc.cohort, folder / "study.toml", dry_run=True)

    return attempt


def dropping(samples: int, straight: bool = True) -> Damage:
    """The strap's force at 0 for so many samples about its largest, or down to it and up again along two lines."""

    def change(found: pd.DataFrame) -> None:
        middle = int(found["normal [N]"].argmax())
        middle = min(max(middle, 40), len(found) - 41)
        rows = np.abs(np.arange(len(found)) - middle)
        ends = found["normal [N]"] * np.clip((rows - samples // 2) / 25.0, 0.0, 1.0)
        found["normal [N]"] = found["normal [N]"].where(rows > samples // 2, 0.0) if straight else ends

    def damage(folder: Path) -> dict[str, Any]:
        table(folder / "P1_strap.csv", change)
        return {}

    return damage


def plates(change: Callable[[dict[str, np.ndarray]], object]) -> Damage:
    return columns_changed("P1_plates.mot", change)  # type: ignore[arg-type]


def talking(share: float) -> Damage:
    """A channel along the floor that reads a part of the one out of it."""
    return plates(lambda c: c.update(feet_force_vx=c["feet_force_vx"] + share * c["feet_force_vy"]))


def chair(ahead: float) -> Damage:
    return plates(lambda c: c.update(chair_force_px=c["chair_force_px"] + ahead))


def modulus(change: Callable[[pd.DataFrame], object] = as_it_is, **options: Any) -> Attempt:
    """Modulus of the synthetic step, and a trial that was not used, whose areas are changed."""

    def attempt(folder: Path) -> Lines:
        used, pressed, other = areas(folder), forces(folder), folder / "other.csv"
        shutil.copy(used, other)
        table(other, change)
        given = {"area": (used,), "force": pressed, "radius": gc.mm(37), "bootstrap": 0, "predict_area": (other,)}
        return heard(gc.modulus, **given, **options)

    return attempt


def a_percent_more(found: pd.DataFrame) -> None:
    found["area_fixed [mm^2]"] *= 1.01


def measured(first: float, last: float) -> Attempt:
    """Modulus with areas [mm^2] that were measured at 0.8 and 0.95 times the largest force."""

    def attempt(folder: Path) -> Lines:
        most = pd.read_csv(forces(folder), comment="#").filter(regex="medial|lateral").sum(axis=1).max()
        rows = f"{0.8 * most},{first}\n{0.95 * most},{last}"
        (folder / "measured.csv").write_text(f"force [N],area [mm^2]\n{rows}\n")
        return modulus(a_percent_more, calibrate=folder / "measured.csv")(folder)

    return attempt


FINDINGS: dict[str, Finding] = {
    "pairs: one motion for both bodies": Finding(
        pairs("gait_patella.csv", "gait.csv"), "warned: .*patella and femur keep their place .*the motion of one that"
    ),
    "cohort: a trial's file copied": Finding(
        study(41.0), "warned: B: ball_B.csv has the bytes of ball_A.csv, of A", alarm="has the bytes of"
    ),
    "compare: a strap drops to 0": Finding(risen(dropping(16)), "warned: .*exactly 0 N .*was its cell off"),
    "design: a strap drops to 0": Finding(risen(dropping(16), True), "warned: .*exactly 0 N .*was its cell off"),
    "compare: cross-talk of 15 %": Finding(risen(talking(0.15)), "warned: .*force along x is .*cross-talk"),
    "design: cross-talk of 15 %": Finding(risen(talking(0.15), True), "warned: .*force along x is .*cross-talk"),
    "compare: a chair 0.5 m ahead": Finding(risen(chair(0.5)), "warned: .*before the rise; are the places of chair"),
    "modulus: tested with its own areas": Finding(modulus(), "warned: .*`predict_area` has the areas of `area`"),
    "modulus: areas that fall": Finding(
        measured(2000.0, 1650.0), "warned: .*its area falls from 2000 to 1650", alarm="its area falls from"
    ),
    "modulus: a strip in cm": Finding(
        modulus(a_percent_more, reading="strip", length=gc.mm(6)),
        "warned: .*wide on a strip of 6 mm.*length in mm",
        alarm="wide on a strip",
    ),
    "knee: bodies of the other leg": Finding(
        settled(bodies=("femur_l", "tibia_l")), "warned: .*femur_l in `bodies` of the left", alarm="in `bodies` of the"
    ),
    "knee: a load 100 mm beside": Finding(
        settled(load_point="0,0,100", free=("adduction", "rotation"), springs={"rotation": 20.6}),
        "refused: .*no frame came to rest.*`load_point`",
        alarm="no frame came to rest",
    ),
}
RIGHT: dict[str, Attempt] = {
    "pairs": pairs(),
    "cohort of two": study(40.0),
    "cohort of two equal files of one frame": study(41.0, rows=1),
    "a strap as it is": risen(untouched),
    "a strap at 0 for 3 samples": risen(dropping(2)),
    "a strap that slackens": risen(dropping(16, straight=False)),
    "cross-talk of 3 %": risen(talking(0.03)),
    "a chair 0.05 m ahead": risen(chair(0.05)),
    "areas of another trial": modulus(a_percent_more),
    "areas that grow": measured(1650.0, 2000.0),
    "a strip of 60 mm": modulus(a_percent_more, reading="strip", length=gc.mm(60)),
    "bodies of this leg": settled(bodies=("femur_r", "tibia_r")),
}


@pytest.mark.parametrize("finding", as_parameters(FINDINGS))
def test_a_wrong_input_is_heard_of(finding: Finding, tmp_path: Path) -> None:
    lines = finding.attempt(tmp_path)
    assert any(re.search(finding.words, line) for line in lines), lines


@pytest.mark.parametrize("attempt", RIGHT.values(), ids=RIGHT)
def test_what_nearly_is_wrong_is_not_doubted(attempt: Attempt, tmp_path: Path) -> None:
    words = "|".join(finding.forbidden for finding in FINDINGS.values())
    assert not [line for line in attempt(tmp_path) if line.startswith("refused") or re.search(words, line)]


TIMES = np.arange(0.0, 3.0, 0.02)
SWELLING = 8.0 * np.clip(np.cos(2.0 * np.pi * TIMES / 3.0), 0.0, None)


@pytest.mark.parametrize(
    ("force", "doubted"),
    [
        (np.where(SWELLING < 2.0, 0.0, SWELLING), False),  # a mat's threshold of 2 N, reached while the strap slackens
        (np.where(TIMES < 1.5, np.where(SWELLING < 2.0, 0.0, SWELLING), 0.0), False),  # and stays slack
        (np.where(TIMES < 2.0, 8.0, 0.0), True),  # off until the end
        (np.where(np.abs(TIMES - 1.5) < 0.2, 0.0, 8.0), True),
        (np.where(np.abs(TIMES - 0.4) < 0.1, 0.0, SWELLING), True),
    ],
)
def test_a_jump_is_one_beside_the_slope_before_it(force: np.ndarray, doubted: bool, tmp_path: Path) -> None:
    pd.DataFrame({"time [s]": TIMES, "normal [N]": force}).to_csv(tmp_path / "strap.csv", index=False)
    with collecting(Record("test", {})) as record:
        strap_force(tmp_path / "strap.csv", "strap", "thigh", TIMES)
    assert any("was its cell off" in line for line in record.warnings) is doubted


@pytest.mark.parametrize(("lowered", "doubted"), [(0.05, False), (0.15, False), (0.3, True)])
def test_a_hip_is_looked_at_where_somebody_sits_or_squats(lowered: float, doubted: bool) -> None:
    """Who walks has a knee of 66 degrees in swing, with a hip that is stretched and hardly lowered."""
    time = np.linspace(0.0, 1.0, 50)
    bent = np.sin(np.pi * time)
    chain = leg_chain(Subject())
    values = np.zeros((50, len(chain.coordinates)))
    for name, most in (("knee", 66.0), ("hip", 10.0), ("ankle", -10.0)):
        values[:, [c.name for c in chain.coordinates].index(name)] = np.radians(most) * bent
    with collecting(Record("test", {})) as record:
        doubt_bending(Path("walk.mot"), chain, values, 0.9 - lowered * bent)
    assert any("hip is 10 degrees" in line for line in record.warnings) is doubted
