"""A study of two trials: both groups, errors beside recordings that are known, descriptions that cannot be right."""

from __future__ import annotations

import re
import shutil
import warnings
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.shoulder.study.cases import COPIED
from geocontact.analyses.shoulder.study.result import StudyResult
from tests.cli.calls import MESHES

TRIAL = MESHES / "overhead_P1T1S100"
BOTH = """\
[tasks.T1]
tool = { value = 1.3, unit = "kg" }
push = { value = 35, unit = "N" }

[persons.P1]
mass = { value = 82, unit = "kg" }
sex = "male"
dominant = "right"
upper_arm = { value = 296, unit = "mm" }

[persons.P2]
mass = { value = 70, unit = "kg" }
sex = "male"
dominant = "left"
upper_arm = { value = 278, unit = "mm" }

[[trials]]
name = "bare"
person = "P1"
task = "T1"
markers = "markers.trc"
tool = "tool.csv"

[[trials]]
name = "supported"
person = "P1"
task = "T1"
markers = "markers.trc"
tool = "tool.csv"
level = "100%"
recorded = "recorded.csv"
recorded_other = "recorded_other.csv"
without = "bare"

[[trials]]
name = "unsupported"
person = "P2"
task = "T1"
markers = "markers.trc"
tool = "tool.csv"
level = "0%"
"""
LATE, HIGH = np.radians(2.0), 3.0
"""What the recording shows more than the simulation: elevation [rad], force [N]."""


def studied(file: Path) -> StudyResult:
    """Without its warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        return gc.shoulder.study(file)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The shipped trial twice, and recordings that are the simulation shifted by `LATE` and `HIGH`."""
    place = tmp_path_factory.mktemp("study")
    for name in ("markers.trc", "tool.csv"):
        shutil.copy(TRIAL / name, place / name)
    (place / "P1.toml").write_text('upper_arm = { value = 296, unit = "mm" }\n', encoding="utf-8")
    (place / "study.toml").write_text(BOTH, encoding="utf-8")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        options = {"person": place / "P1.toml", "tool": place / "tool.csv"}
        right, left = (each.simulation for each in gc.shoulder.simulate(place / "markers.trc", **options).arms)
    time, force = right.motion.time, right.supporting + HIGH
    columns = {"time [s]": time, "elevation [rad]": right.elevation + LATE, "force [N]": force}
    pd.DataFrame(columns).to_csv(place / "recorded.csv", index=False)
    columns = {"time [s]": time, "elevation [rad]": left.elevation - 2.0 * LATE}
    pd.DataFrame(columns).to_csv(place / "recorded_other.csv", index=False)
    return place


@pytest.fixture(scope="module")
def found(folder: Path) -> StudyResult:
    return studied(folder / "study.toml")


def test_errors_are_those_that_were_made(found: StudyResult) -> None:
    errors = found.table("errors").set_index(["arm", "channel", "part"]).sort_index()
    assert errors.loc[("right", "elevation", "all"), "bias"] == pytest.approx(-2.0, abs=1e-6)
    assert errors.loc[("left", "elevation", "all"), "bias"] == pytest.approx(4.0, abs=1e-6)
    assert errors.loc[("right", "force", "work"), "rmsd"] == pytest.approx(3.0, abs=1e-6)
    assert errors.loc[("right", COPIED, "all"), "rmsd"] > 4.0, "the human elevation is not that of the exoskeleton"
    assert set(errors["trial"]) == {"supported"}, "the other one has no recording"
    summary = found.table("summary").set_index(["channel", "part"])
    assert summary.loc[("elevation", "all"), "arms"] == 2 and summary.loc[("force", "all"), "arms"] == 1
    assert summary.loc[("elevation", "all"), "mae"] == pytest.approx(3.0, abs=1e-6)


def test_arms_out_of_the_cuff_are_told_in_every_sentence(found: StudyResult) -> None:
    """Without support P2's arm slides out by millimetres; where the cylinder carries the device it stays in."""
    out = [case.within.simulation.out_of_cuff.mean() for case in found.cases]
    assert out[:2] == [0.0, 0.0] and 0.05 < out[2] < 0.3
    assert len(found.sentences) > 3
    wanted = r"; the sphere is out of the cuff in [12] of [46] simulations, for up to \d\d% of the time$"
    for line in found.sentences:
        assert re.search(wanted, line), line


def test_same_motion_makes_no_difference_between_groups(found: StudyResult) -> None:
    rows = found.table("differences").set_index("trial")
    assert list(zip(rows.index, rows.pop("arm"), strict=True)) == [
        ("supported", "right"),
        ("supported", "left"),
        ("mean", "both"),
    ]
    np.testing.assert_allclose(rows.loc["supported"].iloc[:, :3].astype(float), 0.0, atol=1e-12)
    assert rows.loc["mean", "shoulder less exoskeleton [deg]"] > 2.0


def test_level_and_arms_are_those_of_the_trial(found: StudyResult) -> None:
    """Both arms, the right one first; without a recording where none was named."""
    names = [case.name for case in found.cases]
    assert names == [f"{trial}, {side} arm" for trial in ("supported", "unsupported") for side in ("right", "left")]
    supported, _, other, _ = found.cases
    assert supported.within.simulation.supporting.max() > 20.0 > other.within.simulation.supporting.max()
    assert other.without is None and other.recorded is None


def test_the_dominant_arm_is_what_was_recorded(folder: Path, tmp_path: Path) -> None:
    """A left-handed person's `recorded` is beside the left arm."""
    place = tmp_path / "study"
    shutil.copytree(folder, place)
    (place / "study.toml").write_text(BOTH.replace('dominant = "right"', 'dominant = "left"'), encoding="utf-8")
    errors = studied(place / "study.toml").table("errors")
    assert set(errors.loc[errors["channel"] == "force", "arm"]) == {"left"}
    assert errors.loc[errors["channel"] == "elevation", "bias"].abs().max() > 4.1


def test_a_joint_at_its_stop_in_all_arms_is_one_finding(found: StudyResult) -> None:
    """Six simulations of four arms, each with the first passive joint at its stop: one sentence, no warning."""
    arms = [arm.simulation for case in found.cases for arm in (case.within, case.without) if arm is not None]
    shares = [float(each.at_stop[:, 0].mean()) for each in arms]
    assert len(shares) == 6 and min(shares) > 0.0
    (line,) = [line for line in found.sentences if "passive_1" in line]
    assert line.startswith(
        f"passive_1 is at a stop in all of 6 simulations, for {min(shares):.0%} to {max(shares):.0%} of the time: "
    )
    assert not any("passive_1" in line for line in found.warnings)


def test_equal_warnings_are_one_line_with_their_range(found: StudyResult) -> None:
    arms = [arm.simulation for case in found.cases for arm in (case.within, case.without) if arm is not None]
    out = [float(each.out_of_cuff.mean()) for each in arms if each.out_of_cuff.any()]
    (line,) = [line for line in found.warnings if "out of the cuff" in line]
    assert line.startswith(f"the sphere is out of the cuff in {len(out)} of 6 simulations, for ")
    assert f"{max(out):.0%} of the time" in line


def test_the_headline_has_force_and_elevation(found: StudyResult) -> None:
    """Elevations are 2 and 4 degrees off, the force 3 N."""
    page = found.pages({})["report.html"]
    assert page.headline[0].startswith(
        "Over 2 recorded arms the simulation misses the elevation by 3° and the force by"
    )
    assert any(label.startswith("force") and value == "3 N" for label, value in page.facts)


def test_a_study_without_the_device_is_none(folder: Path, tmp_path: Path) -> None:
    place = tmp_path / "study"
    shutil.copytree(folder, place)
    bare = "\n".join(line for line in BOTH.splitlines() if not line.startswith("level"))
    (place / "study.toml").write_text(bare, encoding="utf-8")
    with pytest.raises(gc.InputError, match="none was recorded in the device"):
        studied(place / "study.toml")


def test_everything_is_written(found: StudyResult, tmp_path: Path) -> None:
    out = found.write(tmp_path / "out")
    names = {"summary.csv", "errors.csv", "differences.csv", "passive.csv", "study.png", "report.html", "run.json"}
    assert names <= {file.name for file in out.iterdir()}
    roles = {entry["role"] for entry in found.record.inputs}
    assert {"study", "supported markers", "supported recorded, right", "supported recorded, left"} <= roles


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("[[trials]]", "[[trial]]", "trial: is not known here; perhaps trials"),
        ('name = "unsupported"', 'name = "supported"', "two have the name 'supported'"),
        ('level = "0%"', 'level = "120%"', "level is 120%; give 0 to 100%"),
        ("recorded_other.csv", "record.csv", "there is no file record.csv"),
        ('without = "bare"', 'without = "none"', "no trial 'none'; there are bare, supported, unsupported"),
        ('level = "0%"', 'logger = "a.csv"', "logger: is not known here"),
    ],
)
def test_descriptions_that_cannot_be(folder: Path, tmp_path: Path, old: str, new: str, told: str) -> None:
    place = tmp_path / "study"
    shutil.copytree(folder, place)
    text = BOTH.replace(old, new) if old == "[[trials]]" else new.join(BOTH.rsplit(old, 1))
    (place / "study.toml").write_text(text, encoding="utf-8")
    with pytest.raises(gc.InputError) as error:
        studied(place / "study.toml")
    assert told in str(error.value)


def test_curves_over_the_work_are_those_at_the_same_share_of_it(found: StudyResult, folder: Path) -> None:
    """The first 10 % of the shoulder's range to the last is the work; by hand from the table over time."""
    table = found.table("normalised")
    rows = table[(table["trial"] == "supported") & (table["arm"] == "right")]
    assert list(rows["motion recorded"].unique()) == ["in the device", "without it"]
    own = rows[rows["motion recorded"] == "in the device"].set_index("work [-]")
    assert len(own) == 101 and own.index[0] == 0.0 and own.index[-1] == 1.0
    s = found.cases[0].within.simulation
    high = np.degrees(s.motion.elevation)
    raised = np.flatnonzero(high > high.min() + 0.1 * np.ptp(high))
    first, last = s.motion.time[raised[[0, -1]]]
    for share in (0.0, 0.25, 0.5, 1.0):
        at = first + share * (last - first)
        wanted = [np.interp(at, s.motion.time, each) for each in (np.degrees(s.elevation), high, s.supporting)]
        np.testing.assert_allclose(own.loc[share, ["exoskeleton [deg]", "shoulder [deg]", "force [N]"]], wanted)
    panels = found.curves()["normalised"].panels
    assert [curve.name for curve in panels[0].curves][:2] == [
        "exoskeleton, motion in the device",
        "shoulder, motion in the device",
    ]
    assert len(panels) == 8 and panels[0].over is not None and panels[0].over.unit == "%"
