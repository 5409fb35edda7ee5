"""Sensor noise with something beside it: hum of the mains, a cable that is knocked, a filter in the measuring chain."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.linalg import toeplitz

from geocontact.gap_benchmark.synthetic.noise import NoiseFilter, SensorNoise, smooth_covariance, smooth_noise


@dataclass(frozen=True)
class FilteredNoise:
    """White noise that came through a filter of the measuring chain, above a white floor.

    Parameters
    ----------
    sd
        Whole standard deviation.
    passed
        The filter.
    white
        Share of the variance that was added after it.
    """

    sd: float
    passed: NoiseFilter
    white: float = 0.1

    def draw(self, rng: np.random.Generator, count: int, step: float) -> Float[np.ndarray, " s"]:
        """One realisation."""
        smooth = smooth_noise(rng, self.sd * np.sqrt(1.0 - self.white), count, step, self.passed)
        return np.asarray(smooth + self.sd * np.sqrt(self.white) * rng.standard_normal(count))

    def covariance(self, count: int, step: float) -> Float[np.ndarray, "s s"]:
        """Of `count` samples in a row."""
        smooth = smooth_covariance(self.sd * np.sqrt(1.0 - self.white), count, step, self.passed)[0]
        return np.asarray(smooth + self.white * self.sd**2 * np.eye(count))


@dataclass(frozen=True)
class Humming:
    """Hum of the mains beside other noise, of another phase in every trial; sampled as it is, so that it may fold.

    Parameters
    ----------
    beside
        The other noise.
    hum
        Root mean square of the hum.
    frequency
        Of the mains [Hz].
    third
        Root mean square of its third harmonic, whose phase follows that of the hum.
    """

    beside: SensorNoise
    hum: float
    frequency: float
    third: float = 0.0

    @property
    def sd(self) -> float:
        """Of all together."""
        return float(np.hypot(np.hypot(self.beside.sd, self.hum), self.third))

    def draw(self, rng: np.random.Generator, count: int, step: float) -> Float[np.ndarray, " s"]:
        """One realisation."""
        angle = 2.0 * np.pi * self.frequency * step * np.arange(count) + rng.uniform(0.0, 2.0 * np.pi)
        noise = self.beside.draw(rng, count, step) + np.sqrt(2.0) * self.hum * np.sin(angle)
        return np.asarray(noise + np.sqrt(2.0) * self.third * np.sin(3.0 * angle) if self.third else noise)

    def covariance(self, count: int, step: float) -> Float[np.ndarray, "s s"]:
        """Of `count` samples in a row, over all phases."""
        angle = 2.0 * np.pi * self.frequency * step * np.arange(count)
        along = self.hum**2 * np.cos(angle) + self.third**2 * np.cos(3.0 * angle)
        return np.asarray(self.beside.covariance(count, step) + toeplitz(along))


@dataclass(frozen=True)
class Knocked:
    """A cable that is knocked now and then: a short ringing beside other noise, at a moment of its own in every trial.

    Parameters
    ----------
    beside
        The other noise.
    height
        Largest value of a knock, in standard deviations of the other noise.
    decay, frequency
        Time in which it falls to 1/e [s]; of its ringing [Hz].
    chance
        Of a knock in a trial.
    """

    beside: SensorNoise
    height: float
    decay: float
    frequency: float
    chance: float

    @property
    def sd(self) -> float:
        """Of the other noise: most trials have no more."""
        return self.beside.sd

    def draw(self, rng: np.random.Generator, count: int, step: float) -> Float[np.ndarray, " s"]:
        """One realisation."""
        noise = self.beside.draw(rng, count, step)
        begin, sign, knocked = rng.uniform(0.0, count * step), rng.choice([-1.0, 1.0]), rng.random() < self.chance
        return noise + sign * self._shape(np.arange(count) * step - begin) if knocked else noise

    def covariance(self, count: int, step: float) -> Float[np.ndarray, "s s"]:
        """Of `count` samples in a row, over all moments: that of shot noise as rare as this."""
        shape = self._shape((np.arange(count) + 0.5) * step)
        along = np.correlate(shape, shape, "full")[count - 1 :] * self.chance / count
        return np.asarray(self.beside.covariance(count, step) + toeplitz(along))

    def _shape(self, since: Float[np.ndarray, " s"]) -> Float[np.ndarray, " s"]:
        inside = np.maximum(since, 0.0)
        ringing = np.exp(-inside / self.decay) * np.cos(2.0 * np.pi * self.frequency * inside)
        return np.where(since >= 0.0, self.height * self.beside.sd * ringing, 0.0)
