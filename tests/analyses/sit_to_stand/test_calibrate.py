"""A calibration by the analysis: what is refused at once, and the shipped study from end to end."""

from __future__ import annotations

import threading
import warnings
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.frame.record import Record
from geocontact.analyses.sit_to_stand.calibrate.options import StandingCalibrateOptions
from geocontact.analyses.sit_to_stand.calibrate.phases import doubt_phase, say_selection
from geocontact.analyses.sit_to_stand.calibrate.result import read, run
from geocontact.io.opensim.storage_writer import write_moco_trajectory
from geocontact.standing_up.calibrated_phase import Ended
from geocontact.standing_up.chain import FOOT_PARAMETERS
from tests import opensim_oracle
from tests.analyses.sit_to_stand.ctrl_c import Interrupting
from tests.cli.calls import MESHES
from tests.elsewhere import Elsewhere
from tests.recording import opened
from tests.unchecked import unchecked

STUDY = MESHES / "standing_up" / "study.toml"
BEST, SAME, WORSE = Ended(1.0, True, True), Ended(1.0005, True, True), Ended(3.0, True, False)


def changed(folder: Path, *changes: tuple[str, str], file: str = "study.toml", trials: int = 3) -> Path:
    """The shipped study with some of the text of one file replaced, and only its first trials."""
    for each in STUDY.parent.iterdir():
        text = each.read_text()
        if each.name == "study.toml":
            parts = text.split("\n[[trials]]")
            text = "\n[[trials]]".join(parts[: trials + 1])
        if each.name == file:
            for old, new in changes:
                assert old in text
                text = text.replace(old, new)
        (folder / each.name).write_text(text)
    return folder / "study.toml"


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("value = 70,", "value = 7000,", "cannot be the mass of a person"),
        ("[noise]", "[noises]", "noises: is not known here; perhaps noise"),
        ("value = 2,", "value = 0,", "0 N cannot be the standard deviation of a force"),
        ('rates = "T1_rates.sto"', "", "rates is tracked, and this trial has none"),
        ('name = "T2"', 'name = "T1"', "two have the name 'T1'"),
        ('name = "T2"', 'name = "../T2"', "cannot be that of a file"),
        ('chair = "chair_force"', 'chair = "sofa"', "no plate 'sofa'"),
        ('chair = "chair_force"', "start = 1.75", "samples are left of it"),
        ('feet = "feet_force"', 'feet = "chair_force"', "the feet must stand on it throughout"),
        ("mass =", 'free = ["stifness"]\nmass =', "'stifness' is not known here"),
        ("mass =", 'tracks = ["rates"]\nmass =', "coordinates are not among them"),
        ("T1_plates.mot", "T4_plates.mot", "there is no file T4_plates.mot"),
        ("T1_plates.mot", "T3_rates.sto", "no column of the form"),
    ],
)
def test_a_study_that_cannot_be_read_is_refused(tmp_path: Path, old: str, new: str, words: str) -> None:
    with pytest.raises(gc.InputError, match=words):
        gc.sit_to_stand.calibrate(changed(tmp_path, (old, new)))


def test_trials_of_another_model_are_refused(tmp_path: Path) -> None:
    study = changed(tmp_path, ("\tankle\t", "\tenkel\t"), file="T2_coordinates.sto")
    with pytest.raises(gc.InputError, match="no column for ankle"):
        gc.sit_to_stand.calibrate(study)


def moved(text: str, column: str, by: float) -> str:
    """A storage with one column moved."""
    head, body = text.split("endheader\n")
    names, *rows = body.splitlines()
    at = names.split("\t").index(column)
    cells = [row.split("\t") for row in rows]
    for row in cells:
        row[at] = f"{float(row[at]) + by:.6g}"
    return f"{head}endheader\n" + "\n".join([names, *("\t".join(row) for row in cells)]) + "\n"


@pytest.mark.parametrize(
    ("column", "by", "words"),
    [
        ("time", 5.0, "put plates and markers on one clock"),
        ("chair_force_vy", 20.0, "seat-off not found: its force is 20 N to the end"),
        ("feet_force_px", 3.0, "is 3.0. m ahead of the ankle"),
    ],
)
def test_plates_that_do_not_belong_are_refused(tmp_path: Path, column: str, by: float, words: str) -> None:
    study = changed(tmp_path)
    file = tmp_path / "T1_plates.mot"
    file.write_text(moved(file.read_text(), column, by))
    with pytest.raises(gc.InputError, match=words):
        gc.sit_to_stand.calibrate(study)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"nodes": 1.0}, "nodes"),
        ({"degree": 1}, "2 to 9"),
        ({"level": 1.0}, "between 0 and 1"),
        ({"starts": -1}, "0 to"),
    ],
)
def test_options_that_cannot_be_are_refused(given: dict[str, float], words: str) -> None:
    with pytest.raises(gc.InputError, match=words):
        gc.sit_to_stand.calibrate(STUDY, **given)


def test_trials_begin_when_the_chair_is_left(tmp_path: Path) -> None:
    opened(Record("sit-to-stand calibrate", {}))
    given = read(StandingCalibrateOptions(STUDY))
    assert [trial.name for trial in given.trials] == ["T1", "T2", "T3"]
    np.testing.assert_allclose([trial.time[-1] for trial in given.trials], [1.5, 1.3, 1.8])
    weight = given.subject.mass * 9.81
    assert all(0.9 < trial.force[-1, 1] / weight < 1.1 for trial in given.trials)


@pytest.mark.slow
def test_one_shipped_trial_from_files_to_files(tmp_path: Path) -> None:
    study = changed(tmp_path, ("mass =", 'free = ["stiffness", "heel", "toe"]\nmass ='), trials=1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        found = gc.sit_to_stand.calibrate(study, resamples=0, nodes=15.0)
    assert found.accepted, found.warnings
    mesh = found.table("certificate")  # 22 even intervals leave more than 1 N m
    assert mesh["intervals [-]"].item() > 22 and mesh["shortest interval [s]"].item() < 0.99 * 1.5 / 22
    errors = found.table("errors").set_index("quantity")
    assert errors.loc["force_y", "rmsd"] < 10.0 and errors.loc["centre", "rmsd"] < 1.2
    out = found.write(tmp_path / "cal")
    names = {"parameters.csv", "errors.csv", "certificate.csv", "correlation.csv", "trial_T1.csv", "solution_T1.sto"}
    assert names | {"report.html", "model.osim", "run.json", "standing_up.png"} <= {each.name for each in out.iterdir()}
    rows = pd.read_csv(out / "trial_T1.csv")
    assert rows["residual [N]"].max() < 5.0 and rows["residual [N m]"].max() < 1.0
    head, body = (out / "solution_T1.sto").read_text().split("endheader\n")
    assert "num_states=12" in head and len(body.split("\n")[0].split("\t")) == 1 + 12 + 3 + 6


@pytest.mark.slow
@pytest.mark.skipif(threading.current_thread() is not threading.main_thread(), reason="signals come to the main thread")
def test_ctrl_c_keeps_the_last_iterate_and_says_so(tmp_path: Path) -> None:
    study = changed(tmp_path, trials=1)
    asked = StandingCalibrateOptions(study, nodes=12.0)
    opened(Record("sit-to-stand calibrate", {}, listener=Interrupting(4)))
    found = run(read(asked), asked)
    assert not found.accepted and found.exit_code == 1
    assert any("interrupted; the last iterate is saved" in line for line in found.warnings)
    numbers = found.phases[0].numbers.numbers
    assert {n.verdict for n in numbers} == {"not settled", "held"} and len(numbers) == len(FOOT_PARAMETERS)
    found.write(tmp_path / "cal")
    assert (tmp_path / "cal" / "report.html").is_file()


@pytest.mark.oracle
def test_opensim_reads_the_trajectory(opensim: Elsewhere, tmp_path: Path) -> None:
    time, file = np.linspace(0.0, 1.0, 11), tmp_path / "solution.sto"
    joint, torque = "/jointset/ankle/ankle", "/forceset/ankle_torque"
    states = {f"{joint}/value": time**2, f"{joint}/speed": 2 * time}
    write_moco_trajectory(file, time, states, {torque: 3 * time}, {f"{joint}/accel": time}, True)
    names, columns = opensim(opensim_oracle.moco_trajectory, str(file), list(states), [torque])
    assert names == list(states)
    np.testing.assert_allclose(columns, np.column_stack([time, *states.values(), 3 * time]), rtol=1e-9)


def doubts(**other: object) -> tuple[list[str], list[str]]:
    """Sentences and warnings of a phase without anything to doubt but what is given."""
    numbers = SimpleNamespace(numbers=(SimpleNamespace(name="heel", verdict=other.pop("verdict", "known")),))
    one = {
        "name": "A",
        "found": SimpleNamespace(solved=True, ending="solved", motions=()),
        "doubt": "",
        "motions": (),
        "numbers": numbers,
        "shares": {"force": 0.5, "rates": 0.5},
        "ends": (BEST,),
        "misfit": 0.8,
    }
    record = opened(Record("sit-to-stand calibrate", {}))
    with unchecked():
        doubt_phase(SimpleNamespace(**(one | other)))  # type: ignore[arg-type]
    return list(record.sentences), list(record.warnings)


@pytest.mark.filterwarnings("ignore::geocontact.InputWarning")
@pytest.mark.parametrize(
    ("other", "words"),
    [
        ({"shares": {"force": 0.995, "rates": 0.005}}, "99.5 % of the cost are force"),
        ({"ends": (WORSE, BEST)}, "ends in a minimum worse than that of another start"),
        ({"ends": (Ended(2.0, False, False), BEST)}, "ends in a minimum worse than that of another start"),
        ({"ends": (Ended(1.0005, True, False), BEST)}, "ends in a minimum worse than that of another start"),
        ({"misfit": 1.74}, "phase A leaves 1.7 times the sum of squares that the noise explains"),
        ({"verdict": "not separable"}, "not separable, with intervals that cover both: heel"),
        ({"verdict": "on its bound"}, "at a bound, so the value only reflects the bound: heel"),
        ({"verdict": "prior-dominated"}, "add little to the prior of heel"),
        ({"doubt": "it is singular"}, "phase A has no intervals: it is singular"),
    ],
)
def test_what_changes_how_numbers_are_read_is_warned_of(other: dict[str, object], words: str) -> None:
    assert any(words in line for line in doubts(**other)[1])


@pytest.mark.filterwarnings("ignore::geocontact.InputWarning")
@pytest.mark.parametrize(
    ("why", "words"),
    [
        ("it is singular", "phase A: no parameters are selected: it is singular; the usual ones are free"),
        ("", "phase A: its trials identify no parameter, so that the usual ones are free"),
    ],
)
def test_why_nothing_was_selected_is_said(why: str, words: str) -> None:
    record = opened(Record("sit-to-stand calibrate", {}))
    with unchecked():
        say_selection(SimpleNamespace(name="A", selection=(), unselected=why), True)  # type: ignore[arg-type]
    assert list(record.warnings) == [words]


def test_nothing_to_doubt_is_not_warned_of() -> None:
    said, warned = doubts(ends=(BEST, SAME, WORSE))
    assert not warned and said == ["phase A: 2 of 3 starts end in the lowest minimum, 3 converge"]
