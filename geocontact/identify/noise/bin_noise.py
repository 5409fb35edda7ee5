"""What a noise that remembers leaves in the means of bins: their covariance, exact for the times that were sampled."""

from __future__ import annotations

from math import exp

import numpy as np
from jaxtyping import Float, Int

from geocontact.geometry.kernels.compile import kernel


@kernel
def mean_covariance(
    time: Float[np.ndarray, " t"], place: Int[np.ndarray, " t"], bins: int, tau: float
) -> Float[np.ndarray, "b b"]:
    """Covariance of the bins' means of an Ornstein-Uhlenbeck noise of variance 1 and correlation time `tau` [s].

    Parameters
    ----------
    time, place
        Of each sample of one trial, in the order of time [s]; the bin that it falls into.

    Returns
    -------
    array
        Mean of exp(-lag/tau) over the pairs of samples of two bins; 0 for a bin without samples.
    """
    out, count, kept = np.zeros((bins, bins)), np.zeros(bins), np.zeros(bins)
    for i in range(time.size):
        if i > 0:
            kept *= exp(-(time[i] - time[i - 1]) / tau)
        here = place[i]
        for b in range(bins):
            out[here, b] += kept[b]
            out[b, here] += kept[b]
        out[here, here] += 1.0
        kept[here] += 1.0
        count[here] += 1.0
    for a in range(bins):
        for b in range(bins):
            out[a, b] /= max(count[a] * count[b], 1.0)
    return out
