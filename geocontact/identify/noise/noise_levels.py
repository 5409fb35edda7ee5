"""Levels of noise, and their prior, before residuals are looked at.

Noise that is estimated grows with whatever the model misses, so that a strong gap passes for high noise. What is known
of it beforehand is therefore a belief and, where there is one, a limit: of the whole noise of a sensor, and of that of
an input.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb
from statistics import NormalDist

import numpy as np
from jaxtyping import Float

from geocontact.identify.optimise.bounded_gauss_newton import CLOSE

QUARTILE = NormalDist().inv_cdf(0.75)  # that half of the magnitudes of standard normal numbers lie below


def typical_noise(values: Float[np.ndarray, " n"], differences: int = 0) -> float:
    """Standard deviation of normal noise, in the unit of `values`, that has their median magnitude; 0 without values.

    `values` are its differences of that order k: of white noise these have (2k over k) times its variance, the sum of
    the squared binomial coefficients.
    """
    if not len(values):
        return 0.0
    return float(np.median(np.abs(values))) / QUARTILE / float(np.sqrt(comb(2 * differences, differences)))


BEYOND = 0.3  # of the logarithm, that a level can come to exceed what it is limited to


@dataclass(frozen=True)
class NoiseLevels:
    """Standard deviations and correlation times that make up the covariance.

    Parameters
    ----------
    white
        Of each output channel, in its unit.
    coloured
        Of each process with a memory, by channel.
    memory
        Its correlation time [s].
    growing
        White noise of each output channel per unit of its signal.
    inputs
        Of each input, in its unit, after the low-pass filter.
    """

    white: Float[np.ndarray, " c"]
    coloured: Float[np.ndarray, "k c"]
    memory: Float[np.ndarray, "k c"]
    growing: Float[np.ndarray, " c"]
    inputs: Float[np.ndarray, " j"]

    def logarithms(self) -> Float[np.ndarray, " h"]:
        """All numbers in one vector of logarithms."""
        parts = (self.white, self.coloured.ravel(), self.memory.ravel(), self.growing, self.inputs)
        return np.asarray(np.log(np.concatenate(parts)))

    def at(self, logarithms: Float[np.ndarray, " h"]) -> NoiseLevels:
        """Levels of the same shape from such a vector."""
        sizes = np.cumsum([self.white.size, self.coloured.size, self.memory.size, self.growing.size])
        white, coloured, memory, growing, inputs = np.split(np.exp(logarithms), sizes)
        shaped = coloured.reshape(self.coloured.shape), memory.reshape(self.memory.shape)
        return NoiseLevels(white, *shaped, growing, inputs)

    def times(self, sensors: Float[np.ndarray, " c"], inputs: Float[np.ndarray, " j"]) -> NoiseLevels:
        """All noise of each output channel, and that of each input, so many times as high."""
        noise = self.white * sensors, self.coloured * sensors
        return NoiseLevels(*noise, self.memory, self.growing, self.inputs * inputs)

    @property
    def sensors(self) -> Float[np.ndarray, " c"]:
        """Whole noise of each output channel."""
        return np.asarray(np.sqrt(self.white**2 + (self.coloured**2).sum(axis=0)))


@dataclass(frozen=True)
class NoisePriors:
    """Log-normal beliefs, and limits, of levels.

    Unlimited levels have the logarithms m + F x with x standard normal. Where the whole noise of a sensor, or that of
    an input, then exceeds its limit by e of the logarithm, it is scaled down until it exceeds it by b tanh(e/b), with
    b = `BEYOND`: below the limit nothing changes.

    Parameters
    ----------
    middle
        Medians.
    factor
        F, a factor of the covariance of the logarithms.
    sensors, inputs
        Limits of the whole noise of each output channel and of each input, infinite where there is none.
    """

    middle: NoiseLevels
    factor: Float[np.ndarray, "h h"]
    sensors: Float[np.ndarray, " c"]
    inputs: Float[np.ndarray, " j"]

    def levels(self, x: Float[np.ndarray, " h"]) -> NoiseLevels:
        """Levels at a point of the search."""
        return self._limited(self._free(x))

    def slope(self, x: Float[np.ndarray, " h"], pull: Float[np.ndarray, "... h"]) -> Float[np.ndarray, "... h"]:
        """Derivative with respect to x of what has the derivatives `pull` with respect to the levels' logarithms."""
        free = self._free(x)
        sensors, inputs = self._excess(free)
        channels, kinds = len(sensors), len(free.coloured)
        back = pull.copy()
        powers = np.concatenate([free.white[None], free.coloured]) ** 2 / free.sensors**2
        noise = pull[..., : channels * (1 + kinds)].reshape(*pull.shape[:-1], 1 + kinds, channels)
        held = powers * ((_steepness(sensors) - 1.0) * noise.sum(axis=-2))[..., None, :]
        back[..., : channels * (1 + kinds)] += held.reshape(*pull.shape[:-1], -1)
        back[..., pull.shape[-1] - len(inputs) :] *= _steepness(inputs)
        return np.asarray(back @ self.factor)

    def point(self, levels: NoiseLevels) -> Float[np.ndarray, " h"]:
        """Where in the search levels are; those beyond what can be reached are taken as just within."""
        sensors, inputs = (_released(each) for each in self._excess(levels))
        free = levels.times(np.exp(sensors), np.exp(inputs))
        return np.linalg.solve(self.factor, free.logarithms() - self.middle.logarithms())

    def _free(self, x: Float[np.ndarray, " h"]) -> NoiseLevels:
        return self.middle.at(self.middle.logarithms() + self.factor @ x)

    def _limited(self, free: NoiseLevels) -> NoiseLevels:
        sensors, inputs = (_beyond_limit(each) for each in self._excess(free))
        return free.times(np.exp(sensors), np.exp(inputs))

    def _excess(self, levels: NoiseLevels) -> tuple[Float[np.ndarray, " c"], Float[np.ndarray, " j"]]:
        return np.log(levels.sensors) - np.log(self.sensors), np.log(levels.inputs) - np.log(self.inputs)


def _beyond_limit(excess: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
    """What is added to logarithms that exceed their limit so that they hardly do."""
    over = np.maximum(excess, 0.0)
    return np.asarray(BEYOND * np.tanh(over / BEYOND) - over)


def _steepness(excess: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
    """Derivative of the excess that is left with respect to the excess."""
    return np.asarray(1.0 - np.tanh(np.maximum(excess, 0.0) / BEYOND) ** 2)


def _released(left: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
    """What was taken off logarithms of which this excess is left."""
    over = np.minimum(np.maximum(left, 0.0) / BEYOND, 1.0 - CLOSE)
    return np.asarray(BEYOND * np.arctanh(over) - np.maximum(left, 0.0))
