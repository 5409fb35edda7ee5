"""How much of what a model changes of the base model's prediction lies in the calibration trials.

Held-out trials may be faster, larger or longer: an effect that calibration trials hardly show may show there. Its gain
is to be borne out in proportion to what the model with it changes, not to the number of samples.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float

from geocontact.chain.system import FAR
from geocontact.gap.case.problem import Problem
from geocontact.gap.case.refit import ENOUGH
from geocontact.gap.selection.model_comparison import Contender
from geocontact.identify.optimise.least_squares import NO_VALUE


def changes(problem: Problem, base: Contender, one: Contender) -> list[Float[np.ndarray, "_ c"]]:
    """What a model predicts otherwise than the base model, per trial, base parameters refitted.

    0 where either has no value, or no solution.
    """
    no_value = NO_VALUE * problem.calibration.rough

    def silent(residual: Float[np.ndarray, "_ c"]) -> Bool[np.ndarray, "_ c"]:
        return np.asarray((residual == no_value) | (np.abs(residual) > 0.5 * FAR))

    models = zip(base.judged.model.residuals, one.judged.model.residuals, strict=True)
    return [np.where(silent(a) | silent(b), 0.0, a - b) for a, b in models]


def calibration_share(problem: Problem, changed: Sequence[Float[np.ndarray, "_ c"]]) -> float:
    """Part of changes of all trials, squared, in units of the noise floor, that is in the calibration trials.

    That part of all samples where the changes are no more than rounding, or no number.
    """
    count = len(problem.calibration.trials)
    size = np.array([float(np.sum((each / problem.floor) ** 2)) for each in changed])
    if not ENOUGH < size.sum() < np.inf:
        size = np.array([float(each.size) for each in changed])
    return float(size[:count].sum() / size.sum())
