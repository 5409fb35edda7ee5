"""Contacts calibrated on all trials at once, the motions certified, and what the trials tell of each parameter."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from geocontact.analyses.page_words import counted
from geocontact.analyses.run_record import Record
from geocontact.analyses.sit_to_stand.calibrate.options import StandingCalibrateOptions
from geocontact.analyses.sit_to_stand.calibrate.read import StandingTrials
from geocontact.analyses.sit_to_stand.calibrate.result import StandingCalibrateResult
from geocontact.analyses.sit_to_stand.trial_result import TrialResult
from geocontact.dynamics.collocation.solve import CollocationResult, SolverOptions, solve
from geocontact.standing_up.chain import JOINTS, TURNING
from geocontact.standing_up.contact_numbers import ContactNumbers, contact_numbers, unsettled_numbers
from geocontact.standing_up.cost_shares import MOST_OF_IT, cost_shares
from geocontact.standing_up.feet import FOOT_PARAMETERS, feet_on_ground
from geocontact.standing_up.judged import judged
from geocontact.standing_up.phase import PhaseProblem
from geocontact.standing_up.phase_a import phase_a
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.trials import N, seen_in

TOLERANCE = 1e-7
SAME = 1e-3
"""Of the cost: starts that come so near to the best found the same minimum."""
INTERRUPTED = "interrupted"


def run(given: StandingTrials, o: StandingCalibrateOptions, record: Record) -> StandingCalibrateResult:
    """Parameters and motions of all trials."""
    feet = feet_on_ground(given.subject)
    with record.listener.stages("calibrating") as stage:
        phase, found = _searched(given, o, feet, record, stage)
        stage("judging the motions")
        settled = found.solved
        motions = judged(feet.equations, range(len(JOINTS)), TURNING, phase, found, certify=settled)
        numbers = _numbers(phase, found, o, record)
    trials = tuple(
        TrialResult(
            recorded=trial,
            model=seen_in(feet, motion, found.p, trial.time, trial.name),
            acceleration=motion.state(trial.time)[:, 2 * N : 3 * N],
            torque=motion.control(trial.time)[:, N:],
            judged=seen,
        )
        for trial, motion, seen in zip(given.trials, found.motions, motions, strict=True)
    )
    result = StandingCalibrateResult(
        record=record,
        options=o,
        given=given,
        found=found,
        numbers=numbers,
        trials=trials,
        shares=cost_shares(phase, found),
    )
    _doubt(result)
    _say(result)
    return result


def _searched(
    given: StandingTrials,
    o: StandingCalibrateOptions,
    feet: StandingModel,
    record: Record,
    stage: Callable[[str], None],
) -> tuple[PhaseProblem, CollocationResult]:
    """The best of all starts; the first is what is believed."""
    rng = np.random.default_rng(o.seed)
    sd = np.array([each.sd for each in FOOT_PARAMETERS])
    options = SolverOptions("radau", o.degree, 1, TOLERANCE, o.iterations, o.time_limit)
    meshes = tuple(np.linspace(0.0, 1.0, round(o.nodes * float(t.time[-1])) + 1) for t in given.trials)
    ends: list[tuple[PhaseProblem, CollocationResult]] = []
    for k in range(o.starts + 1):
        phase = _phase(given, feet, None)
        if k:
            phase = _phase(given, feet, phase.control.guess_p + sd * rng.normal(size=len(sd)))

        def told(iteration: int, objective: float, residual: float, k: int = k) -> None:
            start = f"start {k + 1} of {o.starts + 1}, " if o.starts else ""
            stage(f"{start}iteration {iteration}, objective {objective:.5g}, residual {residual:.2g}")

        ends.append((phase, solve(phase.control, options, meshes=meshes, progress=told)))
        if ends[-1][1].ending.startswith(INTERRUPTED):
            break
    solved = [end for end in ends if end[1].solved]
    best = min(solved or ends, key=lambda end: end[1].objective)
    if o.starts and solved:
        _say_of_starts(record, [end[1].objective for end in ends], [end[1].solved for end in ends])
    return best


def _phase(given: StandingTrials, feet: StandingModel, start: np.ndarray | None) -> PhaseProblem:
    return phase_a(feet, given.subject, given.trials, given.noise, free=given.free, tracks=given.tracks, start=start)


def _say_of_starts(record: Record, objectives: list[float], solved: list[bool]) -> None:
    best = min(value for value, ended in zip(objectives, solved, strict=True) if ended)
    same = [ended and value <= best * (1.0 + SAME) for value, ended in zip(objectives, solved, strict=True)]
    record.say(f"{sum(same)} of {len(objectives)} starts end in the best minimum, {sum(solved)} in a minimum")
    if not same[0]:
        record.warn("the search from what is believed ends in a minimum that another start beats; the best is taken")


def _numbers(
    phase: PhaseProblem, found: CollocationResult, o: StandingCalibrateOptions, record: Record
) -> ContactNumbers:
    if not found.solved:
        return unsettled_numbers(phase, found)
    try:
        return contact_numbers(phase, found, o.level)
    except ValueError as error:
        record.warn(f"no intervals: {error}")
        return unsettled_numbers(phase, found)


def _doubt(r: StandingCalibrateResult) -> None:
    """Everything that changes how the numbers are to be read."""
    record = r.record
    if not r.found.solved:
        record.warn(f"the search ended without an answer: {r.found.ending}; values are those of its last iterate")
    for trial in r.trials:
        seen = trial.judged.certificate
        if seen is not None and not seen.converged:
            record.warn(f"{trial.recorded.name} is not certified: {'; '.join(seen.failed)}; give more `nodes`")
    at_bound, believed = (
        ", ".join(n.name for n in r.numbers.numbers if n.verdict == verdict) for verdict in ("on its bound", "believed")
    )
    if at_bound:
        record.warn(f"on its bound, so that the value says where the bound is: {at_bound}")
    if believed:
        words = f"these trials tell little more than what was believed of {believed}"
        record.warn(f"{words}: their values are mostly the belief's")
    most = max(r.shares, key=lambda name: r.shares[name])
    if r.shares[most] > MOST_OF_IT:
        record.warn(f"{100.0 * r.shares[most]:.1f} % of the cost are {most}: check the noise of the others")


def _say(r: StandingCalibrateResult) -> None:
    record, errors = r.record, r.errors
    known = [n for n in r.numbers.numbers if n.verdict == "known"]
    sought = [n for n in r.numbers.numbers if n.verdict != "held"]
    force = max(errors[errors["quantity"].str.startswith("force")]["rmsd"])
    centre = max(errors[errors["quantity"] == "centre"]["rmsd"])
    angle = max(errors[errors["unit"] == "deg"]["rmsd"])
    record.say(
        f"{counted(len(r.trials), 'trial')}: ground reaction within {force:.1f} N, centre of pressure within "
        f"{centre:.1f} mm, angles within {angle:.2f}° (largest RMSD of a trial)"
    )
    if r.found.solved:
        passed = [t.judged.certificate is not None and t.judged.certificate.converged for t in r.trials]
        worst = max(float(t.judged.force.max()) for t in r.trials), max(float(t.judged.moment.max()) for t in r.trials)
        record.say(
            f"{sum(passed)} of {counted(len(passed), 'motion')} certified: at most {worst[0]:.2g} N and "
            f"{worst[1]:.2g} N m are left of the balance between the points"
        )
    names = ", ".join(n.name for n in known) or "none"
    record.say(f"{len(known)} of {counted(len(sought), 'parameter')} known: {names}")
    record.say(f"{r.found.ending} after {counted(r.found.iterations, 'iteration')}, {r.found.seconds:.1f} s")
    record.results["calibrate"] = {
        "solved": r.found.solved,
        "ending": r.found.ending,
        "iterations": r.found.iterations,
        "cpu_seconds": round(r.found.seconds, 3),
        "objective": r.found.objective,
        "condition": None if r.numbers.told_apart is None else r.numbers.told_apart.condition,
        "sharper_than_believed": r.numbers.directions.tolist(),
        "cost_shares": r.shares,
        "parameters": {n.name: n.value for n in r.numbers.numbers},
    }
