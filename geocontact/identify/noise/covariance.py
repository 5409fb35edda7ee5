"""Covariance of what a trial's residual is made of: sensor noise, noise with a memory, noise of the inputs.

Over a trial the residual r = measured - predicted is, to first order,

    r = w + c + sum_j R_j n_j + B d

with w white sensor noise (part of it in proportion to the signal; that of a quotient is higher where its divisor is
small), c one or more Ornstein-Uhlenbeck
processes per channel (a filter in the measuring chain is quick, muscle tone and sway are slow), n_j the noise of input
j, whose spectrum is known, R_j what the model makes of it (`input_noise`), and d the trial's own deviation of some
parameters (donning, placement; `trial_variation`). The time axis is cut into blocks that are taken as independent of
each other, apart from d; that keeps matrices small, and is right for what is forgotten within a block.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from jaxtyping import Float, Int
from scipy.linalg import lapack

from geocontact.identify.noise.block_sums import carried, pulled, summed
from geocontact.identify.noise.input_noise import InputNoise
from geocontact.identify.noise.noise_levels import NoiseLevels
from geocontact.identify.optimise.bounded_gauss_newton import ROUNDING

BLOCK_ROWS = 120  # of a covariance matrix: cost grows with the square of it


@dataclass(frozen=True)
class NoiseBlock:
    """Rows of one stretch of a trial and the parts that its covariance is summed from.

    Parameters
    ----------
    rows
        Flat indices (t, c), channel after channel, each in the order of time.
    time, channel
        Of each row [s].
    inputs
        Covariance that noise of unit variance of each input makes of rows divided by `spread`.
    spread
        How many times its level the sensor noise of each row is.
    signal
        What noise may grow with, per level of the sensor noise that `spread` had when the trial was cut.
    """

    rows: Int[np.ndarray, " n"]
    time: Float[np.ndarray, " n"]
    channel: Int[np.ndarray, " n"]
    inputs: Float[np.ndarray, "j n n"]
    spread: Float[np.ndarray, " n"]
    signal: Float[np.ndarray, " n"]

    def louder(self, times: Float[np.ndarray, " n"]) -> NoiseBlock:
        """The same rows with sensor noise so many times as high."""
        return replace(self, inputs=self.inputs / np.outer(times, times), spread=self.spread * times)

    def covariance(self, levels: NoiseLevels) -> Float[np.ndarray, "n n"]:
        """Covariance of rows divided by `spread`, at these levels."""
        powers = (levels.white**2, levels.coloured**2, levels.memory, levels.growing**2, levels.inputs**2)
        return summed(self.time, self.channel, self.signal, self.inputs, *powers, 1.0 + ROUNDING)

    def pulls(self, levels: NoiseLevels, pull: Float[np.ndarray, "n n"]) -> Float[np.ndarray, " h"]:
        """Sum of `pull` times the derivative of the covariance with respect to each logarithm of a level.

        `pull` is symmetric; its upper half is read.
        """
        parts = pulled(self.time, self.channel, self.signal, self.inputs, levels.memory, pull)
        white, (coloured, lagged), growing, inputs = parts
        sums = np.concatenate([white, coloured.ravel(), lagged.ravel(), growing, inputs])
        return np.asarray(_per_logarithm(levels) * sums)

    def derivatives_times(self, levels: NoiseLevels, values: Float[np.ndarray, " n"]) -> Float[np.ndarray, "h n"]:
        """Derivative of the covariance with respect to each logarithm of a level, times `values`."""
        moved = carried(self.time, self.channel, self.signal, self.inputs, levels.memory, values)
        return np.asarray(_per_logarithm(levels)[:, None] * moved)


def _per_logarithm(levels: NoiseLevels) -> Float[np.ndarray, " h"]:
    """What the parts of a covariance, or its coloured ones' slopes by 1/τ, are multiplied by for its derivatives."""
    coloured = levels.coloured**2
    parts = (
        2.0 * levels.white**2,
        (2.0 * coloured).ravel(),
        (coloured / levels.memory).ravel(),
        2.0 * levels.growing**2,
        2.0 * levels.inputs**2,
    )
    return np.concatenate(parts)


@dataclass(frozen=True)
class Layout:
    """One trial cut into blocks; rows are its measured samples, channel after channel within a block."""

    shape: tuple[int, int]
    blocks: tuple[NoiseBlock, ...]

    @classmethod
    def of(
        cls,
        time: Float[np.ndarray, " t"],
        present: np.ndarray,
        heard: InputNoise,
        spread: Float[np.ndarray, "t c"],
        signal: Float[np.ndarray, "t c"],
        pieces: Sequence[slice] = (),
    ) -> Layout:
        """Blocks of a trial, none of them in two of its pieces (`data.trial`).

        Parameters
        ----------
        time
            Of each sample [s].
        present
            Which samples were measured (t, c).
        heard
            What noise of inputs makes.
        spread
            How many times its level the sensor noise of each sample is.
        signal
            What the noise of each sample may grow with.
        pieces
            Rows that hold all measured ones; all rows by default.
        """
        measured = []
        for run in pieces or (slice(0, len(time)),):
            count = max(1, round(present[run].sum() / BLOCK_ROWS))
            edges = [round(each) for each in np.linspace(run.start, run.stop, count + 1)]
            measured += [(a, b) for a, b in pairwise(edges) if present[a:b].any()]
        return cls(present.shape, tuple(_block(time, present, heard, spread, signal, a, b) for a, b in measured))

    def whitener(self, levels: NoiseLevels) -> Whitener:
        """What turns noise of these levels into independent numbers of unit variance."""
        factors = [factor_of(block.covariance(levels)) for block in self.blocks]
        inverses = tuple(
            lapack.dtrtri(factor, lower=1)[0] / block.spread
            for block, (factor, _) in zip(self.blocks, factors, strict=True)
        )
        scale = sum(scale + float(np.log(b.spread).sum()) for b, (_, scale) in zip(self.blocks, factors, strict=True))
        return Whitener(tuple(block.rows for block in self.blocks), inverses, scale)

    def louder(self, times: Float[np.ndarray, "t c"]) -> Layout:
        """The same trial with the sensor noise of each sample so many times as high."""
        return Layout(self.shape, tuple(block.louder(times.ravel()[block.rows]) for block in self.blocks))

    @cached_property
    def rows(self) -> Int[np.ndarray, " n"]:
        """Flat indices (t, c) of all rows."""
        return np.concatenate([block.rows for block in self.blocks])


@dataclass(frozen=True)
class Whitener:
    """Lower triangular factors, one per block, and the sum of logarithms that belongs to the likelihood."""

    rows: tuple[Int[np.ndarray, " _"], ...]
    factors: tuple[Float[np.ndarray, "_ _"], ...]
    log_scale: float

    def __call__(self, values: Float[np.ndarray, "t c p"]) -> Float[np.ndarray, "n p"]:
        """Whitened rows of what is given for all samples."""
        flat = values.reshape(values.shape[0] * values.shape[1], values.shape[-1])
        return np.concatenate([f @ flat[rows] for rows, f in zip(self.rows, self.factors, strict=True)])

    def of_channel(self, values: Float[np.ndarray, "t p"], channel: int, channels: int) -> Float[np.ndarray, "n p"]:
        """Whitened rows of what is given for all samples of one of so many channels and is 0 in the others."""
        parts = []
        for rows, f in zip(self.rows, self.factors, strict=True):
            first, last = np.searchsorted(rows % channels, [channel, channel + 1])  # channel after channel
            parts.append(f[:, first:last] @ values[rows[first:last] // channels])
        return np.concatenate(parts)

    def among(self, samples: Int[np.ndarray, " k"], channels: int) -> Whitener:
        """The same for values of these samples alone, in increasing order; they hold all measured ones."""
        places = (np.searchsorted(samples, rows // channels) * channels + rows % channels for rows in self.rows)
        return replace(self, rows=tuple(places))

    def coloured(self, independent: Float[np.ndarray, "n ..."]) -> Float[np.ndarray, "n ..."]:
        """The way back: noise of these levels from independent numbers, in the order of the rows."""
        from scipy.linalg import solve_triangular

        parts, at = [], 0
        for factor in self.factors:
            parts.append(solve_triangular(factor, independent[at : at + len(factor)], lower=True))
            at += len(factor)
        return np.concatenate(parts)


def _block(
    time: np.ndarray,
    present: np.ndarray,
    heard: InputNoise,
    spread: Float[np.ndarray, "t c"],
    signal: Float[np.ndarray, "t c"],
    first: int,
    last: int,
) -> NoiseBlock:
    sample, channel = [], []
    for c in range(present.shape[1]):
        own = first + np.flatnonzero(present[first:last, c])
        sample.append(own)
        channel.append(np.full(len(own), c))
    at, which = np.concatenate(sample), np.concatenate(channel)
    own = spread[at, which]
    return NoiseBlock(
        at * present.shape[1] + which,
        time[at],
        which,
        heard.covariance(at, which) / np.outer(own, own),
        own,
        signal[at, which] / own,
    )


def factor_of(covariance: Float[np.ndarray, "n n"]) -> tuple[Float[np.ndarray, "n n"], float]:
    """Lower Cholesky factor, and half the logarithm of the determinant.

    Tables of the low-pass kernel are exact to a few digits; where input noise dwarfs the rest, the diagonal is raised
    until there is a factor.
    """
    raised, more = covariance, 10.0 * ROUNDING
    while True:
        factor, failed = lapack.dpotrf(
            raised.T, lower=1, clean=1
        )  # symmetric: turned round it need not be copied twice
        if not failed:
            return factor, float(np.log(factor.diagonal()).sum())
        if more > 1.0:
            raise ValueError("a noise covariance has no finite factor")
        raised = covariance + more * np.diag(np.diag(covariance))
        more *= 10.0
