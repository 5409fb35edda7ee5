"""Sums over the pairs of rows of one block of a trial: its covariance, and how that answers to levels of noise.

Rows are measured samples, channel after channel, in the order of time. Within a channel exp(-lag/τ) of two rows is the
product over the steps between them, so that exponentials are taken of steps only.
"""

from __future__ import annotations

from math import exp

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.geometry.kernels.compile import kernel


@kernel
def decays(
    time: Float[np.ndarray, " n"], channel: Int[np.ndarray, " n"], memory: Float[np.ndarray, " c"]
) -> Float[np.ndarray, " n"]:
    """Correlation of each row with the one before it, 0 at the first row of a channel."""
    out = np.zeros(time.size)
    for i in range(1, time.size):
        if channel[i] == channel[i - 1]:
            out[i] = exp(-(time[i] - time[i - 1]) / memory[channel[i]])
    return out


@kernel
def heard(inputs: Float[np.ndarray, "j n n"]) -> Bool[np.ndarray, " j"]:
    """Inputs whose noise is felt in the block: of the others no variance, so no covariance, is more than 0."""
    out = np.zeros(inputs.shape[0], np.bool_)
    for j in range(inputs.shape[0]):
        for a in range(inputs.shape[1]):
            if inputs[j, a, a] != 0.0:
                out[j] = True
                break
    return out


@kernel
def summed(
    time: Float[np.ndarray, " n"],
    channel: Int[np.ndarray, " n"],
    signal: Float[np.ndarray, " n"],
    inputs: Float[np.ndarray, "j n n"],
    white: Float[np.ndarray, " c"],
    coloured: Float[np.ndarray, "k c"],
    memory: Float[np.ndarray, "k c"],
    growing: Float[np.ndarray, " c"],
    powers: Float[np.ndarray, " j"],
    raised: float,
) -> Float[np.ndarray, "n n"]:
    """Covariance of a block: variances of white and of coloured noise per channel, of what grows with the signal per
    square of it, powers of the inputs' noise.

    The diagonal is multiplied by `raised`.
    """
    size = time.size
    out = np.zeros((size, size))
    felt = np.flatnonzero(heard(inputs))
    for a in range(size):
        for j in felt:
            for b in range(a, size):
                out[a, b] += powers[j] * inputs[j, a, b]
        out[a, a] += white[channel[a]] + growing[channel[a]] * signal[a] ** 2
    for k in range(memory.shape[0]):
        kept = decays(time, channel, memory[k])
        for a in range(size):
            part = coloured[k, channel[a]]
            out[a, a] += part
            for b in range(a + 1, size):
                if channel[b] != channel[a]:
                    break
                part *= kept[b]
                out[a, b] += part
    for a in range(size):
        out[a, a] *= raised
        for b in range(a):
            out[a, b] = out[b, a]
    return out


@kernel
def along_channel(
    kept: Float[np.ndarray, " n"],
    time: Float[np.ndarray, " n"],
    channel: Int[np.ndarray, " n"],
    pull: Float[np.ndarray, "n n"],
    out: Float[np.ndarray, "two c"],
) -> None:
    """Adds, to what `out` holds of each channel, `pull` times exp(-lag/τ) and times lag exp(-lag/τ) [s] over its pairs.

    `kept` are the `decays` of τ.
    """
    for a in range(time.size):
        c = channel[a]
        near, far, correlation = out[0, c] + pull[a, a], out[1, c], 1.0
        for b in range(a + 1, time.size):
            if channel[b] != c:
                break
            correlation *= kept[b]
            both = 2.0 * pull[a, b] * correlation
            near += both
            far += both * (time[b] - time[a])
        out[0, c], out[1, c] = near, far


@kernel
def pulled(
    time: Float[np.ndarray, " n"],
    channel: Int[np.ndarray, " n"],
    signal: Float[np.ndarray, " n"],
    inputs: Float[np.ndarray, "j n n"],
    memory: Float[np.ndarray, "k c"],
    pull: Float[np.ndarray, "n n"],
) -> tuple[Float[np.ndarray, " c"], Float[np.ndarray, "two k c"], Float[np.ndarray, " c"], Float[np.ndarray, " j"]]:
    """Sums of a symmetric `pull`, whose upper half is read: over each channel's diagonal, times exp(-lag/τ) over its
    pairs and times lag exp(-lag/τ) [s] for each τ, times the squared signal over the diagonal, and times each input's
    covariance.
    """
    size = time.size
    white, growing, of_inputs = np.zeros(memory.shape[1]), np.zeros(memory.shape[1]), np.zeros(inputs.shape[0])
    out = np.zeros((2, memory.shape[0], memory.shape[1]))
    for k in range(memory.shape[0]):
        along_channel(decays(time, channel, memory[k]), time, channel, pull, out[:, k])
    felt = np.flatnonzero(heard(inputs))
    for a in range(size):
        white[channel[a]] += pull[a, a]
        growing[channel[a]] += pull[a, a] * signal[a] ** 2
        for j in felt:
            total = 0.5 * pull[a, a] * inputs[j, a, a]
            for b in range(a + 1, size):
                total += pull[a, b] * inputs[j, a, b]
            of_inputs[j] += 2.0 * total
    return white, out, growing, of_inputs


@kernel
def carried(
    time: Float[np.ndarray, " n"],
    channel: Int[np.ndarray, " n"],
    signal: Float[np.ndarray, " n"],
    inputs: Float[np.ndarray, "j n n"],
    memory: Float[np.ndarray, "k c"],
    values: Float[np.ndarray, " n"],
) -> Float[np.ndarray, "h n"]:
    """What `pulled` sums over, as products with a vector: of each channel's diagonal, of exp(-lag/τ) for each τ, of
    lag exp(-lag/τ) [s] for each τ, of the squared signal on each channel's diagonal, and of each input's covariance.
    """
    kinds, channels = memory.shape
    size, slow, grown, first = (
        time.size,
        channels * (1 + kinds),
        channels * (1 + 2 * kinds),
        channels * (2 + 2 * kinds),
    )
    out = np.zeros((first + inputs.shape[0], size))
    for a in range(size):
        out[channel[a], a] = values[a]
        out[grown + channel[a], a] = signal[a] ** 2 * values[a]
    for k in range(kinds):
        kept = decays(time, channel, memory[k])
        for a in range(size):
            c = channel[a]
            level, lagged = channels * (1 + k) + c, slow + channels * k + c
            out[level, a] += values[a]
            correlation = 1.0
            for b in range(a + 1, size):
                if channel[b] != c:
                    break
                correlation *= kept[b]
                lag = correlation * (time[b] - time[a])
                out[level, a] += correlation * values[b]
                out[level, b] += correlation * values[a]
                out[lagged, a] += lag * values[b]
                out[lagged, b] += lag * values[a]
    for j in np.flatnonzero(heard(inputs)):
        for a in range(size):
            total = 0.0
            for b in range(size):
                total += inputs[j, a, b] * values[b]
            out[first + j, a] = total
    return out
