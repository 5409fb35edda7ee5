"""Intervals by block bootstrap of a residual that remembers.

Blocks of a short recording's residual, put together at random, vary too little: what reaches across their edges is
lost. So each replicate is post-blackened (Davison and Hinkley 1997, Bootstrap Methods and their Application, sec.
8.2.3): a correlation time is drawn from its weights (`memory`), the residual is whitened with it, blocks of what is
left are drawn with random places and signs, and the memory is put back. The blocks are longer than the residual's
correlation, so that whatever memory the whitening misses stays inside them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from geocontact.geometry.kernels.compile import kernel
from geocontact.identify.noise.autocorrelation import Autocorrelation
from geocontact.identify.noise.autoregressive import AutoregressiveNoise

CORRELATIONS = 3.0  # correlation times in a block: exp(-3) is left of the correlation
FEWEST = 4  # blocks
AT_ONCE = 4_000_000  # samples of replicates in memory


@dataclass(frozen=True, eq=False)
class Replicates:
    """Estimates from resampled residuals.

    Parameters
    ----------
    estimates
        A row per replicate, a column per parameter.
    lower, upper
        Of each parameter.
    block
        Length of a block [s].
    blocks
        In the recording; few of them mean a rough interval.
    """

    estimates: Float[np.ndarray, "b p"]
    lower: Float[np.ndarray, " p"]
    upper: Float[np.ndarray, " p"]
    block: float
    blocks: int


def block_bootstrap(
    time: Float[np.ndarray, " n"],
    predicted: Float[np.ndarray, " n"],
    residual: Float[np.ndarray, " n"],
    memory: Autocorrelation,
    refit: Callable[[Float[np.ndarray, "b n"]], Float[np.ndarray, "b p"]],
    count: int,
    level: float = 0.95,
    seed: int = 0,
) -> Replicates:
    """Percentile intervals from `count` replicates of predicted + resampled residual.

    Parameters
    ----------
    refit
        Estimates from each row of synthetic measurements, of each row by itself: long recordings come in parts.
    """
    rng = np.random.default_rng(seed)
    step = float(np.median(np.diff(time)))
    n = len(time)
    length = int(np.clip(np.ceil(CORRELATIONS * memory.typical / step), 1, max(n // FEWEST, 1)))
    drawn = rng.choice(len(memory.tau), count, p=memory.weight)
    blocks = -(-n // length)
    wider = np.sqrt(n / memory.freedom * blocks / max(blocks - 1, 1))
    found: list[Float[np.ndarray, "b p"]] = []
    order: list[Int[np.ndarray, " b"]] = []
    for k in np.unique(drawn):
        own, tau = np.flatnonzero(drawn == k), float(memory.tau[k])
        innovations = AutoregressiveNoise(np.ones(1), np.array([tau])).whitened(time, residual[:, None, None])[:, 0]
        keep = np.exp(-np.diff(time) / tau)
        for part in np.array_split(own, min(-(-len(own) * n // AT_ONCE), len(own))):
            found.append(refit(predicted + wider * _blackened(innovations, keep, length, len(part), rng)))
            order.append(part)
    values = np.concatenate(found)[np.argsort(np.concatenate(order))]
    tails = [50.0 * (1.0 - level), 50.0 * (1.0 + level)]
    lower, upper = np.percentile(values, tails, axis=0)
    return Replicates(values, lower, upper, length * step, blocks)


def _blackened(
    innovations: Float[np.ndarray, " n"],
    keep: Float[np.ndarray, " n-1"],
    length: int,
    count: int,
    rng: np.random.Generator,
) -> Float[np.ndarray, "b n"]:
    """Resampled residuals: blocks of the innovations with random places and signs, given the memory back.

    Parameters
    ----------
    keep
        What is kept of a sample in the next one.
    """
    n = len(innovations)
    blocks = -(-n // length)
    first = rng.integers(0, n, (count, blocks))
    places = ((first[:, :, None] + np.arange(length)) % n).reshape(count, -1)[:, :n]
    signs = rng.choice([-1.0, 1.0], (count, blocks)).repeat(length, axis=1)[:, :n]
    noise = np.ascontiguousarray((innovations[places] * signs).T)  # a row per sample: steps through memory in order
    _remember(noise, keep, np.sqrt(1.0 - keep**2))
    return np.asarray(noise.T)


@kernel
def _remember(noise: Float[np.ndarray, "n b"], keep: Float[np.ndarray, " n-1"], new: Float[np.ndarray, " n-1"]) -> None:
    """Each row becomes its share that is new and what is kept of the row before it, in place."""
    for k in range(1, noise.shape[0]):
        for b in range(noise.shape[1]):
            noise[k, b] = noise[k, b] * new[k - 1] + keep[k - 1] * noise[k - 1, b]
