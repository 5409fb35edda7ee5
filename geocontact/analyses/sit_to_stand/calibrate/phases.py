"""Phases of a calibration: searched on all trials at once, what makes their numbers doubtful, and tables."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import reserve, say
from geocontact.analyses.sit_to_stand.calibrate.options import StandingCalibrateOptions
from geocontact.analyses.sit_to_stand.trial_tables import certificate_rows, not_certified
from geocontact.dynamics.collocation.solve import SolverOptions
from geocontact.standing_up.calibrated_phase import DOUBTFUL, CalibratedPhase, PhaseSearch
from geocontact.standing_up.calibration import calibrated_phases
from geocontact.standing_up.chain import FOOT_PARAMETERS
from geocontact.standing_up.contact_numbers import ContactNumber
from geocontact.standing_up.phase import MOST_OF_IT
from geocontact.standing_up.trials import StandingUpTrials

TOLERANCE = 1e-7


def phases_sought(
    given: StandingUpTrials, o: StandingCalibrateOptions, stage: Callable[[str], None]
) -> tuple[CalibratedPhase, ...]:
    """A, and with an exoskeleton B, as the options have it."""
    options = SolverOptions("radau", o.degree, 1, TOLERANCE, o.iterations, o.time_limit)
    search = PhaseSearch(options, o.nodes, o.starts, o.resamples, o.seed, o.level, o.profiles, o.select)

    def tell(phase: str, iteration: int, objective: float, residual: float) -> None:
        stage(f"phase {phase}, iteration {iteration}, objective {objective:.5g}, residual {residual:.2g}")

    return calibrated_phases(given, search, tell)


def doubt_phase(one: CalibratedPhase) -> None:
    """Everything that changes how the numbers of a phase are to be read."""
    phase = f"phase {one.name}"
    if not one.found.solved:
        reserve(f"{phase} did not converge: {one.found.ending}; values are from its last iterate")
    if one.doubt:
        reserve(f"{phase} has no intervals: {one.doubt}")
    for motion, seen in zip(one.found.motions, one.motions, strict=True):
        if seen.certificate is not None and not seen.certificate.converged:
            reserve(not_certified(f"{motion.name} in {phase}", seen.certificate))
    if one.found.solved and one.misfit > DOUBTFUL:
        reserve(
            f"{phase} leaves {one.misfit:.1f} times the sum of squares that the noise explains: the model lacks an "
            "effect, or the noise is larger than stated"
        )
    _doubt_verdicts(one)
    most = max(one.shares, key=lambda name: one.shares[name])
    if one.shares[most] > MOST_OF_IT:
        reserve(f"{100.0 * one.shares[most]:.1f} % of the cost are {most}: check the noise of the others")
    _compare_starts(one)


def _doubt_verdicts(one: CalibratedPhase) -> None:
    """Parameters whose values come of something else than the trials."""
    at_bound, by_prior, apart, untested = (
        ", ".join(n.name for n in one.numbers.numbers if n.verdict == verdict)
        for verdict in ("on its bound", "prior-dominated", "not separable", "untested")
    )
    if at_bound:
        reserve(f"at a bound, so the value only reflects the bound: {at_bound}")
    if apart:
        words = f"phase {one.name} has another minimum that costs little more and has other values"
        reserve(f"{words}: not separable, with intervals that cover both: {apart}")
    if by_prior:
        words = f"these trials add little to the prior of {by_prior}"
        reserve(f"{words}: their values come mostly from the prior")
    if untested:
        words = "no force of the ground was recorded: coordinates and their stated noise alone say"
        reserve(f"{words} {untested}: untested; plates under the feet would test it")


def _compare_starts(one: CalibratedPhase) -> None:
    solved = sum(end.solved for end in one.ends)
    if len(one.ends) < 2 or not solved:
        return
    same = sum(end.same for end in one.ends)
    say(f"phase {one.name}: {same} of {len(one.ends)} starts end in the lowest minimum, {solved} converge")
    if not one.ends[0].same:
        reserve(f"phase {one.name} from its default start ends in a minimum worse than that of another start")


def parameters_table(phases: Sequence[CalibratedPhase]) -> pd.DataFrame:
    """Value and interval in SI, and standard deviations of what is searched: lengths in m, others as logarithms."""
    rows = [
        {
            "phase": phase.name,
            "parameter": n.name,
            "unit": n.unit,
            "value": n.value,
            "lower": n.lower,
            "upper": n.upper,
            "sd prior": n.before,
            "sd with the trials": n.after if np.isfinite(n.after) else np.nan,
            "sd of what is assumed": n.assumed,
            "verdict": n.verdict,
        }
        for phase in phases
        for n in _own(phase)
    ]
    return pd.DataFrame(rows)


def _own(phase: CalibratedPhase) -> list[ContactNumber]:
    """Numbers of the feet in phase A, those of the strap in phase B."""
    feet = {each.name for each in FOOT_PARAMETERS}
    return [n for n in phase.numbers.numbers if (n.name in feet) == (phase.name == "A")]


def correlation_table(phases: Sequence[CalibratedPhase]) -> pd.DataFrame:
    """Correlation of the estimates of the parameters that were sought, phase by phase."""
    parts = []
    for phase in phases:
        n = phase.numbers
        columns = {name: n.correlation[:, k] for k, name in enumerate(n.names)}
        parts.append(pd.DataFrame({"phase": phase.name, "parameter": list(n.names), **columns}))
    return pd.concat(parts, ignore_index=True)


def profile_table(phases: Sequence[CalibratedPhase]) -> pd.DataFrame:
    """Rise of minus twice the log posterior where a parameter is held beside its best; 3.84 ends 95 %."""
    parts = [
        pd.DataFrame(
            {
                "phase": phase.name,
                "parameter": each.name,
                "unit": each.unit,
                "distance in sd [-]": each.distance,
                "value": each.places,
                "rise [-]": each.rise,
            }
        )
        for phase in phases
        for each in phase.profiles
    ]
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()


def selection_table(phases: Sequence[CalibratedPhase]) -> pd.DataFrame:
    """Information of the trials on every candidate, in parts of its prior's, and which are identified together."""
    rows = [
        {
            "phase": phase.name,
            "parameter": each.name,
            "turn": each.turn,
            "information alone [-]": each.alone,
            "information beside [-]": each.beside,
            "selection": f"coupled with {each.partner}" if each.partner else each.outcome,
            "free": "yes" if each.name in phase.phase.free else "no",
        }
        for phase in phases
        for each in phase.selection
    ]
    columns = ["phase", "parameter", "turn", "information alone [-]", "information beside [-]", "selection", "free"]
    return pd.DataFrame(rows, columns=columns)


def say_selection(one: CalibratedPhase, asked: bool) -> None:
    """What was selected, or why nothing was."""
    chosen = {each.name for each in one.selection if each.outcome == "identified"}
    if asked and chosen:
        held = ", ".join(each.name for each in one.selection if each.name not in chosen)
        say(
            f"phase {one.name} frees what its trials identify together: {len(chosen)} of {len(one.selection)}"
            + (f", not {held}" if held else "")
        )
    elif asked and one.unselected:
        reserve(f"phase {one.name}: no parameters are selected: {one.unselected}; the usual ones are free")
    elif asked:
        reserve(f"phase {one.name}: its trials identify no parameter, so that the usual ones are free")


def certificate_table(phases: Sequence[CalibratedPhase]) -> pd.DataFrame:
    """What lies between and beyond the points of the motions of all phases."""
    rows = []
    for phase in phases:
        rows += certificate_rows(phase.name, [motion.name for motion in phase.found.motions], phase.motions)
    return pd.DataFrame(rows)
