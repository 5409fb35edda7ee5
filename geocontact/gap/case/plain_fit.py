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
    parameters = [p for p in free(system) if np.isfinite(p.upper - p.lower)]
    edge = 0.1  # of the range, that stays free at either end
    return [
        {},
        *(
            {
                p.name: float(p.lower + (edge + (1.0 - 2.0 * edge) * u) * (p.upper - p.lower))
                for p, u in zip(parameters, row, strict=True)
            }
            for row in even_points(len(parameters))
        ),
    ]


def even_points(dimensions: int) -> Float[np.ndarray, "few d"]:
    """The first `FEW` points of Sobol's sequence in a unit cube, scrambled (Matousek 1998, J. Complexity 14:527).

    Four points need two direction numbers of each dimension: the first is 1, the second here, by Joe & Kuo (2008, SIAM
    J. Sci. Comput. 30:2635). `scipy.stats` has the same points, and is asked for those of more dimensions; it takes
    0.3 s to import.
    """
    second = np.array([int(digit) for digit in "133311311111331313133"])  # one digit each
    if dimensions == 0:
        return np.zeros((0, 0))
    if dimensions > len(second) or FEW > 2**2:
        from scipy.stats import qmc

        return np.asarray(qmc.Sobol(dimensions, seed=0).random(FEW))
    rng, place = np.random.default_rng(0), np.arange(np.iinfo(np.int32).bits - 2)  # binary digits, as there
    shift = rng.integers(2, size=(dimensions, len(place)), dtype=np.uint32) @ 2**place
    mixed = np.tril(rng.integers(2, size=(dimensions, len(place), len(place)), dtype=np.uint32)).astype(int)
    mixed[:, place, place] = 1
    numbers = np.stack([np.full(dimensions, 2 << place[-2]), second[:dimensions] << place[-2]], axis=1)
    digits = numbers[..., None] >> place[::-1] & 1
    one, other = (np.einsum("dpk,djk->jdp", mixed, digits) % 2) @ 2 ** place[::-1]
    return np.array([shift, shift ^ one, shift ^ one ^ other, shift ^ other])[:FEW] / 2.0 ** len(place)


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
