"""The intact side as what a prosthetic foot is meant to be near to: its outcomes, and what is refused."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from geocontact.analyses.frame.record import Record
from geocontact.analyses.prosthesis.design.options import ProsthesisDesignOptions
from geocontact.analyses.prosthesis.design.sweep import intact_table, intact_words
from geocontact.analyses.prosthesis.design.trial import intact_side
from geocontact.analyses.prosthesis.recorded_files import LaboratoryFiles
from geocontact.below_knee_prosthesis.design.drawn import RecordedTrial
from geocontact.below_knee_prosthesis.design.intact_step import IntactStep
from geocontact.below_knee_prosthesis.keel.vsf import vsf_keel
from geocontact.below_knee_prosthesis.leg import Person
from geocontact.data.errors import InputError
from tests.analyses.prosthesis.intact_trial import LENGTH, MASS, RADIUS, STANDING, known_step
from tests.analyses.prosthesis.spoilt_trial import TRIAL
from tests.recording import opened


def found_step(folder: Path, late: float = 0.0, away: float = 0.0, **changed: Any) -> IntactStep | None:
    """As `design` reads it, beside the shipped prosthetic stance."""
    made = known_step(folder, late, away)
    opened(Record("prosthesis design", {}))
    given: dict[str, Any] = {"static": STANDING, "mass": MASS, "plates": TRIAL / "plates.mot", "plate": "own_force"}
    given |= {"intact": made.markers, "intact_plates": made.plates}
    o = ProsthesisDesignOptions(TRIAL / "walking.trc", **(given | changed))
    laboratory = LaboratoryFiles(o.side)
    standing = laboratory.markers("`static`", o.static)
    plate = laboratory.stance(laboratory.plate_under_foot(o.plates, o.plate, o.mass), o.plates)
    trial = RecordedTrial(standing, standing, plate, Person(o.mass), vsf_keel(), 0.117, 0.05, 15.0, 0.2)
    return intact_side(o, trial)


def test_outcomes_are_those_that_were_made(tmp_path: Path) -> None:
    """A shank on a wheel has the wheel's radius; moment and rise as the forces were made."""
    step = found_step(tmp_path)
    assert step is not None
    values = step.outcomes()
    assert values["radius"] == pytest.approx(RADIUS, rel=2e-3)
    assert values["ankle_moment"] == pytest.approx(known_step(tmp_path).ankle_moment, rel=0.02)
    slope = 1.1 * 1.6 * MASS * 9.81 * np.pi / LENGTH
    assert values["loading_rate"] == pytest.approx(slope, rel=0.03)
    words = intact_words(values)
    assert "radius of the roll-over shape 0.31 m" in words
    assert "no peak moment at the socket and no energy that the keel returns" in words
    table = intact_table(values).set_index("outcome")
    assert table.loc["radius", "intact side"] == values["radius"]
    assert table["intact side"].isna().to_dict() == {
        "ankle_moment": False,
        "socket_moment": True,
        "energy": True,
        "radius": False,
        "loading_rate": False,
        "ankle_mean": False,
        "socket_mean": True,
        **dict.fromkeys(("knee_moment", "knee_mean", "hip_moment", "hip_mean", "metabolic"), True),
    }
    own = np.abs(step.ankle_moment)
    mean = (0.5 * (own[1:] + own[:-1]) @ np.diff(step.time)) / np.ptp(step.time)
    assert values["ankle_mean"] == pytest.approx(mean, rel=1e-12)
    assert "not computed of the intact leg" in table.loc["hip_mean", "words"]


CASES: dict[str, tuple[Callable[[Path], IntactStep | None], str]] = {
    "step of the prosthetic side": (
        lambda f: found_step(f, intact_plates=TRIAL / "plates.mot", intact_plate="own_force"),
        "own_force is under the prosthetic foot",
    ),
    "no plate under it": (lambda f: found_step(f, away=0.5), "no plate under the intact foot"),
    "markers missing": (lambda f: found_step(f, intact=TRIAL / "walking.trc"), "no marker LSH1"),
    "not while standing": (lambda f: found_step(f, static=TRIAL / "standing.trc"), "no marker LTH1.* while standing"),
    "aim of no intact step": (lambda f: found_step(f, aim="knee_moment"), "`aim`: .* not computed of a step of the"),
    "two targets": (lambda f: found_step(f, target=0.3), "states already which radius of the roll-over shape"),
    "plate without a trial": (
        lambda f: found_step(f, intact=None, intact_plate="intact_force"),
        "no trial of the intact side is given",
    ),
    "clocks apart": (lambda f: found_step(f, late=0.09), "loaded 0.0[789] s after the markers touch the floor"),
}


@pytest.mark.parametrize("case", CASES)
def test_refused(case: str, tmp_path: Path) -> None:
    run, words = CASES[case]
    with pytest.raises(InputError, match=words):
        run(tmp_path)


def test_target_of_what_an_intact_foot_has_not(tmp_path: Path) -> None:
    """A number for the keel's energy stands beside the intact side's outcomes."""
    assert found_step(tmp_path, aim="energy", target=20.0) is not None
