"""What is shown of support profiles: sentences, torques beside the support, page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import contradicted, if_it_fits, judge, reserve, say
from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import NOT_A_DEVICE
from geocontact.analyses.shoulder.simulated_arm import out_of_cuff_words
from geocontact.data.motion import Course
from geocontact.identify.goodness_of_fit import MUCH, Doubt, GoodnessOfFit, of_range, of_verdict
from geocontact.shoulder_exoskeleton.support.arm_trial import ArmTrial
from geocontact.shoulder_exoskeleton.support.best_profile import Aim, measured
from geocontact.shoulder_exoskeleton.support.closed_loop_profile import SLACK, ClosedLoop, SettledProfile
from geocontact.shoulder_exoskeleton.support.group_profiles import GROUP, MadeProfiles
from geocontact.shoulder_exoskeleton.support.held_out import HeldOutSupport
from geocontact.shoulder_exoskeleton.support.outcome import Factors, SupportOutcome
from geocontact.shoulder_exoskeleton.support.phase_machine import SCREW
from geocontact.shoulder_exoskeleton.support.profile_limits import Limits, SupportCase
from geocontact.view.curves.declared import Curve, Curves, CurveSheet, Shade, stroke
from geocontact.view.page.content import Page, Section, Words
from geocontact.view.page.tables import frame_table

MODEL = (
    "Profiles are chosen by linear programs that are corrected by the simulation of every arm until both agree. The "
    "person moves as without the device."
)
LESS = 0.005
"""Share by which a profile of many factors may take less than one factor does, by rounding and by the simulation."""
MOST = 4
"""Tasks and hands whose factors are on the first screen."""
HANDS = {"dominant": 0, "other": 1}
"""Colours of both hands."""


def profile_curves(
    cases: Sequence[SupportCase], elevations: Mapping[str, Float[np.ndarray, " t"]], factors: Factors
) -> CurveSheet:
    """Torque that the shoulder needs (dashed) and support (a line) of both hands, then elevations, a panel per task
    and person; shaded while the controller takes the tool for running.
    """
    by_task: dict[str, list[SupportCase]] = {}
    for case in cases:
        by_task.setdefault(f"{case.person}, {case.task}", []).append(case)
    torques, angles = [], []
    for name, own in by_task.items():
        time = own[0].time
        running = time[own[0].phase == SCREW]
        spans = [Shade("screw-in, as detected", float(running[0]), float(running[-1]))] if len(running) else []
        needed, raised = [], []
        for case in own[:2]:
            hue, hand = HANDS[case.hand], f"{case.hand} hand"
            shown = {"needed": case.needed, "support": case.support(factors)}
            for k, (what, values) in enumerate(shown.items()):
                needed.append(Curve(f"{what}, {hand}", np.interp(time, case.time, values), stroke=stroke(hue, 1 - k)))
            raised.append(
                Curve(
                    f"elevation, {hand}",
                    np.interp(time, case.time, np.degrees(elevations[case.name])),
                    stroke=stroke(hue, 2),
                )
            )
        over = Course("time", "s", time)
        torques.append(Curves(f"Torque of the shoulder and support: {name}", "N m", needed, spans=spans, over=over))
        angles.append(Curves(f"Elevation of the arm: {name}", "deg", raised, spans=spans, over=over))
    return CurveSheet([*torques, *angles], columns=3)


def answer(taken: Mapping[str, float], held: pd.DataFrame) -> list[str]:
    """What the profile takes away, and what is left of it for a person who did not make it.

    `taken` is what `say_profiles` returns, `held` the table of persons held out.
    """
    kept = if_it_fits(" without pushing an arm up")
    best = (
        f"{taken['taken away']:.1%} of the shoulders' torque is taken away{kept}, in the mean over persons; "
        f"one factor for all tasks, hands and phases takes {taken['taken away by one factor']:.1%}."
    )
    found = [best]
    if len(held) and not contradicted():
        shares, gains = (100.0 * held[name] for name in ("taken away [-]", "gain over one factor [-]"))
        sure = int(held["gain beyond the model's error"].sum())
        pushed = int((held["pushed up [-]"] > 0.0).sum())
        up = f"{pushed} of {len(held)} are pushed up" if pushed else "none is pushed up"
        found.append(
            f"For persons who did not make it: {shares.min():.1f} to {shares.max():.1f} %, {gains.min():.1f} to "
            f"{gains.max():.1f} points over one factor; {up}, and the gain is beyond the model's error for {sure} of "
            f"{len(held)}."
        )
    return found


def profile_page(drawn: CurveSheet, tables: Mapping[str, pd.DataFrame], taken: Mapping[str, float]) -> Page:
    """The page of support profiles.

    `drawn` are those of `profile_curves`, `tables` those of the result, `taken` what `say_profiles` returns.
    """
    front = tables["front"]
    limits, reserves, shares = (front[name].to_numpy(float) for name in front.columns)
    curves = [
        Curve(f"reserve {100.0 * reserve:g} %", 100.0 * shares[reserves == reserve]) for reserve in np.unique(reserves)
    ]
    held = tables["held_out"]
    sections: list[Section] = [
        *drawn.panels,
        frame_table("Factors of support", tables["factors"], 2),
        *(
            [frame_table("Factors in proportion to the weight of the arm", tables["scales"], 2)]
            if len(tables["scales"])
            else []
        ),
        *([frame_table("Leave-one-person-out validation: this person held out", held, 3)] if len(held) else []),
        frame_table("Simulated with the device's own motion", tables["simulated"], 3),
        frame_table("What each profile does, as planned around the profile of all persons", tables["outcomes"], 3),
        Curves("Taken away over the limit of interface force", "%", curves),
        INPUTS,
        OPTIONS,
        Words("What the numbers do not contain", [MODEL, NOT_A_DEVICE]),
    ]
    return Page(
        title="Support profile of a shoulder exoskeleton",
        subtitle="Factors by work phase, hand and task that never push the arm up",
        time=np.unique(limits),
        time_label="force limit [N]",
        headline=answer(taken, tables["held_out"]),
        facts=_facts(tables["factors"]),
        sections=tuple(sections),
        plays=False,
    )


def _facts(factors: pd.DataFrame) -> list[tuple[str, str]]:
    """Factors of the first profile, task by task and hand by hand."""
    own = factors[factors["profile"] == factors["profile"].iloc[0]]
    phases = list(own.columns[3:])
    return [
        (f"{row['task']}, {row['hand']} hand: {', '.join(phases)}", ", ".join(f"{row[phase]:.2f}" for phase in phases))
        for row in own.to_dict("records")[:MOST]
    ]


def say_profiles(made: MadeProfiles, loop: ClosedLoop, trials: Sequence[ArmTrial]) -> dict[str, float]:
    """Best and one factor by the aim, and by the mean over persons where that is another measure; all simulated."""
    whose = {
        "mean": "",
        "worst": " of the person who gains least",
        "cvar": f" in the mean of the worst {loop.worst_share:.0%} of the cases",
    }[loop.aim]
    judge(goodness_of(made))
    say(
        f"{made.group.value:.1%} of the shoulders' torque is removed{whose} in the simulation "
        f"({made.group.profile.value:.1%} planned){_kept(loop.limits)}; one factor for all tasks, hands and phases "
        f"takes {made.one.value:.1%}{_out(made.group, made.one)}"
    )
    best, one = (_by(trials, each, "mean") for each in (made.group, made.one))
    if loop.aim != "mean":
        say(f"the mean over persons is {best:.1%}, and {one:.1%} with one factor{_out(made.group, made.one)}")
    taken = {
        "taken away": best,
        "taken away by one factor": one,
        "taken away by the aim": made.group.value,
        "taken away by one factor by the aim": made.one.value,
        "planned by the aim": made.group.profile.value,
    }
    if made.by_arm is not None and len(set(made.scales.values())) > 1:
        taken["taken away by arm weight, by the aim"] = made.by_arm.value
        say(
            f"with factors in proportion to the weight of each person's arm {made.by_arm.value:.1%} is "
            f"removed{whose}{_out(made.by_arm)}"
        )
    return taken


def goodness_of(made: MadeProfiles) -> GoodnessOfFit:
    """Profiles in the simulation against the limits that they were made to keep, and arms against their cuffs.

    The answer is the profile of all persons: if it passes its limits, no arm is kept from being pushed up.
    """
    doubts = []
    for name, found in (("of all persons", made.group), ("of one factor", made.one), ("by arm weight", made.by_arm)):
        if found is not None and found.passed > SLACK:
            what = (
                f"the profile {name} passes its limits by {found.passed:.2f} N m in the simulation, and none was found "
                "that keeps them; `reserve` leaves room"
            )
            doubts.append(Doubt(what, found is made.group, found.passed))
    runs = made.group.runs
    lost = [run for run in runs.values() if run.outcome.out_of_cuff >= MUCH]
    doubts += of_range("the sphere is out of the cuff most of the time in", len(lost) / len(runs), "the simulations")
    if made.group.value < made.one.value - LESS:
        what = f"factors by phase take {made.group.value:.1%}, less than the {made.one.value:.1%} of one factor"
        doubts.append(Doubt(f"{what}: no best profile was found", True))
    return GoodnessOfFit(tuple(doubts), ("limits in the simulation", "spheres in their cuffs", "one factor"))


def _out(*found: SettledProfile) -> str:
    """What a sentence on simulated profiles says besides where a sphere leaves its cuff."""
    return out_of_cuff_words(*(run.outcome.out_of_cuff for each in found for run in each.runs.values()))


def _kept(limits: Limits) -> str:
    if contradicted():
        return ""
    said = " without ever pushing an arm up"
    if limits.certainty > 0.0:
        said += f", nor in {limits.certainty:.0%} of the draws of the model's errors that it was chosen with"
    return said


def _by(trials: Sequence[ArmTrial], found: SettledProfile, aim: Aim) -> float:
    return measured([(each.person, found.runs[each.name].outcome.reduction) for each in trials], aim)


def say_held_out(judged: Mapping[str, HeldOutSupport], simulated: Mapping[str, SupportOutcome]) -> None:
    """Person by person; a gain that pushes the arm up, or may do so within the model's error, is none.

    `simulated` are the same profiles in the simulation, by trial.
    """
    doubts = list[Doubt]()
    for person, found in judged.items():
        out = out_of_cuff_words(*(simulated[name].out_of_cuff for name in found.outcomes if name in simulated))
        low, high = found.gain_interval
        beyond = "beyond the model's error" if found.gain_is_beyond_the_error else "within the model's error"
        if found.pushed_up[0] > 0.0:
            beyond = "no gain, as it pushes the arm up"
        elif found.pushed_up[1] > 0.0:
            beyond = "no sure gain, as it may push the arm up"
        words = f"{100 * low:.1f} to {100 * high:.1f} points"
        doubts += of_verdict(f"{person} held out, the gain over one factor", found.gain_interval, 0.0, words)
        interval = if_it_fits(f" ({100 * low:.1f} to {100 * high:.1f}, {beyond})")
        say(
            f"{person} held out: {found.reduction:.1%}, {100 * found.gain:+.1f} points over one factor of the others"
            f"{interval}; pushed up {found.pushed_up[0]:.1%} of the time, by "
            f"{found.excess[0]:.1f} N m at most; in 95% of the draws of the model's errors up to "
            f"{found.pushed_up[1]:.1%}, by {found.excess[1]:.1f} N m{out}"
        )
        if found.pushed_up[0] > 0.0:
            reserve(
                f"{person}: the profile that the others make pushes an arm up {found.pushed_up[0]:.1%} of the time, by "
                f"{found.excess[0]:.1f} N m at most; `reserve` leaves room"
            )
    if judged:
        judge(GoodnessOfFit(tuple(doubts), tuple(f"{person} held out" for person in judged)))


def say_simulated(noisy: Mapping[str, Mapping[str, SupportOutcome]], limits: Limits) -> float:
    """What noisy, late sensors leave of it; the share that the group's profile takes away with them."""
    for name, found in noisy.items():
        ones = list(found.values())
        share = float(np.mean([each.reduction for each in ones]))
        up, excess = max(each.pushed_up for each in ones), max(each.excess for each in ones)
        force, rate = max(each.force for each in ones), max(each.rate for each in ones)
        said = f"{share:.1%} removed, pushed up {up:.1%} of the time, by {excess:.1f} N m at most, {force:.0f} N"
        if name == GROUP:
            out = out_of_cuff_words(*(each.out_of_cuff for each in ones))
            say(f"simulated with noisy, late sensors: {said} in the cuff{out}")
        for value, limit, what in ((force, limits.force, f"{force:.0f} N"), (rate, limits.rate, f"{rate:.0f} N m/s")):
            if value > limit:
                reserve(f"the profile {name}, simulated, reaches {what} where the limit is {limit:g}")
        if up > 0.0:
            reserve(f"the profile {name}, simulated, pushes an arm up: {said} in the cuff; `reserve` leaves room")
    return float(np.mean([each.reduction for each in noisy[GROUP].values()]))
