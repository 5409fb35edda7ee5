"""A choice of a foot by the analysis: what is refused at once, and the shipped trial from end to end."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.prosthesis.design.sweep import shown_values
from geocontact.below_knee_prosthesis.design.knob import AIMS
from tests.analyses.prosthesis.intact_trial import STANDING, known_step
from tests.analyses.prosthesis.spoilt_trial import renamed_markers
from tests.cli.calls import MESHES, call

TRIAL = MESHES / "gait_P1_medium_1"
GIVEN: dict[str, Any] = {
    "static": TRIAL / "standing.trc",
    "mass": 77.3,
    "plates": TRIAL / "plates.mot",
    "plate": "own_force",
}


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"feet": 2}, "is not 6 to 600"),
        ({"walks": 0}, "is not 1 to 600"),
        ({"level": 1.0}, "not between 0 and 1"),
        ({"target": -0.3}, "cannot be reached"),
        ({"together": True, "vary": "alignment"}, "alignment is varied anyway"),
        ({"plate": "other_force"}, "no whole stance"),
        ({"numbers": TRIAL / "truth.csv"}, "numbers.csv of prosthesis calibrate"),
    ],
)
def test_refused(changed: dict[str, Any], words: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        with pytest.raises(gc.InputError, match=words):
            gc.prosthesis.design(TRIAL / "walking.trc", **(GIVEN | changed))


def test_pelvis_that_tells_no_hip_is_refused_in_one_line(tmp_path: Path) -> None:
    walking = renamed_markers(tmp_path, "walking.trc", {"LPSI": "other"})
    typed = (f"--{name}={value}" for name, value in (GIVEN | {"out": tmp_path / "out"}).items())
    refused = call("prosthesis", "design", walking, *typed)
    assert refused.code == 2 and len(refused.complaints) == 1 and "no marker LPSI" in refused.err
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_shipped_trial_to_files(tmp_path: Path) -> None:
    """Of a sole that is known: the radius is told, and what has no effect is not."""
    numbers = tmp_path / "numbers.csv"
    zones = ("heel_back", "heel_middle", "heel_front", "midfoot", "forefoot")
    rows = [f"{kind}.{zone},-,1.0,0.9,1.1,known" for kind in ("stiffness", "damping", "friction") for zone in zones]
    numbers.write_text("\n".join(["number,unit,value,lower,upper,verdict", *rows]) + "\n")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        step = known_step(tmp_path)
        given = GIVEN | {"static": STANDING, "intact": step.markers, "intact_plates": step.plates}
        found = gc.prosthesis.design(TRIAL / "walking.trc", **given, numbers=numbers, feet=6, walks=1, together=True)
    known = found.table("answers").set_index("outcome")
    assert known.loc["radius", "identified"]
    assert not known.loc["loading_rate", "identified"]
    assert known.loc["radius", "wanted"] == "nearest to the intact side's 0.31 m"
    assert known.loc["energy", "wanted"] == "the most"
    assert "the intact side's 0.31 m" in found.sentences[0] and "no peak moment at the socket" in found.sentences[3]
    sweep = found.table("sweep").set_index(["response", "outcome"])
    energy = sweep.loc[("angles kept", "energy"), "median"].to_numpy(float)
    assert np.all(np.diff(energy) < 0.0)
    moment = sweep.loc[("torque kept", "ankle_moment"), "median"].to_numpy(float)
    assert np.ptp(moment) < 0.02 * moment.mean()
    ends = found.table("ranges").set_index("outcome").loc["energy"]
    assert (ends["least"].to_numpy(float) <= energy + 1e-12).all() and (ends["most"].to_numpy(float) >= energy).all()
    assert found.held[1] > max(found.held[0], found.held[2])  # torques alone, nearest to the present foot
    assert any("a weak spring at hip and knee" in each for each in found.warnings)
    hangs_on = found.table("sensitivities").set_index(["number", "response", "outcome"])["change"]
    assert hangs_on["fulcrum", "angles kept", "energy"] < 0.0
    step = np.interp([10.0, 20.0], shown_values(found.sweep) - shown_values(found.sweep)[0], energy)
    assert hangs_on["fulcrum", "angles kept", "energy"] == pytest.approx(step[1] - step[0], rel=0.6)
    pairs = found.table("pairs").set_index("outcome")
    assert pairs.loc["socket_moment", "best alignment [deg]"] < 0.0  # toes down shortens the lever
    straight = found.table("together").set_index(["alignment [deg]", "response", "outcome"]).sort_index()
    alone = straight.loc[(0.0, "angles kept", "energy"), "median"].to_numpy(float)
    recorded = np.median(found.sweep.drawn[:, 0, :, AIMS.index("energy")], axis=0)  # pairs keep the recorded load
    np.testing.assert_allclose(alone, recorded, rtol=1e-6)
    numbers_now = found.table("numbers").set_index("number")["value"]
    assert numbers_now["leg foot_pitch"] == 0.0 and numbers_now["sole forefoot_stiffness"] == pytest.approx(
        38547.0, abs=1
    )
    found.write(tmp_path / "out")
    assert (tmp_path / "out" / "report.html").is_file() and (tmp_path / "out" / "pairs.csv").is_file()
    assert (tmp_path / "out" / "intact.csv").is_file()
