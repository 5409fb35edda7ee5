"""Profiles for a group of arms, what each does in the simulation, and how those that others make do on a person.

The best for all persons, one factor for everything, the paper's own, each person's alone, and the group's in proportion
to the weight of each arm. Names are those of tables and files.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from geocontact.shoulder_exoskeleton.device import Device
from geocontact.shoulder_exoskeleton.support.arm_trial import ArmTrial, scales_of
from geocontact.shoulder_exoskeleton.support.best_profile import front, scaled, uniform_profile
from geocontact.shoulder_exoskeleton.support.closed_loop_profile import ClosedLoop, SettledProfile
from geocontact.shoulder_exoskeleton.support.controlled_arm import simulated_support
from geocontact.shoulder_exoskeleton.support.controller_numbers import sensing_of
from geocontact.shoulder_exoskeleton.support.held_out import Maker
from geocontact.shoulder_exoskeleton.support.outcome import TABLE_3, Factors, SupportOutcome, outcome
from geocontact.shoulder_exoskeleton.support.phase_machine import Sensing
from geocontact.shoulder_exoskeleton.support.profile_limits import Limits, SupportCase

GROUP, ONE_FACTOR, PAPER, BY_ARM = "all persons", "one factor", "table 3 of the paper", "by arm weight"
FORCES = (10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 80.0)
"""Limits of interface force on the front [N]."""
RESERVES = (0.0, 0.1, 0.2)
"""Shares left to the shoulder, a front each."""
Outcomes = dict[str, SupportOutcome]
"""Outcome by the name of the case."""


@dataclass(frozen=True)
class NamedProfile:
    """Factors, what they are called, and for which persons."""

    name: str
    factors: Factors
    of: tuple[str, ...]


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
        Moment of the arm's weight by person, those without a trial last [N m].
    scales
        By person; empty where all factors are the same.
    """

    profiles: tuple[NamedProfile, ...]
    group: SettledProfile
    one: SettledProfile
    by_arm: SettledProfile | None
    simulated: Mapping[str, Mapping[str, SupportOutcome]]
    moments: Mapping[str, float]
    scales: Mapping[str, float] = field(default_factory=dict)


def made_profiles(
    trials: Sequence[ArmTrial], loop: ClosedLoop, unseen: Mapping[str, float] | None = None, *, by_arm: bool = True
) -> MadeProfiles:
    """Every profile of these arms; that of the paper where it has all of their tasks.

    Parameters
    ----------
    unseen
        Moment of the arm's weight of persons without a trial, by name [N m].
    by_arm
        Whether to scale the group's profile by the weight of each arm besides.

    ArithmeticError where an arm cannot be simulated.
    """
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
    } | dict(unseen or {})
    if not by_arm:
        return MadeProfiles(tuple(profiles), group, one, None, simulated, moments)
    scales = scales_of(moments, persons)
    all_scaled = loop.settled(trials, scales={person: scales[person] for person in persons})
    for person in moments:
        name = f"{BY_ARM}, {person}"
        profiles.append(NamedProfile(name, scaled(all_scaled.profile.factors, scales[person]), (person,)))
        own_runs = {each.name: all_scaled.runs[each.name].outcome for each in trials if each.person == person}
        if own_runs:
            simulated[name] = own_runs
    return MadeProfiles(tuple(profiles), group, one, all_scaled, simulated, moments, scales)


def _outcomes(found: SettledProfile) -> Outcomes:
    return {name: run.outcome for name, run in found.runs.items()}


def of_others(loop: ClosedLoop, *, one: bool = False, by_arm: bool = True) -> Maker:
    """Makes a profile from the others' trials for a person held out, such as `held_out` takes.

    Parameters
    ----------
    one
        One factor for everything instead of the best profile.
    by_arm
        Whether it is scaled to the weight of the person's arm.
    """

    def make(others: Sequence[ArmTrial], own: Sequence[ArmTrial]) -> Factors:
        person = own[0].person
        moments = {each.person: each.arm_moment for each in (*others, *own)}
        scales = scales_of(moments, {each.person for each in others}) if by_arm else {}
        found = loop.settled(others, uniform_profile, scales) if one else loop.settled(others, scales=scales)
        return scaled(found.profile.factors, scales.get(person, 1.0))

    return make


def with_sensors(trials: Sequence[ArmTrial], device: Device, factors: Mapping[str, Factors], seed: int = 0) -> Outcomes:
    """What each person's factors do, by case: the device in closed loop with its noisy, late sensors.

    Parameters
    ----------
    factors
        By person.
    seed
        Of the sensors' noise.

    ArithmeticError as of `simulated_support`.
    """
    return {
        each.name: simulated_support(each, device, factors[each.person], sensing_of(device) or Sensing(), seed).outcome
        for each in trials
    }


def planned_outcomes(profiles: Sequence[NamedProfile], cases: Sequence[SupportCase]) -> dict[str, Outcomes]:
    """What each profile does by profile and case, linear around the simulation that the cases were corrected by.

    A profile without a factor for a case, or not for its person, has no outcome there.
    """
    return {
        profile.name: {
            case.name: outcome(case, profile.factors)
            for case in cases
            if set(case.keys) <= set(profile.factors) and case.person in profile.of
        }
        for profile in profiles
    }


@dataclass(frozen=True)
class FrontPoint:
    """Share of the torque that is taken away under a limit of interface force [N] and with a reserve."""

    force: float
    reserve: float
    value: float


def front_points(
    cases: Sequence[SupportCase],
    loop: ClosedLoop,
    forces: Sequence[float] = FORCES,
    reserves: Sequence[float] = RESERVES,
) -> tuple[FrontPoint, ...]:
    """Shares taken away over the limit of interface force [N], reserve by reserve; rate and aim are those of `loop`."""
    return tuple(
        FrontPoint(force, reserve, profile.value)
        for reserve in reserves
        for force, profile in zip(
            forces,
            front(cases, [Limits(force, loop.limits.rate, reserve) for force in forces], loop.aim, loop.worst_share),
            strict=True,
        )
    )
