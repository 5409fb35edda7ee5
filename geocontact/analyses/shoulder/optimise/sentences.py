"""What is said of support profiles: shares by one measure, what a person held out gets, what sensors leave of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from geocontact.analyses.run_record import Record
from geocontact.analyses.shoulder.optimise.profiles import GROUP, MadeProfiles
from geocontact.analyses.shoulder.reservations import out_of_cuff_words
from geocontact.shoulder_exoskeleton.support.arm_trial import ArmTrial
from geocontact.shoulder_exoskeleton.support.best_profile import Aim, measured
from geocontact.shoulder_exoskeleton.support.closed_loop_profile import SLACK, ClosedLoop, SettledProfile
from geocontact.shoulder_exoskeleton.support.held_out import HeldOutSupport
from geocontact.shoulder_exoskeleton.support.outcome import SupportOutcome
from geocontact.shoulder_exoskeleton.support.profile_limits import Limits


def say_profiles(record: Record, made: MadeProfiles, loop: ClosedLoop, trials: Sequence[ArmTrial]) -> dict[str, float]:
    """Best and one factor by the aim, and by the mean over persons where that is another measure; all simulated."""
    whose = {
        "mean": "",
        "worst": " of the person who gains least",
        "cvar": f" in the mean of the worst {loop.worst_share:.0%} of the cases",
    }[loop.aim]
    record.say(
        f"{made.group.value:.1%} of the shoulders' torque is taken away{whose} in the simulation "
        f"({made.group.profile.value:.1%} planned){_kept(loop.limits)}; one factor for all tasks, hands and phases "
        f"takes {made.one.value:.1%}{_out(made.group, made.one)}"
    )
    best, one = (_by(trials, each, "mean") for each in (made.group, made.one))
    if loop.aim != "mean":
        record.say(
            f"in the mean over persons it is {best:.1%}, and {one:.1%} with one factor{_out(made.group, made.one)}"
        )
    taken = {
        "taken away": best,
        "taken away by one factor": one,
        "taken away by the aim": made.group.value,
        "taken away by one factor by the aim": made.one.value,
        "planned by the aim": made.group.profile.value,
    }
    if made.by_arm is not None and len(set(made.scales.values())) > 1:
        taken["taken away by arm weight, by the aim"] = made.by_arm.value
        record.say(
            f"with factors in proportion to the weight of each person's arm {made.by_arm.value:.1%} is taken "
            f"away{whose}{_out(made.by_arm)}"
        )
    for name, found in (("of all persons", made.group), ("of one factor", made.one), ("by arm weight", made.by_arm)):
        if found is not None and found.passed > SLACK:
            record.warn(
                f"the profile {name} passes its limits by {found.passed:.2f} N m in the simulation, and none was found "
                "that keeps them; `reserve` leaves room"
            )
    return taken


def _out(*found: SettledProfile) -> str:
    """What a sentence on simulated profiles says besides where a sphere leaves its cuff."""
    return out_of_cuff_words(*(run.outcome.out_of_cuff for each in found for run in each.runs.values()))


def _kept(limits: Limits) -> str:
    said = " without ever pushing an arm up"
    if limits.certainty > 0.0:
        said += f", nor in {limits.certainty:.0%} of the draws of the model's errors that it was chosen with"
    return said


def _by(trials: Sequence[ArmTrial], found: SettledProfile, aim: Aim) -> float:
    return measured([(each.person, found.runs[each.name].outcome.reduction) for each in trials], aim)


def say_held_out(record: Record, judged: Mapping[str, HeldOutSupport], simulated: Mapping[str, SupportOutcome]) -> None:
    """Person by person; a gain that pushes the arm up, or may do so within the model's error, is none.

    `simulated` are the same profiles in the simulation, by trial.
    """
    for person, found in judged.items():
        out = out_of_cuff_words(*(simulated[name].out_of_cuff for name in found.outcomes if name in simulated))
        low, high = found.gain_interval
        beyond = "beyond the model's error" if found.gain_is_beyond_the_error else "within the model's error"
        if found.pushed_up[0] > 0.0:
            beyond = "no gain, as it pushes the arm up"
        elif found.pushed_up[1] > 0.0:
            beyond = "no sure gain, as it may push the arm up"
        record.say(
            f"{person} held out: {found.reduction:.1%}, {100 * found.gain:+.1f} points over one factor of the others "
            f"({100 * low:.1f} to {100 * high:.1f}, {beyond}); pushed up {found.pushed_up[0]:.1%} of the time, by "
            f"{found.excess[0]:.1f} N m at most; in 95% of the draws of the model's errors up to "
            f"{found.pushed_up[1]:.1%}, by {found.excess[1]:.1f} N m{out}"
        )
        if found.pushed_up[0] > 0.0:
            record.warn(
                f"{person}: the profile that the others make pushes an arm up {found.pushed_up[0]:.1%} of the time, by "
                f"{found.excess[0]:.1f} N m at most; `reserve` leaves room"
            )


def say_simulated(record: Record, noisy: Mapping[str, Mapping[str, SupportOutcome]], limits: Limits) -> float:
    """What noisy, late sensors leave of it; the share that the group's profile takes away with them."""
    for name, found in noisy.items():
        ones = list(found.values())
        share = float(np.mean([each.reduction for each in ones]))
        up, excess = max(each.pushed_up for each in ones), max(each.excess for each in ones)
        force, rate = max(each.force for each in ones), max(each.rate for each in ones)
        said = f"{share:.1%} taken away, pushed up {up:.1%} of the time, by {excess:.1f} N m at most, {force:.0f} N"
        if name == GROUP:
            out = out_of_cuff_words(*(each.out_of_cuff for each in ones))
            record.say(f"simulated with noisy, late sensors: {said} in the cuff{out}")
        for value, limit, what in ((force, limits.force, f"{force:.0f} N"), (rate, limits.rate, f"{rate:.0f} N m/s")):
            if value > limit:
                record.warn(f"the profile {name}, simulated, reaches {what} where the limit is {limit:g}")
        if up > 0.0:
            record.warn(f"the profile {name}, simulated, pushes an arm up: {said} in the cuff; `reserve` leaves room")
    return float(np.mean([each.reduction for each in noisy[GROUP].values()]))
