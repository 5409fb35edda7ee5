"""Gap cases in every form: an elbow that is damped, an elastic joint, a knee from pose to cells, somebody's program."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from benchmarks.same_outputs.inputs.text import table, written

LINK, BESIDE = 0.185, 0.09
STIFFNESS, X, Y = 300.0, 0.03, 0.04
DAMPING, NOISE = 25.0, 0.15
"""N s/m, N."""
CELLS = ("PM", "AM", "AL", "PL")
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
"""

STRUT = """import numpy as np


def run(time, inputs, numbers):
    turned = inputs[0] - numbers["neutral"]
    return numbers["k"] * turned * (1.0 + 0.3 * turned**2)
"""


def make(home: Path, meshes: Path) -> None:
    """Each in a folder of its own; `spoilt` is an elbow whose unit nobody knows."""
    elbow(home / "elbow")
    shutil.copytree(home / "elbow", home / "spoilt", dirs_exist_ok=True)
    trial = home / "spoilt" / "trials" / "t02.csv"
    written(trial, trial.read_text("utf-8").replace("force [N]", "force [stone]"))
    joint(home / "joint")
    program(home / "program")
    written(home / "strut.py", STRUT)
    chain(home / "chain", meshes)


def settings(system: str, trials: tuple[str, ...], held: int, *more: str) -> str:
    """case.toml; the last `held` trials are not fitted to."""
    lists = [f"calibration = {json.dumps(trials[:-held])}", f"evaluation = {json.dumps(trials[-held:])}"]
    return "\n".join(["format = 1", f'system = "{system}"', *lists, *more, ""])


def parameter(name: str, start: float, lower: float, upper: float, unit: str) -> str:
    """A table of case.toml."""
    return f'[parameters.{name}]\nstart = {start}\nlower = {lower}\nupper = {upper}\nunit = "{unit}"'


def constants(values: Mapping[str, float]) -> str:
    """A table of case.toml."""
    return "\n".join(["[constants]", *(f"{name} = {value}" for name, value in values.items())])


def sweep(time: np.ndarray, speed: float) -> np.ndarray:
    """An angle [rad] whose turns are no two alike."""
    return 1.1 + 0.55 * np.sin(speed * time) + 0.35 * np.sin(0.37 * speed * time + 1.0)


def elbow(home: Path) -> None:
    """The force of misaligned axes, of a damper along the displacement, and white noise."""
    trials, rng = ("t01", "t02", "t03", "t04"), np.random.default_rng(11)
    for k, name in enumerate(trials):
        time = 0.04 * np.arange(160 + 4 * k)
        beta = sweep(time + 0.9 * k, 2.5 + 0.6 * k)
        tangent = (X * np.cos(beta) + Y * np.sin(beta)) / (LINK + Y * np.cos(beta) - X * np.sin(beta))
        along = Y + np.sqrt(LINK**2 - X**2) - np.hypot(LINK * np.sin(beta) - X, Y + LINK * np.cos(beta))
        total = along - BESIDE * tangent
        force = STIFFNESS * total + DAMPING * np.gradient(total, time) + NOISE * rng.standard_normal(len(time))
        table(home / "trials" / f"{name}.csv", {"time [s]": time, "beta [rad]": beta, "force [N]": force})
    more = (f"[noise]\nforce = {NOISE}", constants({"l_ex": LINK, "z_ex": BESIDE}))
    free = (("k", 280.0, 50.0, 1000.0, "N/m"), ("x", 0.03, 0.0, 0.1, "m"), ("y", 0.04, 0.0, 0.12, "m"))
    written(home / "case.toml", settings("elbow", trials, 2, *more, *(parameter(*one) for one in free)))


def joint(home: Path) -> None:
    """A hardening spring whose stiffness follows a setting, and whose torque comes late."""
    trials, rng = ("t01", "t02", "t03", "t04"), np.random.default_rng(12)
    for k, name in enumerate(trials):
        time = 0.03 * np.arange(120)
        angle, late = (sweep(time + 0.7 * k - delay, 2.0 + 0.5 * k) - 1.0 for delay in (0.0, 0.06))
        torque = 40.0 * np.exp(0.3 * 0.2 * k) * late * (1.0 + 0.6 * late**2) + 0.1 * rng.standard_normal(len(time))
        table(home / "trials" / f"{name}.csv", {"time [s]": time, "angle [rad]": angle, "torque [N m]": torque})
    more = ["[noise]\ntorque = 0.1", constants({"angle0": 0.0, "hardening": 0.6})]
    more += [parameter("k", 35.0, 5.0, 500.0, "N m/rad"), parameter("growth", 0.2, -2.0, 2.0, "-")]
    more += [f"[trial.{name}]\nsetting = {0.2 * k}" for k, name in enumerate(trials)]
    written(home / "case.toml", settings("geocontact.systems.elastic_joint:JOINT", trials, 2, *more))


def program(home: Path) -> None:
    """A spring that an awk script simulates; the measured torque has an offset."""
    written(home / "spring.awk", PROGRAM)
    trials, rng = ("t01", "t02", "t03", "t04"), np.random.default_rng(13)
    for k, name in enumerate(trials):
        time = 0.05 * np.arange(60)
        angle = 0.3 * np.sin(2.0 * np.pi * (0.5 + 0.2 * k) * time + k) + 0.1 * np.sin(7.0 * time)
        turned = angle - 0.05
        torque = 60.0 * turned * (1.0 + 0.3 * turned**2) + 1.5 + 0.2 * rng.standard_normal(len(time))
        table(home / "trials" / f"{name}.csv", {"time [s]": time, "angle [rad]": angle, "torque [N m]": torque})
    words = "awk -F , -v out={out} -f inputs/gap/program/spring.awk {params} {trial}"
    more = (f'simulate = "{words}"', 'inputs = ["angle"]', 'outputs = ["torque"]', "[noise]\ntorque = 0.2")
    free = (("k", 50.0, 10.0, 200.0, "N m/rad"), ("neutral", 0.0, -0.3, 0.3, "rad"))
    written(home / "case.toml", settings("command", trials, 2, *more, *(parameter(*one) for one in free)))


def chain(home: Path, meshes: Path) -> None:
    """Knee angles of the shipped cycle and load cells that swell with it; two meshes in the folder."""
    trials, rng = ("t01", "t02", "t03", "t04"), np.random.default_rng(14)
    rows = np.loadtxt((meshes / "gait.csv").read_text("utf-8").splitlines()[1:], delimiter=",")
    for first, name in zip((0, 2, 1, 3), trials, strict=True):
        some = rows[first::4]
        w, x, y, z = some[:, 4:].T
        adduction = np.arcsin(2.0 * (w * x - y * z))
        rotation = np.arctan2(2.0 * (x * z + w * y), 1.0 - 2.0 * (x**2 + y**2))
        flexion = np.arctan2(2.0 * (x * y + w * z), 1.0 - 2.0 * (x**2 + z**2))
        columns = {"time [s]": some[:, 0], "flexion [rad]": flexion, "adduction [rad]": -adduction}
        columns |= {"rotation [rad]": -rotation} | {f"t{a} [mm]": some[:, 1 + i] for i, a in enumerate("xyz")}
        for i, cell in enumerate(CELLS):
            load = 250.0 + 40.0 * i + 60.0 * np.sin(2.0 * np.pi * some[:, 0] + 0.5 * i)
            columns[f"{cell} [N]"] = load + 4.0 * rng.standard_normal(len(some))
        table(home / "trials" / f"{name}.csv", columns)
    bodies = {"moving": "femoral_component_right_coarse.stl", "fixed": "tibial_insert_right_coarse.stl"}
    for file in bodies.values():
        shutil.copyfile(meshes / file, home / file)
    numbers = {"R": 0.037, "threshold": 0.004, "side": 1, "cell_posterior": -0.015, "cell_anterior": 0.015}
    more = ["[noise]", *(f"{cell} = 4.0" for cell in CELLS), constants(numbers)]
    more += [f'[mesh.{body}]\nfile = "{file}"\nunit = "mm"' for body, file in bodies.items()]
    more += [parameter("E_star", 2e6, 1e5, 1e8, "Pa")]
    written(home / "case.toml", settings("geocontact.systems.knee_chain:CELLS", trials, 2, *more))
