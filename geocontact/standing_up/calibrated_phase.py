"""One phase solved: the best of several starts, corrected by what resampled trials show, its motions certified.

One start, and one more where its answer can be doubted (`other_minima`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.refinement import refined
from geocontact.dynamics.collocation.solve import CollocationResult, Progress, SolverOptions, solve
from geocontact.standing_up.contact_numbers import ContactNumbers, contact_numbers, corrected, unsettled_numbers
from geocontact.standing_up.contact_parameter import usual
from geocontact.standing_up.cost_shares import cost_shares
from geocontact.standing_up.judged import JudgedMotion, judged
from geocontact.standing_up.other_minima import Ended, beside_rivals, doubtful, ended, misfit, rivals
from geocontact.standing_up.phase import PhaseProblem
from geocontact.standing_up.profile import PhaseProfile, profiles
from geocontact.standing_up.resample import Build, Solve, resampled
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.trials import StandingNoise, StandingTrial

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
        Further starts, drawn from what is believed; where the answer can be doubted one more starts there.
    resamples
        Calibrations of trials that the answer makes; 0 or 1 for none.
    level
        Probability of the intervals.
    profiles
        Points to either side of each parameter at which the others are sought again; 0 for none.
    """

    options: SolverOptions
    nodes: float = 30.0
    starts: int = 0
    resamples: int = 0
    seed: int = 0
    level: float = 0.95
    profiles: int = 0


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

    `held` is the covariance of parameters that the phase holds at what is believed or at what another one found.
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
    motions = judged(model.equations, controlled, model.turning, phase, found, certify=found.solved)
    shares = cost_shares(phase, found)
    return CalibratedPhase(name, model, phase, found, numbers, motions, shares, ends, misfits, doubt, curves)


def _least(runs: Sequence[Run]) -> Run:
    return min([run for run in runs if run[1].solved] or runs, key=lambda run: run[1].objective)


def _begun(phase: PhaseProblem, trials: Sequence[StandingTrial], build: Build, search: PhaseSearch) -> PhaseProblem:
    """One that starts at what is believed; where the search started there by itself, drawn from it."""
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
