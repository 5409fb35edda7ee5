"""A program of somebody else's as the base model, from the command line. All trials are synthetic."""

from __future__ import annotations

import json
import shlex
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from tests.cli.calls import Call, call, done
from tests.cli.gap_cases import known
from tests.elsewhere import Elsewhere

PROGRAM = r"""
function number(name,    s) {
    match(told, "\"" name "\": *[-+0-9.eE]+")
    s = substr(told, RSTART, RLENGTH)
    sub(/.*: */, "", s)
    return s + 0
}
FNR == 1 { file++ }
file == 1 { told = told $0; next }
FNR == 1 { k = number("k"); neutral = number("neutral"); print "time [s],torque [N m]" > out; next }
{ turned = $2 - neutral; printf "%s,%.17g\n", $1, k * turned * (1 + 0.3 * turned^2) > out }
END { print "ran" > ran }
"""
SETTINGS = """format = 1
system = "command"
simulate = {simulate}
inputs = ["angle"]
outputs = ["torque"]
calibration = ["t01", "t02"]
evaluation = ["t03", "t04"]

[noise]
torque = 0.2

[parameters.k]
start = 50.0
lower = 10.0
upper = 200.0
unit = "N m/rad"

[parameters.neutral]
start = 0.0
lower = -0.3
upper = 0.3
unit = "rad"
"""
NAMES = ("t01", "t02", "t03", "t04")
LATE = 0.08
"""s."""
RAN = "ran.txt"
runs = pytest.mark.skipif(shutil.which("awk") is None, reason="the simulator is an awk script")


def wrapped(folder: Path, late: float = LATE) -> Path:
    """A case whose torque comes late; its program starts in a few milliseconds and leaves a file beside itself."""
    (folder / "trials").mkdir(parents=True)
    program = folder / "spring.awk"
    program.write_text(PROGRAM, encoding="utf-8")
    script, ran = shlex.quote(str(program)), shlex.quote(f"ran={folder / RAN}")
    words = f"awk -F , -v out={{out}} -v {ran} -f {script} {{params}} {{trial}}"
    (folder / "case.toml").write_text(SETTINGS.format(simulate=json.dumps(words)), encoding="utf-8")
    rng = np.random.default_rng(5)
    for k, name in enumerate(NAMES):
        time = 0.03 * np.arange(120)

        def angle(at: np.ndarray, k: int = k) -> np.ndarray:
            return 0.3 * np.sin(2.0 * np.pi * (0.5 + 0.2 * k) * at + k) + 0.1 * np.sin(7.0 * at)

        turned = angle(time - late) - 0.05
        torque = 60.0 * turned * (1.0 + 0.3 * turned**2) + 0.2 * rng.standard_normal(time.size)
        table = pd.DataFrame({"time [s]": time, "angle [rad]": angle(time), "torque [N m]": torque})
        table.to_csv(folder / "trials" / f"{name}.csv", index=False)
    return folder


def asked(verb: str, case: Path, out: Path, *options: str) -> Call:
    return call("gap", verb, case, "--bare", "--out", out, *options)


PLANTED = ("--effect", "sensor_offset.torque", "--value", "sensor_offset.torque.offset=1.5")


@pytest.mark.parametrize(("verb", "options"), [("diagnose", ()), ("confuse", ()), ("plant", PLANTED)])
def test_a_case_starts_no_program_unasked(tmp_path: Path, verb: str, options: tuple[str, ...]) -> None:
    case = wrapped(tmp_path / "own")
    made = asked(verb, case, tmp_path / "out", *options)
    (line,) = made.complaints
    assert made.code == 2 and "pass --run-simulator if you trust it" in line
    assert not (case / RAN).exists() and not (tmp_path / "out").exists()


@runs
@pytest.mark.slow
@pytest.mark.long  # 2 500 runs of the program; tests/systems/test_command.py finds the delay in Python
def test_a_delay_of_what_a_program_simulates_is_found(tmp_path: Path, elsewhere: Elsewhere) -> None:
    case, out = wrapped(tmp_path / "own"), tmp_path / "out"
    done(elsewhere(asked, "diagnose", case, out, "--run-simulator"))
    told = json.loads((out / "diagnosis.json").read_text("utf-8"))
    assert told["system"] == "command" and told["verdict"] == "explained"
    assert told["effects"][0] in ("time_shift", "filter_lag") and "time_shift" in told["ambiguity"] + told["effects"]
    assert told["gap"]["torque"]["reduction"] > 0.5 and (case / RAN).exists()


@pytest.mark.slow
@runs
def test_what_is_planted_beside_a_program_is_in_the_measured_column(tmp_path: Path) -> None:
    case, out = wrapped(tmp_path / "own", late=0.0), tmp_path / "out"
    with known():
        done(asked("plant", case, out, *PLANTED, "--run-simulator"))
    assert (case / RAN).exists()
    for name in NAMES:
        before, after = (pd.read_csv(home / "trials" / f"{name}.csv") for home in (case, out / "case"))
        np.testing.assert_allclose(after["torque [N m]"] - before["torque [N m]"], 1.5, atol=1e-9)
