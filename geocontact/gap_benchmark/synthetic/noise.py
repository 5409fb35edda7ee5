"""Noise of sensors and of measured inputs, as it is drawn and as its covariance is known."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float
from scipy.linalg import toeplitz
from scipy.signal import butter, filtfilt, freqz, lfilter

USUAL = 6.0
"""Low-pass of measured inputs that most laboratories use [Hz]."""
LOWEST, HIGHEST = 3.0, 20.0
"""That others use [Hz]."""
OTHERS, NOBODY = 0.5, 0.1
"""Shares of others, and of recordings that nobody filtered."""
FAR_FROM_NYQUIST = 0.3
"""Highest corner as a share of the sampling frequency."""
ORDER = 2
"""Of the low-pass that most use, which runs over the data forwards and backwards."""
LONG = 1024
"""Frequencies at which a spectrum is summed."""
SILENT = 1e-7
"""Share of the largest power below which a frequency is left out."""


@runtime_checkable
class SensorNoise(Protocol):
    """Of a sensor: its whole standard deviation, a realisation, and the covariance of `count` samples in a row."""

    @property
    def sd(self) -> float:
        """In the channel's unit."""
        ...

    def draw(self, rng: np.random.Generator, count: int, step: float) -> Float[np.ndarray, " s"]:
        """One realisation."""
        ...

    def covariance(self, count: int, step: float) -> Float[np.ndarray, "s s"]:
        """Of `count` samples in a row."""
        ...


@dataclass(frozen=True)
class Coloured:
    """Sum of two first-order autoregressive processes.

    `sd` is the whole standard deviation; `quick` the lag-one correlation of one part, `slow` [s] the correlation time
    of the other, which holds `share` of the variance.
    """

    sd: float
    quick: float
    slow: float
    share: float

    def parts(self, step: float) -> tuple[tuple[float, float], ...]:
        """(sd, lag-one correlation) of each part."""
        lasting = float(np.exp(-step / self.slow))
        return (self.sd * (1.0 - self.share) ** 0.5, self.quick), (self.sd * self.share**0.5, lasting)

    def draw(self, rng: np.random.Generator, count: int, step: float) -> Float[np.ndarray, " s"]:
        """One realisation."""
        total = np.zeros(count)
        for sd, rho in self.parts(step):
            white = rng.standard_normal(count) * sd * np.sqrt(1.0 - rho * rho)
            white[0] = rng.standard_normal() * sd
            total += lfilter([1.0], [1.0, -rho], white)
        return total

    def covariance(self, count: int, step: float) -> Float[np.ndarray, "s s"]:
        """Of `count` samples in a row."""
        lag = np.arange(count)
        first = np.sum([sd * sd * rho**lag for sd, rho in self.parts(step)], axis=0)
        return np.asarray(toeplitz(first))


@dataclass(frozen=True)
class NoiseFilter:
    """Zero-lag Butterworth: corner [Hz], Nyquist's frequency or more where nobody filtered; order of either pass."""

    corner: float
    order: int = ORDER


def corner_of(rng: np.random.Generator, step: float) -> float:
    """A laboratory's low-pass of measured inputs [Hz]; Nyquist's frequency where nobody filtered."""
    other = np.exp(rng.uniform(np.log(LOWEST), np.log(min(HIGHEST, FAR_FROM_NYQUIST / step))))
    which = rng.random()
    if which < NOBODY:
        return 0.5 / step
    return float(other if which < NOBODY + OTHERS else USUAL)


def unfiltered(step: float, passed: NoiseFilter) -> bool:
    """Whether noise stayed white."""
    return passed.corner >= 0.5 / step


def smooth_noise(
    rng: np.random.Generator, sd: float, count: int, step: float, passed: NoiseFilter
) -> Float[np.ndarray, " s"]:
    """White noise through a zero-lag Butterworth low-pass, as motion data come; `sd` is that of the outcome."""
    if unfiltered(step, passed):
        return np.asarray(sd * rng.standard_normal(count))
    b, a = butter(passed.order, passed.corner, fs=1.0 / step)
    pad = int(1.0 / step)
    raw = filtfilt(b, a, rng.standard_normal(count + 2 * pad))[pad : pad + count]
    return np.asarray(raw * sd / np.sqrt(spectrum(step, passed)[1].sum()))


def spectrum(step: float, passed: NoiseFilter) -> tuple[Float[np.ndarray, " f"], Float[np.ndarray, " f"]]:
    """Angular frequencies [rad/s] and the power at each of unit white noise after the filter."""
    grid = (np.arange(LONG) + 0.5) * np.pi / LONG
    if unfiltered(step, passed):
        return grid / step, np.full(LONG, 1.0 / LONG)
    b, a = butter(passed.order, passed.corner, fs=1.0 / step)
    _, response = freqz(b, a, worN=grid)
    return grid / step, np.abs(response) ** 4 / LONG


def smooth_covariance(sd: float, count: int, step: float, passed: NoiseFilter) -> tuple[Float[np.ndarray, "s s"], ...]:
    """Covariance of such noise with itself, of the noise with its rate, and of the rate with itself."""
    place, cross, rate = unit_covariance(count, step, passed)
    return sd * sd * place, sd * sd * cross, sd * sd * rate


@functools.lru_cache(maxsize=16)
def unit_covariance(count: int, step: float, passed: NoiseFilter) -> tuple[Float[np.ndarray, "s s"], ...]:
    """The same for a standard deviation of 1; rates are those of a cubic spline through the samples.

    A sine of the angular frequency w then has 3 sin(w h)/(h (2 + cos(w h))) for w, h the time between two samples.
    """
    omega, weight = spectrum(step, passed)
    weight = weight / weight.sum()
    heard = weight > SILENT * weight.max()
    omega, weight = omega[heard], weight[heard]
    angle = np.outer(np.arange(count) * step, omega)
    cosine = np.cos(angle)
    slope = 3.0 * np.sin(omega * step) / (step * (2.0 + np.cos(omega * step)))
    with_rate = np.sin(angle) @ (weight * slope)  # cov(q(t), q'(s)) = sum w slope sin(omega (t - s))
    return toeplitz(cosine @ weight), toeplitz(with_rate, -with_rate), toeplitz(cosine @ (weight * slope**2))
