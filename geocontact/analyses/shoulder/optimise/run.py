"""The best support profile for a group, for each person, and for persons that it was not made with."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from geocontact.analyses.json_file import plain
from geocontact.analyses.run_record import Record
from geocontact.analyses.shoulder.optimise.options import ShoulderOptimiseOptions
from geocontact.analyses.shoulder.optimise.read import WorkersAndDevice
from geocontact.analyses.shoulder.optimise.result import FrontPoint, NamedProfile, ShoulderOptimiseResult
from geocontact.data.errors import InputError
from geocontact.shoulder_exoskeleton.support.arm_trial import support_case
from geocontact.shoulder_exoskeleton.support.best_profile import (
    Limits,
    SupportProfile,
    best_profile,
    front,
    uniform_profile,
)
from geocontact.shoulder_exoskeleton.support.held_out import HeldOutSupport, Maker, held_out
from geocontact.shoulder_exoskeleton.support.outcome import TABLE_3, Factors, SupportOutcome, outcome
from geocontact.shoulder_exoskeleton.support.sensing import Sensing
from geocontact.shoulder_exoskeleton.support.simulated_support import simulated_support
from geocontact.shoulder_exoskeleton.support.support_case import SupportCase

WORST = 0.25
"""Share of the cases that count as the worst."""
FORCES = (10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 80.0)
"""Limits of interface force on the front [N]."""
RESERVES = (0.0, 0.1, 0.2)
"""Shares left to the shoulder, a front each."""
GROUP, ONE_FACTOR, PAPER = "all persons", "one factor", "table 3 of the paper"
OTHERS = "of the others"


def run(given: WorkersAndDevice, o: ShoulderOptimiseOptions, record: Record) -> ShoulderOptimiseResult:
    """Profiles, what they do, their fronts, and how they fare with a person held out."""
    cases = [support_case(trial, given.support) for trial in given.trials]
    limits = Limits(o.force_limit or np.inf, o.rate_limit or np.inf, o.reserve)
    share = WORST if o.worst_share is None else o.worst_share

    def make(of: Sequence[SupportCase]) -> SupportProfile:
        return best_profile(of, limits, o.aim, share)

    def one_factor(of: Sequence[SupportCase]) -> SupportProfile:
        return uniform_profile(of, limits)

    best, uniform = make(cases), one_factor(cases)
    persons = tuple(dict.fromkeys(case.person for case in cases))
    profiles = [NamedProfile(GROUP, best.factors), NamedProfile(ONE_FACTOR, uniform.factors)]
    if set(best.factors) <= set(TABLE_3):
        profiles.append(NamedProfile(PAPER, {key: TABLE_3[key] for key in best.factors}))
    alone = [(person, make([case for case in cases if case.person == person])) for person in persons]
    profiles += [NamedProfile(f"{person} alone", profile.factors) for person, profile in alone]
    judged = _held_out(given, o, record, make, one_factor)
    outcomes = {
        profile.name: {
            case.name: outcome(case, profile.factors) for case in cases if set(case.keys) <= set(profile.factors)
        }
        for profile in profiles
    }
    points = [
        FrontPoint(force, reserve, profile.value)
        for reserve in RESERVES
        for force, profile in zip(
            FORCES, front(cases, [Limits(force, limits.rate, reserve) for force in FORCES], o.aim), strict=True
        )
    ]
    led = {GROUP: _simulated(given, {case.person: best.factors for case in cases}, o)}
    if judged:
        led[OTHERS] = _simulated(given, {person: each.factors for person, each in judged.items()}, o)
    result = ShoulderOptimiseResult(
        record=record,
        options=o,
        cases=tuple(cases),
        elevations={trial.name: trial.elevation for trial in given.trials},
        profiles=tuple(profiles),
        outcomes=outcomes,
        simulated=led,
        held_out=judged,
        front=tuple(points),
    )
    _say(record, best, uniform, judged)
    left = _say_simulated(record, led, limits)
    record.results["optimise"] = plain(
        {
            "device": given.device.name,
            "taken away": best.value,
            "taken away by one factor": uniform.value,
            "taken away, simulated": left,
        }
    )
    return result


def _held_out(
    given: WorkersAndDevice, o: ShoulderOptimiseOptions, record: Record, make: Maker, one_factor: Maker
) -> dict[str, HeldOutSupport]:
    """By person; empty where there is one only."""
    if len({trial.person for trial in given.trials}) == 1:
        record.warn("one person only: nobody can be held out, the profile is for this person")
        return {}
    try:
        return held_out(given.trials, given.support, make, one_factor, draws=o.draws, seed=o.seed)
    except KeyError as error:
        what = "a task is of one person only: no profile that the others make has a factor for it"
        raise InputError(o.study or "", "", what, "let every person do every task") from error


def _simulated(
    given: WorkersAndDevice, factors: Mapping[str, Factors], o: ShoulderOptimiseOptions
) -> dict[str, SupportOutcome]:
    """By case, with each person's factors, the device in closed loop with its sensors."""
    found = {}
    for trial in given.trials:
        try:
            one = simulated_support(trial, given.device, factors[trial.person], Sensing(), o.seed)
        except ArithmeticError as error:
            raise InputError(
                o.study or "", trial.name, str(error), "check lengths, unit and names of markers"
            ) from error
        found[trial.name] = one.outcome
    return found


def _say(record: Record, best: SupportProfile, uniform: SupportProfile, judged: dict[str, HeldOutSupport]) -> None:
    record.say(
        f"{best.value:.1%} of the shoulders' torque is taken away without ever pushing an arm up, as the human "
        f"elevation has it; one factor for all tasks, hands and phases takes {uniform.value:.1%}"
    )
    for person, found in judged.items():
        low, high = found.gain_interval
        beyond = "beyond the model's error" if found.gain_is_beyond_the_error else "within the model's error"
        if found.pushed_up[0] > 0.0:
            beyond = "no gain, as it pushes the arm up"
        record.say(
            f"{person} held out: {found.reduction:.1%}, {100 * found.gain:+.1f} points over one factor of the others "
            f"({100 * low:.1f} to {100 * high:.1f}, {beyond}); pushed up {found.pushed_up[0]:.1%} of the time, by "
            f"{found.excess[0]:.1f} N m at most"
        )
        if found.pushed_up[0] > 0.0:
            record.warn(
                f"{person}: the profile that the others make pushes an arm up {found.pushed_up[0]:.1%} of the time, by "
                f"{found.excess[0]:.1f} N m at most; `reserve` leaves room"
            )


def _say_simulated(record: Record, led: Mapping[str, Mapping[str, SupportOutcome]], limits: Limits) -> float:
    """What the simulation leaves of it; the share that the group's profile takes away there."""
    for name, found in led.items():
        ones = list(found.values())
        share = float(np.mean([each.reduction for each in ones]))
        up, excess = max(each.pushed_up for each in ones), max(each.excess for each in ones)
        force, rate = max(each.force for each in ones), max(each.rate for each in ones)
        told = f"{share:.1%} taken away, pushed up {up:.1%} of the time, by {excess:.1f} N m at most, {force:.0f} N"
        if name == GROUP:
            record.say(f"simulated with the device's own motion and sensors: {told} in the cuff")
        for value, limit, what in ((force, limits.force, f"{force:.0f} N"), (rate, limits.rate, f"{rate:.0f} N m/s")):
            if value > limit:
                record.warn(f"the profile {name}, simulated, reaches {what} where the limit is {limit:g}")
        if up > 0.0:
            record.warn(f"the profile {name}, simulated, pushes an arm up: {told} in the cuff; `reserve` leaves room")
    return float(np.mean([each.reduction for each in led[GROUP].values()]))
