"""Sensor noise with a random walk beside it, as a zero wanders with the temperature of a room."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.noise import SensorNoise


@dataclass(frozen=True)
class Wandering:
    """A sensor is set to zero before a trial and walks from there, another way in every trial.

    Parameters
    ----------
    beside
        The other noise.
    walk
        Standard deviation of the walk after one second; it grows with the root of time.
    """

    beside: SensorNoise
    walk: float

    @property
    def sd(self) -> float:
        """Of the other noise, which is all that there is at the start."""
        return self.beside.sd

    def draw(self, rng: np.random.Generator, count: int, step: float) -> Float[np.ndarray, " s"]:
        """One realisation."""
        noise = self.beside.draw(rng, count, step)
        by = self.walk * np.sqrt(step) * rng.standard_normal(count - 1)
        return np.asarray(noise + np.concatenate([[0.0], np.cumsum(by)]))

    def covariance(self, count: int, step: float) -> Float[np.ndarray, "s s"]:
        """Of the first `count` samples of a trial: that of a walk is the time of the earlier one."""
        time = step * np.arange(count)
        return np.asarray(self.beside.covariance(count, step) + self.walk**2 * np.minimum(time[:, None], time))
