"""Noise whose power falls with a power of the frequency, above a white floor; its tails may be heavy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.fft import irfft, next_fast_len, rfft, rfftfreq
from scipy.linalg import toeplitz


@dataclass(frozen=True)
class PowerLawNoise:
    """Power white + (1 - white) (1 + (f longest)²)^(-exponent/2), scaled to `sd`; nearly 1/f for an exponent of 1.

    Parameters
    ----------
    sd
        Whole standard deviation.
    exponent
        0: white.
    longest
        Time beyond which it is even again [s].
    white
        Share of the variance.
    freedom
        Degrees of freedom of Student's distribution of what is filtered, above 2; infinite: normal.
    """

    sd: float
    exponent: float = 0.0
    longest: float = 1.0
    white: float = 0.0
    freedom: float = np.inf

    def draw(self, rng: np.random.Generator, count: int, step: float) -> Float[np.ndarray, " s"]:
        """One realisation."""
        length, power = self._power(count, step)
        raw = rng.standard_normal(length)
        if np.isfinite(self.freedom):
            raw = rng.standard_t(self.freedom, length) * np.sqrt(1.0 - 2.0 / self.freedom)
        return np.asarray(self.sd * irfft(rfft(raw) * np.sqrt(power), length)[:count])

    def covariance(self, count: int, step: float) -> Float[np.ndarray, "s s"]:
        """Of `count` samples in a row."""
        length, power = self._power(count, step)
        return np.asarray(toeplitz(self.sd**2 * irfft(power, length)[:count]))

    def _power(self, count: int, step: float) -> tuple[int, Float[np.ndarray, " f"]]:
        """Length of a period that is long enough, and the power at its frequencies; 1 on average over both sides."""
        length = next_fast_len(2 * (count + int(self.longest / step)), real=True)
        falling = (1.0 + (rfftfreq(length, step) * self.longest) ** 2) ** (-0.5 * self.exponent)
        mean = irfft(falling, length)[0]
        return length, self.white + (1.0 - self.white) * falling / mean
