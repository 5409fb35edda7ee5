"""Support profiles: arms and device that they are made from, how they are made, and how they fare with others."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.motion.markers import markers_given, renamed_as_told
from geocontact.analyses.shoulder.devices import device_named, wearer_of_lengths
from geocontact.analyses.shoulder.optimise.options import ShoulderOptimiseOptions
from geocontact.analyses.shoulder.recordings import tool_current
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.identify.signals.filters import filled_and_smoothed
from geocontact.io.recordings.overhead_study import OverheadStudy, StudyTrial, read_overhead_study
from geocontact.shoulder_exoskeleton.arm_motion import Side
from geocontact.shoulder_exoskeleton.arms_from_markers import MarkerSettings
from geocontact.shoulder_exoskeleton.cuff_contact import OutOfCuffError
from geocontact.shoulder_exoskeleton.device import Device, Wearer, lever
from geocontact.shoulder_exoskeleton.human_arm import ToolWork, arm_moment
from geocontact.shoulder_exoskeleton.support.arm_trial import (
    ArmTrial,
    Support,
    ToolUse,
    Worker,
    recorded_arms,
    scales_of,
)
from geocontact.shoulder_exoskeleton.support.best_profile import front, scaled, uniform_profile
from geocontact.shoulder_exoskeleton.support.closed_loop_profile import ClosedLoop, SettledProfile
from geocontact.shoulder_exoskeleton.support.controlled_arm import simulated_support
from geocontact.shoulder_exoskeleton.support.held_out import HeldOutSupport, Maker, held_out
from geocontact.shoulder_exoskeleton.support.outcome import TABLE_3, Factors, SupportOutcome, outcome
from geocontact.shoulder_exoskeleton.support.phase_machine import Sensing, Thresholds
from geocontact.shoulder_exoskeleton.support.profile_limits import Limits, SupportCase
from geocontact.shoulder_exoskeleton.synthetic import all_arms

T = TypeVar("T")
GROUP, ONE_FACTOR, PAPER, BY_ARM = "all persons", "one factor", "table 3 of the paper", "by arm weight"
WORST = 0.25
"""Share of the cases that count as the worst."""
CERTAIN = 0.95
"""Share of the draws in which no arm is pushed up, where no reserve makes room for them."""
FORCES = (10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 80.0)
"""Limits of interface force on the front [N]."""
RESERVES = (0.0, 0.1, 0.2)
"""Shares left to the shoulder, a front each."""
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
    if o.study is None:
        reserve(SYNTHETIC)
        arms = all_arms(dominant_share=o.dominant_share, cutoff=o.cutoff)
        return WorkersAndDevice(tuple(arms), device, support_of(device))
    study = read_overhead_study(o.study)
    add_input("`study`", o.study, persons=len(study.persons), trials=len(study.trials))
    bare = [trial for trial in study.trials if trial.level is None]
    if not bare:
        reserve("every trial was recorded in the device: the shoulder's torque is that of arms that it supported")
    lengths = {name: wearer_of_lengths(o.study, each.lengths) for name, each in study.persons.items()}
    arms = [arm for trial in bare or study.trials for arm in _arms(o, study, trial, lengths[trial.person])]
    unseen = {
        name: arm_moment(each.mass, each.sex, lengths[name].upper_arm)
        for name, each in study.persons.items()
        if name not in {trial.person for trial in bare or study.trials}
    }
    return WorkersAndDevice(tuple(arms), device, support_of(device), unseen)


def support_of(device: Device) -> Support:
    """Torque of the device's cylinder at full level over the elevation of its arm."""
    a, b, phase = (np.array(device[name]) for name in ("lever_a", "lever_b", "lever_phase"))

    def torque(elevation: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
        return np.asarray(device.peak_force * lever(elevation, a, b, phase))

    return Support(torque, device["lag"])


def _arms(o: ShoulderOptimiseOptions, study: OverheadStudy, trial: StudyTrial, lengths: Wearer) -> list[ArmTrial]:
    person, task = study.persons[trial.person], study.tasks[trial.task]
    recorded = renamed_as_told(markers_given(trial.markers, o.axes, None, o.c3d_unit), o.markers_map)
    seen = _filled(recorded, o.gap_limit)
    add_input(f"{trial.person} {trial.task}", trial.markers, frames=len(seen))
    current = tool_current(trial.tool, seen.time)
    share = o.dominant_share if task.dominant_share is None else task.dominant_share
    use = ToolUse(ToolWork(task.tool, task.push, dominant_share=share), current > Thresholds().on, current)
    dominant: Side = "right" if person.dominant == "right" else "left"
    worker = Worker(trial.person, person.mass, person.sex, dominant, lengths)
    settings = MarkerSettings(upright=trial.upright, gap_limit=o.gap_limit)
    arms, notes = recorded_arms(f"{trial.person}{trial.task}", worker, trial.task, seen, settings, use, o.cutoff)
    for note in notes:
        reserve(f"{trial.markers.name}: {note}")
    return arms


def _filled(seen: MarkerTrajectories, longest: float) -> MarkerTrajectories:
    """Markers at even times without gaps; those that begin late or end early are left out."""
    known = np.isfinite(seen.positions).all(axis=2)
    kept = [k for k in range(len(seen.names)) if known[0, k] and known[-1, k]]
    if not kept:
        raise InputError(seen.source, "", "no marker is seen from the first to the last frame", "cut the trial")
    names = tuple(seen.names[k] for k in kept)
    columns = seen.positions[:, kept].reshape(len(seen), -1)
    try:
        time, values = filled_and_smoothed(seen.time, columns, cutoff=None, longest_gap=longest)
    except ValueError as error:
        raise InputError(seen.source, "", str(error), "fill the gap, or give a larger `gap_limit`") from error
    return MarkerTrajectories(time, values.reshape(len(time), len(kept), 3), names, seen.source)


@dataclass(frozen=True)
class NamedProfile:
    """Factors, what they are called, and for which persons."""

    name: str
    factors: Factors
    of: tuple[str, ...]


@dataclass(frozen=True)
class FrontPoint:
    """Share of the torque that is taken away under a limit of interface force [N] and with a reserve."""

    force: float
    reserve: float
    value: float


def closed_loop(workers: WorkersAndDevice, o: ShoulderOptimiseOptions) -> ClosedLoop:
    """What profiles are made by, with the limits and the aim that the options name."""
    certainty = (0.0 if o.reserve else CERTAIN) if o.certainty is None else o.certainty
    limits = Limits(o.force_limit or np.inf, o.rate_limit or np.inf, o.reserve, certainty)
    worst = WORST if o.worst_share is None else o.worst_share
    return ClosedLoop(workers.device, workers.support, limits, o.aim, worst, seed=o.seed)


@dataclass(frozen=True, eq=False)
class MadeProfiles:
    """Profiles, and what they do in the simulation.

    Parameters
    ----------
    group, one, by_arm
        For all persons, of one factor, and scaled by the weight of each arm; the last where it is asked for.
    simulated
        By profile and case, with exact sensors.
    moments
        Of the arms' weight by person, those without a trial last [N m].
    scales
        By person; empty where all factors are the same.
    """

    profiles: tuple[NamedProfile, ...]
    group: SettledProfile
    one: SettledProfile
    by_arm: SettledProfile | None
    simulated: Mapping[str, Mapping[str, SupportOutcome]]
    moments: Mapping[str, float]
    scales: Mapping[str, float]


def made_profiles(given: WorkersAndDevice, loop: ClosedLoop, *, by_arm: bool) -> MadeProfiles:
    """ArithmeticError where an arm cannot be simulated."""
    trials = given.trials
    persons = tuple(dict.fromkeys(each.person for each in trials))
    group, one = loop.settled(trials), loop.settled(trials, uniform_profile)
    profiles = [
        NamedProfile(GROUP, group.profile.factors, persons),
        NamedProfile(ONE_FACTOR, one.profile.factors, persons),
    ]
    simulated = {GROUP: _outcomes(group), ONE_FACTOR: _outcomes(one)}
    if set(group.profile.factors) <= set(TABLE_3):
        paper = {key: TABLE_3[key] for key in group.profile.factors}
        profiles.append(NamedProfile(PAPER, paper, persons))
        simulated[PAPER] = {each.name: loop.run(each, paper).outcome for each in trials}
    for person in persons if len(persons) > 1 else ():
        own = loop.settled([each for each in trials if each.person == person])
        profiles.append(NamedProfile(f"{person} alone", own.profile.factors, persons))
        simulated[f"{person} alone"] = _outcomes(own)
    moments = {
        person: float(np.mean([each.arm_moment for each in trials if each.person == person])) for person in persons
    } | dict(given.unseen)
    if not by_arm:
        return MadeProfiles(tuple(profiles), group, one, None, simulated, moments, {})
    scales = scales_of(moments, persons)
    all_scaled = loop.settled(trials, scales={person: scales[person] for person in persons})
    for person in moments:
        name = f"{BY_ARM}, {person}"
        profiles.append(NamedProfile(name, scaled(all_scaled.profile.factors, scales[person]), (person,)))
        own_runs = {each.name: all_scaled.runs[each.name].outcome for each in trials if each.person == person}
        if own_runs:
            simulated[name] = own_runs
    return MadeProfiles(tuple(profiles), group, one, all_scaled, simulated, moments, scales)


def _outcomes(found: SettledProfile) -> dict[str, SupportOutcome]:
    return {name: run.outcome for name, run in found.runs.items()}


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
        reserve("one person only: nobody can be held out, the profile is for this person")
        return {}
    try:
        return held_out(
            given.trials,
            given.support,
            of_others(loop, o, one=False),
            of_others(loop, o, one=True),
            draws=o.draws,
            seed=o.seed,
            reaches=loop.transfer,
        )
    except KeyError as error:
        what = "a task is of one person only: no profile that the others make has a factor for it"
        raise InputError(o.study or "", "", what, "let every person do every task") from error


def of_others(loop: ClosedLoop, o: ShoulderOptimiseOptions, *, one: bool) -> Maker:
    """Makes a profile, or one factor, from the others, and scales it to the arm of the person held out."""

    def make(others: Sequence[ArmTrial], own: Sequence[ArmTrial]) -> Factors:
        person = own[0].person
        moments = {each.person: each.arm_moment for each in (*others, *own)}
        scales = scales_of(moments, {each.person for each in others}) if o.scale == "arm" else {}
        found = loop.settled(others, uniform_profile, scales) if one else loop.settled(others, scales=scales)
        return scaled(found.profile.factors, scales.get(person, 1.0))

    return make


def with_sensors(
    given: WorkersAndDevice, factors: Mapping[str, Factors], o: ShoulderOptimiseOptions
) -> dict[str, SupportOutcome]:
    """What a person's factors do, by case: the device in closed loop with its noisy, late sensors."""
    return sound(
        o,
        lambda: {
            each.name: simulated_support(each, given.device, factors[each.person], Sensing(), o.seed).outcome
            for each in given.trials
        },
    )


def planned_outcomes(
    profiles: Sequence[NamedProfile], cases: Sequence[SupportCase]
) -> dict[str, dict[str, SupportOutcome]]:
    """What each profile does by profile and case, linear around the simulation that the cases were corrected by."""
    return {
        profile.name: {
            case.name: outcome(case, profile.factors)
            for case in cases
            if set(case.keys) <= set(profile.factors) and case.person in profile.of
        }
        for profile in profiles
    }


def front_points(cases: Sequence[SupportCase], loop: ClosedLoop) -> tuple[FrontPoint, ...]:
    """Shares taken away over the limit of interface force, reserve by reserve."""
    return tuple(
        FrontPoint(force, reserve, profile.value)
        for reserve in RESERVES
        for force, profile in zip(
            FORCES,
            front(cases, [Limits(force, loop.limits.rate, reserve) for force in FORCES], loop.aim, loop.worst_share),
            strict=True,
        )
    )
