"""How far a calibration is off on average: the same calibration on trials that its own answer makes.

Motion and parameters are sought together. Where the motion can follow the noise of the plate, the parameters go along,
and always in the same sense, however many samples there are: the mode of the joint posterior is not that of the
parameters alone (Neyman & Scott (1948), Consistent estimates based on partially consistent observations, Econometrica
16, 1-32). So the answer is taken for the truth, trials with fresh noise are made of it, and calibrated: the mean of
what comes out, less the answer, is taken off (parametric bootstrap; Efron & Tibshirani (1993), ch. 10).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.solve import CollocationResult
from geocontact.standing_up.phase import PhaseProblem
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.trials import StandingNoise, StandingTrial, recorded

Build = Callable[[Sequence[StandingTrial], "Float[np.ndarray, ' p'] | None"], PhaseProblem]
Solve = Callable[[PhaseProblem, "CollocationResult | None"], CollocationResult]


@dataclass(frozen=True, eq=False)
class Resampled:
    """Answers of calibrations on trials made of one answer.

    Parameters
    ----------
    off
        What they found less what they were made with, of what is searched, a row for each.
    """

    off: Float[np.ndarray, "r p"]

    @property
    def bias(self) -> Float[np.ndarray, " p"]:
        """Their mean."""
        return np.asarray(self.off.mean(axis=0))

    @property
    def widening(self) -> float:
        """Of a standard deviation, because the mean of so few is not known exactly."""
        return float(np.sqrt(1.0 + 1.0 / len(self.off)))


def resampled(
    model: StandingModel,
    trials: Sequence[StandingTrial],
    noise: StandingNoise,
    found: CollocationResult,
    build: Build,
    solve: Solve,
    count: int,
    seed: int,
) -> Resampled | None:
    """`count` of them that were solved, of at most twice as many; None where there are fewer than two.

    Parameters
    ----------
    build, solve
        Make the phase's problem of trials and of where the parameters start, and solve it from a result.
    """
    rows: list[Float[np.ndarray, " p"]] = []
    for k in range(2 * count):
        again = [
            _like(recorded(model, motion, found.p, trial.rate, noise, 1000 * seed + 100 * k + j, trial.name), trial)
            for j, (trial, motion) in enumerate(zip(trials, found.motions, strict=True))
        ]
        end = solve(build(again, found.p), found)
        if end.ending.startswith("interrupted"):
            break
        if end.solved:
            rows.append(end.p - found.p)
        if len(rows) == count:
            break
    return Resampled(np.array(rows)) if len(rows) > 1 else None


def _like(again: StandingTrial, trial: StandingTrial) -> StandingTrial:
    """On the same chair, and without the straps that were not recorded."""
    again = replace(again, chair=trial.chair)
    if again.strap is None or trial.strap is None or not trial.elsewhere:
        return again
    strap = np.where(np.isnan(trial.strap), np.nan, again.strap)
    others = {name: np.where(np.isnan(trial.elsewhere[name]), np.nan, of) for name, of in again.elsewhere.items()}
    return replace(again, strap=strap, elsewhere=others)
