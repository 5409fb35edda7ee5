"""Studies of an exoskeleton with its own dynamics: torques of hinges by mode and motors, and what is refused."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import butter, filtfilt

import geocontact as gc
from geocontact.analyses.frame.record import Record
from geocontact.analyses.sit_to_stand.standing_trials import standing_trials
from geocontact.io.text.tables import read_table
from geocontact.standing_up.trials import StandingUpTrials
from tests.cli.calls import MESHES
from tests.recording import opened

SAMPLE = MESHES / "standing_up_exoskeleton"
HINGES = ("exo_ankle", "exo_knee", "exo_hip")


@pytest.fixture(scope="module")
def numbers(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """numbers.csv of the shipped exoskeleton that moves alone."""
    folder = tmp_path_factory.mktemp("device")
    found = gc.sit_to_stand.device(SAMPLE / "unloaded_coordinates.sto", motors=SAMPLE / "unloaded_motors.sto")
    return found.write(folder / "device") / "numbers.csv"


def study_of(folder: Path, trial: str, head: str = "", *, hinges: bool = False, tail: str = "") -> Path:
    """The first shipped trial with other keys; its torques are those of the person alone unless with `hinges`."""
    for kind in ("coordinates.sto", "rates.sto", "plates.mot", "strap.csv", "torques.sto"):
        text = (SAMPLE / f"T1_{kind}").read_text()
        if kind == "torques.sto" and not hinges:
            top, body = text.split("endheader\n")
            rows = ["\t".join(line.split("\t")[:4]) for line in body.splitlines()]
            text = top.replace("nColumns=7", "nColumns=4") + "endheader\n" + "\n".join(rows) + "\n"
        (folder / f"T1_{kind}").write_text(text)
    text = (SAMPLE / "study.toml").read_text().split("\n[[trials]]")
    text = [text[0].replace("exoskeleton = true", f"exoskeleton = true\n{head}") + tail, f"{text[1]}{trial}\n"]
    (folder / "study.toml").write_text("\n[[trials]]".join(text))
    return folder / "study.toml"


def read(study: Path) -> tuple[StandingUpTrials, list[str]]:
    record = opened(Record("sit-to-stand calibrate", {}))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        return standing_trials(study, "study"), list(record.warnings)


def friction(numbers: Path, study: Path) -> np.ndarray:
    """By hand: Butterworth of order 2 both ways, whose two passes have half the power at 6 Hz; central differences."""
    rows = [line.split(",") for line in numbers.read_text().splitlines()]
    told = {row[0]: row[1] for row in rows}
    table = read_table(study.parent / "T1_coordinates.sto")
    step = float(table.time[1] - table.time[0])
    corner = np.arctan(np.tan(np.pi * 6.0 * step) / (np.sqrt(2.0) - 1.0) ** 0.25) / (np.pi * step)
    low = butter(2, corner * 2.0 * step)
    found = []
    for name in HINGES:
        angle = np.radians(table.column(name))
        rate = np.gradient(filtfilt(*low, angle, padlen=len(angle) - 1), step)
        viscous, coulomb = (float(told[f"{name} {kind} friction"]) for kind in ("viscous", "Coulomb"))
        found.append(viscous * rate + coulomb * np.tanh(rate / np.radians(1.0)))
    return np.stack(found, axis=1)


def test_a_passive_trial_needs_no_motors(tmp_path: Path, numbers: Path) -> None:
    """Its hinges have friction alone; masses that were not weighed are warned of."""
    study = study_of(tmp_path, 'mode = "passive"', f'device = "{numbers}"')
    given, warned = read(study)
    torque = given.trials[0].torque
    assert torque is not None and given.subject.device.identified
    wanted = -friction(numbers, study)[-len(torque) :]
    inner = slice(20, -20)
    assert np.abs(wanted[inner]).max() > 3.0
    np.testing.assert_allclose(torque[inner, 3:], wanted[inner], atol=0.05)
    assert any("inertia of exo_shank is raised by 0.0" in line for line in warned)
    assert any("no mass of foot_plate, shank, thigh, module" in line for line in warned)
    shipped, _ = read(study_of(tmp_path, "", hinges=True))
    np.testing.assert_array_equal(torque[:, :3], shipped.trials[0].torque[:, :3])  # type: ignore[index]


def test_a_device_that_is_set_to_a_man_is_not_a_womans(tmp_path: Path, numbers: Path) -> None:
    """`sit-to-stand device` identifies with a man's lengths: other ones would turn its sums into wrong bodies."""
    study = study_of(tmp_path, 'mode = "passive"', f'device = "{numbers}"', tail='\n[person]\nsex = "female"\n')
    with pytest.raises(
        gc.InputError, match=r"lengths of a man of that height, from which \[person\] differs by 52\.\d mm"
    ):
        read(study)


def test_a_mode_without_torques_is_warned_of(tmp_path: Path) -> None:
    tracks = 'tracks = ["coordinates", "rates", "force", "centre", "strap"]'
    given, warned = read(study_of(tmp_path, 'mode = "passive"', tracks))
    assert given.trials[0].torque is None
    assert warned == ["T1: mode has no effect, as torque is not among tracks: add it, or leave mode out"]


def test_motors_drive_the_hinges_less_friction(tmp_path: Path, numbers: Path) -> None:
    study = study_of(
        tmp_path,
        'mode = "active"\nmotors = "motors.sto"',
        f'device = "{numbers}"',
        tail="\n[masses]\n"
        + "".join(
            f'{n} = {{ value = {v}, unit = "kg" }}\n'
            for n, v in (("foot_plate", 2), ("shank", 3), ("thigh", 4.2), ("module", 5))
        ),
    )
    time = read_table(study.parent / "T1_coordinates.sto").time
    rows = "\n".join(f"{t:.6f}\t10\t{20.0 * t:.6f}\t-5" for t in time)
    head = f"motors\nversion=1\nnRows={len(time)}\nnColumns=4\ninDegrees=no\nendheader\n"
    (tmp_path / "motors.sto").write_text(head + "time\t" + "\t".join(HINGES) + "\n" + rows + "\n")
    given, warned = read(study)
    torque, none = given.trials[0].torque, friction(numbers, study)
    motors = np.column_stack([np.full(len(time), 10.0), 20.0 * time, np.full(len(time), -5.0)])
    assert torque is not None and not [line for line in warned if "mode" in line or "no mass" in line]
    inner = slice(20, -20)
    np.testing.assert_allclose(torque[inner, 3:], (motors - none)[-len(torque) :][inner], atol=0.05)
    assert given.subject.device.masses.thigh == 4.2
    study.write_text(study.read_text().replace('mode = "active"', 'mode = "passive"'))
    assert any("mode passive, and torques of" in line and "it helps" in line for line in read(study)[1])


def test_without_its_own_dynamics_a_passive_trial_is_frictionless(tmp_path: Path) -> None:
    given, warned = read(study_of(tmp_path, 'mode = "off"'))
    torque = given.trials[0].torque
    assert torque is not None and not torque[:, 3:].any() and torque[:, :3].any()
    assert any("hinges without friction" in line for line in warned)


def test_weights_and_dashpots_are_the_studys(tmp_path: Path) -> None:
    tail = "\n[weights]\ntorques = 2e-6\njoint_jerk = 80\n\n[straps]\ndamping = 25\nturning_damping = 0.3\n"
    given, _ = read(study_of(tmp_path, "", hinges=True, tail=tail))
    assert (given.weights.torques, given.weights.energy, given.weights.jerk) == (2e-6, 1e-3, (20.0, 80.0))
    assert (given.sites[0].damping, given.sites[0].turning_damping) == (25.0, 0.3)


@pytest.mark.parametrize(
    ("trial", "head", "words"),
    [
        ("", "", r"no column 'exo_ankle'.*mode = \"passive\""),
        ('mode = "active"', "", "no column 'exo_ankle'"),
        ('mode = "off"\nmotors = "T1_torques.sto"', "", "motors that are off give no torque"),
        ('mode = "asleep"', "", "'asleep' is none"),
        ("movement = 1\nstart = 0.2", "", "choose the time twice"),
        ('task = "squat"', "", "a squat has no chair"),
        ('mode = "passive"', 'device = "T1_strap.csv"', "has no columns number, value and note"),
    ],
)
def test_what_cannot_be_is_refused(tmp_path: Path, trial: str, head: str, words: str) -> None:
    with pytest.raises(gc.InputError, match=words):
        read(study_of(tmp_path, trial, head))


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("^height,1.75", "height,1.8", "set to 1.8 m, the person is 1.75 m tall"),
        ("^exo_thigh inertia,[^,]*", "exo_thigh inertia,-0.3", "exo_thigh has no inertia left"),
        ("^exo_hip Coulomb friction,[^,]*", "exo_hip Coulomb friction,x", "is not a number"),
        (
            "^exo_hip Coulomb friction,[^,]*",
            "exo_hip Coulomb friction,-1.98",
            "would drive.*name device.toml of the same",
        ),
        ("by itself", "in sums or not at all", "identifies 0 parameters by themselves"),
        ("^exo_hip viscous friction", "hip friction", "no exo_hip viscous friction"),
    ],
)
def test_dynamics_of_another_exoskeleton_are_refused(
    tmp_path: Path, numbers: Path, old: str, new: str, words: str
) -> None:
    changed = re.sub(old, new, numbers.read_text(), flags=re.MULTILINE)
    (tmp_path / "numbers.csv").write_text(changed)
    with pytest.raises(gc.InputError, match=words):
        read(study_of(tmp_path, 'mode = "passive"', 'device = "numbers.csv"'))


def test_a_person_without_an_exoskeleton_has_no_device(tmp_path: Path) -> None:
    study = study_of(tmp_path, 'mode = "passive"')
    study.write_text(study.read_text().replace("exoskeleton = true\n", ""))
    with pytest.raises(gc.InputError, match="mode of T1 has no effect without an exoskeleton"):
        read(study)
