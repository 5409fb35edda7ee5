"""Wrong inputs on commands of the last weeks, silent in a fifth round: each is heard of; right ones are not."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.misalignment.identify.numbers import read as read_identify
from geocontact.analyses.misalignment.identify.options import IdentifyOptions
from geocontact.analyses.motion.styles import Cutting
from geocontact.analyses.prosthesis.foot_file import foot_of
from geocontact.analyses.shoulder.simulate.arms import read as read_arms
from geocontact.analyses.shoulder.simulate.options import ShoulderSimulateOptions
from geocontact.analyses.sit_to_stand.calibrate.options import StandingCalibrateOptions
from geocontact.analyses.sit_to_stand.calibrate.result import read as read_calibrate
from geocontact.analyses.sit_to_stand.standing_trials import _warn_of_copies
from geocontact.analyses.sit_to_stand.worn_trials import confront_segments, person_of
from geocontact.io.recordings.gait_events import read_gait_events
from geocontact.io.recordings.standing_study import read_standing_study
from tests.analyses.findings.heard import Finding, Lines, as_parameters, heard, heard_reading
from tests.analyses.findings.test_left_out_commands import table, times_column
from tests.analyses.loadcells import synthetic_walk
from tests.analyses.misalignment.measured_arm import record
from tests.analyses.prosthesis.test_foam_file import FOAM
from tests.cli.calls import MESHES
from tests.trial_checks.damage import Damage, columns_changed, files_of, text_changed, times

Attempt = Callable[[Path], Lines]
WORN, SITES, OVERHEAD = (
    MESHES / name for name in ("standing_up_exoskeleton", "standing_up_sites", "overhead_P1T1S100")
)


def untouched(_: Path) -> dict[str, Any]:
    return {}


def in_plane(change: Damage = untouched, **options: Any) -> Attempt:
    """Sit-to-stand coordinates of the shipped whole body."""

    def attempt(folder: Path) -> Lines:
        there = files_of(MESHES / "whole_body", folder)
        change(there)
        given = {"model": there / "body.osim", "plates": there / "plates.mot", "height": 1.75}
        given |= {"feet": "right_force,left_force", "chair": "chair_force"}
        return heard(gc.sit_to_stand.coordinates, there / "ik.mot", **(given | options))

    return attempt


def turned(*names: str) -> Callable[[dict[str, np.ndarray]], None]:
    return lambda columns: columns.update({name: -columns[name] for name in names})


def loads(factor: float) -> Damage:
    """Forces and moments of all plates times a factor."""

    def change(columns: dict[str, np.ndarray]) -> None:
        columns.update({name: factor * each for name, each in columns.items() if "_v" in name or "torque" in name})

    return columns_changed("plates.mot", change)


def moved(change: Damage = untouched, feet: str = "feet_force", plates: str = "T1") -> Attempt:
    """Sit-to-stand movements of a shipped trial."""

    def attempt(folder: Path) -> Lines:
        there = files_of(WORN, folder)
        change(there)
        given = {"plates": there / f"{plates}_plates.mot", "chair": "chair_force", "feet": feet}
        return heard(gc.sit_to_stand.movements, there / "T1_coordinates.sto", **given)

    return attempt


def person(keys: str) -> Attempt:
    """The person of a shipped study with own values of segments."""

    def attempt(folder: Path) -> Lines:
        file = files_of(SITES, folder) / "study.toml"
        text_changed(file.name, lambda text: text.replace("true\n", f"true\n[person]\n{keys}\n", 1))(file.parent)
        subject = person_of(read_standing_study(file))
        return heard_reading(lambda _: confront_segments(subject, file), lambda: None)

    return attempt


def segment(name: str, key: str, value: float, unit: str) -> Attempt:
    return person(f'{name} = {{ {key} = {{ value = {value}, unit = "{unit}" }} }}')


def strapped(own: str) -> Attempt:
    """Trials of a shipped study, of which the second has another strap."""

    def attempt(folder: Path) -> Lines:
        file = files_of(SITES, folder) / "study.toml"
        text_changed(file.name, lambda text: text.replace('"T2_strap_pelvis.csv"', f'"{own}"'))(file.parent)
        study = read_standing_study(file)
        return heard_reading(lambda _: _warn_of_copies(study.trials), lambda: None)

    return attempt


def measured(change: Callable[[pd.DataFrame], object], which: slice = slice(None), turning: float = 0.0) -> Attempt:
    """Elbow fit, up to its reading, of three trials with a moment and the arm's angle."""

    def attempt(folder: Path) -> Lines:
        files = record(folder, turning=turning)
        for file in files[which]:
            table(file, lambda found: (change(found), found)[1])
        return heard_reading(read_identify, IdentifyOptions, files)

    return attempt


def sought(change: Damage = untouched) -> Attempt:
    """Sit-to-stand calibrate, up to its reading, of trials with several straps."""

    def attempt(folder: Path) -> Lines:
        there = files_of(SITES, folder)
        change(there)
        return heard_reading(read_calibrate, StandingCalibrateOptions, there / "study.toml")

    return attempt


def strap_times(factor: float) -> Damage:
    def damage(folder: Path) -> dict[str, Any]:
        table(folder / "T1_strap_pelvis.csv", times_column("normal [N]", factor))
        return {}

    return damage


def exchanged(folder: Path) -> dict[str, Any]:
    one, other = (folder / f"T3_strap{site}.csv" for site in ("", "_shank"))
    ours, theirs = one.read_text(), other.read_text()
    one.write_text(theirs)
    other.write_text(ours)
    return {}


def of_another_trial(folder: Path) -> Lines:
    files = record(folder)
    theirs = pd.read_csv(files[1])["moment [N m]"]
    table(files[0], lambda found: found.__setitem__("moment [N m]", theirs))
    return heard_reading(read_identify, IdentifyOptions, files)


def foam(below: float) -> Attempt:
    def attempt(folder: Path) -> Lines:
        file = folder / "foot.toml"
        file.write_text(FOAM.replace("below = { value = 25,", f"below = {{ value = {below},"))
        return heard_reading(lambda _: foot_of(file), lambda: None)

    return attempt


def raised(**options: Any) -> Attempt:
    """Shoulder simulate, up to its reading, of a person whose upper arm is 300 mm long."""

    def attempt(folder: Path) -> Lines:
        file = folder / "person.toml"
        file.write_text('upper_arm = { value = 300, unit = "mm" }\n')
        given = {"side": "right", "sex": "male", "person": file} | options
        return heard_reading(read_arms, ShoulderSimulateOptions, OVERHEAD / "markers.trc", **given)

    return attempt


def cells(kilograms: float) -> Attempt:
    return lambda folder: heard(gc.load_cells, synthetic_walk.recorded(folder), unit="N", body_mass=kilograms)


def struck(*at: float) -> Attempt:
    """Heel strikes of one style at these times [s]."""

    def attempt(folder: Path) -> Lines:
        file = folder / "events.csv"
        rows = [f"walk, right, heel strike, {each}, slow" for each in at]
        file.write_text("\n".join(["recording, side, event, time [s], style", *rows, ""]))
        events = read_gait_events(file)
        return heard_reading(lambda _: Cutting(file, events, "right", None).cycles_of("walk"), lambda: None)

    return attempt


def as_it_is(_: object) -> None:
    return None


MOMENT = "moment [N m]"
FINDINGS: dict[str, Finding] = {
    "coordinates: chair under a foot": Finding(
        in_plane(feet="right_force,chair_force", chair="left_force"), "warned: .*carries 246 N before and 441 N after"
    ),
    "coordinates: a foot left out": Finding(in_plane(feet="right_force"), "refused: .*0.35 times the weight of 70 kg"),
    "coordinates: knees turned": Finding(
        in_plane(columns_changed("ik.mot", turned("knee_angle_r", "knee_angle_l"))), "warned: .*knee is .*sign turned"
    ),
    "coordinates: loads in lbf": Finding(in_plane(loads(1 / 4.448)), "refused: .*0.22 times the weight of 70 kg"),
    "coordinates: loads in kgf": Finding(in_plane(loads(1 / 9.81)), "refused: .*0.10 times the weight of 70 kg"),
    "coordinates: moments in N mm": Finding(
        in_plane(columns_changed("plates.mot", times(1e3, "torque_z"))), "warned: .*from below the centre of mass"
    ),
    "coordinates: a child's height": Finding(in_plane(height=1.2), "warned: `height`: 1.20 m, and by shank and thigh"),
    "movements: one plate twice": Finding(moved(feet="chair_force"), "refused: `feet`: chair_force is the chair's"),
    "movements: hips turned": Finding(
        moved(columns_changed("T1_coordinates.sto", turned("hip"))), "warned: .*hip is 11. degrees where the hip is lo"
    ),
    "movements: ankles turned": Finding(
        moved(columns_changed("T1_coordinates.sto", turned("ankle"))), "warned: .*ankle is 2. degrees where the hip is"
    ),
    "movements: an ankle of 0": Finding(
        moved(columns_changed("T1_coordinates.sto", times(0.0, "ankle"))), "warned: .*ankle stays at 0 degrees while"
    ),
    "movements: plates of another rise": Finding(moved(plates="T3"), "warned: .*feet_force.* is 0.17 s after weight"),
    "movements: loads in lbf": Finding(
        moved(columns_changed("T1_plates.mot", times(1 / 4.448, "_vy"))), "warned: .*carry 183 N, 18.7 kg.*not in lbf"
    ),
    "calibrate: a strap turned": Finding(sought(strap_times(-1.0)), "warned: T1: .*pelvis falls .*is its sign turned"),
    "calibrate: two straps exchanged": Finding(sought(exchanged), "warned: T3: .*thigh follows .*shank.*are they exch"),
    "person: a thigh's mass of both legs": Finding(segment("thigh", "mass", 20.0, "kg"), "warned: .*its mass is 2 tim"),
    "person: a shank in cm": Finding(segment("shank", "length", 44.0, "mm"), "warned: .*its length is 0.099 times"),
    "person: a thigh's centre beyond it": Finding(
        segment("thigh", "centre", 0.6, "m"), "warned: .*its centre is 1.4 times its length"
    ),
    "person: a radius as long as the thigh": Finding(
        segment("thigh", "gyration", 0.4, "m"), "warned: .*its gyration is 0.94 times its length"
    ),
    "sites: a strap of another trial": Finding(strapped("T1_strap_pelvis.csv"), "warned: T2: its strap_pelvis is that"),
    "elbow: a moment turned in one trial": Finding(
        measured(times_column(MOMENT, -1.0), slice(1, 2)), "warned: .*arm_2.*is its sign turned in this trial"
    ),
    "elbow: a moment of another trial": Finding(of_another_trial, "warned: .*arm_1.*is it of this trial, on its clock"),
    "elbow: forces in kgf beside a moment": Finding(
        measured(times_column("force [N]", 1 / 9.81)), "warned: .*a lever of 1.2 m .*in N m and N"
    ),
    "elbow: the hinge's angle for the arm's": Finding(
        measured(lambda found: found.__setitem__("alpha [deg]", found["beta [deg]"])), "refused: .*alpha has the values"
    ),
    "foam: 250 mm below the axis": Finding(foam(250.0), "warned: .*230 mm of something else lie between"),
    "shoulder: pounds for kg": Finding(raised(mass=181.0), "warned: .*181 kg with an upper arm of 300 mm"),
    "shoulder: a child's height": Finding(raised(mass=82.0, height=1.2), "warned: .*82 kg with the height of 1.20 m"),
    "cells: pounds for kg": Finding(cells(132.0), "warned: .*1.03 times the body's weight.*`body_mass` in kg"),
    "events: one strike too many": Finding(struck(0.0, 0.4, 1.1, 2.2), "warned: .*0.4 to 1.1 s: is a heel strike mis"),
}
RIGHT: dict[str, Attempt] = {
    "coordinates": in_plane(),
    "coordinates: loads 5 % off": in_plane(loads(1.05)),
    "coordinates: 1.6 m": in_plane(height=1.6),
    "movements": moved(),
    "movements: loads 20 % off": moved(columns_changed("T1_plates.mot", times(1.2, "_vy"))),
    "calibrate": sought(),
    "calibrate: a strap twice as stiff": sought(strap_times(2.0)),
    "person: a thigh 20 % heavier": segment("thigh", "mass", 11.9, "kg"),
    "person: a shank 10 % longer": segment("shank", "length", 490.0, "mm"),
    "person: a thigh's radius of a third": segment("thigh", "gyration", 0.15, "m"),
    "sites": strapped("T2_strap_pelvis.csv"),
    "elbow": measured(as_it_is),
    "elbow: a cuff that resists turning": measured(as_it_is, turning=2.0),
    "elbow: moments 20 % off in one trial": measured(times_column(MOMENT, 1.2), slice(1, 2)),
    "foam": foam(25.0),
    "foam: 60 mm below the axis": foam(60.0),
    "shoulder": raised(mass=82.0),
    "shoulder: 82 kg and 1.75 m": raised(mass=82.0, height=1.75),
    "cells": cells(60.0),
    "cells: who stands, 1.07 weights": cells(127.0),
    "events": struck(0.0, 1.0, 2.1, 3.0),
}
KNOWN = "T10 is taken to lie|no `person`"
"""Warnings of what is right."""


@pytest.mark.parametrize("finding", as_parameters(FINDINGS))
def test_it_is_heard_of(finding: Finding, tmp_path: Path) -> None:
    lines = finding.attempt(tmp_path)
    assert [line for line in lines if re.match(finding.words, line, re.DOTALL)], lines


@pytest.mark.parametrize("attempt", RIGHT.values(), ids=RIGHT)
def test_what_is_right_is_not_doubted(attempt: Attempt, tmp_path: Path) -> None:
    said = [line for line in attempt(tmp_path) if line.startswith(("refused", "warned", "contradicts"))]
    assert not [line for line in said if not re.search(KNOWN, line)]
