"""What predictions are off by because rates of recorded inputs cannot be had from their sampling.

Rates come from a cubic through neighbours. Where the movement is fast for the sampling, and more so at the ends of a
recording, where all neighbours are on one side, that is off by more than noise. How far off it is, is seen by taking
more neighbours (grid refinement, Richardson's extrapolation: Roache, Verification and Validation in Computational
Science and Engineering, 1998, ch. 5). At the ends the order is lower and the estimate a lower bound.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from geocontact.chain.differentiated_inputs import DEGREE
from geocontact.chain.system import FAR, System
from geocontact.data.trial import Trial
from geocontact.gap.case.problem import Problem
from geocontact.gap.levels import DEVIATIONS


def error_of_rates(system: System, trial: Trial, values: Mapping[str, float]) -> Float[np.ndarray, "t c"]:
    """Numerical error of a prediction, in the outputs' units; 0 where there is none.

    A polynomial of degree p through symmetric neighbours gives rates of order p + 1; neighbours twice as far away are
    off by 2^(p + 1) times as much.
    """
    fine, wide = (system.reaching(n * system.motion.reach).simulate(trial, values) for n in (1.0, 2.0))
    told = [np.isfinite(each) & (np.abs(each) < 0.5 * FAR) for each in (fine, wide)]
    return np.where(told[0] & told[1], wide - fine, 0.0) / (2.0 ** (DEGREE + 1) - 1.0)


def coarse_rates(problem: Problem) -> tuple[str, ...]:
    """In words where the base model's prediction is off by more than DEVIATIONS of a channel's noise for this.

    At the worst sample of all trials, as the last column of the placement has it; nothing for a channel whose rates are
    told well enough everywhere.
    """
    trials = problem.recorded.trials
    errors = [np.abs(columns[..., -1]) for columns in problem.placement]
    told = []
    for c, name in enumerate(problem.system.outputs):
        most = [float(error[:, c].max()) / problem.floor_of_noise[c] for error in errors]
        worst = int(np.argmax(most))
        if most[worst] > DEVIATIONS:
            at = trials[worst].time[int(np.argmax(errors[worst][:, c]))]
            told.append(
                f"rates of the inputs are told too coarsely: at {at:.3g} s of {trials[worst].name} "
                f"{name} is off by {most[worst]:.2g} times its noise or more"
            )
    return tuple(told)
