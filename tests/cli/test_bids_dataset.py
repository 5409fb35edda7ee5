"""`geocontact ik --bids`: the dataset holds what was recorded and found; BIDS' own validator finds no error."""

from __future__ import annotations

import csv
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from geocontact.data.bids_name import LONGEST, BidsName
from geocontact.data.errors import InputError
from geocontact.io.motion.bids import BidsChannels, write_bids
from tests import legs
from tests.cli.calls import Call, call, done

BELOW = "sub-P1/ses-2/motion"
UNSEEN = "foot_r2"
NAMED = "sub-P1_ses-2_task-swing_tracksys-{}_run-01_{}"


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> Call:
    """A planted motion of 5 s to 5.4 s whose last marker is unseen in two frames."""
    folder = tmp_path_factory.mktemp("bids")
    _, model, time, values = legs.planted(folder)
    markers = legs.markers_of(model, time, values)
    markers.positions[3:5, markers.names.index(UNSEEN)] = np.nan
    file = legs.trc_file(folder, markers)
    named = ("--bids", "sub-P1_ses-2_task-swing_run-01")
    return done(
        call("ik", file, "--model", legs.model_file(folder), *named, "--out", folder / "o", folder=folder / "o")
    )


def rows(file: Path) -> list[list[str]]:
    with file.open(encoding="utf-8", newline="") as text:
        return list(csv.reader(text, delimiter="\t"))


def columns(found: Call, system: str) -> dict[str, list[str]]:
    """Cells of each channel, by the names of the file beside."""
    below = found.folder / "bids" / BELOW
    head, *channels = rows(below / NAMED.format(system, "channels.tsv"))
    assert head == ["name", "component", "type", "tracked_point", "units", "reference_frame"]
    cells = rows(below / NAMED.format(system, "motion.tsv"))
    return dict(zip((each[0] for each in channels), map(list, zip(*cells, strict=True)), strict=True))


def test_places_are_those_recorded(found: Call) -> None:
    """The .trc is in mm, the dataset in m."""
    lines = [each.split("\t") for each in found.folder.joinpath("seen.trc").read_text(encoding="utf-8").splitlines()]
    names = [name for name in lines[3][2:] if name.strip()]
    recorded, ours = lines[6:] if not lines[5][0].strip() else lines[5:], columns(found, "markers")
    assert list(ours) == ["latency", *(f"{name}_{axis}" for name in names for axis in "xyz")]
    for k, channel in enumerate(list(ours)[1:]):
        for line, cell in zip(recorded, ours[channel], strict=True):
            written = line[2 + k] if 2 + k < len(line) else ""
            assert (
                cell == "n/a"
                if written.strip() in ("", "nan")
                else float(cell) * 1e3 == pytest.approx(float(written), abs=1e-5)
            )
    assert [i for i, cell in enumerate(ours[f"{UNSEEN}_y"]) if cell == "n/a"] == [3, 4]


def test_coordinates_are_those_of_ik_mot(found: Call) -> None:
    text = found.folder.joinpath("ik.mot").read_text(encoding="utf-8")
    head, *lines = text[text.index("endheader") :].splitlines()[1:]
    wanted = dict(zip(head.split(), np.array([each.split() for each in lines], float).T, strict=True))
    ours = columns(found, "model")
    np.testing.assert_allclose(np.array(ours["latency"], float), wanted["time"] - wanted["time"][0], atol=1e-8)
    assert list(ours)[1:] == head.split()[1:]
    for name in head.split()[1:]:
        np.testing.assert_allclose(np.array(ours[name], float), wanted[name], rtol=1e-6, atol=1e-7)


def sidecar(found: Call, system: str, suffix: str) -> Any:
    return json.loads((found.folder / "bids" / BELOW / NAMED.format(system, suffix)).read_text(encoding="utf-8"))


def test_rate_counts_and_frame_stand_beside(found: Call) -> None:
    _, *channels = rows(found.folder / "bids" / BELOW / NAMED.format("markers", "channels.tsv"))
    motion = sidecar(found, "markers", "motion.json")
    times = np.array(columns(found, "markers")["latency"], float)
    assert motion["SamplingFrequency"] == pytest.approx(1.0 / (times[1] - times[0]), rel=1e-6)
    assert motion["MotionChannelCount"] == len(channels) and motion["POSChannelCount"] == len(channels) - 1
    assert motion["TrackedPointsCount"] * 3 == len(channels) - 1 and "TaskDescription" not in motion
    frame = sidecar(found, "markers", "channels.json")["reference_frame"]["Levels"]["ground"]
    assert frame["SpatialAxes"] == "_U_"  # gravity pulls along -y in this model
    assert {row[-1] for row in channels} == {"n/a", "ground"}


def test_uneven_times_are_stated(tmp_path: Path) -> None:
    time = np.array([0.0, 0.01, 0.02, 0.05])
    system = BidsChannels.of_coordinates(("flexion", "height"), ("deg", "m"), np.ones((4, 2)))
    write_bids(tmp_path, BidsName.of("sub-1_task-sit"), time, [system], "0")
    found = json.loads((tmp_path / "sub-1/motion/sub-1_task-sit_tracksys-model_motion.json").read_text("utf-8"))
    assert found["SamplingFrequency"] == pytest.approx(100.0)
    assert found["SamplingFrequencyEffective"] == pytest.approx(60.0)
    assert "unevenly" in found["TaskDescription"] and (found["JNTANGChannelCount"], found["POSChannelCount"]) == (1, 1)


@pytest.mark.parametrize(
    ("name", "what"),
    [
        ("P1", "does not begin with one of sub-"),
        ("sub-P1", "task- is missing"),
        ("task-walk", "sub- is missing"),
        ("sub-P_1_task-walk", "does not begin with one of sub-"),
        ("sub-../x_task-walk", "is not letters and digits"),
        ("sub-P1_task-walk_run-a", "is not a number"),
        ("sub-P1_task-walk_task-run", "task- is there twice"),
        ("sub-_task-walk", "is not letters and digits"),
        (f"sub-{'a' * 200}_task-walk", "has 214 characters, more than 180"),
    ],
)
def test_names_that_bids_does_not_allow(name: str, what: str) -> None:
    with pytest.raises(InputError, match=what):
        BidsName.of(name)


def test_the_longest_name_fits_into_names_of_files() -> None:
    text = f"sub-{'a' * 60}_ses-1_task-{'b' * 60}_acq-{'c' * 30}_run-1"
    text += "1" * (LONGEST - len(text))
    assert len(BidsName.of(text).file("markers", "channels.json")) <= 255


def test_one_name_is_not_of_several_trials(tmp_path: Path) -> None:
    """Datasets of one run twice could not be put together."""
    _, model, time, values = legs.planted(tmp_path)
    file = legs.trc_file(tmp_path, legs.markers_of(model, time, values))
    legs.model_file(tmp_path)
    file.with_name("walk2.trc").write_bytes(file.read_bytes())
    refused = call("ik", tmp_path, "--bids", "sub-1_task-walk", "--out", tmp_path / "o")
    assert refused.code == 2 and "--bids: is of one trial, and there are" in refused.err, refused.err
    done(call("ik", tmp_path, "--trial", "walk2", "--bids", "sub-1_task-walk", "--out", tmp_path / "o"))


def test_one_frame_has_no_rate(tmp_path: Path) -> None:
    _, model, time, values = legs.planted(tmp_path)
    file = legs.trc_file(tmp_path, legs.markers_of(model, time[:1], values[:1]))
    refused = call(
        "ik", file, "--model", legs.model_file(tmp_path), "--bids", "sub-1_task-stand", "--out", tmp_path / "o"
    )
    assert (refused.code, len(refused.complaints)) == (2, 1) and "there is one frame" in refused.err


@pytest.mark.oracle
def test_the_validator_of_bids_finds_no_error(found: Call) -> None:
    pytest.importorskip("bids_validator_deno", reason="bids-validator-deno is the oracle")
    program = Path(sys.executable).with_name("bids-validator-deno")
    command = [program, found.folder / "bids", "--format", "json", "--max-rows", "-1"]
    ran = subprocess.run(command, capture_output=True, text=True, timeout=120, env={**os.environ, "NO_COLOR": "1"})
    issues = json.loads(ran.stdout)["issues"]["issues"]
    assert [each for each in issues if each["severity"] == "error"] == [] and ran.returncode == 0
    assert json.loads(ran.stdout)["summary"]["dataTypes"] == ["motion"]
