"""Wrong recordings of load cells, mats, forces and surfaces, silent in a round of 60: each is heard of, by name."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from tests.analyses.findings.heard import Finding, Lines, as_lines, as_parameters, heard
from tests.analyses.loadcells import synthetic_walk as walk
from tests.analyses.mat import samples
from tests.analyses.modulus.synthetic_step import areas, forces
from tests.cli.calls import FEMUR, INSERT, MESHES, gait
from tests.trial_checks import test_commands as trials

Change = Callable[[pd.DataFrame], object]
Attempt = Callable[[Path], Lines]


def rewritten(file: Path, change: Change) -> Path:
    table = pd.read_csv(file)
    change(table)
    table.to_csv(file, index=False)
    return file


def cells(change: Change, cycles: str | None = "stride", **options: str) -> Attempt:
    """Load cells on four synthetic strides with one thing wrong."""
    asked = {"unit": "N", "cycles": cycles} | options
    return lambda folder: heard(gc.load_cells, rewritten(walk.recorded(folder), change), **asked)


def times(factor: float, *columns: str) -> Change:
    def change(table: pd.DataFrame) -> None:
        for name in columns or table.columns[1:]:
            table[name] = factor * table[name]

    return change


def plus(force: float) -> Change:
    def change(table: pd.DataFrame) -> None:
        table[table.columns[1:]] += force

    return change


def held(cell: str, force: float) -> Change:
    return lambda table: table.__setitem__(cell, force)


def pressed(change: Change) -> Attempt:
    """Modulus of the synthetic step with other forces."""

    def attempt(folder: Path) -> Lines:
        return heard(
            gc.modulus, area=(areas(folder),), force=rewritten(forces(folder), change), radius=gc.mm(37), bootstrap=0
        )

    return attempt


def on_thigh(step: float) -> Attempt:
    """Mat on a plane, with this step of time [s]."""

    def attempt(folder: Path) -> Lines:
        ramp = samples.uniform() * np.sin(np.linspace(0.0, np.pi, 50))[:, None, None]
        files = samples.on_plane(folder)
        return heard(gc.mat, samples.frames(folder, ramp, step), unit="mm", cutoff=0.0, **files)

    return attempt


def knee(moving: Path, motion: Path | None = None) -> Attempt:
    """Area of two frames of the shipped knee."""
    return lambda folder: heard(
        gc.area, moving, INSERT, unit="mm", motion=(str(motion or gait(folder)),), threshold=(4e-3,)
    )


def gathering(old: str, new: str) -> Attempt:
    """Gap gather of two shipped walks, with words of its settings replaced."""

    def attempt(folder: Path) -> Lines:
        there = trials.gather_files(folder)
        assert trials.text_changed("gather.toml", lambda text: text.replace(old, new))(there) == {}
        return as_lines(trials.gather(there))

    return attempt


FINDINGS: dict[str, Finding] = {
    "cells in N called lbf": Finding(cells(times(1.0), unit="lbf"), "warned: .*much for a knee; is its unit right"),
    "cells: time in ms": Finding(cells(times(1e3, "time [s]")), "warned: .*is its time in s, not in ms"),
    "cells: one is dead": Finding(cells(held("AM", 0.0)), "warned: .*AM reads 0 N all the time"),
    "cells: one is stuck": Finding(cells(held("AM", 312.5), None), "warned: .*AM reads 312.5 N all the time"),
    "cells: one is another": Finding(
        cells(lambda t: t.__setitem__("PM", t["AM"])), "warned: .*PM and AM are equal sample by sample"
    ),
    "cells: not set to zero": Finding(cells(plus(600.0)), "refused: .*never below 2480 N: were the cells set to zero"),
    "modulus: forces not set to zero": Finding(pressed(plus(800.0)), "warned: .*is the force zero without contact"),
    "mat: time in ms": Finding(on_thigh(20.0), "warned: .*is its time in s, not in ms"),
    "area: a left component on a right insert": Finding(
        knee(MESHES / "femoral_component_left_coarse.stl"), "warned: .*by its name.*are both of one joint"
    ),
    "gather: k in N/mm": Finding(
        gathering("start = 3e4", "start = 30"), "warned: .*is unusual for the stiffness k of a sphere"
    ),
    "gather: kinetic friction above the static one": Finding(
        gathering("mu_k = 0.7", "mu_k = 1.7"), "warned: .*larger than the static mu_s"
    ),
    "area: motion of the left knee": Finding(
        knee(FEMUR, MESHES / "gait_left.csv"), "warned: .*gait_left.csv of the left", slow=True
    ),
}
RIGHT: dict[str, Attempt] = {
    "cells": cells(times(1.0)),
    "cells at 4000 N": cells(times(3.0)),
    "cells with an offset": cells(plus(20.0)),
    "forces with an offset of 20 N": pressed(plus(20.0)),
    "mat of a seat, 2 Hz": on_thigh(0.5),
    "knee": knee(FEMUR),
    "gather": gathering("start = 3e4", "start = 2e3"),
}


@pytest.mark.parametrize("finding", as_parameters(FINDINGS))
def test_a_wrong_recording_is_heard_of(finding: Finding, tmp_path: Path) -> None:
    lines = finding.attempt(tmp_path)
    assert any(re.search(finding.words, line) for line in lines), lines


@pytest.mark.parametrize("attempt", RIGHT.values(), ids=RIGHT)
def test_what_nearly_is_wrong_is_not_doubted(attempt: Attempt, tmp_path: Path) -> None:
    words = "|".join(finding.words.partition(".*")[2] for finding in FINDINGS.values())
    assert not [
        line for line in attempt(tmp_path) if line.startswith(("refused", "contradicts")) or re.search(words, line)
    ]
