"""What synthetic trials tell of effects: grounds of an elbow moved slowly and fast, and of a strapped-on thigh."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from unittest.mock import patch

import numpy as np
from scipy.stats import ncx2

from geocontact.chain.effect import Candidate
from geocontact.data.diagnosis import NextExperiment
from geocontact.data.gap_case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.effects.catalogue import candidates
from geocontact.gap.attribute import Attribution
from geocontact.gap.case.preparation import problem_of
from geocontact.gap.experiment.menu import menu
from geocontact.gap.experiment.proposal import TELLS, first_of, next_experiment
from geocontact.gap.identifiability.detectability import SURE, detectabilities, power
from geocontact.gap.identifiability.non_identifiable import non_identifiable
from geocontact.gap.identifiability.separability import (
    OneLaw,
    classes,
    confounder_of,
    one_law,
    refitted,
    separation,
    separations,
)
from geocontact.gap.identifiability.signatures import BaseState, at_nats, base_state_of, own_slopes, sized
from geocontact.gap.selection.model_comparison import base_contender, pairs, singles
from geocontact.gap.selection.verdict import Answer
from geocontact.systems.catalogue import system_of
from tests.gap.cases import Late, drifting, elbow_case

LAG = 0.04  # s


def quickened(case: GapCase, times: float) -> GapCase:
    """The same movements and forces in less time."""

    def quick(trial: Trial) -> Trial:
        return replace(trial, signals=replace(trial.signals, time=trial.time / times))

    both = ([quick(t) for t in trials] for trials in (case.calibration, case.evaluation))
    calibration, evaluation = (tuple(each) for each in both)
    return replace(case, calibration=calibration, evaluation=evaluation)


def thigh_case() -> GapCase:
    """One site, a stiffness and an arm; white noise."""
    rng = np.random.default_rng(3)
    names = ("thigh_normal", "thigh_tangential", "thigh_rotation", "thigh_force")
    trials = []
    for k in range(4):
        time = 0.02 * np.arange(150)
        normal = 0.01 + 0.006 * np.sin(2.0 * time + k) + 0.002 * np.sin(5.3 * time)
        rotation = 0.08 * np.sin(1.3 * time + 0.7 * k)
        force = 2500.0 * (normal + 0.03 * rotation) + 0.3 * rng.standard_normal(len(time))
        columns = np.column_stack([normal, 0.004 * np.sin(1.7 * time), rotation, force])
        trials.append(Trial(f"t{k}", Signals(time, columns, names, ("m", "m", "rad", "N"))))
    parameters = (
        Parameter("k_n_thigh", "N/m", 2000.0, 200.0, 9000.0),
        Parameter("rho_thigh", "m", 0.02, -0.1, 0.1),
    )
    fixed = {"b": 0.0}
    return GapCase("c", "sit_to_stand", tuple(trials[:2]), tuple(trials[2:]), parameters, fixed, {"thigh_force": 0.3})


def stood(case: GapCase) -> tuple[BaseState, dict[str, Candidate]]:
    """Ground of a case without an effect, and its candidates by label."""
    problem = problem_of(case, system_of(case))
    base = base_contender(problem).judged
    known = {one.label: one for one in candidates(problem.system) if one.parameters}
    return base_state_of(problem, base.noise, base.model.values), known


def swallowed_shares() -> dict[str, float]:
    """Share of each effect that base parameters imitate, where a search for it sets out; the slow elbow."""
    ground, known = stood(elbow_case(seed=1))
    found = {label: sized(ground, one, {}) for label, one in known.items()}
    return {label: one.absorbed / one.whole for label, one in found.items()}


def lag_against_delay(times: float) -> tuple[float, float]:
    """Nats that a delay and a filter differ by, each as late as the other, on movements so many times as fast."""
    ground, known = stood(quickened(elbow_case(seed=1, duration=16.0 * times), times))
    late = sized(ground, known["time_shift"], {"time_shift.delay": LAG})
    slow = sized(ground, known["filter_lag"], {"filter_lag.lag": LAG, "filter_lag.order": 1.0})
    found = {(each.true, each.confounder): each.nats for each in separations(ground, [late, slow])}
    return found["time_shift", "filter_lag"], found["filter_lag", "time_shift"]


def same_things() -> tuple[dict[tuple[str, str], float], tuple[tuple[str, ...], ...]]:
    """Separations at a strapped-on thigh, and classes."""
    ground, known = stood(thigh_case())
    wanted = [c for c in known.values() if c.name in ("preload", "motion_offset", "sensor_offset", "damping")]
    found = separations(ground, [at_nats(ground, one, 50.0) for one in wanted])
    return {(each.true, each.confounder): each.nats for each in found}, classes(found)


def straight_and_refitted() -> list[tuple[str, str, float, float]]:
    """Separations that were found to first order, and what a bounded refit makes of the same."""
    ground, known = stood(elbow_case(seed=1))
    labels = ("damping", "relaxation", "filter_lag", "preload", "motion_offset.beta", "time_shift")
    others = [confounder_of(ground, known[label]) for label in labels]
    found = []
    for one in (known[label] for label in labels[:3]):
        effect = at_nats(ground, one, 20.0)
        target = ground.moved(one.apply(ground.system), {**ground.values, **effect.values})
        for other in others:
            apart = separation(ground, effect, target, other)
            if apart.way == "linearised":
                fitted = refitted(ground, effect, other, other.starts[0])
                found.append((one.label, other.label, apart.nats, fitted))
    return found


def nats_asked_for() -> list[tuple[float, float]]:
    """Visible nats that were asked for and those that came of it."""
    ground, known = stood(elbow_case(seed=1))
    asked = [(label, nats) for label in ("damping", "dead_zone", "end_stop.upper") for nats in (8.0, 200.0)]
    return [(nats, at_nats(ground, known[label], nats).visible) for label, nats in asked]


def powers() -> list[tuple[float, float]]:
    """Power of seeing a delay where nothing else may gain, drawn and in closed form, over growing delays.

    A delay has one parameter: its gain is half a noncentral chi-square with one degree of freedom, less its price; half
    of what is left of the other sign does not count.
    """
    ground, known = stood(elbow_case(seed=1))
    ground = replace(ground, fitted_rows=len(ground.slopes))  # nothing held out that would have to bear it out
    found = []
    for nats in (2.0, 6.0, 9.0, 14.0, 24.0):
        one = at_nats(ground, known["time_shift"], nats)
        moved = ground.moved(one.candidate.apply(ground.system), {**ground.values, **one.values})
        slope = ground.left(own_slopes(ground, one.candidate, one.values, moved)[:, 0])
        p = one.candidate.parameters[0]
        price = 0.5 * np.log1p((p.upper - p.lower) ** 2 / 12.0 * float(slope @ slope))
        exact = float(ncx2.sf(2.0 * (SURE + price), 1, 2.0 * one.visible))
        found.append((power(ground, one, [], 1), exact))
    return found


def smallest() -> dict[str, tuple[float | None, float, float, float]]:
    """Smallest amplitude of some effects, visible nats there, power there, and power at half of it."""
    ground, known = stood(elbow_case(seed=1))
    asked = [known[label] for label in ("damping", "dead_zone", "sensor_gain.force")]
    found = {}
    for one in detectabilities(ground, asked, asked):
        first = one.candidate.parameters[0]
        less = sized(ground, one.candidate, {**one.at.values, first.name: 0.5 * one.at.amplitude})
        found[one.candidate.label] = (one.smallest, one.at.visible, one.power, power(ground, less, [], 1))
    return found


def proposed(effects: Mapping[str, float] | None, times: float = TELLS) -> NextExperiment | None:
    """What to record next where a delay and a filter are in question, and where nothing was found.

    `times` is how much more the change must promise.
    """
    late = "time_shift" if effects else ""
    case = elbow_case(late, effects, seed=1)
    problem = problem_of(case, system_of(case))
    base = base_contender(problem)
    known = candidates(problem.system)
    if effects:
        competitors = singles(problem, base, [one for one in known if one.name in ("time_shift", "filter_lag")])
        said = Answer("explained", ("time_shift",), {}, ("time_shift", "filter_lag"), competitors[0])
    else:
        competitors, said = [], Answer("no_gap", (), {}, (), base)
    found = Attribution(problem, None, problem, base, tuple(competitors), {}, (), (), {}, (), said)
    names = [each.name for each in non_identifiable(problem, known, ())]
    with patch("geocontact.gap.experiment.proposal.TELLS", times):
        return next_experiment(found, first_of(known, names))


def on_the_menu() -> dict[str, tuple[str, Trial]]:
    """Words and inputs of each change for the slow elbow, and the trial that they are made of."""
    case = elbow_case(seed=1)
    found = {one.name: (one.words, one.trial) for one in menu(system_of(case), case.calibration)}
    return {"as it was": ("", sorted(case.calibration, key=len)[1]), **found}


def attributed(case: GapCase, named: tuple[str, ...], rivals: tuple[str, ...]) -> Attribution:
    """A case of which some effects are named, one or two, and others are in question; the best models of each."""
    problem = problem_of(case, system_of(case))
    base = base_contender(problem)
    known = candidates(problem.system)
    found = singles(problem, base, [one for one in known if one.name in (*named, *rivals)])
    if len(named) == 2:
        offered = [one for one in known if one.name in (*named, *rivals)]
        found = [*found, *pairs(problem, found, offered)]
    order = tuple(sorted(named))
    chosen = max((one for one in found if one.names == order), key=lambda one: one.nats, default=base)
    said = Answer("explained" if named else "no_gap", named, {}, (*named, *rivals), chosen)
    return Attribution(problem, None, problem, base, tuple(found), {}, (), (), {}, (), said)


def laws_of_slow_delay() -> tuple[OneLaw, OneLaw, OneLaw, OneLaw]:
    """Of a delay of slow movements, a filter and damping in question; too many; nothing named; something unknown."""
    found = attributed(elbow_case(seed=1, change=Late(LAG)), ("time_shift",), ("filter_lag", "damping"))
    nobody = Answer("no_gap", (), {}, found.answer.ambiguity, found.base)
    unknown = replace(nobody, verdict="unknown", chosen=found.answer.chosen)
    many = replace(found.answer, verdict="unresolved", effects=())
    law, all_of_them, none, other = (
        one_law(replace(found, answer=each)) for each in (found.answer, many, nobody, unknown)
    )
    return law, all_of_them, none, other


def laws_of_pair() -> OneLaw:
    """Of a delay and a drift, where a filter and damping are in question."""

    def both(name: str, time: np.ndarray, force: np.ndarray) -> np.ndarray:
        return drifting(name, time, Late(LAG)(name, time, force))

    found = attributed(elbow_case(seed=1, change=both), ("sensor_drift", "time_shift"), ("filter_lag", "damping"))
    return one_law(found)


def laws_of_play_and_delay() -> tuple[OneLaw, OneLaw]:
    """Of a play and a delay, a filter in question; the same where the filter is most probable beside something else."""
    play = {"dead_zone.width": 0.002, "dead_zone.share": 1.0}
    case = elbow_case("dead_zone", play, seed=1, change=Late(0.5 * LAG))
    found = attributed(case, ("dead_zone", "time_shift"), ("filter_lag",))
    beside = next(one for one in found.contenders if one.names == ("filter_lag", "time_shift"))
    likely = replace(beside, judged=replace(beside.judged, nats=found.answer.chosen.nats + 1.0))
    return one_law(found), one_law(replace(found, contenders=(*found.contenders, likely)))
