"""Further stances of a calibration: which are taken, what is refused, and all of them from end to end."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.frame.record import Record
from geocontact.analyses.prosthesis.calibrate.foot_on_plate import further_stances
from geocontact.analyses.prosthesis.calibrate.options import ProsthesisCalibrateOptions
from tests.analyses.prosthesis.test_compare import written
from tests.cli.calls import MESHES
from tests.recording import opened

TRIAL = MESHES / "gait_P1_medium_1"
GIVEN: dict[str, Any] = {
    "static": TRIAL / "standing.trc",
    "mass": 77.3,
    "plates": TRIAL / "plates.mot",
    "plate": "own_force",
}


def asked(study: Path, **changed: Any) -> ProsthesisCalibrateOptions:
    return ProsthesisCalibrateOptions(TRIAL / "walking.trc", further=study, **(GIVEN | changed))


def test_marked_stances_are_taken_and_the_named_one_counts_once(tmp_path: Path) -> None:
    opened(Record("prosthesis calibrate", {}))
    found = further_stances(asked(written(tmp_path, "low", "medium", "high")))
    assert [(each.name, each.setting) for each in found] == [("P1_low_1", "low"), ("P1_high_1", "high")]
    assert [each.other_plate for each in found] == [None, None]
    marked = ('setting = "high"', 'setting = "high"\ncalibrated = true')
    study = written(tmp_path, "low", "medium", "high", changed=marked)
    (found_one,) = further_stances(asked(study, full=True, other_plate="other_force"))
    assert (found_one.name, found_one.other_plate) == ("P1_high_1", "other_force")


@pytest.mark.parametrize(
    ("settings", "changed", "options", "words"),
    [
        (("medium",), ("", ""), {}, "no stance beside the one named"),
        (("low",), ("value = 77.3", "value = 70"), {}, "P1 has 70 kg, `mass` is 77.3 kg"),
        (("low",), ("[persons.P1]", '[persons.P1]\nside = "left"'), {}, "the prosthesis is on the left"),
        (("low",), ('setting = "low"', 'setting = "low"\nground = "plane:0,1,0,0"'), {}, "on another ground"),
        (("low",), ('setting = "low"', 'setting = "soft"'), {}, "'soft' is none"),
    ],
)
def test_refused(
    tmp_path: Path, settings: tuple[str, ...], changed: tuple[str, str], options: dict[str, Any], words: str
) -> None:
    study = written(tmp_path, *settings, changed=changed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        with pytest.raises(gc.InputError, match=words):
            gc.prosthesis.calibrate(TRIAL / "walking.trc", further=study, **(GIVEN | options))


@pytest.mark.slow
@pytest.mark.long
def test_one_sole_for_two_settings(tmp_path: Path) -> None:
    """Both stances in every table, one height and pitch of their standing trial."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        found = gc.prosthesis.calibrate(TRIAL / "walking.trc", further=written(tmp_path, "low"), starts=0, **GIVEN)
    table = found.table("stances").set_index("stance")
    assert list(table.index) == ["first", "P1_low_1"] and list(table["setting"]) == ["medium", "low"]
    for one, name in zip(found.fitted, table.index, strict=True):
        off = (one.fit.predicted[:, 1] - one.stance.force[:, 1]) / one.stance.weight
        assert table.loc[name, "vertical rmse [-]"] == pytest.approx(np.sqrt(np.mean(off**2)), rel=1e-9)
    assert table["foot pitch [deg]"].nunique() == 1 and len(found.last.offsets) == 1
    assert set(found.table("stance")["stance"]) == {"first", "P1_low_1"}
    assert any(line.startswith("P1_low_1 (low): vertical force within") for line in found.sentences)
