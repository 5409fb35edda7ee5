"""What `simulate`, `calibrate` and `design` refuse alike."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import geocontact as gc
from tests.analyses.prosthesis.spoilt_trial import TRIAL, delayed_plates, in_metres, renamed_markers, spoilt_plates
from tests.cli.calls import call

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


def test_a_ground_that_is_none_is_refused_before_anything_is_warned_of(tmp_path: Path) -> None:
    given = GIVEN | {"other-plate": "other_force", "ground": "hill", "out": tmp_path / "out"}
    typed = (f"--{name}={value}" for name, value in given.items())
    refused = call("prosthesis", "simulate", TRIAL / "walking.trc", *typed)
    assert refused.code == 2 and refused.warnings == [] and len(refused.complaints) == 1
    assert "'hill' is neither a plane nor stairs" in refused.err and not (tmp_path / "out").exists()
