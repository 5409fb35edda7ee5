"""What `simulate` and `calibrate` refuse alike, and what a simulated stance and a calibrated sole are doubted for."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.frame.record import Record
from geocontact.analyses.prosthesis.calibrate.result import doubts_of_fit
from geocontact.analyses.prosthesis.simulate.result import doubt
from geocontact.below_knee_prosthesis.plate_checks import clock_offset
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from geocontact.below_knee_prosthesis.simulate import Stance, simulate_stance
from meshes.gait_course import course
from meshes.gait_persons import PARTICIPANTS, true_leg
from tests.analyses.prosthesis.spoilt_trial import TRIAL, delayed_plates, in_metres, renamed_markers, spoilt_plates
from tests.cli.calls import call
from tests.recording import opened

GIVEN: dict[str, Any] = {
    "static": TRIAL / "standing.trc",
    "mass": 77.3,
    "plates": TRIAL / "plates.mot",
    "plate": "own_force",
}
COMMANDS: dict[str, tuple[Callable[..., object], dict[str, Any]]] = {
    "simulate": (gc.prosthesis.simulate, {"other_plate": "other_force"}),
    "calibrate": (gc.prosthesis.calibrate, {}),
    "design": (gc.prosthesis.design, {}),
}
SPINES = {"RASI": "LASI", "LASI": "RASI", "RPSI": "LPSI", "LPSI": "RPSI"}
CASES: dict[str, tuple[Callable[[Path], dict[str, Any]], str]] = {
    "mass in g": (lambda _: {"mass": 77.3e3}, "cannot be the mass of a walking person"),
    "markers in m": (lambda f: {"static": in_metres(f, "standing.trc")}, "is the unit in the file's head right"),
    "spines exchanged": (
        lambda f: {"static": renamed_markers(f, "standing.trc", SPINES)},
        "left and right are exchanged",
    ),
    "knee exchanged": (
        lambda f: {"static": renamed_markers(f, "standing.trc", {"RKNE": "RKNM", "RKNM": "RKNE"})},
        "left and right are exchanged",
    ),
    "foot backwards": (
        lambda f: {"static": renamed_markers(f, "standing.trc", {"RHEE": "RTOE", "RTOE": "RHEE"})},
        "the foot points backwards",
    ),
    "force in kN": (lambda f: {"plates": spoilt_plates(f, "own_force_v", lambda x: 1e-3 * x)}, "is it in N"),
    "force upside down": (
        lambda f: {"plates": spoilt_plates(f, "own_force_v", lambda x: -x)},
        "turn the sign of forces",
    ),
    "plate elsewhere": (
        lambda f: {"plates": spoilt_plates(f, "own_force_px", lambda x: x + 0.8)},
        "no plate under the foot",
    ),
    "clocks apart": (
        lambda f: {"plates": delayed_plates(f, 45)},
        "own_force is loaded 0.08 s after the markers touch the floor",
    ),
}


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("case", CASES)
def test_refused(case: str, command: str, tmp_path: Path) -> None:
    (spoil, words), (run, more) = CASES[case], COMMANDS[command]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        with pytest.raises(gc.InputError, match=words):
            run(TRIAL / "walking.trc", **(GIVEN | more | spoil(tmp_path)))


def test_one_plate_for_both_feet_is_refused() -> None:
    with pytest.raises(gc.InputError, match="own_force is named for both feet"):
        gc.prosthesis.simulate(TRIAL / "walking.trc", **GIVEN, other_plate="own_force")


def test_spines_exchanged_while_walking_do_not_fit(tmp_path: Path) -> None:
    walking = renamed_markers(tmp_path, "walking.trc", SPINES)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        with pytest.raises(gc.InputError, match="left and right exchanged"):
            gc.prosthesis.simulate(walking, **GIVEN, other_plate="other_force")


@pytest.mark.parametrize("shift", [-0.15, -0.02, 0.0, 0.08])
def test_offset_of_clocks_is_the_smaller_of_both_ends(shift: float) -> None:
    """A foot that lands 20 ms late by its height and leaves on time."""
    time = np.arange(-0.3, 1.3, 0.01)
    height = np.where((time > 0.02) & (time < 0.7), -0.01, 0.02)
    plates = np.arange(-0.3, 1.3, 0.002)
    load = np.where((plates > shift) & (plates < 0.7 + shift), 700.0, 0.0)
    ends = shift - 0.02, shift
    wanted = 0.0 if ends[0] * ends[1] <= 0.0 else np.sign(shift) * min(map(abs, ends))
    assert clock_offset(time, height, plates, load) == pytest.approx(wanted, abs=0.015)


@pytest.fixture(scope="module")
def pressed() -> Stance:
    """Some milliseconds of a stance that begins with the foot on the floor."""
    leg = true_leg(PARTICIPANTS[0], 0.03)
    one = course(leg, vsf_foot(), 0.1174, 0.72)
    return simulate_stance(one.motion, vsf_foot(), 0.1174, one.push, (0.06, 0.07), machine_code=False)


def doubts(stance: Stance) -> str:
    record = opened(Record("prosthesis simulate", {}))
    doubt(stance)
    return "; ".join(record.warnings)


def test_a_foot_on_the_floor_at_the_start_is_told(pressed: Stance) -> None:
    assert "the foot is on the floor at the start" in doubts(pressed)
    assert "never loaded: forefoot" in doubts(pressed)


def test_limits_of_the_socket_are_told(pressed: Stance) -> None:
    found = pressed.found
    q, u = found.q.copy(), found.u.copy()
    q[2:, 6], u[3:, 6], q[:, 2] = 0.036, 0.11, np.radians(25.0)
    told = doubts(replace(pressed, found=replace(found, q=q, u=u)))
    assert "the socket pistons by 36 mm, past 35 mm" in told
    assert "faster than 100 mm/s" in told
    assert "the socket turns by 25 degrees" in told
    assert "pistons" not in doubts(pressed)


def test_a_sphere_below_its_radius_is_told(pressed: Stance) -> None:
    depth = pressed.loads.depth.copy()
    depth[1, :3] = 0.023
    told = doubts(replace(pressed, loads=replace(pressed.loads, depth=depth)))
    assert "3 spheres sink beyond their radius, up to 23 mm" in told


def test_a_ground_that_is_none_is_refused_before_anything_is_warned_of(tmp_path: Path) -> None:
    given = GIVEN | {"other-plate": "other_force", "ground": "hill", "out": tmp_path / "out"}
    typed = (f"--{name}={value}" for name, value in given.items())
    refused = call("prosthesis", "simulate", TRIAL / "walking.trc", *typed)
    assert refused.code == 2 and refused.warnings == [] and len(refused.complaints) == 1
    assert "'hill' is neither a plane nor stairs" in refused.err and not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("height", "pitch", "residual", "vertical", "words"),
    [
        (0.5, -1.2, 0.3, 0.01, []),
        (-2.5, 0.0, 0.3, 0.01, ["did the foot stand flat"]),
        (0.0, 2.1, 0.3, 0.01, ["did the foot stand flat"]),
        (0.0, 0.0, 0.4, 0.053, ["missed by 5.3% of body weight, the residual is 0.4 times its noise"]),
        (0.0, 0.0, 2.5, 0.02, ["missed by 2.0% of body weight, the residual is 2.5 times its noise"]),
        (0.0, -3.0, 0.4, 0.2, ["did the foot stand flat", "missed by 20.0% of body weight"]),
    ],
)
def test_a_foot_out_of_flat_and_a_stance_that_is_missed_are_said(
    height: float, pitch: float, residual: float, vertical: float, words: list[str]
) -> None:
    found = doubts_of_fit(height, pitch, residual, vertical)
    assert len(found) == len(words)
    assert all(each in line for each, line in zip(words, found, strict=True))
