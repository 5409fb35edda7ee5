"""The three large studies are made by one command each, and what reads their descriptions takes them."""

from __future__ import annotations

import shlex
import tomllib
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from benchmarks import sessions
from benchmarks.prosthesis import compare
from benchmarks.shoulder import trials
from benchmarks.standing import nine
from benchmarks.standing.nine_truth import write_truth
from geocontact.io.mocap.markers import read_markers
from geocontact.io.recordings.gait_study import read_gait_study
from geocontact.io.recordings.standing_study import read_standing_study
from geocontact.io.text.tables import read_table
from geocontact.standing_up.chain import Subject
from meshes import gait_persons
from meshes.gait_persons import PARTICIPANTS


def command_of(capsys: pytest.CaptureFixture[str]) -> list[str]:
    """Words of the last line."""
    return shlex.split(capsys.readouterr().out.splitlines()[-1])


def test_the_prosthesis_study_has_34_trials_of_four_persons(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """By the study: 4 persons, 3 settings, 3 trials, two lost; the files of a trial made without simulating it."""
    made = []

    def files(trial: tuple[Any, ...]) -> dict[str, str]:
        made.append(trial)
        return dict.fromkeys(("walking.trc", "plates.mot", "standing.trc"), "")

    monkeypatch.setattr(compare, "synthetic_trial", lambda person, setting, k, **_: (person.name, setting, k))
    monkeypatch.setattr(compare, "trial_files", files)
    assert sessions.main(["prosthesis", str(tmp_path)]) == 0
    every = {(f"P{p}", setting, k) for p in range(1, 5) for setting in ("low", "medium", "high") for k in (1, 2, 3)}
    assert set(made) == every - {("P2", "medium", 3), ("P4", "high", 3)} and len(made) == 34
    study = read_gait_study(tmp_path / "study.toml")
    assert len(study.trials) == 34 and {each.mass for each in study.persons.values()} == {p.mass for p in PARTICIPANTS}
    assert command_of(capsys)[:4] == ["geocontact", "prosthesis", "compare", str(tmp_path / "study.toml")]
    sessions.main(["prosthesis", str(tmp_path)])
    assert len(made) == 34, "what is there is kept"


def test_the_law_of_a_benchmark_is_in_the_same_description(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compare, "synthetic_trial", lambda *_, **__: None)
    monkeypatch.setattr(compare, "trial_files", lambda _: {})
    (tmp_path / "P1_calibrated").mkdir()
    told = tomllib.loads(compare.written(tmp_path, PARTICIPANTS[0], False))
    assert told["persons"]["P1"]["law"] == "P1_calibrated/law.toml"
    assert [one["name"] for one in told["trials"] if one.get("calibrated")] == ["P1_medium_1"]
    assert len(told["trials"]) == 9


def test_the_shoulder_study_has_18_trials(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    made = []

    def trial(folder: Path, what: tuple[Any, ...]) -> str:
        made.append("".join(each.name for each in what))
        return trials.part({"name": made[-1]})

    class Here:
        def __init__(self, workers: int) -> None:
            pass

        def __enter__(self) -> Here:
            return self

        def __exit__(self, *_: object) -> None:
            pass

        map = staticmethod(map)

    monkeypatch.setattr(trials, "write_trial", trial)
    monkeypatch.setattr(trials, "ProcessPoolExecutor", Here)
    assert sessions.main(["shoulder", str(tmp_path)]) == 0
    every = {f"P{p}T{t}S{s}" for p in (1, 2, 3) for t in (1, 2) for s in (0, 50, 100)}
    assert set(made) == every and len(made) == 18
    told = tomllib.loads((tmp_path / "study.toml").read_text(encoding="utf-8"))
    assert len(told["trials"]) == 18 and set(told["persons"]) == {"P1", "P2", "P3"}
    assert command_of(capsys)[:3] == ["geocontact", "shoulder", "study"]


def test_the_nine_trials_are_of_one_session(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Which is made by what the benchmark makes it by, and its results are not touched."""
    spans = {name: (float(k), k + 1.0) for k, name in enumerate((*nine.PASSIVE, *nine.HELD_OUT))}
    monkeypatch.setattr(nine, "pipelines", lambda out: nine.write_studies(out, spans))
    assert sessions.main(["sit-to-stand", str(tmp_path)]) == 0
    names = [
        [one["name"] for one in tomllib.loads((tmp_path / f"{study}.toml").read_text("utf-8"))["trials"]]
        for study in ("calibration", "prediction")
    ]
    assert names == [["T1", "T2", "T3"], ["P1", "P2", "P3", "P4", "P5", "P6"]]
    assert command_of(capsys)[3] == str(tmp_path / "calibration.toml")


@pytest.mark.slow
@pytest.mark.long
def test_a_trial_of_a_prosthesis_is_made_and_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One of the 34, simulated: its files are there, and hold a walk that goes on."""
    monkeypatch.setattr(gait_persons, "PARTICIPANTS", PARTICIPANTS[:1])
    monkeypatch.setattr(compare, "trials_of", lambda person: [(f"{person.name}_medium_1", "medium")])
    assert sessions.main(["prosthesis", str(tmp_path)]) == 0
    (trial,) = read_gait_study(tmp_path / "study.toml").trials
    walk = read_markers(tmp_path / trial.name / "walking.trc")
    assert walk.time[-1] > 0.6 and np.nanmax(np.ptp(walk.positions, axis=0)) > 0.5
    plates = read_table(tmp_path / trial.name / "plates.mot")
    assert plates.needed("own_force_vy").max() > 0.8 * 9.81 * PARTICIPANTS[0].mass, "it bears the weight"


@pytest.mark.slow
@pytest.mark.long
def test_trials_of_a_shoulder_are_made_and_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One task of one person, bare and in all conditions: where the device is worn more lifts the arm by its level."""
    write = partial(trials.write_study, persons=trials.PARTICIPANTS[:1], tasks=trials.TASKS[:1], workers=1)
    monkeypatch.setattr(trials, "write_study", write)
    assert sessions.main(["shoulder", str(tmp_path)]) == 0
    told = tomllib.loads((tmp_path / "study.toml").read_text(encoding="utf-8"))["trials"]
    assert len(told) == 3 and all(read_markers(tmp_path / each["markers"]).time[-1] > 1.0 for each in told)
    worn = {each["level"]: pd.read_csv(tmp_path / each["recorded"])["force [N]"] for each in told if "level" in each}
    assert 0.0 <= worn["50%"].mean() < worn["100%"].mean()


@pytest.mark.slow
@pytest.mark.long
def test_a_trial_of_standing_up_is_made_and_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The first of the nine, of a finer model with fewer nodes, through markers, plates, motors and mats."""
    write_truth(tmp_path / "truth.npz", Subject(), 20, names=("T1",))
    monkeypatch.setattr(nine, "spread", lambda _: {})
    monkeypatch.setattr(nine, "write_studies", partial(nine.write_studies, studies={"calibration": ("T1",)}))
    assert sessions.main(["sit-to-stand", str(tmp_path)]) == 0
    (trial,) = read_standing_study(tmp_path / "calibration.toml").trials
    assert trial.coordinates.is_file() and trial.torques is not None and trial.torques.is_file()
    assert trial.strap and all(each.is_file() for each in trial.strap)
    angles = read_table(trial.coordinates)
    used = (angles.time >= (trial.start or 0.0)) & (angles.time <= (trial.end or np.inf))
    assert np.ptp(angles.needed("hip")[used]) > 30.0, "it stands up"
