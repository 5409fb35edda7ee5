"""One phase solved: the best of several starts, corrected by what resampled trials show, its motions certified.

One start, and one more where its answer can be doubted (`other_minima`).

Laplace's interval knows the minimum that the search ended in and no other. On trials that another model made (own
Lagrangian, feedback at every joint) phase A ends in one of two: one with the modulus on its bound and the lowest points
at 80 mm, the other with both inside, 12 lower in minus twice the log posterior of 18455. Where a model fits, such a
difference would settle it; where it does not, squares count for too much, and differences are divided by `misfit` as
uncertainties are multiplied by its root elsewhere (Birge (1932), The calculation of errors by the method of least
squares, Phys Rev 40, 207-227).

So a phase is solved once more, from the prior, where its answer can be doubted: a number that is sought ends on
its bound, or the misfit is larger than `DOUBTFUL`. The least of both is the answer. Another minimum within `RIVAL` of
it stays possible: a number that it puts outside the interval is not separable, and the interval covers both.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.special import ndtri

from geocontact.dynamics.collocation.solve import CollocationResult, Progress, SolverOptions, refined, solve
from geocontact.standing_up.contact_numbers import (
    WITH_INTERVAL,
    Build,
    ContactNumber,
    ContactNumbers,
    Solve,
    contact_numbers,
    corrected,
    on_their_bounds,
    resampled,
    unsettled_numbers,
)
from geocontact.standing_up.phase import RATE, JudgedMotion, PhaseProblem, cost_shares, judged
from geocontact.standing_up.profile import PhaseProfile, profiles
from geocontact.standing_up.selection import SelectedParameter
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.strap_sites import ContactParameter, usual
from geocontact.standing_up.trials import StandingNoise, StandingTrial

DOUBTFUL = 1.2
"""Misfit above which the answer is sought again. Synthetic trials of the model itself have 0.83 to 0.84, those of
another one 1.7 to 2.0."""
RIVAL = 10.0
"""Rise of minus twice the log posterior, in parts of the misfit, below which another minimum stays possible: its height
is e^-5 of the best one's, 0.7 %."""
SAME_PLACE = 0.01
"""Share of the prior: parameters that come so near are those of one minimum."""


@dataclass(frozen=True)
class Ended:
    """How the search from one start ended.

    Parameters
    ----------
    objective
        Cost there.
    same
        Whether it is the minimum that was taken.
    """

    objective: float
    solved: bool
    same: bool


def misfit(
    model: StandingModel, trials: Sequence[StandingTrial], phase: PhaseProblem, found: CollocationResult
) -> float:
    """Least cost in parts of what noise alone would make of it.

    As many squares count as are recorded: those of the jerk are as many as the motion has free values.
    """
    n, squares = model.count, 0.0
    widths = {"coordinates": n, "rates": n, "force": 2, "centre": 1, "torque": n - 3}
    for trial in trials:
        width = sum(widths.get(name, 0) for name in phase.terms)
        if "strap" in phase.terms and trial.straps is not None:
            width += int(np.isfinite(trial.straps).all(axis=0).sum())
        squares += width * float(np.ptp(trial.time)) * trial.rate
    return RATE * found.objective / squares


def doubtful(phase: PhaseProblem, found: CollocationResult, misfits: float) -> bool:
    """Whether the answer is to be sought from another start, where anything is."""
    low, high = phase.control.p
    return bool((low < high).any() and (on_their_bounds(phase, found.p).any() or misfits > DOUBTFUL))


def ended(
    phase: PhaseProblem, runs: Sequence[tuple[PhaseProblem, CollocationResult]], best: CollocationResult
) -> tuple[Ended, ...]:
    """Every start's end; the first is the search's own."""
    return tuple(Ended(run.objective, run.solved, run.solved and _same(phase, run, best)) for _, run in runs)


def rivals(
    phase: PhaseProblem,
    runs: Sequence[tuple[PhaseProblem, CollocationResult]],
    best: CollocationResult,
    misfits: float,
) -> tuple[Float[np.ndarray, " p"], ...]:
    """Parameters of the other minima that stay possible."""
    most = RIVAL * max(1.0, misfits) / RATE
    near = [run for _, run in runs if run.solved and run.objective - best.objective <= most]
    return tuple(run.p for run in near if not _same(phase, run, best))


def beside_rivals(
    numbers: ContactNumbers,
    phase: PhaseProblem,
    p: Float[np.ndarray, " p"],
    others: Sequence[Float[np.ndarray, " p"]],
    level: float,
) -> ContactNumbers:
    """Numbers of the minimum at `p`, those that another minimum has outside their interval as not separable.

    The interval then has both, each as wide as it was, but no value of the other that is out of bounds; the standard
    deviation is that of an interval so wide.
    """
    reach = float(ndtri(0.5 + 0.5 * level))
    told = []
    for k, (of, number) in enumerate(zip(phase.parameters, numbers.numbers, strict=True)):
        off = [float(other[k] - p[k]) for other in others]
        out = number.verdict in WITH_INTERVAL and max(map(abs, off), default=0.0) > reach * number.after
        told.append(_with_rivals(of, number, off, reach) if out else number)
    return replace(numbers, numbers=tuple(told))


def _with_rivals(of: ContactParameter, number: ContactNumber, off: Sequence[float], reach: float) -> ContactNumber:
    best, half = of.searched(number.value), reach * number.after
    least, most = of.searched(of.least), of.searched(of.most)
    low = min(best - half, max(best + min(off) - half, least))
    high = max(best + half, min(best + max(off) + half, most))
    return replace(
        number,
        lower=of.value(low),
        upper=of.value(high),
        after=0.5 * (high - low) / reach,
        verdict="not separable",
    )


def _same(phase: PhaseProblem, one: CollocationResult, other: CollocationResult) -> bool:
    spread = np.array([each.sd for each in phase.parameters])
    return bool((np.abs(one.p - other.p) <= SAME_PLACE * spread).all())


Run = tuple[PhaseProblem, CollocationResult]
INTERRUPTED = "interrupted"


@dataclass(frozen=True)
class PhaseSearch:
    """How a phase is solved.

    Parameters
    ----------
    options
        Of the solver; its intervals do not count.
    nodes
        Intervals a second where the search starts; those that leave too much of the balance are halved.
    starts
        Further starts, drawn from the prior; where the answer can be doubted one more starts there.
    resamples
        Calibrations of trials that the answer makes; 0 or 1 for none.
    level
        Probability of the intervals.
    profiles
        Points to either side of each parameter at which the others are sought again; 0 for none.
    select
        Whether those of the candidates are free that the trials identify together.
    """

    options: SolverOptions
    nodes: float = 30.0
    starts: int = 0
    resamples: int = 0
    seed: int = 0
    level: float = 0.95
    profiles: int = 0
    select: bool = False


@dataclass(frozen=True, eq=False)
class CalibratedPhase:
    """A phase and its answer.

    Parameters
    ----------
    name
        A or B.
    found
        Motions and parameters that belong together: the corrected ones where there were resamples and intervals.
    numbers
        What the trials tell of each parameter; their values are those of `found`.
    motions
        Certificate and residual of each trial.
    shares
        Of the cost, by term.
    ends
        Of each start; the first is the search's own.
    misfit
        Least cost in parts of what noise alone would make of it.
    doubt
        Why there are no intervals; empty where there are.
    profiles
        Of the parameters as found, before any correction.
    selection
        Of all candidates, which the trials identify together.
    unselected
        Why there is no selection; empty where there is one.
    """

    name: str
    model: StandingModel
    phase: PhaseProblem
    found: CollocationResult
    numbers: ContactNumbers
    motions: tuple[JudgedMotion, ...]
    shares: dict[str, float]
    ends: tuple[Ended, ...]
    misfit: float
    doubt: str = ""
    profiles: tuple[PhaseProfile, ...] = ()
    selection: tuple[SelectedParameter, ...] = ()
    unselected: str = ""

    @property
    def certified(self) -> bool:
        """Whether the search was solved and every motion passes."""
        seen = [motion.certificate for motion in self.motions]
        return self.found.solved and all(each is not None and each.converged for each in seen)


def calibrated_phase(
    name: str,
    model: StandingModel,
    trials: Sequence[StandingTrial],
    noise: StandingNoise,
    build: Build,
    search: PhaseSearch,
    progress: Progress | None = None,
    held: Float[np.ndarray, "p p"] | None = None,
) -> CalibratedPhase:
    """Solve what `build` makes of trials and of where the parameters start (None: where the phase itself says).

    `held` is the covariance of parameters that the phase holds at the prior or at what another one found.
    """
    even = tuple(np.linspace(0.0, 1.0, round(search.nodes * float(t.time[-1])) + 1) for t in trials)

    def solved(phase: PhaseProblem, warm: CollocationResult | None) -> CollocationResult:
        meshes = even if warm is None else warm.meshes
        return solve(phase.control, search.options, meshes=meshes, warm=warm, progress=progress)

    def finer(phase: PhaseProblem, found: CollocationResult) -> CollocationResult:
        return refined(phase.control, found, search.options, model.turning, progress=progress)

    runs = _runs(trials, build, search, solved)
    phase, found = _least(runs)
    if found.solved and doubtful(phase, found, misfit(model, trials, phase, found)):
        begun = _begun(phase, trials, build, search)
        runs.append((begun, solved(begun, None)))
        phase, found = _least(runs)
    misfits = misfit(model, trials, phase, found)
    ends, others, at = ended(phase, runs, found), rivals(phase, runs, found, misfits), found.p
    found = finer(phase, found)
    numbers, doubt = unsettled_numbers(phase, found), ""
    curves: tuple[PhaseProfile, ...] = ()
    if found.solved:
        again = None
        if search.resamples > 1:
            again = resampled(model, trials, noise, found, build, solved, search.resamples, search.seed)
        try:
            numbers = contact_numbers(phase, found, search.level, again, held)
        except ValueError as error:
            doubt = str(error)
        if search.profiles:
            curves = profiles(phase, found, numbers, search.profiles, solved)
        numbers = beside_rivals(numbers, phase, at, others, search.level)
        if again is not None and not doubt:
            p = corrected(phase, found, again)
            phase = replace(phase, control=replace(phase.control, p=(p, p), guess_p=p))
            found = finer(phase, solved(phase, found))
    controlled = range(len(model.joints))
    motions = judged(model.stepper, controlled, model.turning, phase, found, certify=found.solved)
    shares = cost_shares(phase, found)
    return CalibratedPhase(name, model, phase, found, numbers, motions, shares, ends, misfits, doubt, curves)


def _least(runs: Sequence[Run]) -> Run:
    return min([run for run in runs if run[1].solved] or runs, key=lambda run: run[1].objective)


def _begun(phase: PhaseProblem, trials: Sequence[StandingTrial], build: Build, search: PhaseSearch) -> PhaseProblem:
    """One that starts at the prior; where the search started there by itself, drawn from it."""
    middle = usual(phase.parameters)
    begun = build(trials, middle)
    if np.allclose(begun.control.guess_p, build(trials, None).control.guess_p):
        sd = np.array([each.sd for each in phase.parameters])
        # another draw than that of the first further start
        draw = np.random.default_rng([search.seed, 1]).normal(size=len(sd))
        begun = build(trials, middle + sd * draw)
    return begun


def _runs(trials: Sequence[StandingTrial], build: Build, search: PhaseSearch, solved: Solve) -> list[Run]:
    rng = np.random.default_rng(search.seed)
    runs: list[Run] = []
    for k in range(search.starts + 1):
        phase = build(trials, None)
        if k:
            sd = np.array([each.sd for each in phase.parameters])
            phase = build(trials, phase.control.guess_p + sd * rng.normal(size=len(sd)))
        runs.append((phase, solved(phase, None)))
        if runs[-1][1].ending.startswith(INTERRUPTED):
            break
    return runs
