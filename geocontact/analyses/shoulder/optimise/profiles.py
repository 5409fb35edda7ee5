"""The profiles of a group: for all persons, one factor, the paper's, each person's alone and by arm weight."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from geocontact.analyses.shoulder.optimise.read import WorkersAndDevice
from geocontact.analyses.shoulder.optimise.result import NamedProfile
from geocontact.shoulder_exoskeleton.support.arm_scales import scales_of
from geocontact.shoulder_exoskeleton.support.best_profile import scaled, uniform_profile
from geocontact.shoulder_exoskeleton.support.closed_loop_profile import ClosedLoop, SettledProfile
from geocontact.shoulder_exoskeleton.support.outcome import TABLE_3, SupportOutcome

GROUP, ONE_FACTOR, PAPER, BY_ARM = "all persons", "one factor", "table 3 of the paper", "by arm weight"


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
