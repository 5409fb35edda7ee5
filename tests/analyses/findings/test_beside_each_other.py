"""Wrong inputs that a second input or a usual size shows, silent in two rounds; right ones are not doubted."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.gap.case import doubt_numbers
from geocontact.analyses.prosthesis.ranges import EDGE
from geocontact.data.gap_case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.trial import Trial
from geocontact.io.cases.gap_case import read_gap_case
from tests.analyses.findings.heard import Finding, Lines, as_lines, as_parameters, heard, heard_reading
from tests.analyses.findings.test_left_out_commands import as_it_is, table, times_column
from tests.analyses.findings.test_new_commands import settled
from tests.analyses.findings.test_pages import ANGLE, compared_arm
from tests.analyses.misalignment.trials import KNOWN, locked, recorded
from tests.analyses.modulus.synthetic_step import areas, forces
from tests.cli.calls import PLATE, SPHERE, poses
from tests.cli.gap_cases import damped_elbow
from tests.trial_checks import test_commands as trials

Attempt = Callable[[Path], Lines]
Change = Callable[[pd.DataFrame], object]


def modulus(change: Change = as_it_is, **options: Any) -> Attempt:
    """Modulus of the synthetic step with changed areas."""

    def attempt(folder: Path) -> Lines:
        pressed, touched = forces(folder), areas(folder)
        table(touched, change)
        return heard(gc.modulus, area=(touched,), force=pressed, radius=gc.mm(37), bootstrap=0, **options)

    return attempt


def medial(factor: float) -> Change:
    def change(found: pd.DataFrame) -> None:
        found["area_fixed_medial [mm^2]"] *= factor

    return change


def elbow(trial: str = "t01", factor: float = 1.0, old: str = "", new: str = "") -> Attempt:
    """Numbers of the elbow's gap case, the force of one trial times a factor, or words of the case replaced."""

    def attempt(folder: Path) -> Lines:
        case = damped_elbow(folder / "elbow")
        table(case / "trials" / f"{trial}.csv", lambda t: t.__setitem__("force [N]", factor * t["force [N]"]))
        text = (case / "case.toml").read_text()
        assert old in text
        (case / "case.toml").write_text(text.replace(old, new))
        return heard_reading(lambda _: doubt_numbers(read_gap_case(case), case / "case.toml"), lambda: None)

    return attempt


def overhead(push: float) -> Attempt:
    """Shoulder optimise, up to its reading, of one push [N]."""

    def attempt(folder: Path) -> Lines:
        there = trials.files_of(trials.OVERHEAD, folder)
        (there / "study.toml").write_text(trials.OVERHEAD_STUDY.replace("value = 35,", f"value = {push},"))
        return heard_reading(trials.read_optimise, trials.ShoulderOptimiseOptions, there / "study.toml")

    return attempt


HEEL = """[parameters.k_heel]
start = 3e4
lower = 0.0
upper = 1e6
unit = "N/m^n"
[parameters.b_heel]
start = 0.6
lower = 0.0
upper = 1e6
unit = "N s/m"
"""


def gathered(start: float = 150.0, radius: float = 1.0, heel: bool = False) -> Attempt:
    """Gap gather of two shipped walks, with a start of the spheres' damping, and their radii times a factor.

    With a `heel` the spheres there have a damping of their own, of 0.6 N s/m.
    """

    def attempt(folder: Path) -> Lines:
        there = trials.gather_files(folder)
        text = (there / "gather.toml").read_text()
        text = text.replace("start = 150.0", f"start = {start}")
        if heel:
            text = text.replace("[from.t01]", f"{HEEL}[from.t01]")
            file = there / "spheres.csv"
            file.write_text(file.read_text().replace("all", "heel", 1))
        (there / "gather.toml").write_text(text)
        table(there / "spheres.csv", lambda t: t.__setitem__("radius [m]", radius * t["radius [m]"]))
        return as_lines(trials.gather(there))

    return attempt


def in_use(trial: str, noise: float = 0.02) -> Attempt:
    """Currents of which one steps up to 1.5 A, and the others are off, in movements that are alike."""

    def attempt(folder: Path) -> Lines:
        rng, time, made = np.random.default_rng(0), np.arange(500) / 100.0, []
        for k in range(5):
            angle, current = 0.3 * np.sin(3.0 * time + k), noise * rng.standard_normal(500)
            current += 1.5 * (time > 2.0) * (f"t{k}" == trial)
            signals = Signals(time, np.column_stack([angle, current, 31.0 * angle]), NAMES, ("rad", "A", "N m"))
            made.append(Trial(f"t{k}", signals))
        case = GapCase("case", "geocontact.systems.elastic_joint:JOINT", tuple(made[:3]), tuple(made[3:]), ())
        return heard_reading(lambda _: doubt_numbers(case, folder / "case.toml"), lambda: None)

    return attempt


NAMES = ("angle", "current", "torque")


def frozen(frames: int, jumps: bool = True) -> Attempt:
    """Area of a ball on a plate that moves steadily, but for some frames; it then goes on as it was, or from there."""

    def attempt(folder: Path) -> Lines:
        at = np.arange(40.0)
        at[10 : 10 + frames] = at[10]
        if not jumps:
            at[10 + frames :] -= frames - 1
        rows = [(0.0, -21.5 - 0.02 * k, 0.0) for k in at]
        return heard(gc.area, PLATE, SPHERE, unit="mm", motion=(str(poses(folder, *rows)),), threshold=(4e-3,))

    return attempt


def elbows(change: Change = as_it_is) -> Attempt:
    """Elbow fit of three synthetic trials, of which the second is changed."""

    def attempt(folder: Path) -> Lines:
        files = locked(recorded(folder))
        table(files[1], change)
        return heard(gc.misalignment.identify, files, **KNOWN)

    return attempt


def planted(threshold: float) -> Attempt:
    """Id of the synthetic leg, up to its reading."""
    return lambda folder: as_lines(trials.inverse_dynamics(trials.leg_files(folder), threshold=threshold))


def arm(more: float = 0.0, rough: float = 0.5) -> Attempt:
    """Shoulder compare of a recorded angle that is off by so much [deg], and by something else."""
    return compared_arm(**{"elevation [deg]": ANGLE + more + rough * np.sin(ANGLE)})


OLD, IN_N_PER_MM = "start = 280.0\nlower = 50.0\nupper = 1000.0", "start = 0.28\nlower = 0.05\nupper = 1.0"
FINDINGS: dict[str, Finding] = {
    "modulus: three times the medial areas": Finding(
        modulus(medial(3.0)), "warned: .*medial and lateral areas are .* together .*the total is"
    ),
    "modulus: Poisson 0.0046": Finding(
        modulus(poisson=(0.0046,)), "warned: `poisson`: 0.0046 is unusual", alarm="`poisson`: .* is unusual"
    ),
    "shoulder compare: with itself": Finding(
        compared_arm(**{"elevation [deg]": ANGLE}), "warned: .*the recording is the simulation, sample by sample"
    ),
    "shoulder compare: 20 degrees more": Finding(arm(20.0), "warned: .*20 degrees higher throughout.*sensor's zero"),
    "shoulder compare: 15 degrees less": Finding(arm(-15.0), "warned: .*15 degrees lower throughout.*sensor's zero"),
    "gap: one trial in kN": Finding(elbow(factor=1e-3), "warned: .*trial t01: force changes by .*in another unit"),
    "gap: one held-out trial in mN": Finding(elbow("t04", 1e3), "warned: .*trial t04: force changes by .*another unit"),
    "gap: an elbow's stiffness in N/mm": Finding(
        elbow(old=OLD, new=IN_N_PER_MM),
        r"warned: .*\[parameters.k\] start: 0.28 N/m .*0.28 N/mm meant",
        alarm="N/mm meant",
    ),
    "optimise: a push of 350 N": Finding(
        overhead(350.0), "warned: .*350 N are 44% of the weight of P1", alarm="of the weight of"
    ),
    "knee: a layer of 0.8 mm": Finding(
        settled(thickness=gc.mm(0.8)), "warned: .*largest pressure: .*check `modulus`, `poisson`, `thickness`"
    ),
    "gather: damping in N s/mm": Finding(gathered(start=0.15), "warned: .*b_all: .*is unusual for a damping"),
    "gather: the larger damping in N s/mm": Finding(
        gathered(start=0.9, heel=True), "warned: .*b_all: .*is unusual for a damping"
    ),
    "area: a pose that is held": Finding(frozen(12), "warned: .*one pose in 12 frames.*was the body lost"),
    "elbow: one trial in kgf": Finding(
        elbows(times_column("force [N]", 1.0 / 9.81)),
        "warned: .*another unit, gain or zero.*locked_2 is described worst",
        alarm="is described worst",
    ),
    "elbow: 5 N more in one trial": Finding(
        elbows(lambda found: found.__setitem__("force [N]", found["force [N]"] + 5.0)),
        "warned: .*locked_2 .*is a unit, a sign or a zero another one there",
    ),
    "id: a threshold of 2000 N": Finding(planted(2000.0), "warned: .*carries nothing .*less than `threshold`"),
    "gather: spheres ten times as large": Finding(
        gathered(radius=10.0), "warned: .*above the plate .*are the spheres where the sole is"
    ),
}
RIGHT: dict[str, Attempt] = {
    "modulus": modulus(),
    "modulus: medial areas half a per cent off": modulus(medial(1.005)),
    "modulus: Poisson 0.05": modulus(poisson=(0.05, 0.46)),
    "modulus: Poisson 0": modulus(poisson=(0.0,)),
    "shoulder compare: 5 degrees more": arm(5.0),
    "shoulder compare: 20 degrees more here and there": arm(10.0, 15.0),
    "gap": elbow(),
    "gap: one trial ten times as large": elbow(factor=10.0),
    "gap: a motor that is on in one trial": in_use("t4"),
    "gap: a motor that is on in one trial, quietly": in_use("t0", noise=0.0126),
    "optimise: a push of 200 N": overhead(200.0),
    "knee": settled(),
    "area: 3 equal poses": frozen(3),
    "area: a body that rests": frozen(12, jumps=False),
    "elbow": elbows(),
    "id: a threshold of 20 N": planted(20.0),
    "gather": gathered(),
    "gather: a damping of 20 N s/m": gathered(start=20.0),
    "gather: a heel that is hardly damped": gathered(heel=True),
}


@pytest.mark.parametrize("finding", as_parameters(FINDINGS))
def test_a_wrong_input_is_heard_of(finding: Finding, tmp_path: Path) -> None:
    lines = finding.attempt(tmp_path)
    assert any(re.search(finding.words, line) for line in lines), lines


@pytest.mark.parametrize("attempt", RIGHT.values(), ids=RIGHT)
def test_what_nearly_is_wrong_is_not_doubted(attempt: Attempt, tmp_path: Path) -> None:
    words = "|".join(finding.forbidden for finding in FINDINGS.values())
    assert not [line for line in attempt(tmp_path) if line.startswith("refused") or re.search(words, line)]


@pytest.mark.parametrize(("millimetres", "doubted"), [(0.06, True), (0.0, False), (10.0, False)])
def test_an_edge_in_metres_is_doubted(millimetres: float, doubted: bool) -> None:
    """Of `prosthesis walk`, `calibrate`, `compare`, `design`: 60 mm, given as 0.06."""
    assert ("is 0.06 m meant" in (EDGE.doubt(1e-3 * millimetres) or "")) is doubted
