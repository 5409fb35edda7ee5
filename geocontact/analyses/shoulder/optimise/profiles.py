"""Support profiles: arms and device that they are made from, limits, and how they do on persons held out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.motion.checked_trial import check_trial
from geocontact.analyses.motion.markers import markers_given, renamed_as_told, turn_of
from geocontact.analyses.person import name_unused, person_segments, unused_values
from geocontact.analyses.shoulder.devices import device_named, wearer_of_lengths
from geocontact.analyses.shoulder.optimise.options import ShoulderOptimiseOptions
from geocontact.analyses.shoulder.recordings import doubt_tool, push_force, tool_current
from geocontact.analyses.shoulder.study_checks import check_study, doubt_share
from geocontact.data.body_segments import BodySegments
from geocontact.data.errors import InputError
from geocontact.io.recordings.overhead_study import OverheadStudy, StudyTrial, read_overhead_study
from geocontact.shoulder_exoskeleton.arm_motion import Side
from geocontact.shoulder_exoskeleton.arms_from_markers import MarkerSettings, filled_markers
from geocontact.shoulder_exoskeleton.cuff_contact import OutOfCuffError
from geocontact.shoulder_exoskeleton.device import Device, Wearer
from geocontact.shoulder_exoskeleton.human_arm import CHAIN, ToolWork, arm_moment
from geocontact.shoulder_exoskeleton.support.arm_trial import (
    ArmTrial,
    Support,
    ToolUse,
    Worker,
    recorded_arms,
    support_of,
)
from geocontact.shoulder_exoskeleton.support.closed_loop_profile import ClosedLoop
from geocontact.shoulder_exoskeleton.support.group_profiles import of_others
from geocontact.shoulder_exoskeleton.support.held_out import HeldOutSupport, held_out
from geocontact.shoulder_exoskeleton.support.phase_machine import Thresholds
from geocontact.shoulder_exoskeleton.support.profile_limits import Limits
from geocontact.shoulder_exoskeleton.synthetic import all_arms
from geocontact.trial_checks.recorded import TrialInputs

T = TypeVar("T")
WORST = 0.25
"""Share of the cases that count as the worst."""
CERTAIN = 0.95
"""Share of the draws in which no arm is pushed up, where no reserve makes room for them."""
OTHERS = "of the others"
SYNTHETIC = "no `study`: the persons are synthetic, all their numbers invented"


@dataclass(frozen=True, eq=False)
class WorkersAndDevice:
    """Arms in their trials, and what the device can do.

    Parameters
    ----------
    unseen
        Moment of the arm's weight of persons without a trial, by name [N m].
    """

    trials: tuple[ArmTrial, ...]
    device: Device
    support: Support
    unseen: Mapping[str, float] = field(default_factory=dict)


def read(o: ShoulderOptimiseOptions) -> WorkersAndDevice:
    """Everything the options name."""
    device = device_named(o.device)
    doubt_share(o.dominant_share, "`dominant_share`")
    if o.study is None:
        reserve(SYNTHETIC)
        arms = all_arms(dominant_share=o.dominant_share, cutoff=o.cutoff)
        return WorkersAndDevice(tuple(arms), device, support_of(device))
    study = read_overhead_study(o.study)
    add_input("`study`", o.study, persons=len(study.persons), trials=len(study.trials))
    check_study(study, o.study, o.c3d_unit)
    bare = [trial for trial in study.trials if trial.level is None]
    if not bare:
        reserve("every trial was recorded in the device: the shoulder's torque is for arms that it supported")
    lengths = {name: wearer_of_lengths(o.study, each.lengths) for name, each in study.persons.items()}
    bodies = {
        name: person_segments(each.sex, each.age, each.mass, each.height, each.own, (o.study, f"[persons.{name}]"))
        for name, each in study.persons.items()
    }
    for name, each in study.persons.items():
        idle = unused_values(each, each.mass, _of_arm)
        name_unused((o.study, f"[persons.{name}]"), idle, "shoulder optimise")
    arms = [
        arm
        for trial in bare or study.trials
        for arm in _arms(o, study, trial, lengths[trial.person], bodies[trial.person])
    ]
    unseen = {
        name: arm_moment(each.mass, bodies[name], lengths[name].upper_arm)
        for name, each in study.persons.items()
        if name not in {trial.person for trial in bare or study.trials}
    }
    return WorkersAndDevice(tuple(arms), device, support_of(device), unseen)


def _of_arm(segments: BodySegments) -> list[float]:
    """What the torque of an arm takes of the segments."""
    arm = [segments[name] for name in CHAIN]
    return [value for each in arm for value in (each.length, each.mass, each.centre, *each.radii[:2])]


def _arms(
    o: ShoulderOptimiseOptions, study: OverheadStudy, trial: StudyTrial, lengths: Wearer, body: BodySegments
) -> list[ArmTrial]:
    person, task = study.persons[trial.person], study.tasks[trial.task]
    recorded = renamed_as_told(markers_given(trial.markers, o.axes, None, o.c3d_unit), o.markers_map)
    check_trial(TrialInputs(markers=recorded, turn=turn_of(o.axes)))
    seen = filled_markers(recorded, o.gap_limit)
    add_input(f"{trial.person} {trial.task}", trial.markers, frames=len(seen))
    current = tool_current(trial.tool, seen.time)
    share = o.dominant_share if task.dominant_share is None else task.dominant_share
    work = ToolWork(task.tool, task.push, task.push_direction, share)
    push = None if trial.push is None else push_force(trial.push, seen.time)
    use = ToolUse(work, current > Thresholds().on, current, push)
    dominant: Side = "right" if person.dominant == "right" else "left"
    worker = Worker(trial.person, person.mass, body, dominant, lengths)
    settings = MarkerSettings(upright=trial.upright, gap_limit=o.gap_limit)
    arms, notes = recorded_arms(f"{trial.person}{trial.task}", worker, trial.task, seen, settings, use, o.cutoff)
    for note in notes:
        reserve(f"{trial.markers.name}: {note}")
    if current.any():
        doubt_tool(trial.tool, use.running, [arm.motion for arm in arms])
    return arms


def closed_loop(workers: WorkersAndDevice, o: ShoulderOptimiseOptions) -> ClosedLoop:
    """What profiles are made by, with the limits and the aim that the options name."""
    certainty = (0.0 if o.reserve else CERTAIN) if o.certainty is None else o.certainty
    limits = Limits(o.force_limit or np.inf, o.rate_limit or np.inf, o.reserve, certainty)
    worst = WORST if o.worst_share is None else o.worst_share
    return ClosedLoop(workers.device, workers.support, limits, o.aim, worst, seed=o.seed)


def sound(o: ShoulderOptimiseOptions, what: Callable[[], T]) -> T:
    """What is made of a study; InputError where its arms cannot be simulated, or there is no profile."""
    try:
        return what()
    except OutOfCuffError as error:
        raise InputError(o.study or "", "", error.what, error.cause) from error
    except ArithmeticError as error:
        raise InputError(o.study or "", "", str(error), "check lengths, unit and names of markers") from error


def judged_held_out(given: WorkersAndDevice, loop: ClosedLoop, o: ShoulderOptimiseOptions) -> dict[str, HeldOutSupport]:
    """How profiles of the others fare, by person; empty where there is one only."""
    if len({trial.person for trial in given.trials}) == 1:
        reserve("only one person: cross-validation is impossible, the profile is for this person")
        return {}
    by_arm = o.scale == "arm"
    try:
        return held_out(
            given.trials,
            given.support,
            of_others(loop, one=False, by_arm=by_arm),
            of_others(loop, one=True, by_arm=by_arm),
            draws=o.draws,
            seed=o.seed,
            reaches=loop.transfer,
        )
    except KeyError as error:
        what = "a task is of one person only: no profile that the others make has a factor for it"
        raise InputError(o.study or "", "", what, "let every person do every task") from error
