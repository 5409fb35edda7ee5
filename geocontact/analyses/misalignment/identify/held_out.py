"""How well numbers predict bins that they were not fitted to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.misalignment.identify.reached_bins import MIRRORED
from geocontact.axis_misalignment.bins import FORCE, Binned, binned
from geocontact.axis_misalignment.least_squares import ElbowFit, law_at, problem_of, r_squared
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError


@dataclass(frozen=True, eq=False)
class Held:
    """R² and root mean square error [N] of bin means that were not fitted, by what was held out."""

    name: str
    r2: float
    rmse: float
    bins: int


def each_left_out(data: Binned, e: ElbowFit) -> list[Held]:
    """Each trial in turn, predicted by what the others give."""
    if len(data.names) < 2:
        return []
    found = []
    for trial, name in enumerate(data.names):
        problem = problem_of(data.without(trial), e.problem.parameters, e.problem.priors, e.problem.scale)
        theta = problem.theta(problem.searched(e.values).values)
        found.append(_held(name, data.only(trial), theta))
    return found


def predicted(
    paths: Sequence[Path], recordings: Sequence[ElbowRecording], data: Binned, e: ElbowFit, width: float
) -> list[Held]:
    """Recordings of their own, in bins of `width` [rad]; InputError for one whose force mirrors what is predicted."""
    found = []
    for path, r in zip(paths, recordings, strict=True):
        own = binned([r], width, data.pressure)
        measured, force = own.cells.means[:, FORCE], law_at(own.cells.means).force(e.theta)
        with np.errstate(invalid="ignore"):
            along = float(np.corrcoef(measured, force)[0, 1])
        if along < MIRRORED:
            what = f"its force mirrors what the fitted trials predict (correlation {along:.2f} over the bins)"
            raise InputError(path, "", what, "is its sign turned? correct the file, or leave it out")
        found.append(_held(r.name, own, e.theta))
    return found


def _held(name: str, data: Binned, theta: Float[np.ndarray, " 8"]) -> Held:
    measured, force = data.cells.means[:, FORCE], law_at(data.cells.means).force(theta)
    rmse = float(np.sqrt(np.mean((measured - force) ** 2)))
    return Held(name, r_squared(measured, force), rmse, len(measured))
