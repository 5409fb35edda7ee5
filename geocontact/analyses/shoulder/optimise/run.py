"""The best support profile for a group, for each person, and for persons that it was not made with."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TypeVar

import numpy as np

from geocontact.analyses.json_file import plain
from geocontact.analyses.run_record import Record
from geocontact.analyses.shoulder.optimise.options import ShoulderOptimiseOptions
from geocontact.analyses.shoulder.optimise.profiles import GROUP, made_profiles
from geocontact.analyses.shoulder.optimise.read import WorkersAndDevice
from geocontact.analyses.shoulder.optimise.result import FrontPoint, ShoulderOptimiseResult
from geocontact.analyses.shoulder.optimise.sentences import say_held_out, say_profiles, say_simulated
from geocontact.data.errors import InputError
from geocontact.shoulder_exoskeleton.in_cuff import OutOfCuffError
from geocontact.shoulder_exoskeleton.support.arm_scales import scales_of
from geocontact.shoulder_exoskeleton.support.arm_trial import ArmTrial, support_case
from geocontact.shoulder_exoskeleton.support.best_profile import front, scaled, uniform_profile
from geocontact.shoulder_exoskeleton.support.closed_loop_profile import ClosedLoop
from geocontact.shoulder_exoskeleton.support.held_out import HeldOutSupport, Maker, held_out
from geocontact.shoulder_exoskeleton.support.outcome import Factors, SupportOutcome, outcome
from geocontact.shoulder_exoskeleton.support.profile_limits import Limits
from geocontact.shoulder_exoskeleton.support.sensing import Sensing
from geocontact.shoulder_exoskeleton.support.simulated_support import simulated_support

WORST = 0.25
"""Share of the cases that count as the worst."""
CERTAIN = 0.95
"""Share of the draws in which no arm is pushed up, where no reserve makes room for them."""
FORCES = (10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 80.0)
"""Limits of interface force on the front [N]."""
RESERVES = (0.0, 0.1, 0.2)
"""Shares left to the shoulder, a front each."""
OTHERS = "of the others"
T = TypeVar("T")


def run(given: WorkersAndDevice, o: ShoulderOptimiseOptions, record: Record) -> ShoulderOptimiseResult:
    """Profiles, what they do, their fronts, and how they fare with a person held out."""
    certainty = (0.0 if o.reserve else CERTAIN) if o.certainty is None else o.certainty
    limits = Limits(o.force_limit or np.inf, o.rate_limit or np.inf, o.reserve, certainty)
    loop = ClosedLoop(
        given.device, given.support, limits, o.aim, WORST if o.worst_share is None else o.worst_share, seed=o.seed
    )
    made = _found(o, lambda: made_profiles(given, loop, by_arm=o.scale == "arm"))
    judged = _found(o, lambda: _held_out(given, loop, o, record))
    corrected = tuple(
        support_case(each, given.support, transfer=made.group.transfers[each.name]) for each in given.trials
    )
    outcomes = {
        profile.name: {
            case.name: outcome(case, profile.factors)
            for case in corrected
            if set(case.keys) <= set(profile.factors) and case.person in profile.of
        }
        for profile in made.profiles
    }
    points = [
        FrontPoint(force, reserve, profile.value)
        for reserve in RESERVES
        for force, profile in zip(
            FORCES,
            front(corrected, [Limits(force, limits.rate, reserve) for force in FORCES], o.aim, loop.worst_share),
            strict=True,
        )
    ]
    persons = dict.fromkeys(each.person for each in given.trials)
    noisy = {GROUP: _sensed(given, dict.fromkeys(persons, made.group.profile.factors), o)}
    if judged:
        noisy[OTHERS] = _sensed(given, {person: each.factors for person, each in judged.items()}, o)
    result = ShoulderOptimiseResult(
        record=record,
        options=o,
        cases=tuple(support_case(each, given.support) for each in given.trials),
        corrected=corrected,
        elevations={trial.name: trial.elevation for trial in given.trials},
        profiles=made.profiles,
        moments=made.moments,
        scales=made.scales,
        outcomes=outcomes,
        simulated=made.simulated,
        noisy=noisy,
        held_out=judged,
        front=tuple(points),
    )
    taken = say_profiles(record, made, loop, given.trials)
    say_held_out(record, judged, noisy.get(OTHERS, {}))
    left = say_simulated(record, noisy, limits)
    record.results["optimise"] = plain({"device": given.device.name, **taken, "with sensors": left})
    return result


def _found(o: ShoulderOptimiseOptions, what: Callable[[], T]) -> T:
    """What is made of a study; InputError where its arms cannot be simulated, or there is no profile."""
    try:
        return what()
    except OutOfCuffError as error:
        raise InputError(o.study or "", "", error.what, error.cause) from error
    except ArithmeticError as error:
        raise InputError(o.study or "", "", str(error), "check lengths, unit and names of markers") from error


def _held_out(
    given: WorkersAndDevice, loop: ClosedLoop, o: ShoulderOptimiseOptions, record: Record
) -> dict[str, HeldOutSupport]:
    """By person; empty where there is one only."""
    if len({trial.person for trial in given.trials}) == 1:
        record.warn("one person only: nobody can be held out, the profile is for this person")
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


def _sensed(
    given: WorkersAndDevice, factors: Mapping[str, Factors], o: ShoulderOptimiseOptions
) -> dict[str, SupportOutcome]:
    """By case, with each person's factors, the device in closed loop with its noisy, late sensors."""
    return _found(
        o,
        lambda: {
            each.name: simulated_support(each, given.device, factors[each.person], Sensing(), o.seed).outcome
            for each in given.trials
        },
    )
