"""Noise with heavy tails as a mixture of scales: each sample, and each stretch, has a precision of its own.

A residual d is normal with variance s²/w, and w has a gamma distribution of mean 1 and ν/2 as its shape, so that d has
Student's distribution with ν degrees of freedom. Given d, the most one may expect of w is (ν + 1)/(ν + d²/s²), and ν
and s are those that make the residuals most likely, by expectation and maximisation (Lange, Little & Taylor 1989,
J. Am. Stat. Assoc. 84:881). Weighed so, no sample's square is more than ν + 1 noise variances. A stretch of n samples
that is still louder than that gets the same for the whole of it, (ν + n)/(ν + q), q the sum of its weighed squares.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.identify.optimise.bounded_gauss_newton import CLOSE, LIMIT

DEGREES = (1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0)
"""Degrees of freedom that are tried; with more a sample of four standard deviations still weighs a third or more."""
NARROWEST = 1e-3
"""Share of the variance, that a scale squared is at the least: samples that happen to agree exactly are no noise
level."""


@dataclass(frozen=True)
class StudentNoise:
    """Degrees of freedom, scale, and what the residuals gain in logarithm of likelihood over a normal one [nats].

    `spread` is the gain's standard deviation over draws of as many residuals: that of a sum of what each gains (Vuong
    1989, Econometrica 57:307).
    """

    degrees: float
    scale: float
    gain: float
    spread: float

    @property
    def words(self) -> str:
        """What is seen."""
        return f"noise with heavy tails (Student's with {self.degrees:g} degrees of freedom)"

    def weights(self, residuals: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
        """Weights of single samples."""
        return np.asarray((self.degrees + 1.0) / (self.degrees + (residuals / self.scale) ** 2))

    def weights_of_stretches(self, residuals: Sequence[Float[np.ndarray, " _"]]) -> list[Float[np.ndarray, " _"]]:
        """Weights of samples that belong together in stretches: a sample's own, times that of its stretch."""
        found = []
        for part in residuals:
            own = self.weights(part)
            square = float((own * (part / self.scale) ** 2).sum())
            whole = (self.degrees + len(part)) / (self.degrees + square)
            found.append(own * min(whole, 1.0))
        return found


def student_noise(residuals: Float[np.ndarray, " n"]) -> StudentNoise:
    """The most likely of `DEGREES` and its scale; one that gains nothing where all residuals are 0."""
    if not residuals.any():
        return StudentNoise(DEGREES[-1], 1.0, 0.0, 0.0)
    found = [_with_degrees(residuals, degrees) for degrees in DEGREES]
    return max(found, key=lambda one: one.gain)


def _with_degrees(residuals: Float[np.ndarray, " n"], degrees: float) -> StudentNoise:
    from scipy.special import gammaln

    squares = residuals**2
    variance = float(squares.mean())
    power = variance
    for _ in range(LIMIT):
        new = float(((degrees + 1.0) * squares / (degrees + squares / power)).mean())
        done = abs(new - power) < CLOSE * power
        power = max(new, NARROWEST * variance)
        if done:
            break
    constant = gammaln(0.5 * (degrees + 1.0)) - gammaln(0.5 * degrees) - 0.5 * np.log(np.pi * degrees * power)
    heavy = constant - 0.5 * (degrees + 1.0) * np.log1p(squares / (degrees * power))
    normal = -0.5 * (np.log(2.0 * np.pi * variance) + squares / variance)
    each = heavy - normal
    return StudentNoise(degrees, float(np.sqrt(power)), float(each.sum()), float(np.sqrt(len(each)) * each.std()))
