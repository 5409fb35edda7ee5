"""Covariance that the noise of inputs makes of a trial's outputs, for models with and without a motion of their own.

A model without one answers at every moment to the inputs' values and rates at that moment: a_j n_j + b_j n_j' with
sensitivities a and b over time (`Instant`). One with inertia goes on answering: the noise of every recorded sample is
followed by a response, and outputs are the sum of these (`Lasting`), r = R n.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float, Int

from geocontact.identify.signals.low_pass import LowPass

Rates = Callable[[Float[np.ndarray, " f"]], Float[np.ndarray, " f"]]

FREQUENCIES, HIGHEST = 400, 4.0  # that the spectrum of filtered noise is summed at, up to so many corners
LAGS = 1001  # of the periods of the values that the covariance is tabled at
LONGEST = 6.0  # periods of the mean frequency that are tabled


@dataclass(frozen=True)
class NoiseSpectrum:
    """Noise of unit variance, by its power.

    Parameters
    ----------
    frequency
        Evenly spaced from 0 on [Hz].
    power
        At each, in any unit.
    rate
        Amplitude of the rate that a unit sine of each is given [1/s]: 2 π f, or less where rates are smoothed.
    left
        Share of the power at each frequency that is left of noise that had unit variance.
    """

    frequency: Float[np.ndarray, " f"]
    power: Float[np.ndarray, " f"]
    rate: Float[np.ndarray, " f"]
    left: Float[np.ndarray, " f"]

    @classmethod
    def after(cls, passed: LowPass, rate_of_waves: Rates, left: Rates = np.ones_like) -> NoiseSpectrum:
        """White noise that came through a filter, and what is `left` of it.

        `rate_of_waves` gives the rates of sines by their frequency [Hz], `left` shares of the power.
        """
        frequency = np.linspace(0.0, min(HIGHEST * passed.corner, 0.5 / passed.step), FREQUENCIES)
        return cls(frequency, passed.power(frequency), rate_of_waves(frequency), left(frequency))

    def covariance(
        self, lag: Float[np.ndarray, "m n"]
    ) -> tuple[Float[np.ndarray, "m n"], Float[np.ndarray, "m n"], Float[np.ndarray, "m n"]]:
        """Covariance of the noise with itself, of its rate with it, of its rate with its rate.

        `lag` is that of the first argument behind the second [s]: ∫ S cos(2π f τ) df, -∫ S r sin(2π f τ) df and
        ∫ S r² cos(2π f τ) df, with r the rates of unit sines.
        """
        grid, value, mixed, rate = self._tables
        inside = np.abs(lag)
        even = np.interp(inside, grid, value, right=0.0)
        odd = np.sign(lag) * np.interp(inside, grid, mixed, right=0.0)
        return even, odd, np.interp(inside, grid, rate, right=0.0)

    @cached_property
    def _tables(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Lags [s], and the three covariances there."""
        power = self.power.copy()
        power[[0, -1]] *= 0.5  # trapezoidal rule
        power /= power.sum()
        power *= self.left
        first = float(self.frequency[1])
        means = [float(each @ self.frequency) / max(each.sum(), 1e-300) for each in (power, power * self.rate**2)]
        own, slowest = max(means[0], first), max(min(means), first)  # smoothed rates may be slower than values
        longest = min(LONGEST / slowest, 0.5 / first)  # from there on a sum over frequencies runs backwards
        grid = np.linspace(0.0, longest, max(round((LAGS - 1) * longest * own / LONGEST), 1) + 1)
        even, odd = _waves(self.frequency, grid, np.array([power, power * self.rate, power * self.rate**2]))
        return grid, even[0], -odd[1], even[2]


def _waves(
    frequency: Float[np.ndarray, " f"], grid: Float[np.ndarray, " g"], weights: Float[np.ndarray, "k f"]
) -> tuple[Float[np.ndarray, "k g"], Float[np.ndarray, "k g"]]:
    """Weighed sums of cosines and of sines at evenly spaced lags from 0 on.

    exp(iφ(a + b)) = exp(iφa) exp(iφb): of n lags 2√n have exponentials of their own.
    """
    inner = int(np.ceil(np.sqrt(len(grid))))
    outer, phase = -(-len(grid) // inner), 2j * np.pi * frequency * (grid[1] if len(grid) > 1 else 0.0)
    near, far = (np.exp(phase * (step * np.arange(n))[:, None]) for step, n in ((1, inner), (inner, outer)))
    sums = np.array([((far * own) @ near.T).ravel()[: len(grid)] for own in weights])
    return sums.real, sums.imag


@runtime_checkable
class InputNoise(Protocol):
    """What noise of unit variance of each input makes of some samples of some channels."""

    def covariance(self, at: Int[np.ndarray, " n"], channel: Int[np.ndarray, " n"]) -> Float[np.ndarray, "j n n"]:
        """Covariance of samples `at` of the channels `channel`, for each input."""


@dataclass(frozen=True)
class Instant:
    """Noise that is felt while it is there.

    Parameters
    ----------
    time
        Of each sample [s].
    to_value, to_rate
        How the outputs answer to an input's value and rate.
    spectra
        Of the noise of each input.
    """

    time: Float[np.ndarray, " t"]
    to_value: Float[np.ndarray, "t c j"]
    to_rate: Float[np.ndarray, "t c j"]
    spectra: tuple[NoiseSpectrum, ...]

    def covariance(self, at: Int[np.ndarray, " n"], channel: Int[np.ndarray, " n"]) -> Float[np.ndarray, "j n n"]:
        """a aᵀ C + (b aᵀ - a bᵀ) C' + b bᵀ C'' with the covariances C of the noise and its rate.

        These are looked up once for two samples, whatever number of channels there is.
        """
        samples, own = np.unique(at, return_inverse=True)
        lag, pairs = self.time[samples][:, None] - self.time[samples], np.ix_(own, own)
        found = np.empty((self.to_value.shape[-1], len(at), len(at)))
        for j, spectrum in enumerate(self.spectra):
            a, b = self.to_value[at, channel, j], self.to_rate[at, channel, j]
            if not a.any() and not b.any():
                found[j] = 0.0
                continue
            value, mixed, rate = (each[pairs] for each in spectrum.covariance(lag))
            found[j] = value * np.outer(a, a) + mixed * (np.outer(b, a) - np.outer(a, b)) + rate * np.outer(b, b)
        return found


@dataclass(frozen=True)
class Lasting:
    """Noise whose response lasts.

    Parameters
    ----------
    time
        Of each sample [s].
    response
        Of sample i of channel c to a unit change of input j at sample i - l, for l from `-ahead` on.
    ahead
        Samples by which outputs are ahead of an input, as rates from both sides make them.
    spectra
        Of the noise of each input.
    """

    time: Float[np.ndarray, " t"]
    response: Float[np.ndarray, "j t c l"]
    ahead: int
    spectra: tuple[NoiseSpectrum, ...]

    def covariance(self, at: Int[np.ndarray, " n"], channel: Int[np.ndarray, " n"]) -> Float[np.ndarray, "j n n"]:
        """R C Rᵀ over the samples of the inputs that are felt."""
        longest = self.response.shape[-1]
        first = max(int(at.min()) - longest + 1 + self.ahead, 0)
        felt = np.arange(first, min(int(at.max()) + self.ahead + 1, len(self.time)))
        lag = at[:, None] - felt + self.ahead
        inside = (lag >= 0) & (lag < longest)
        apart = self.time[felt][:, None] - self.time[felt]
        found = np.empty((len(self.response), len(at), len(at)))
        for j, response in enumerate(self.response):
            if not response.any():
                found[j] = 0.0
                continue
            rows = np.where(inside, response[at[:, None], channel[:, None], np.where(inside, lag, 0)], 0.0)
            found[j] = rows @ self.spectra[j].covariance(apart)[0] @ rows.T
        return found
