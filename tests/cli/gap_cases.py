"""Small gap cases on disk: an elbow whose cuff damps, and folders of it that are spoilt in one place."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest import mock

import numpy as np

from geocontact.analyses.frame.record import Listener, Record
from geocontact.analyses.gap.diagnose.options import DiagnoseOptions
from geocontact.analyses.gap.diagnose.result import DiagnoseResult, read, run
from geocontact.analyses.gap.discriminability.result import DiscriminabilityResult, discriminability
from tests.recording import opened
from tests.systems.examples import (
    ELBOW_CONSTANTS,
    ELBOW_VALUES,
    elbow,
    elbow_angle,
    example,
    recording,
    spheres,
)
from tests.unchecked import unchecked

CALIBRATION, EVALUATION = ("t01", "t02"), ("t03", "t04")
DAMPING = 25.0
"""N s/m."""
NOISE = 0.15
"""N, white."""
TOLD: list[tuple[str, str]] = []
"""Stages of `diagnosed_elbow`, as they were told."""
SETTINGS = f"""format = 1
system = "elbow"
calibration = {list(CALIBRATION)}
evaluation = {list(EVALUATION)}

[noise]
force = {NOISE}

[constants]
l = {ELBOW_CONSTANTS["l"]}
z = {ELBOW_CONSTANTS["z"]}

[parameters.k]
start = 280.0
lower = 50.0
upper = 1000.0
unit = "N/m"

[parameters.x]
start = 0.03
lower = 0.0
upper = 0.1
unit = "m"

[parameters.y]
start = 0.04
lower = 0.0
upper = 0.12
unit = "m"

[trial.t01]
condition = "synthetic"
"""


def damped_elbow(folder: Path, damping: float = DAMPING, samples: int = 160) -> Path:
    """The case in `folder`: force of the elbow's formula and of a linear damper along its deflection."""
    (folder / "trials").mkdir(parents=True)
    (folder / "case.toml").write_text(SETTINGS, encoding="utf-8")
    rng = np.random.default_rng(11)
    for k, name in enumerate((*CALIBRATION, *EVALUATION)):
        time = 0.04 * np.arange(samples + 4 * k)
        beta = elbow_angle(time + 0.9 * k, 2.5 + 0.6 * k)
        empty = np.full(time.size, np.nan)
        force = elbow().simulate(recording(name, time, {"beta": beta, "force": empty}), ELBOW_VALUES)[:, 0]
        force = force + damping / ELBOW_VALUES["k"] * np.gradient(force, time) + NOISE * rng.standard_normal(time.size)
        write_trial(folder, name, time, beta, force)
    return folder


class Hearing(Listener):
    """Keeps the stages that are told, with what they are stages of."""

    def __init__(self, heard: list[tuple[str, str]]) -> None:
        self.heard = heard

    @contextmanager
    def stages(self, label: str) -> Iterator[Callable[[str], None]]:
        """A block whose stages are kept."""
        yield lambda stage: self.heard.append((label, stage))


@cache
def diagnosed_elbow() -> DiagnoseResult:
    """Its diagnosis, made once for all tests of a process."""
    with TemporaryDirectory() as folder, unchecked():
        options = DiagnoseOptions(damped_elbow(Path(folder) / "elbow_7"))
        opened(Record("gap diagnose", options.in_si(), options.in_si(), listener=Hearing(TOLD)))
        return run(read(options), options)


@contextmanager
def known() -> Iterator[mock.Mock]:
    """A diagnosis is given those findings instead of making them again."""
    findings = diagnosed_elbow().findings
    with (
        mock.patch("geocontact.analyses.gap.inject.result.diagnose", return_value=findings),
        mock.patch("geocontact.analyses.gap.diagnose.result.findings_of", return_value=findings) as instead,
    ):
        yield instead


EFFECTS = ("damping", "time_shift", "filter_lag", "sensor_gain", "unit_error", "sign_flip")
"""Asked about in `confused_elbow`."""


@cache
def confused_elbow() -> DiscriminabilityResult:
    """What its trials can tell of some effects, made once for all tests of a process."""
    same = mock.patch(
        "geocontact.gap.identifiability.discriminability.attribute",
        return_value=diagnosed_elbow().findings.attribution,
    )
    with TemporaryDirectory() as folder, unchecked(), same:
        return discriminability(damped_elbow(Path(folder) / "elbow_7"), effects=",".join(EFFECTS))


def write_trial(folder: Path, name: str, time: np.ndarray, beta: np.ndarray, force: np.ndarray) -> None:
    """A trial file, all digits."""
    rows = [",".join(map(repr, row)) for row in np.column_stack((time, beta, force)).tolist()]
    text = "\n".join(["time [s],beta [rad],force [N]", *rows]) + "\n"
    (folder / "trials" / f"{name}.csv").write_text(text, encoding="utf-8")


def spoilt(good: Path, folder: Path, file: str, old: str, new: str) -> Path:
    """A copy of a case with a text replaced in one file; both must be there."""
    shutil.copytree(good, folder)
    path = folder / file
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")
    return folder


def reordered(good: Path, folder: Path, calibration: Sequence[str], evaluation: Sequence[str]) -> Path:
    """A copy that lists its trials in another order."""
    spoilt(good, folder, "case.toml", f"calibration = {list(CALIBRATION)}", f"calibration = {list(calibration)}")
    text = (folder / "case.toml").read_text(encoding="utf-8")
    text = text.replace(f"evaluation = {list(EVALUATION)}", f"evaluation = {list(evaluation)}")
    (folder / "case.toml").write_text(text, encoding="utf-8")
    return folder


def in_degrees_and_kilonewtons(good: Path, folder: Path) -> Path:
    """A copy with its columns in other units, noise with them."""
    spoilt(good, folder, "case.toml", f"force = {NOISE}", f"force = {NOISE * 1e-3!r}")
    for path in (folder / "trials").glob("*.csv"):
        table = np.loadtxt(path, delimiter=",", skiprows=1)
        table[:, 0] *= 1e3
        table[:, 1] = np.degrees(table[:, 1])
        table[:, 2] *= 1e-3
        rows = [",".join(map(repr, row)) for row in table.tolist()]
        path.write_text("\n".join(["time [ms],beta [deg],force [kN]", *rows]) + "\n", encoding="utf-8")
    return folder


def foot_case(folder: Path) -> Path:
    """A foot on three zones of spheres, two trials each side, without an effect."""
    system, trials = example("foot")
    (folder / "trials").mkdir(parents=True)
    names = ("t01", "t02")
    head = [f"{name} [{system.unit(name)}]" for name in (*system.inputs, *system.outputs)]
    for name, trial in zip(names, trials, strict=True):
        table = np.column_stack((trial.time, *(trial.column(one) for one in (*system.inputs, *system.outputs))))
        rows = [",".join("" if np.isnan(v) else repr(v) for v in row) for row in table.tolist()]
        text = "\n".join([",".join(["time [s]", *head]), *rows]) + "\n"
        (folder / "trials" / f"{name}.csv").write_text(text, encoding="utf-8")
    spheres().to_csv(folder / "spheres.csv", index=False)
    lines = [
        "format = 1",
        'system = "foot"',
        'calibration = ["t01"]',
        'evaluation = ["t02"]',
        'spheres = "spheres.csv"',
    ]
    lines += ["[constants]", *(f"{name} = {value}" for name, value in system.constants.items())]
    for p in system.parameters:
        lines += [f"[parameters.{p.name}]", f"start = {p.start}", f"lower = {p.lower}", f"upper = {p.upper}"]
        lines += [f'unit = "{p.unit}"']
    (folder / "case.toml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return folder
