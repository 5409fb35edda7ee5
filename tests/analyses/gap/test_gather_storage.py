"""Angles of `ik` and moments of `id` gathered into a gap case. All recordings here are synthetic."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.systems.catalogue import system_of
from tests.cli.calls import call, done, written

TIME = 0.02 * np.arange(121)
LATER = TIME[5:-5]
"""Inverse dynamics needs neighbours: its file begins later and ends earlier."""
SETTINGS = """format = 1
system = "geocontact.systems.elastic_joint:JOINT"
calibration = ["t01"]
evaluation = ["t02"]

[noise]
angle = 0.1
torque = 0.2

[parameters.k]
start = 50.0
lower = 10.0
upper = 200.0
unit = "N m/rad"

[columns]
"angle [deg]" = "knee_angle_r"
"torque [N m]" = "knee_angle_r_moment"
"""
TORQUE = '"torque [N m]" = "knee_angle_r_moment"\n'
SOURCES = "".join(f'[from.{name}]\ninputs = "{name}/ik.mot"\noutputs = "{name}/id.sto"\n' for name in ("t01", "t02"))


def angle(name: str, time: np.ndarray) -> np.ndarray:
    """rad."""
    return 0.4 * np.sin(2.0 * np.pi * (0.4 if name == "t01" else 0.6) * time)


@pytest.fixture
def plan(tmp_path: Path) -> Callable[..., Path]:
    """Files as `geocontact ik` and `geocontact id` write them, and gather.toml beside them."""
    for name in ("t01", "t02"):
        (tmp_path / name).mkdir()
        degrees = np.degrees(angle(name, TIME))
        columns = np.column_stack([0.9 + 0.0 * TIME, degrees])
        labels = ("pelvis_ty", "knee_angle_r")
        write_storage(tmp_path / name / "ik.mot", TIME, labels, columns, title="Coordinates", degrees=True)
        moments = np.column_stack([LATER, 60.0 * angle(name, LATER)])
        labels, title = ("pelvis_ty_force", "knee_angle_r_moment"), "Inverse Dynamics Generalized Forces"
        write_storage(tmp_path / name / "id.sto", LATER, labels, moments, title=title, degrees=False)

    def made(change: Callable[[str], str] = lambda text: text) -> Path:
        return written(tmp_path / "gather.toml", change(SETTINGS + SOURCES))

    return made


def test_angles_come_in_radians_and_moments_at_their_times(plan: Callable[..., Path], tmp_path: Path) -> None:
    result = gc.gather(plan())
    assert str(result) == "2 trials" and list(result.tables()) == ["trials/t01", "trials/t02"]
    assert list(result.table().columns) == ["time [s]", "angle [rad]", "torque [N m]"]
    case = read_gap_case(result.write(tmp_path / "case"))
    for trial in (*case.calibration, *case.evaluation):
        np.testing.assert_allclose(trial.column("angle"), angle(trial.name, TIME), atol=1e-8)
        inside = (LATER[0] - 1e-9 <= TIME) & (LATER[-1] + 1e-9 >= TIME)
        assert np.isfinite(trial.column("torque")).tolist() == inside.tolist()
        np.testing.assert_allclose(trial.column("torque")[inside], 60.0 * angle(trial.name, LATER), atol=1e-6)
    assert case.noise == pytest.approx({"angle": np.radians(0.1), "torque": 0.2})
    assert system_of(case).name == "elastic_joint"


def test_python_and_command_write_the_same_case(plan: Callable[..., Path], tmp_path: Path) -> None:
    settings = plan()
    made = done(call("gap", "gather", settings, "--out", tmp_path / "typed"))
    called = gc.gather(settings).write(tmp_path / "called")
    names = [p.relative_to(called) for p in called.rglob("*") if p.is_file() and p.name != "run.json"]
    assert sorted(map(str, names)) == ["case.toml", "report.html", "trials/t01.csv", "trials/t02.csv"]
    for name in names:
        if name.suffix != ".html":  # which tells the options as they were typed
            assert (tmp_path / "typed" / name).read_bytes() == (called / name).read_bytes(), name
    assert made.out.splitlines()[-1] == f"next: geocontact gap diagnose {tmp_path / 'typed'} --out …"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            lambda t: t.partition("[columns]")[0] + SOURCES,
            "[columns]: is missing: [from.t01] names a .mot or .sto file",
        ),
        (lambda t: t.replace('_moment"', '_torque"'), "id.sto: holds none of knee_angle_r, knee_angle_r_torque"),
        (lambda t: t.replace('outputs = "t02/id.sto"\n', 'thigh = "t02"\n'), "[from.t01]: has no mat of thigh"),
        (
            lambda t: t.replace("[columns]", '[columns]\n"load [N]" = "hip_force"'),
            "no column 'hip_force', which [columns]",
        ),
        (lambda t: t.replace('"t01/id.sto"', '"t01/id.csv"'), "id.csv: there is no such file"),
        (lambda t: t.replace("[deg]", "[rad]"), "angles are in deg by the header"),
        (
            lambda t: t.replace(TORQUE, "").replace("torque = 0.2", "").replace("id.sto", "ik.mot"),
            "has a column 'angle'",
        ),
    ],
)
def test_what_cannot_be_gathered_is_refused(
    plan: Callable[..., Path], change: Callable[[str], str], message: str
) -> None:
    with pytest.raises(gc.InputError, match=re.escape(message)):
        gc.gather(plan(change))


def test_columns_without_a_file_that_needs_them_are_refused(plan: Callable[..., Path], tmp_path: Path) -> None:
    for name in ("t01", "t02"):
        written(tmp_path / f"{name}.csv", "time [s],angle [rad]\n0,0\n1,1\n")
    change = lambda t: re.sub(r'inputs = "(t0.)/ik.mot"\noutputs = .*', r'inputs = "\1.csv"\nthigh = "\1"', t)  # noqa: E731
    with pytest.raises(gc.InputError, match=re.escape("[columns]: has no effect: no trial comes from a .mot or .sto")):
        gc.gather(plan(change))
