"""The simulators of docs/how-to/simulators: what they give, against equations written out here; begun as cases."""

from __future__ import annotations

import json
import re
import shlex
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.integrate import solve_ivp

import geocontact as gc
from geocontact.io.cases.gap_case import program

EXAMPLES = Path(__file__).resolve().parents[3] / "docs" / "how-to" / "simulators"
MASS, LENGTH, GRAVITY = 1.8, 0.3, 9.81
TIME = 0.01 * np.arange(300)


def angle_of(k: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Angle, rate, acceleration of synthetic trial k."""
    w, v = 2.0 + 0.7 * k, 5.0 + k
    position = 0.6 * np.sin(w * TIME) + 0.2 * np.sin(v * TIME)
    rate = 0.6 * w * np.cos(w * TIME) + 0.2 * v * np.cos(v * TIME)
    return position, rate, -0.6 * w**2 * np.sin(w * TIME) - 0.2 * v**2 * np.sin(v * TIME)


def recorded(folder: Path, damping: float) -> Path:
    """Synthetic trials of a pendulum with a drive: m L² φ'' + b φ' + m g L sin φ, noise of 0.02 N m."""
    folder.mkdir()
    noise = np.random.default_rng(4)
    for k in range(1, 7):
        angle, rate, acceleration = angle_of(k)
        torque = MASS * (LENGTH**2 * acceleration + GRAVITY * LENGTH * np.sin(angle)) + damping * rate
        columns = {"time [s]": TIME, "angle [rad]": angle, "torque [N m]": torque + noise.normal(0.0, 0.02, len(TIME))}
        pd.DataFrame(columns).to_csv(folder / f"t{k}.csv", index=False)
    return folder


@pytest.mark.slow
@pytest.mark.oracle
def test_a_mujoco_arm_is_begun_and_diagnosed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The drive's damper of 0.3 N m s/rad, which the arm lacks, is named with its size."""
    pytest.importorskip("mujoco")
    monkeypatch.chdir(EXAMPLES)
    data = recorded(tmp_path / "data", damping=0.3)
    result = gc.init_gap_case(simulator="mujoco_arm.py", data=data, number={"m": MASS})
    angle, _, acceleration = angle_of(2)
    exact = MASS * (LENGTH**2 * acceleration + GRAVITY * LENGTH * np.sin(angle))
    inner = slice(10, -10)  # rates at the ends of a trial are one-sided differences
    assert np.abs(result.run.simulated["t2"][inner, 0] - exact[inner]).max() < 0.01 * np.ptp(exact)
    assert result.run.system.parameters[1].fixed and not result.found.adapter[0]
    case = result.write(tmp_path / "case")
    said = gc.diagnose(case, bare=True).diagnosis
    assert said.effects == ("damping",)
    assert said.parameters["damping.b"].value == pytest.approx(0.3, rel=0.1)


OPENSIM = """
import json, sys
import numpy as np
import geocontact as gc
result = gc.init_gap_case(simulator="opensim_forward.py", data=sys.argv[1])
print(json.dumps({name: curve[:, 0].tolist() for name, curve in result.run.simulated.items()}))
"""


@pytest.mark.oracle
def test_an_opensim_forward_model_is_begun(tmp_path: Path) -> None:
    """Against a Runge-Kutta integration of the pendulum; in a process of its own, as all of OpenSim's tests."""
    if find_spec("opensim") is None:  # not imported here: its libraries and casadi's do not agree
        pytest.skip("the opensim package is the oracle; pip install opensim")
    folder = tmp_path / "data"
    folder.mkdir()
    time = 0.02 * np.arange(100)
    for k in (1, 2, 3, 4):
        torque = 1.5 * np.sin((1.0 + k) * time)
        columns = {"time [s]": time, "torque [N m]": torque, "angle [rad]": 0.1 * torque}
        pd.DataFrame(columns).to_csv(folder / f"t{k}.csv", index=False)
    words = [sys.executable, "-c", OPENSIM, str(folder)]
    done = subprocess.run(words, cwd=EXAMPLES, capture_output=True, text=True, check=True)
    found = np.array(json.loads(done.stdout.splitlines()[-1])["t3"])
    m, k, b = 1.5, 2.0, 0.3
    inertia = m * LENGTH**2 + 1e-6

    def moved(t: float, y: np.ndarray) -> list[float]:
        drive = np.interp(t, time, 1.5 * np.sin(4.0 * time))
        return [y[1], (drive - m * GRAVITY * LENGTH * np.sin(y[0]) - k * y[0] - b * y[1]) / inertia]

    exact = solve_ivp(moved, (0.0, time[-1]), [0.0, 0.0], t_eval=time, rtol=1e-9, atol=1e-10, max_step=0.01).y[0]
    np.testing.assert_allclose(found, exact, atol=1e-4)


def test_the_matlab_text_reads_and_writes_what_a_program_must() -> None:
    """Its command has the three places, its output the header that is read; nothing of it is run here."""
    text = (EXAMPLES / "simulator.m").read_text()
    command = re.search(r'--simulator "(.+)"', text)
    assert command is not None
    made = program(command[1], ("angle",), ("torque",), {"angle": "rad", "torque": "N m"})
    assert made.command == tuple(shlex.split(command[1])) and made.command[0] == "matlab"
    assert "'time [s],torque [N m]\\n'" in text and "'NumHeaderLines', 1" in text
