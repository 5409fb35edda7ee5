"""Residuals of an identification at an elbow by bin, and what normal noise would leave in their place.

Neighbouring bins share noise: a force that remembers is met again in the next bin a moment later. A test of their
distribution has to know of that, so its p-value comes from residuals of simulated normal noise with the same memory.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.axis_misalignment.bins import FORCE, Binned
from geocontact.axis_misalignment.least_squares import ElbowFit
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.identify.intervals.bin_tests import DRAWS, Normality, lilliefors
from geocontact.identify.noise.autocorrelation import spread
from geocontact.identify.noise.bin_noise import mean_covariance
from geocontact.identify.signals.angle_bins import bin_numbers


def residual_by_bin(data: Binned, e: ElbowFit) -> tuple[Float[np.ndarray, " b"], Float[np.ndarray, " b"]]:
    """Angle [rad] and measured less fitted force [N] of each bin, all trials together."""
    there = np.unique(data.cells.place)
    return data.centres[there], _pooled(data, (data.cells.means[:, FORCE] - e.predicted)[None])[0]


def standard_residuals(data: Binned, e: ElbowFit) -> Float[np.ndarray, " b"]:
    """Residual of each bin times the root of its information: about one spread, however long a bin was stayed in."""
    return np.asarray(residual_by_bin(data, e)[1] * _root_information(data))


def normal_residuals(
    recordings: Sequence[ElbowRecording], data: Binned, e: ElbowFit, count: int = DRAWS, seed: int = 0
) -> Float[np.ndarray, "d b"]:
    """`standard_residuals` of `count` draws of normal noise in the place of the recorded one.

    Ornstein-Uhlenbeck noise with the correlation time of `data` along the recorded angles, less what the fit would take
    out of it, to first order.
    """
    left = _noise_left(recordings, data, e, count, seed)
    return np.asarray(_pooled(data, left / e.problem.weight) * _root_information(data))


@dataclass(frozen=True)
class Excess:
    """What the fit leaves, trial by trial and bin by bin, against what noise within the trials would leave.

    Parameters
    ----------
    ratio
        Of the weighted sums of squares, 1 where noise is all.
    p
        Share of draws of noise that leave as much.
    """

    ratio: float
    p: float


def excess(
    recordings: Sequence[ElbowRecording], data: Binned, e: ElbowFit, count: int = DRAWS, seed: int = 1
) -> Excess:
    """Offsets that change from trial to trial, and whatever the law misses, leave more than a trial's noise does."""
    left = _noise_left(recordings, data, e, count, seed)
    draws = np.einsum("dn,dn->d", left, left)
    found = float(np.sum((e.problem.weight * (data.cells.means[:, FORCE] - e.predicted)) ** 2))
    return Excess(found / float(draws.mean()), float((1 + np.sum(draws >= found)) / (1 + len(draws))))


def _noise_left(
    recordings: Sequence[ElbowRecording], data: Binned, e: ElbowFit, count: int, seed: int
) -> Float[np.ndarray, "d n"]:
    """Weighted residuals of draws of noise, by trial and bin."""
    rng, bins, cells = np.random.default_rng(seed), len(data.visits.edges) - 1, data.cells
    noise = np.empty((count, len(cells.count)))
    for trial, r in enumerate(recordings):
        mine = cells.trial == trial
        all_bins = mean_covariance(r.time, bin_numbers(r.beta, data.visits.edges), bins, float(data.noise.tau[0]))
        reached = cells.place[mine]
        value, vector = np.linalg.eigh(all_bins[np.ix_(reached, reached)])
        noise[:, mine] = rng.standard_normal((count, len(value))) @ (vector * np.sqrt(np.maximum(value, 0.0))).T
    jacobian = e.problem.jacobian(e.values)
    slopes, off = jacobian[: len(cells.count)], noise * e.problem.weight
    return np.asarray(data.noise.sd[0] * (off - off @ slopes @ spread(jacobian) @ slopes.T))


def normality(recordings: Sequence[ElbowRecording], data: Binned, e: ElbowFit) -> Normality:
    """Lilliefors' test of the bins' standard residuals."""
    return lilliefors(standard_residuals(data, e), normal_residuals(recordings, data, e))


def _pooled(data: Binned, off: Float[np.ndarray, "d n"]) -> Float[np.ndarray, "d b"]:
    """Means of cells over the trials, for the bins that were reached."""
    there, place = np.unique(data.cells.place, return_inverse=True)
    share = np.zeros((len(place), len(there)))
    share[np.arange(len(place)), place] = data.cells.count
    return np.asarray(off @ (share / share.sum(axis=0)))


def _root_information(data: Binned) -> Float[np.ndarray, " b"]:
    information = np.bincount(data.cells.place, data.information)
    return np.asarray(np.sqrt(information[np.unique(data.cells.place)]))
