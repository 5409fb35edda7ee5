"""What was measured of a channel, and the steps that the recording comes in."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.gap.case.problem import Problem
from geocontact.gap.levels import FEWEST


def measured_columns(problem: Problem, c: int) -> list[Float[np.ndarray, " _"]]:
    """Measured values of one channel, trial by trial, trials with a few only left out."""
    columns = [outputs[:, c] for outputs in problem.recorded.outputs]
    return [x[np.isfinite(x)] for x in columns if np.isfinite(x).sum() >= FEWEST]
