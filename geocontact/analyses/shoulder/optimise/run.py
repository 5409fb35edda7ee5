"""The best support profile for a group, for each person, and for persons that it was not made with."""

from __future__ import annotations

from collections.abc import Sequence

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
from geocontact.shoulder_exoskeleton.support.held_out import HeldOutSupport, held_out
from geocontact.shoulder_exoskeleton.support.outcome import TABLE_3, outcome
from geocontact.shoulder_exoskeleton.support.support_case import SupportCase

WORST = 0.25
"""Share of the cases that count as the worst."""
FORCES = (10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 80.0)
"""Limits of interface force on the front [N]."""
RESERVES = (0.0, 0.1, 0.2)
"""Shares left to the shoulder, a front each."""
GROUP, ONE_FACTOR, PAPER = "all persons", "one factor", "table 3 of the paper"


def run(given: WorkersAndDevice, o: ShoulderOptimiseOptions, record: Record) -> ShoulderOptimiseResult:
    """Profiles, what they do, their fronts, and how they fare with a person held out."""
    cases = [support_case(trial, given.support) for trial in given.trials]
    limits = Limits(o.force_limit or np.inf, o.rate_limit or np.inf, o.reserve)
    share = WORST if o.worst_share is None else o.worst_share

    def make(of: Sequence[SupportCase]) -> SupportProfile:
        return best_profile(of, limits, o.aim, share)

    best, uniform = make(cases), uniform_profile(cases, limits)
    persons = tuple(dict.fromkeys(case.person for case in cases))
    profiles = [NamedProfile(GROUP, best.factors), NamedProfile(ONE_FACTOR, uniform.factors)]
    if set(best.factors) <= set(TABLE_3):
        profiles.append(NamedProfile(PAPER, {key: TABLE_3[key] for key in best.factors}))
    alone = [(person, make([case for case in cases if case.person == person])) for person in persons]
    profiles += [NamedProfile(f"{person} alone", profile.factors) for person, profile in alone]
    judged: dict[str, HeldOutSupport] = {}
    if len(persons) > 1:
        try:
            judged = held_out(given.trials, given.support, make, uniform.factors, draws=o.draws, seed=o.seed)
        except KeyError as error:
            what = "a task is of one person only: no profile that the others make has a factor for it"
            raise InputError(o.study or "", "", what, "let every person do every task") from error
    else:
        record.warn("one person only: nobody can be held out, the profile is for this person")
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
    result = ShoulderOptimiseResult(
        record=record,
        options=o,
        cases=tuple(cases),
        elevations={trial.name: trial.elevation for trial in given.trials},
        profiles=tuple(profiles),
        outcomes=outcomes,
        held_out=judged,
        front=tuple(points),
    )
    _say(record, best, uniform, judged)
    record.results["optimise"] = plain(
        {"device": given.device.name, "taken away": best.value, "taken away by one factor": uniform.value}
    )
    return result


def _say(record: Record, best: SupportProfile, uniform: SupportProfile, judged: dict[str, HeldOutSupport]) -> None:
    record.say(
        f"{best.value:.1%} of the shoulders' torque is taken away without ever pushing an arm up; one factor for all "
        f"tasks, hands and phases takes {uniform.value:.1%}"
    )
    for person, found in judged.items():
        low, high = found.gain_interval
        beyond = "beyond" if found.gain_is_beyond_the_error else "within"
        record.say(
            f"{person} held out: {found.reduction:.1%}, {100 * found.gain:+.1f} points over one factor "
            f"({100 * low:.1f} to {100 * high:.1f}, {beyond} the model's error); pushed up {found.pushed_up[0]:.1%} of "
            f"the time, by {found.excess[0]:.1f} N m at most"
        )
        if found.pushed_up[0] > 0.0:
            record.warn(
                f"{person}: the profile that the others make pushes an arm up {found.pushed_up[0]:.1%} of the time, by "
                f"{found.excess[0]:.1f} N m at most; `reserve` leaves room"
            )
