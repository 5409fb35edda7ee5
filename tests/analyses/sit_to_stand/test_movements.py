"""One recording of three movements, cut by the command and by a study that names one of them."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.frame.record import Record
from geocontact.analyses.sit_to_stand.standing_trials import standing_trials
from geocontact.io.recordings.standing_study import read_standing_study
from geocontact.io.text.tables import read_table
from geocontact.standing_up.trials import StandingTrial
from tests.cli.calls import MESHES, call
from tests.recording import opened

SAMPLE = MESHES / "standing_up"
STILL, STEP = 80, 0.01
CHAIR = {"plates": "plates.mot", "chair": "chair_force", "feet": "feet_force"}


def _storage(file: Path, like: Path, values: np.ndarray) -> None:
    head, body = like.read_text().split("endheader\n")
    names = body.splitlines()[0]
    rows = "\n".join("\t".join(f"{x:.6f}" for x in row) for row in values)
    title = head.splitlines()[0]
    degrees = "no" if "plates" in like.name else "yes"
    top = f"{title}\nversion=1\nnRows={len(values)}\nnColumns={values.shape[1]}\ninDegrees={degrees}\nendheader\n"
    file.write_text(f"{top}{names}\n{rows}\n")


def recording(folder: Path) -> tuple[float, float]:
    """The first shipped trial up, the same down, and up again; when it starts again and how long one lasts [s]."""
    for kind, suffix in (("coordinates", "sto"), ("rates", "sto"), ("plates", "mot")):
        table = read_table(SAMPLE / f"T1_{kind}.{suffix}")
        up = np.column_stack([table.column(name) for name in table.channels])
        if kind == "rates":
            still = np.zeros((STILL, up.shape[1]))
            whole = np.vstack([up, still, -up[::-1], still, up, still])
        else:
            top, low = np.tile(up[-1], (STILL, 1)), np.tile(up[0], (STILL, 1))
            whole = np.vstack([up, top, up[::-1], low, up, top])
        time = STEP * np.arange(len(whole))
        _storage(folder / f"{kind}.{suffix}", SAMPLE / f"T1_{kind}.{suffix}", np.column_stack([time, whole]))
    return STEP * (2 * (len(up) + STILL)), STEP * len(up)


def trial_of(folder: Path, keys: str) -> StandingTrial:
    opened(Record("sit-to-stand calibrate", {}))
    head = (SAMPLE / "study.toml").read_text().split("\n[[trials]]")[0]
    files = 'coordinates = "coordinates.sto"\nrates = "rates.sto"\nplates = "plates.mot"\nfeet = "feet_force"\n'
    (folder / "study.toml").write_text(f'{head}\n[[trials]]\n{files}chair = "chair_force"\n{keys}\n')
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        (trial,) = standing_trials(folder / "study.toml", "study").trials
    return trial


def test_three_movements_are_cut_and_a_study_reads_the_cut(tmp_path: Path) -> None:
    again, lasts = recording(tmp_path)
    options = [
        word for key, value in CHAIR.items() for word in (f"--{key}", tmp_path / value if key == "plates" else value)
    ]
    out = tmp_path / "cut"
    made = call("sit-to-stand", "movements", tmp_path / "coordinates.sto", *options, "--out", out, folder=out)
    assert made.code == 0, made.err
    table = made.table("movements.csv")
    assert list(table["movement"]) == ["standing up 1", "sitting down 1", "standing up 2"]
    assert (table["chair agrees"] == "yes").all() and "3 movements: 2 standing up, 1 sitting down" in made.out
    first, second = table.loc[0], table.loc[2]
    for column in ("start [s]", "seat-off or contact [s]"):
        assert second[column] - first[column] == pytest.approx(again, abs=0.03)
    # the shipped file has its seat-off at 0.3 s and is still after 1.8 s
    assert first["seat-off or contact [s]"] == pytest.approx(0.3, abs=0.011) and 1.4 < first["end [s]"] < lasts
    study = (SAMPLE / "study.toml").read_text().split("\n[[trials]]")[0]
    (out / "study.toml").write_text(study + "\n" + (out / "trials.toml").read_text().replace("#", "\n#"))
    read = read_standing_study(out / "study.toml").trials
    assert [each.task for each in read] == ["standing up", "sitting down", "standing up"]
    assert [each.start for each in read] == pytest.approx(list(table["start [s]"]), rel=1e-5)


def test_a_trial_that_names_its_movement_is_that_of_its_times(tmp_path: Path) -> None:
    again, _ = recording(tmp_path)
    one, two = (trial_of(tmp_path, f"movement = {k}") for k in (1, 2))
    assert abs(len(one.time) - len(two.time)) <= 2 and 1.0 < one.time[-1] < 1.6
    np.testing.assert_allclose(two.q[:100], one.q[:100], atol=1e-9)
    by_times = trial_of(tmp_path, f"start = {again:.2f}")
    np.testing.assert_allclose(by_times.q[: len(two.q)], two.q, atol=1e-9)
    down = trial_of(tmp_path, 'movement = 1\ntask = "sitting down"')
    assert down.chair is None and down.q[-1, 4] > down.q[0, 4] + 1.0, "the knee is flexed at seat contact"
    np.testing.assert_allclose(down.q[::-1][:90], one.q[:90], atol=1e-9)
    seated = trial_of(tmp_path, 'movement = 1\ntask = "sitting down"\nsitting = true')
    assert seated.chair is not None and len(seated.time) > len(down.time)
    assert abs(seated.chair[0, 1]) < 1.0 and seated.chair[-1, 1] > 5.0, "on the chair at its end"


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ("movement = 3", "standing up is there 2 times in coordinates.sto, among 3 movements"),
        ('movement = 2\ntask = "sitting down"', "sitting down is there 1 times"),
        ('task = "sitting down"\nend = 1.7', "seat contact not found: its force is 0 N at the end"),
        ('task = "sitting down"\nstart = 5\nend = 5.3', "seat contact not found: its force is at least"),
    ],
)
def test_movements_that_are_not_there_are_refused(tmp_path: Path, keys: str, words: str) -> None:
    recording(tmp_path)
    with pytest.raises(gc.InputError, match=words):
        trial_of(tmp_path, keys)


def test_a_squat_is_cut_where_no_chair_was_recorded(tmp_path: Path) -> None:
    """The shipped rise from its end back and again: down and up at once."""
    for kind, suffix in (("coordinates", "sto"), ("rates", "sto"), ("plates", "mot")):
        table = read_table(SAMPLE / f"T1_{kind}.{suffix}")
        up = np.column_stack([table.column(name) for name in table.channels])
        still, way = (0.0 * up[0], -1.0) if kind == "rates" else (up[0], 1.0)
        whole = np.vstack([way * up[::-1], still, up])
        rows = np.column_stack([STEP * np.arange(len(whole)), whole])
        _storage(tmp_path / f"{kind}.{suffix}", SAMPLE / f"T1_{kind}.{suffix}", rows)
    found = gc.sit_to_stand.movements(tmp_path / "coordinates.sto")
    down, up_again = found.movements
    assert (down.kind, up_again.kind) == ("going down", "rising")
    trials = found.trials_toml(tmp_path)
    assert f'# With the next, it may be a squat: then task = "squat", end = {up_again.end:.6g} here.' in trials
    head = (SAMPLE / "study.toml").read_text().split("\n[[trials]]")[0]
    files = 'coordinates = "coordinates.sto"\nrates = "rates.sto"\nplates = "plates.mot"\nfeet = "feet_force"\n'
    (tmp_path / "study.toml").write_text(f'{head}\n[[trials]]\n{files}task = "squat"\nmovement = 1\n')
    opened(Record("sit-to-stand calibrate", {}))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        (trial,) = standing_trials(tmp_path / "study.toml", "study").trials
    assert trial.time[-1] == pytest.approx(up_again.end - down.start, abs=0.011)


def test_one_sample_of_noise_moves_no_trial(tmp_path: Path) -> None:
    """8 N on the empty chair, once, 1 s after seat-off: the trial of `movement` stays as it was."""
    recording(tmp_path)
    wanted = trial_of(tmp_path, "movement = 1")
    file = tmp_path / "plates.mot"
    table = read_table(file)
    rows = np.column_stack([table.time, *(table.column(name) for name in table.channels)])
    rows[130, 1 + list(table.channels).index("chair_force_vy")] = 8.0
    _storage(file, SAMPLE / "T1_plates.mot", rows)
    np.testing.assert_array_equal(trial_of(tmp_path, "movement = 1").q, wanted.q)


def test_a_task_that_the_coordinates_contradict_is_warned_of(tmp_path: Path) -> None:
    recording(tmp_path)
    record = opened(Record("sit-to-stand calibrate", {}))
    trial_of(tmp_path, "movement = 1")
    del record
    record = opened(Record("sit-to-stand calibrate", {}))
    study = tmp_path / "study.toml"
    text = study.read_text().replace("movement = 1", "start = 2.6\nend = 4.2").replace('chair = "chair_force"\n', "")
    study.write_text(text)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        standing_trials(study, "study")
    assert any("the hip moves as in sitting down, and its task is standing up" in line for line in record.warnings)


def test_somebody_who_stands_still_is_refused(tmp_path: Path) -> None:
    recording(tmp_path)
    table = read_table(tmp_path / "coordinates.sto")
    rows = np.column_stack([table.time, *(table.column(name) for name in table.channels)])
    rows[:, 1:] = rows[0, 1:]
    _storage(tmp_path / "still.sto", SAMPLE / "T1_coordinates.sto", rows)
    with pytest.raises(gc.InputError, match="the hip moves by 0 mm, where a movement is 100 mm at least"):
        gc.sit_to_stand.movements(tmp_path / "still.sto")


def test_a_chair_that_was_not_set_to_zero_is_warned_of(tmp_path: Path) -> None:
    recording(tmp_path)
    file = tmp_path / "plates.mot"
    table = read_table(file)
    add: Callable[[str], float] = lambda name: 20.0 if name == "chair_force_vy" else 0.0  # noqa: E731
    rows = np.column_stack([table.time, *(table.column(name) + add(name) for name in table.channels)])
    _storage(file, SAMPLE / "T1_plates.mot", rows)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        found = gc.sit_to_stand.movements(tmp_path / "coordinates.sto", plates=file, chair="chair_force")
    assert (found.table("movements")["chair agrees"] == "no").all()
    assert any("the chair carries 320 N before and 20 N after" in line for line in found.warnings)
