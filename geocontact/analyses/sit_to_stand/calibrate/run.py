"""Contacts calibrated on all trials at once, phase by phase, the motions certified, and what the trials tell."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from jaxtyping import Float

from geocontact.analyses.page_words import counted
from geocontact.analyses.run_record import Record
from geocontact.analyses.sit_to_stand.calibrate.options import StandingCalibrateOptions
from geocontact.analyses.sit_to_stand.calibrate.result import StandingCalibrateResult
from geocontact.analyses.sit_to_stand.certificate_words import not_certified
from geocontact.analyses.sit_to_stand.standing_trials import StandingUpTrials
from geocontact.analyses.sit_to_stand.trial_result import TrialResult
from geocontact.dynamics.collocation.solve import SolverOptions
from geocontact.standing_up.calibrated_phase import CalibratedPhase, PhaseSearch, calibrated_phase
from geocontact.standing_up.contact_numbers import believed_covariance, held_covariance
from geocontact.standing_up.cost_shares import MOST_OF_IT
from geocontact.standing_up.exoskeleton import strapped
from geocontact.standing_up.feet import FOOT_PARAMETERS, feet_on_ground
from geocontact.standing_up.other_minima import DOUBTFUL
from geocontact.standing_up.phase import PhaseProblem
from geocontact.standing_up.phase_a import TRACKS, phase_a
from geocontact.standing_up.phase_b import phase_b
from geocontact.standing_up.trials import StandingTrial, seen_in

TOLERANCE = 1e-7
Start = Float[np.ndarray, " p"] | None


def run(given: StandingUpTrials, o: StandingCalibrateOptions, record: Record) -> StandingCalibrateResult:
    """Parameters and motions of all trials."""
    with record.listener.stages("calibrating") as stage:
        phases = _phases(given, o, stage)
    last = phases[-1]
    n = last.model.count
    trials = tuple(
        TrialResult(
            recorded=trial,
            model=seen_in(last.model, motion, last.found.p, trial.time, trial.name),
            points=seen_in(last.model, motion, last.found.p, motion.held_times, trial.name),
            acceleration=motion.state(motion.held_times)[:, 2 * n : 3 * n],
            judged=seen,
        )
        for trial, motion, seen in zip(given.trials, last.found.motions, last.motions, strict=True)
    )
    result = StandingCalibrateResult(record=record, options=o, given=given, phases=phases, trials=trials)
    for phase in phases:
        _doubt(record, phase)
    _say(result)
    return result


def _phases(
    given: StandingUpTrials, o: StandingCalibrateOptions, stage: Callable[[str], None]
) -> tuple[CalibratedPhase, ...]:
    """A, and with an exoskeleton B on what A found; only A where its search has no answer."""
    options = SolverOptions("radau", o.degree, 1, TOLERANCE, o.iterations, o.time_limit)
    search = PhaseSearch(options, o.nodes, o.starts, o.resamples, o.seed, o.level, o.profiles)
    if given.exoskeleton:
        model = strapped(given.subject, given.sites, seated=given.seated)
    else:
        model = feet_on_ground(given.subject, seated=given.seated)
    in_a = tuple(name for name in TRACKS if name in given.tracks)

    def told(phase: str) -> Callable[[int, float, float], None]:
        return lambda iteration, objective, residual: stage(
            f"phase {phase}, iteration {iteration}, objective {objective:.5g}, residual {residual:.2g}"
        )

    def build_a(trials: Sequence[StandingTrial], start: Start) -> PhaseProblem:
        return phase_a(model, given.subject, trials, given.noise, free=given.free, tracks=in_a, start=start)

    of_feet = [each.name for each in FOOT_PARAMETERS if each.name not in given.free]
    believed = believed_covariance(model.parameters, of_feet)
    first = calibrated_phase("A", model, given.trials, given.noise, build_a, search, told("A"), believed)
    if not given.exoskeleton or not first.found.solved:
        return (first,)
    feet, straps = first.found.p[: len(FOOT_PARAMETERS)], [name for site in given.sites for name in site.names]

    def build_b(trials: Sequence[StandingTrial], start: Start) -> PhaseProblem:
        strap = None if start is None else start[len(feet) :]
        noise, tracks = given.noise, given.tracks
        return phase_b(model, given.subject, trials, noise, feet, free=straps, tracks=tracks, start=strap)

    known = held_covariance(first.numbers, first.phase.parameters)
    return first, calibrated_phase("B", model, given.trials, given.noise, build_b, search, told("B"), known)


def _doubt(record: Record, one: CalibratedPhase) -> None:
    """Everything that changes how the numbers of a phase are to be read."""
    phase = f"phase {one.name}"
    if not one.found.solved:
        record.warn(f"{phase} ended without an answer: {one.found.ending}; values are those of its last iterate")
    if one.doubt:
        record.warn(f"{phase} has no intervals: {one.doubt}")
    for motion, seen in zip(one.found.motions, one.motions, strict=True):
        if seen.certificate is not None and not seen.certificate.converged:
            record.warn(not_certified(f"{motion.name} in {phase}", seen.certificate))
    at_bound, believed, apart = (
        ", ".join(n.name for n in one.numbers.numbers if n.verdict == verdict)
        for verdict in ("on its bound", "believed", "not separable")
    )
    if at_bound:
        record.warn(f"on its bound, so that the value says where the bound is: {at_bound}")
    if apart:
        words = f"{phase} has another minimum that costs little more and has other values"
        record.warn(f"{words}: not separable, with intervals that cover both: {apart}")
    if one.found.solved and one.misfit > DOUBTFUL:
        record.warn(
            f"{phase} leaves {one.misfit:.1f} times the squares that the noise makes: "
            "the model lacks something, or the noise is larger than said"
        )
    if believed:
        words = f"these trials tell little more than what was believed of {believed}"
        record.warn(f"{words}: their values are mostly the belief's")
    most = max(one.shares, key=lambda name: one.shares[name])
    if one.shares[most] > MOST_OF_IT:
        record.warn(f"{100.0 * one.shares[most]:.1f} % of the cost are {most}: check the noise of the others")
    _compare_starts(record, one)


def _compare_starts(record: Record, one: CalibratedPhase) -> None:
    solved = sum(end.solved for end in one.ends)
    if len(one.ends) < 2 or not solved:
        return
    same = sum(end.same for end in one.ends)
    record.say(f"phase {one.name}: {same} of {len(one.ends)} starts end in the best minimum, {solved} in one")
    if not one.ends[0].same:
        record.warn(f"phase {one.name} from where it starts by itself ends in a minimum that another start beats")


def _say(r: StandingCalibrateResult) -> None:
    record, errors = r.record, r.errors
    numbers = [number for phase in r.phases for number in phase.numbers.numbers if number.verdict != "held"]
    known = [number.name for number in numbers if number.verdict == "known"]
    worst = {}
    straps = errors["quantity"].str.endswith("strap")
    for name, chosen in (("force", errors["unit"] == "N"), ("centre", errors["quantity"] == "centre")):
        worst[name] = errors[chosen & ~straps]["rmsd"].max()
    angle = errors[errors["unit"] == "deg"]["rmsd"].max()
    worn = errors[straps].groupby("quantity", sort=False)["rmsd"].max()
    also = "".join(f", {name} within {off:.1f} N" for name, off in worn.items())
    record.say(
        f"{counted(len(r.trials), 'trial')}: ground reaction within {worst['force']:.1f} N, centre of pressure within "
        f"{worst['centre']:.1f} mm, angles within {angle:.2f}°{also} (largest RMSD of a trial)"
    )
    if r.found.solved:
        seen = [each for phase in r.phases for each in phase.motions]
        passed = sum(each.certificate is not None and each.certificate.converged for each in seen)
        left = max(float(each.force.max()) for each in seen), max(float(each.moment.max()) for each in seen)
        record.say(
            f"{passed} of {counted(len(seen), 'motion')} certified: at most {left[0]:.2g} N and {left[1]:.2g} N m are "
            "left of the balance between the points"
        )
    record.say(f"{len(known)} of {counted(len(numbers), 'parameter')} known: {', '.join(known) or 'none'}")
    for phase in r.phases:
        found = phase.found
        record.results[f"phase {phase.name}"] = {
            "solved": found.solved,
            "ending": found.ending,
            "iterations": found.iterations,
            "cpu_seconds": round(found.seconds, 3),
            "objective": found.objective,
            "misfit": phase.misfit,
            "starts": [{"objective": end.objective, "solved": end.solved, "same": end.same} for end in phase.ends],
            "condition": None if phase.numbers.told_apart is None else phase.numbers.told_apart.condition,
            "sharper_than_believed": phase.numbers.directions.tolist(),
            "cost_shares": phase.shares,
            "parameters": {n.name: n.value for n in phase.numbers.numbers},
        }
