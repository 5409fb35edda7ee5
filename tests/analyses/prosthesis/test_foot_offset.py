"""Height and pitch of a foot beside its standing trial: from `calibrate` through law.toml into what takes the law."""

from __future__ import annotations

import hashlib
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.cop.foot import sole_law
from geocontact.analyses.cop.options import CopOptions
from geocontact.analyses.frame.record import Record
from geocontact.analyses.prosthesis.compare.options import ProsthesisCompareOptions
from geocontact.analyses.prosthesis.compare.stances import read as read_study
from geocontact.analyses.prosthesis.design.options import ProsthesisDesignOptions
from geocontact.analyses.prosthesis.design.trial import read as read_design
from geocontact.analyses.prosthesis.recorded_files import offset_of_law
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.analyses.prosthesis.simulate.walk import read as read_walk
from geocontact.analyses.prosthesis.simulate.walk import walk_of
from geocontact.below_knee_prosthesis.leg import AS_STOOD, FootOffset
from geocontact.io.recordings.spheres import SphereTable
from tests.analyses.prosthesis import test_compare
from tests.analyses.prosthesis.spoilt_trial import out_of_flat
from tests.analyses.prosthesis.test_simulate import GIVEN, TRIAL
from tests.recording import opened

FOOT = "[foot]\nheight = 0.4e-3\nheight_sd = 0.1e-3\npitch = -0.012\npitch_sd = 0.002\n"
OFFSET = FootOffset(0.4e-3, -0.012, 0.1e-3, 0.002)


def law(folder: Path, text: str) -> Path:
    file = folder / "law.toml"
    file.write_text(text)
    return file


def record() -> Record:
    return opened(Record("prosthesis simulate", {}))


def test_a_law_without_it_has_the_foot_as_it_stood(tmp_path: Path) -> None:
    assert offset_of_law(None, TRIAL / "standing.trc") == AS_STOOD
    assert offset_of_law(law(tmp_path, "n = 1.3\n"), TRIAL / "standing.trc") == AS_STOOD
    assert offset_of_law(law(tmp_path, FOOT), TRIAL / "standing.trc") == OFFSET


def test_it_holds_for_its_own_standing_trial_only(tmp_path: Path) -> None:
    own = hashlib.sha256((TRIAL / "standing.trc").read_bytes()).hexdigest()
    file, heard = law(tmp_path, f'{FOOT}standing = "{own}"\n'), record()
    assert offset_of_law(file, TRIAL / "standing.trc") == OFFSET and not heard.warnings
    assert offset_of_law(file, out_of_flat(tmp_path, 0.01)) == AS_STOOD
    assert "of another standing trial" in heard.warnings[0]


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("pitch = 0.57", r"foot.pitch.*not at most 0.35.*\[rad\]"),
        ("height = 0.4", r"foot.height.*not at most 0.05.*\[m\]"),
        ("pitch_sd = -0.1", "foot.pitch_sd.*not at least 0"),
        ("roll = 0.1", "foot.roll.*is not known here"),
        ("pitch = nan", "foot.pitch.*finite"),
        ('standing = "abc"', "foot.standing.*SHA-256"),
    ],
)
def test_what_it_cannot_be_is_refused(tmp_path: Path, line: str, words: str) -> None:
    with pytest.raises(gc.InputError, match=words):
        offset_of_law(law(tmp_path, f"[foot]\n{line}\n"), TRIAL / "standing.trc")


def test_centre_of_pressure_of_other_feet_says_that_it_is_not_used(tmp_path: Path) -> None:
    one = np.ones(1)
    table = SphereTable(np.zeros((1, 3)), 0.01 * one, ("foot",), None, None, None)
    heard = record()
    options = CopOptions(TRIAL / "walking.trc", motion=tmp_path, law=law(tmp_path, f"k = 1e4\n{FOOT}"))
    sole_law(table, options)
    assert any("[foot]" in line and "no effect here" in line for line in heard.warnings)


@pytest.mark.slow
def test_simulate_compare_and_design_start_from_it(tmp_path: Path) -> None:
    """The keel's frame on the shank is turned by the pitch, and its middle raised by the height, in each of them."""
    file = law(tmp_path, FOOT)
    study = test_compare.written(tmp_path, "low", changed=("[persons.P1]\n", f'[persons.P1]\nlaw = "{file}"\n'))
    given = {name: value for name, value in GIVEN.items() if name != "other_plate"}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        asked = [ProsthesisSimulateOptions(TRIAL / "walking.trc", **GIVEN, **own) for own in ({}, {"law": file})]
        without, walk = (walk_of(read_walk(o), o) for o in asked)
        plain = without.leg
        (stance,) = read_study(ProsthesisCompareOptions(study))
        trial = read_design(ProsthesisDesignOptions(TRIAL / "walking.trc", **given, law=file)).trial
    for leg in (walk.leg, walk.walked.motion.leg, stance.walk.leg, trial.leg):
        turned = plain.turn.inv() * leg.turn
        np.testing.assert_allclose(turned.as_rotvec(), [0.0, 0.0, -0.012], atol=1e-12)
        middles = [each.keel + each.turn.apply([0.11, 0.0, 0.0]) for each in (plain, leg)]
        np.testing.assert_allclose(plain.turn.inv().apply(middles[1] - middles[0]), [0.0, 0.4e-3, 0.0], atol=1e-12)
        assert leg.offset == OFFSET


@pytest.mark.slow
def test_a_planted_pitch_is_found_written_and_taken_over(tmp_path: Path) -> None:
    """The person stood turned by 0.57 degrees: 12.3 % of body weight off without height and pitch, 6.7 % with them."""
    static = out_of_flat(tmp_path, -np.radians(0.57))
    trial: dict[str, Any] = GIVEN | {"static": static}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        others = {name: value for name, value in trial.items() if name != "other_plate"}
        found = gc.prosthesis.calibrate(TRIAL / "walking.trc", **others, starts=0)
        found.write(tmp_path / "out")
        file = tmp_path / "out" / "law.toml"
        text = file.read_text()
        without = law(tmp_path, text[: text.index("[foot]")])
        walks = [gc.prosthesis.simulate(TRIAL / "walking.trc", **trial, law=each) for each in (file, without)]
    rows = found.table("numbers").set_index("number")
    sd = rows.loc["foot.pitch", "prior upper"] / 1.959964
    assert sd == pytest.approx(np.radians(0.5))
    # -0.74 degrees; the trial is of a finer foot, and as shipped -0.53 is found, so that this is no test of how near
    # the pitch is found: tests/below_knee_prosthesis/calibration/test_height_and_pitch.py is
    assert rows.loc["foot.pitch", "value"] == pytest.approx(np.radians(-0.74), abs=np.radians(0.15))
    assert rows.loc["foot.pitch", "verdict"] == "known"
    taken = walks[0].table("numbers").set_index("number")["value"]
    assert taken["leg foot_pitch"] == pytest.approx(rows.loc["foot.pitch", "value"], rel=1e-12)
    assert 0.0 < taken["leg foot_pitch_sd"] < np.radians(0.2)
    assert walks[1].table("numbers").set_index("number")["value"]["leg foot_pitch"] == 0.0
    errors = [each.table("errors").set_index("quantity")["rmse"]["resultant"] for each in walks]
    assert errors[0] < 0.75 * errors[1]
    assert any("degrees" in each and "according to the law's file" in each for each in walks[0].sentences)
    assert not any("according to the law's file" in each for each in walks[1].sentences)
