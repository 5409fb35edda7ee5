"""A simulator on the command line: three files in and out, results remembered, failures in one sentence."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from geocontact.data.simulator import SimulatorError
from geocontact.io.cases.gap_case import Program, program

UNITS = {"angle": "rad", "torque": "N m"}
TIME = np.linspace(0.0, 1.0, 21)
ANGLE = np.sin(3.0 * TIME)[None]
SPRING = """
import csv, json, sys
numbers = json.load(open(sys.argv[1]))
head, *rows = csv.reader(open(sys.argv[2]))
assert head == ["time [s]", "angle [rad]"], head
with open(sys.argv[3], "w") as out:
    out.write("time [s],note [-],torque [N mm]\\n")
    for time, angle in rows:
        out.write(f"{time},1,{1e3 * numbers['k'] * float(angle)!r}\\n")
"""


def simulator(folder: Path, text: str, places: str = "{params} {trial} {out}") -> Program:
    file = folder / "my simulator.py"
    file.write_text(text, encoding="utf-8")
    return program(f'"{sys.executable}" -S -E "{file}" {places}', ("angle",), ("torque",), UNITS)


def test_numbers_and_inputs_go_in_and_outputs_come_out_in_si_units(tmp_path: Path) -> None:
    own = simulator(tmp_path, SPRING)
    np.testing.assert_allclose(own.run(TIME, ANGLE, {"k": 7.0, "level": 1.0}), 7.0 * ANGLE.T, rtol=1e-14)


def test_the_same_run_is_not_made_twice(tmp_path: Path) -> None:
    own = simulator(tmp_path, SPRING)
    first = own.run(TIME, ANGLE, {"k": 7.0})
    first[:] = 0.0
    np.testing.assert_allclose(own.run(TIME, ANGLE, {"k": 7.0}), 7.0 * ANGLE.T, rtol=1e-14)
    assert own.runs == 1
    own.run(TIME, 1.5 * ANGLE, {"k": 7.0})
    own.run(TIME, ANGLE, {"k": 8.0})
    assert own.runs == 3


def test_what_is_remembered_is_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    own = simulator(tmp_path, SPRING)
    monkeypatch.setattr("geocontact.io.cases.gap_case.KEPT", 2 * 8 * len(TIME))
    for k in (1.0, 2.0, 3.0, 1.0):
        own.run(TIME, ANGLE, {"k": k})
    assert own.runs == 4 and len(own._known) == 2


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("import sys; sys.exit('the solver gave up')", "ended with code 1: the solver gave up"),
        ("pass", "wrote no {out}"),
        (SPRING.replace("N mm", "J s"), "its output cannot be used: "),
        (SPRING.replace("N mm", "N"), "its output has torque in N, the trials in N m"),
        (SPRING.replace("torque [", "moment ["), "its output has no column torque"),
        (SPRING.replace("for time, angle in rows:", "for time, angle in rows[1:]:"), "its output has 20 rows"),
        (SPRING.replace("{time},1", "{float(time) * 1.001},1"), "has 21 rows or other times than the 21 of"),
    ],
)  # fmt: skip
def test_a_program_that_fails_is_one_sentence(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(SimulatorError) as caught:
        simulator(tmp_path, text).run(TIME, ANGLE, {"k": 7.0})
    assert message in str(caught.value) and "\n" not in str(caught.value)


def test_a_program_that_hangs_is_stopped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("geocontact.io.cases.gap_case.TIMEOUT", 0.2)
    with pytest.raises(SimulatorError, match=r"took more than 0\.2 s"):
        simulator(tmp_path, "import time; time.sleep(30)").run(TIME, ANGLE, {"k": 7.0})


def test_a_program_that_is_not_there(tmp_path: Path) -> None:
    own = program("./nowhere {params} {trial} {out}", ("angle",), ("torque",), UNITS)
    with pytest.raises(SimulatorError, match=r"\./nowhere cannot be started: No such file"):
        own.run(TIME, ANGLE, {"k": 7.0})


def test_a_command_has_three_places(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"has no \{out\}; write for example"):
        simulator(tmp_path, SPRING, "{params} {trial}")
