"""A model as somebody with a simulator has it: fitted by least squares to what was measured, nothing smoothed first.

What is judged by its held-out error, what is reported of it and what is drawn are this one fit. Beside it the same with
noise of the inputs taken off and rates smoothed: what gains in one of them only is no effect but less noise.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from geocontact.gap.case.plain_fit import Plain, plain_fit
from geocontact.gap.case.problem import Problem
from geocontact.gap.case.refit import ROUNDS, Refit, refit


def measured_fit(
    problem: Problem, model: Refit, floor: Float[np.ndarray, " c"]
) -> tuple[dict[str, float], list[Float[np.ndarray, "_ c"]]]:
    """Parameters from the calibration trials, every channel divided by its floor, and residuals of all trials.

    Parameters
    ----------
    model
        Where the search sets out.
    floor
        Of each channel, in its unit.
    """
    count, whole = len(problem.calibration.trials), problem.recorded
    first = replace(whole, trials=whole.trials[:count], outputs=whole.outputs[:count])
    system = model.system.as_measured()
    values = refit(system, first, [Plain(there, floor) for there in first.present], [model.values], ROUNDS).values
    return values, whole.residuals(system, values)


def smoothed_fit(problem: Problem, model: Refit, floor: Float[np.ndarray, " c"]) -> list[Float[np.ndarray, "_ c"]]:
    """Residuals of the held-out trials, inputs and rates as the contest has them, fitted as in `measured_fit`."""
    values = plain_fit(model.system, problem.calibration, floor, [model.values]).values
    return problem.evaluation.residuals(model.system, values)
