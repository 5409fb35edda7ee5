"""A base model fitted by plain least squares, and as somebody with a simulator has it.

What is judged by its held-out error, what is reported of it and what is drawn are this one fit. Beside it the same with
noise of the inputs taken off and rates smoothed: what gains in one of them only is no effect but less noise.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.chain.system import System
from geocontact.gap.case.problem import Problem
from geocontact.gap.case.refit import ROUNDS, Measured, Refit, free, refit
from geocontact.gap.levels import FEW


@dataclass(frozen=True)
class Plain:
    """Weighing by a standard deviation per channel only."""

    present: np.ndarray
    floor: Float[np.ndarray, " c"]
    log_scale: float = 0.0

    def __call__(self, values: Float[np.ndarray, "t c p"]) -> Float[np.ndarray, "n p"]:
        """Rows of measured samples, divided by the floor."""
        return np.asarray((values / self.floor[:, None])[self.present])


def plain_fit(
    system: System,
    measured: Measured,
    floor: Float[np.ndarray, " c"],
    starts: Sequence[Mapping[str, float]],
    rounds: int = ROUNDS,
) -> Refit:
    """The base model refitted to measured trials, every channel divided by `floor`, the best of several starts."""
    return refit(system, measured, [Plain(there, floor) for there in measured.present], starts, rounds)


def base_starts(system: System) -> list[dict[str, float]]:
    """The parameters' own start, and points spread evenly over their bounds."""
    from scipy.stats import qmc

    parameters = [p for p in free(system) if np.isfinite(p.upper - p.lower)]
    edge = 0.1  # of the range, that stays free at either end
    spread = qmc.Sobol(len(parameters), seed=0).random(FEW) if parameters else np.zeros((0, 0))
    return [
        {},
        *(
            {
                p.name: float(p.lower + (edge + (1.0 - 2.0 * edge) * u) * (p.upper - p.lower))
                for p, u in zip(parameters, row, strict=True)
            }
            for row in spread
        ),
    ]


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
