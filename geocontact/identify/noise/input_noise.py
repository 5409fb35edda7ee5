"""Covariance that the noise of inputs makes of a trial's outputs, for models with and without a motion of their own.

A model without one answers at every moment to the inputs' values and rates at that moment: a_j n_j + b_j n_j' with
sensitivities a and b over time (`Instant`). One with inertia goes on answering: the noise of every recorded sample is
followed by a response, and outputs are the sum of these (`Lasting`), r = R n.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float, Int

from geocontact.identify.noise.noise_spectrum import NoiseSpectrum


@runtime_checkable
class InputNoise(Protocol):
    """What noise of unit variance of each input makes of some samples of some channels."""

    def covariance(self, at: Int[np.ndarray, " n"], channel: Int[np.ndarray, " n"]) -> Float[np.ndarray, "j n n"]:
        """Of samples `at` of the channels `channel`, for each input."""


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
