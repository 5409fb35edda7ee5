"""Arms in the trials of a study: read, simulated along the motion in the device and along that without it, tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import add_input, collecting, current, reserve
from geocontact.analyses.frame.record import Record
from geocontact.analyses.motion.markers import unit_of_c3d
from geocontact.analyses.person import name_unused, stated_of_body
from geocontact.analyses.shoulder.devices import wearer_of_lengths
from geocontact.analyses.shoulder.recordings import recorded_channels, shown_in
from geocontact.analyses.shoulder.shared_options import SUPPORT, level
from geocontact.analyses.shoulder.simulate.arms import Worn, worn_along
from geocontact.analyses.shoulder.simulate.options import ShoulderSimulateOptions
from geocontact.analyses.shoulder.study.options import StudyOptions
from geocontact.analyses.shoulder.study_checks import check_study
from geocontact.data.errors import InputError
from geocontact.identify.signals.agreement import Agreement
from geocontact.io.recordings.overhead_study import OverheadStudy, StudyTrial, read_overhead_study
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion, Side
from geocontact.shoulder_exoskeleton.beside_recording import (
    ELEVATION,
    FEWEST,
    FORCE,
    PASSIVE,
    BesideRecording,
    Channels,
    beside_recording,
)
from geocontact.shoulder_exoskeleton.cuff_contact import OutOfCuffError
from geocontact.shoulder_exoskeleton.device import JOINTS
from geocontact.shoulder_exoskeleton.work_phases import PHASES
from geocontact.shoulder_exoskeleton.working_arm import SimulatedArm, arm_at_work, screw_in

COPIED = "elevation, copied from the shoulder"
"""What stands beside the simulated elevation: joint angles of the human taken as those of the exoskeleton."""
DEG = float(np.degrees(1.0))
DIFFERENCES = ("exoskeleton [deg]", "shoulder [deg]", "force [N]", "shoulder less exoskeleton [deg]")


@dataclass(frozen=True, eq=False)
class StudyTrialInputs:
    """A trial in the device with what its files hold: the arms that were recorded, and logger and mat by their side."""

    trial: StudyTrial
    level: float
    within: Worn
    without: Worn | None
    recorded: Mapping[Side, Channels]


def read(o: StudyOptions) -> tuple[StudyTrialInputs, ...]:
    """Every trial with a level; InputError where there is none."""
    study = read_overhead_study(o.study)
    add_input("study", o.study, trials=len(study.trials))
    check_study(study, o.study, o.c3d_unit)
    for name, person in study.persons.items():
        name_unused((o.study, f"[persons.{name}]"), stated_of_body(person), "shoulder study")
    found = tuple(_trial(study, each, share, o) for each in study.trials if (share := _level(each, o)) is not None)
    if not found:
        raise InputError(o.study, "[[trials]]", "none was recorded in the device", 'write level = "100%" into those')
    return found


def _level(trial: StudyTrial, o: StudyOptions) -> float | None:
    if trial.level is None:
        return None
    share = level(trial.level, f"{o.study.name} [[trials]] {trial.name} level")
    if not 0.0 <= share <= 1.0:
        raise InputError(o.study, f"[[trials]] {trial.name}", f"level is {trial.level}", "give 0 to 100%")
    if doubt := SUPPORT.doubt(share):
        reserve(f"{o.study} [[trials]] {trial.name} level: {doubt}")
    return share


def _trial(study: OverheadStudy, trial: StudyTrial, share: float, o: StudyOptions) -> StudyTrialInputs:
    within = _worn(study, trial, share, o)
    bare = next((each for each in study.trials if each.name == trial.without), None)
    without = None if bare is None else _worn(study, bare, share, o)
    recorded: dict[Side, Channels] = {}
    for side, file in zip(_sides(study, trial), (trial.recorded, trial.recorded_other), strict=True):
        if file is None:
            continue
        if side not in [arm.side for arm in within.arms]:
            raise InputError(file, "", f"the {side} arm has no markers in {trial.markers.name}", "leave it out")
        recorded[side] = recorded_channels(file)
        add_input(f"{trial.name} recorded, {side}", file, samples=len(recorded[side].time))
    return StudyTrialInputs(trial, share, within, without, recorded)


def _sides(study: OverheadStudy, trial: StudyTrial) -> tuple[Side, Side]:
    """Sides of the dominant arm and of the other."""
    return ("right", "left") if study.persons[trial.person].dominant == "right" else ("left", "right")


def _worn(study: OverheadStudy, trial: StudyTrial, share: float, o: StudyOptions) -> Worn:
    person = study.persons[trial.person]
    asked = ShoulderSimulateOptions(
        trial.markers,
        device=o.device,
        level=share,
        cutoff=o.cutoff,
        gap_limit=o.gap_limit,
        upright=trial.upright,
        tool=trial.tool,
        markers_map=o.markers_map,
        axes=o.axes,
        c3d_unit=unit_of_c3d(o.c3d_unit, trial.markers),
    )
    with collecting(Record("shoulder simulate", {})) as own:
        named = f"mass of [persons.{trial.person}] in {o.study}"
        found = worn_along(asked, wearer_of_lengths(o.study, person.lengths), person.mass, named, person.age)
    for entry in own.inputs:
        current().inputs.append(entry | {"role": f"{trial.name} {entry['role']}"})
    for line in own.warnings:
        if not any(line in known for known in current().warnings):
            reserve(f"{trial.name}: {line}", cause=line in own.causes)
    return found


@dataclass(frozen=True, eq=False)
class StudyCase:
    """An arm in a trial.

    Parameters
    ----------
    within
        Along the motion recorded in the device: the study's group 1.
    without
        Along the motion recorded without it: group 2; None where there is none.
    recorded
        Of this arm's logger and mat; None where there are none.
    beside
        `within` beside the recording; the channel `COPIED` is the human elevation in place of the exoskeleton's.
    """

    trial: StudyTrial
    within: SimulatedArm
    without: SimulatedArm | None
    recorded: Channels | None
    beside: BesideRecording | None

    @property
    def errors(self) -> dict[str, Mapping[str, Agreement]]:
        """By channel and part of the trial; none without a recording."""
        return {} if self.beside is None else {name: one.errors for name, one in self.beside.channels.items()}

    @property
    def name(self) -> str:
        """Trial and arm."""
        return f"{self.trial.name}, {self.within.side} arm"


def study_case(each: StudyTrialInputs, arm: ArmMotion, o: StudyOptions) -> StudyCase:
    """One arm, simulated along both motions, and its errors beside logger and mat."""
    within = _simulated(each, each.within, arm, o)
    bare = () if each.without is None else each.without.arms
    same = next((one for one in bare if one.side == arm.side), None)
    without = None if each.without is None or same is None else _simulated(each, each.without, same, o)
    recorded = each.recorded.get(arm.side)
    beside = None if recorded is None else _beside(each, within, recorded)
    return StudyCase(each.trial, within, without, recorded, beside)


def _simulated(each: StudyTrialInputs, worn: Worn, arm: ArmMotion, o: StudyOptions) -> SimulatedArm:
    try:
        return arm_at_work(arm, worn.device, worn.wearer, each.level, tool=worn.tool)
    except OutOfCuffError as error:
        raise InputError(
            o.study, f"[[trials]] {each.trial.name}", f"{arm.side} arm: {error.what}", error.cause
        ) from error
    except (ArithmeticError, ValueError) as error:
        remedy = "look at it alone with shoulder simulate"
        what = f"{arm.side} arm: {error}"
        raise InputError(o.study, f"[[trials]] {each.trial.name}", what, remedy) from error


def _beside(each: StudyTrialInputs, within: SimulatedArm, recorded: Channels) -> BesideRecording:
    s, time = within.simulation, within.simulation.motion.time
    models = {
        ELEVATION: (ELEVATION, s.elevation),
        COPIED: (ELEVATION, s.motion.elevation),
        FORCE: (FORCE, s.supporting),
        **{joint: (joint, s.angles[:, k]) for k, joint in enumerate(PASSIVE)},
    }
    found = beside_recording(time, models, [PHASES[number] for number in within.phase], recorded)
    if not found.channels:
        what = f"was recorded from {recorded.time[0]:g} to {recorded.time[-1]:g} s"
        remedy = f"its markers are from {time[0]:g} to {time[-1]:g} s"
        raise InputError("", f"{each.trial.name}, {s.motion.side} arm", what, remedy)
    return found


def error_table(cases: Sequence[StudyCase]) -> pd.DataFrame:
    """One row for each trial, arm, channel and part of the trial."""
    rows = []
    for case in cases:
        t = case.trial
        for channel, errors in case.errors.items():
            unit, factor = shown_in(channel)
            for part, a in errors.items():
                numbers = {"mae": a.mae * factor, "rmsd": a.rmsd * factor, "bias": a.bias * factor, "r2 [-]": a.r2}
                words = {
                    "trial": t.name,
                    "arm": case.within.side,
                    "person": t.person,
                    "task": t.task,
                    "level": t.level,
                    "channel": channel,
                }
                rows.append({**words, "part": part, "unit": unit, **numbers, "samples": a.samples})
    of = ["trial", "arm", "person", "task", "level", "channel", "part", "unit"]
    return pd.DataFrame(rows, columns=[*of, "mae", "rmsd", "bias", "r2 [-]", "samples"])


def summary_table(cases: Sequence[StudyCase]) -> pd.DataFrame:
    """Means over all arms and trials, each counting the same, with the standard deviation of the RMSD between them."""
    errors = error_table(cases)
    rows = []
    for (channel, part), group in errors.groupby(["channel", "part"], sort=False):
        spread = float(group["rmsd"].std(ddof=1)) if len(group) > 1 else float("nan")
        means = {name: float(group[name].mean()) for name in ("mae", "rmsd", "bias")}
        unit = str(group["unit"].iloc[0])
        rows.append({"channel": channel, "part": part, "unit": unit, **means, "sd of rmsd": spread, "arms": len(group)})
    return pd.DataFrame(rows, columns=["channel", "part", "unit", "mae", "rmsd", "bias", "sd of rmsd", "arms"])


def difference_table(cases: Sequence[StudyCase]) -> pd.DataFrame:
    """Means over the screw-in, motion recorded in the device less that without it; last row: means of their sizes.

    The last column is of the motion recorded in the device: what copying joint angles would miss.
    """
    rows: list[dict[str, object]] = []
    for case in cases:
        if case.without is None:
            continue
        one, two = screw_in(case.within), screw_in(case.without)
        values = (
            DEG * (one.exoskeleton - two.exoskeleton),
            DEG * (one.shoulder - two.shoulder),
            one.force - two.force,
            DEG * (one.shoulder - one.exoskeleton),
        )
        rows.append({"trial": case.trial.name, "arm": case.within.side, **dict(zip(DIFFERENCES, values, strict=True))})
    table = pd.DataFrame(rows, columns=["trial", "arm", *DIFFERENCES])
    if len(table):
        table.loc[len(table)] = ["mean", "both", *table[list(DIFFERENCES)].abs().mean()]
    return table


def passive_table(cases: Sequence[StudyCase]) -> pd.DataFrame:
    """How far the passive joints move, and how the sphere does in the cuff, in both groups."""
    rows = []
    for case in cases:
        for group, arm in (("in the device", case.within), ("without it", case.without)):
            if arm is None:
                continue
            s = arm.simulation
            spans = {
                f"{joint} {end} [deg]": DEG * float(getattr(s.angles[:, k], end)())
                for k, joint in enumerate(JOINTS[:-1])
                for end in ("min", "max")
            }
            slip = {"slip [mm]": 1e3 * float(s.slip[-1]), "out of the cuff [-]": float(s.out_of_cuff.mean())}
            rows.append({"trial": case.trial.name, "arm": case.within.side, "motion recorded": group, **spans, **slip})
    return pd.DataFrame(rows)


SAMPLES = 101
"""Samples of a normalised curve."""
GROUPS = ("in the device", "without it")


def normalised_table(cases: Sequence[StudyCase]) -> pd.DataFrame:
    """Curves of both groups over the work, 0 % where the arm is first raised and 100 % where it last is.

    Durations differ from trial to trial and between the groups; so the angles of exoskeleton and shoulder stand beside
    each other at the same part of the work (figs. 11 and 12 of the study).
    """
    columns = ["trial", "arm", "motion recorded", "work [-]", "exoskeleton [deg]", "shoulder [deg]", "force [N]"]
    rows = []
    for case in cases:
        for group, arm in zip(GROUPS, (case.within, case.without), strict=True):
            if arm is None:
                continue
            s, at_work = arm.simulation, np.flatnonzero(arm.phase)
            if len(at_work) < FEWEST:
                continue
            time = s.motion.time
            at = np.linspace(time[at_work[0]], time[at_work[-1]], SAMPLES)
            curves = [np.interp(at, time, each) for each in (DEG * s.elevation, DEG * s.motion.elevation, s.supporting)]
            words = {"trial": case.trial.name, "arm": arm.side, "motion recorded": group}
            rows += [
                {**words, **dict(zip(columns[3:], values, strict=True))}
                for values in zip(np.linspace(0.0, 1.0, SAMPLES), *curves, strict=True)
            ]
    return pd.DataFrame(rows, columns=columns)
