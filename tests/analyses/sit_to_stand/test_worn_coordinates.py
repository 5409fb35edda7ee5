"""A trial with the exoskeleton worn, from a whole body's angles and plates to a study of phases A, B and C.

The trials are synthetic: those of `meshes`, put into space by `meshes.whole_body`.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.frame.collector import collecting, current
from geocontact.analyses.frame.record import Record
from geocontact.analyses.sit_to_stand.standing_trials import standing_trials
from geocontact.io.text.tables import read_table
from meshes.whole_body import main
from tests.cli.calls import MESHES
from tests.recording import opened

WORN, HELD_OUT = MESHES / "standing_up_exoskeleton", MESHES / "standing_up_held_out"
pytestmark = pytest.mark.filterwarnings("ignore::geocontact.InputWarning")


def in_space(folder: Path, sample: Path = WORN, trial: str = "T1") -> dict[str, Any]:
    main(folder, sample, trial)
    of = {"model": folder / "body.osim", "plates": folder / "plates.mot", "height": 1.75}
    beside = {"worn": "coordinates.sto", "torques": "torques.sto", "strap": "strap.csv"}
    return of | {key: sample / f"{trial}_{name}" for key, name in beside.items()}


def studied(folder: Path, sample: Path = WORN, trial: str = "T1") -> Path:
    """The study of a trial, found from the whole body."""
    found = gc.sit_to_stand.coordinates(folder / "ik.mot", **in_space(folder, sample, trial))
    return Path(found.write(folder / "out")) / "study.toml"


def test_a_worn_trial_is_found_again_with_all_its_channels(tmp_path: Path) -> None:
    """Hinges of a file in degrees beside a motion in radians, torques, strap and plates: those of the shipped trial."""
    file = studied(tmp_path)
    opened(Record("sit-to-stand calibrate", {}))
    shipped, made = (standing_trials(each, "study") for each in (WORN / "study.toml", file))
    one, other = shipped.trials[0], made.trials[0]
    moving = slice(0, len(other.time))
    assert made.exoskeleton and 100 < len(other.time) <= len(one.time)
    assert other.q.shape[1] == 9
    for channel, atol in (("q", 1e-7), ("force", 1e-4), ("centre", 1e-6), ("torque", 1e-9), ("strap", 1e-9)):
        np.testing.assert_allclose(getattr(other, channel), getattr(one, channel)[moving], atol=atol, err_msg=channel)
    table = read_table(file.parent / "coordinates.mot")
    inputs = json.loads((file.parent / "run.json").read_text("utf-8"))["inputs"]
    assert {"`torques`", "`strap`"} <= {one["role"] for one in inputs}
    assert abs(float(table.column("exo_knee").max()) - 90.0) < 40.0  # a seated knee, printed in degrees


def hinges(folder: Path, factor: float, late: float = 0.0) -> Path:
    """The shipped hinges, their angles times a factor, on a clock that is late."""
    lines = (WORN / "T1_coordinates.sto").read_text().splitlines()
    k = next(n for n, line in enumerate(lines) if line.startswith("time"))
    rows = [[float(each) for each in line.split()] for line in lines[k + 1 :]]
    for row in rows:
        row[0] += late
        row[7:] = [factor * each for each in row[7:]]
    text = lines[: k + 1] + ["\t".join(f"{each:.8g}" for each in row) for row in rows]
    file = folder / "hinges.sto"
    file.write_text("\n".join(text) + "\n", encoding="utf-8")
    return file


@pytest.mark.parametrize(
    ("factor", "late", "words"),
    [
        (-1.0, 0.0, r"exo_knee is \d+ degrees \(root mean square\) from knee; are its unit, sign and zero"),
        (57.3, 0.0, r"exo_ankle is \d+ degrees \(root mean square\) from ankle; are its unit"),
        (1.0, 5.0, r"runs from 5 to 6.8 s, the motion from 0 to 1.8 s; put both on one clock"),
    ],
)
def test_hinges_of_another_sign_unit_or_clock_are_refused(
    tmp_path: Path, factor: float, late: float, words: str
) -> None:
    """A calibration of such angles did not end."""
    given = in_space(tmp_path) | {"worn": hinges(tmp_path, factor, late)}
    with pytest.raises(gc.InputError, match=words):
        gc.sit_to_stand.coordinates(tmp_path / "ik.mot", **given)


def test_a_study_with_such_hinges_is_refused_before_any_search(tmp_path: Path) -> None:
    for file in WORN.iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    hinges(tmp_path, -1.0).replace(tmp_path / "T1_coordinates.sto")
    opened(Record("sit-to-stand calibrate", {}))
    with pytest.raises(gc.InputError, match=r"T1_coordinates.sto exo_knee: exo_knee is"):
        standing_trials(tmp_path / "study.toml", "study")


def test_hinges_are_doubted_where_samples_are_used(tmp_path: Path) -> None:
    """Exoskeleton not yet on, or already off: what lies outside of the trial says nothing of it."""
    for file in WORN.iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    lines = (WORN / "T1_coordinates.sto").read_text().splitlines()
    table = [line.split() for line in lines[7:]]
    cut = (tmp_path / "study.toml").read_text("utf-8").replace('name = "T1"', 'name = "T1"\nend = 1.0', 1)
    (tmp_path / "study.toml").write_text(cut, encoding="utf-8")
    for row in table:
        if float(row[0]) > 1.0:
            row[7:] = ["200", "200", "200"]
    text = "\n".join([*lines[:7], *("\t".join(row) for row in table)]) + "\n"
    (tmp_path / "T1_coordinates.sto").write_text(text, encoding="utf-8")
    with collecting(Record("test", {})):
        standing_trials(tmp_path / "study.toml", "study")
        assert not [line for line in current().warnings if "exo_" in line and "root mean square" in line]


def test_torques_and_strap_are_read(tmp_path: Path) -> None:
    """Files that a study of them would refuse are refused before it is written, and in a study as well."""
    given = in_space(tmp_path)
    late = tmp_path / "late.csv"
    late.write_text("\n".join((WORN / "T1_strap.csv").read_text("utf-8").splitlines()[:50]) + "\n", encoding="utf-8")
    for key, file, words in (
        ("torques", WORN / "T1_coordinates.sto", r"has columns foot_x, foot_y, foot_turn: it holds coordinates, not"),
        ("torques", WORN / "T1_strap.csv", "ankle"),
        ("strap", late, r"the trial from 0.01 to 1.79 s"),
    ):
        with pytest.raises(gc.InputError, match=words):
            gc.sit_to_stand.coordinates(tmp_path / "ik.mot", **(given | {key: file}))
    for file in WORN.iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    (tmp_path / "T1_torques.sto").write_bytes((WORN / "T1_coordinates.sto").read_bytes())
    opened(Record("sit-to-stand calibrate", {}))
    with pytest.raises(gc.InputError, match="it holds coordinates, not torques"):
        standing_trials(tmp_path / "study.toml", "study")


def test_what_cannot_be_separated_is_said(tmp_path: Path) -> None:
    given = in_space(tmp_path) | {"strap": None}
    with pytest.raises(gc.InputError, match=r"`strap`.*stiffness and place and the person's torques are not separable"):
        gc.sit_to_stand.coordinates(tmp_path / "ik.mot", **given)
    given = in_space(tmp_path) | {"worn": WORN / "T1_torques.sto"}
    with pytest.raises(gc.InputError):
        gc.sit_to_stand.coordinates(tmp_path / "ik.mot", **(given | {"worn": tmp_path / "plates.mot"}))


@pytest.mark.slow
def test_phases_a_b_and_c_of_trials_from_whole_bodies(tmp_path: Path) -> None:
    """Intervals of the calibration cover what made the synthetic trial; a trial that was not used is predicted."""
    one, other = tmp_path / "one", tmp_path / "other"
    one.mkdir()
    other.mkdir()
    study = studied(one)
    found = gc.sit_to_stand.calibrate(study, resamples=0, time_limit=120.0)
    calibrated = found.write(tmp_path / "calibrated")
    table = pd.read_csv(Path(calibrated) / "parameters.csv").set_index("parameter")
    truth = pd.read_csv(WORN / "truth.csv").set_index("parameter")["value"]
    known = table[table["verdict"] == "known"]
    assert {"strap normal", "strap tangential", "strap turning", "strap place"} <= set(known.index)
    inside = [row["lower"] <= truth[name] <= row["upper"] for name, row in known.iterrows()]
    assert sum(inside) >= len(inside) - 1
    ahead = gc.sit_to_stand.predict(
        studied(other, HELD_OUT, "P1"), parameters=Path(calibrated) / "parameters.csv", against=study, time_limit=120.0
    )
    errors = pd.read_csv(Path(ahead.write(tmp_path / "predicted")) / "errors.csv")
    off = errors.set_index(["predictor", "quantity"])["rmsd"]
    for quantity in ("strap", "hip"):
        assert off["all given", quantity] < 0.5 * off["mean of the calibration", quantity]
