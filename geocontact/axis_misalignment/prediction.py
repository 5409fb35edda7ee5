"""What a fit to an elbow's recordings predicts of what it did not use, and what it leaves of what it did."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.axis_misalignment.bins import FORCE, Binned, binned
from geocontact.axis_misalignment.least_squares import (
    ElbowFit,
    Excess,
    estimated,
    excess,
    law_at,
    normality,
    problem_of,
    r_squared,
    residual_by_bin,
    standard_residuals,
)
from geocontact.axis_misalignment.uncertainty import along_the_scale
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.identify.intervals.bin_tests import Normality

FACTORS = np.geomspace(0.5, 2.0, 41)
"""Factors of the lengths at which the line along the scale is drawn."""


def correlations_with_others(data: Binned, least: int) -> Float[np.ndarray, " trials"]:
    """Correlation of the mean forces of each trial with those of all others, over the bins that both reach [-].

    NaN where fewer than `least` bins are in common, as with a single trial. Near -1 a trial has the other sign.
    """
    bins = len(data.visits.edges) - 1
    found = np.full(len(data.names), np.nan)
    if len(found) < 2:
        return found
    for trial in range(len(data.names)):
        mine, others = data.only(trial).cells, data.without(trial).cells
        count = np.bincount(others.place, others.count, bins)
        mean = np.bincount(others.place, others.count * others.means[:, FORCE], bins) / np.where(count > 0, count, 1)
        both = count[mine.place] > 0
        if both.sum() >= least:
            found[trial] = np.corrcoef(mine.means[both, FORCE], mean[mine.place][both])[0, 1]
    return found


TURNED: Mapping[str, Callable[[ElbowRecording], ElbowRecording]] = {
    "the sign of its force is turned": lambda r: replace(r, force=-r.force),
    "its angle runs backwards in time": lambda r: replace(r, beta=r.beta[::-1].copy()),
    "its angle is counted from the other end": lambda r: replace(r, beta=r.beta.min() + r.beta.max() - r.beta),
}
"""What makes the force of a trial mirror that of the others over the angle, and what undoes it."""
ALIKE = 0.05
"""Difference of two correlations, below which neither cause is the likelier one."""


def turned_words(recordings: Sequence[ElbowRecording], trial: int, width: float, least: int) -> tuple[float, str]:
    """Which of `TURNED` makes a trial go with the others: the best correlation, and the causes that reach it."""
    found = {}
    for words, undone in TURNED.items():
        some = [*recordings[:trial], undone(recordings[trial]), *recordings[trial + 1 :]]
        found[words] = float(np.nan_to_num(correlations_with_others(binned(some, width), least)[trial], nan=-1.0))
    most = max(found.values())
    said = [f"{words} ({value:.2f} without that)" for words, value in found.items() if value >= most - ALIKE]
    return most, ", or ".join(said)


@dataclass(frozen=True, eq=False)
class Held:
    """How well bin means that were not fitted are predicted: R² [-], root mean square error [N], how many bins."""

    name: str
    r2: float
    rmse: float
    bins: int


def each_left_out(data: Binned, e: ElbowFit) -> list[Held]:
    """Each trial in turn, predicted by a search from the fit of all with the others alone; empty for a single trial."""
    if len(data.names) < 2:
        return []
    found = []
    for trial, name in enumerate(data.names):
        sensors = e.problem.beside[0].sensors if e.problem.beside else None
        problem = problem_of(data.without(trial), e.problem.parameters, e.problem.priors, e.problem.scale, sensors)
        theta = problem.theta(problem.searched(e.values).values)
        found.append(held_out(name, data.only(trial), theta))
    return found


def held_out(name: str, data: Binned, theta: Float[np.ndarray, " 8"]) -> Held:
    """How well the law with the numbers `theta`, in the order of NAMES and in SI, predicts the bin means of `data`."""
    measured, force = data.cells.means[:, FORCE], law_at(data.cells.means).force(theta)
    rmse = float(np.sqrt(np.mean((measured - force) ** 2)))
    return Held(name, r_squared(measured, force), rmse, len(measured))


@dataclass(frozen=True, eq=False)
class ScaleLine:
    """Numbers along the scale, which all give the same force.

    Parameters
    ----------
    numbers
        A row each, in the order of NAMES, SI units.
    r2, alone_r2
        R² of each row, and where k alone changes as it does along the line.
    """

    numbers: Float[np.ndarray, "m 8"]
    r2: Float[np.ndarray, " m"]
    alone_r2: Float[np.ndarray, " m"]


def scale_line(e: ElbowFit, factors: Float[np.ndarray, " m"] = FACTORS) -> ScaleLine:
    """Numbers of the fit with all lengths times each factor and the stiffness divided by it, and how well they fit."""
    measured, rows = e.problem.force, along_the_scale(e, factors)
    alone = np.tile(e.theta, (len(rows), 1))
    alone[:, 0] = rows[:, 0]
    r2, alone_r2 = (
        np.array([r_squared(measured, e.problem.law.force(theta)) for theta in each]) for each in (rows, alone)
    )
    return ScaleLine(rows, r2, alone_r2)


@dataclass(frozen=True, eq=False)
class Residuals:
    """Measured less fitted mean force of each bin.

    Parameters
    ----------
    beta, off
        Angle [rad] and residual [N], all trials together.
    standard
        Over the standard deviation of the bin's mean.
    normality, excess
        Whether they are normal, and how much larger than noise within the trials.
    """

    beta: Float[np.ndarray, " b"]
    off: Float[np.ndarray, " b"]
    standard: Float[np.ndarray, " _"]
    normality: Normality
    excess: Excess


def residuals_of(recordings: Sequence[ElbowRecording], data: Binned, e: ElbowFit) -> Residuals:
    """Residuals of a fit by bin, with the tests of their distribution and size."""
    beta, off = residual_by_bin(data, e)
    return Residuals(
        beta, off, standard_residuals(data, e), normality(recordings, data, e), excess(recordings, data, e)
    )


def mirrored_r2(e: ElbowFit) -> float:
    """R² that the same model reaches on the force turned over: near the fit's where the sign is not identified."""
    turned = estimated(e.problem.measuring(-e.problem.force))
    return r_squared(-e.problem.force, turned.predicted)
