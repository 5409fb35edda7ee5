"""Recordings as inputs of equations: splines with as many derivatives as a prescribed coordinate needs."""

from __future__ import annotations

from dataclasses import dataclass
from math import factorial

import numpy as np
from jaxtyping import Float
from scipy.interpolate import PPoly, make_interp_spline

SMOOTH = 5
"""Degree of the splines: accelerations have continuous derivatives of second order."""


@dataclass(frozen=True, eq=False)
class RecordedInputs:
    """Inputs over time, piece by piece polynomials; a stepper with machine code evaluates them there.

    Parameters
    ----------
    breaks
        Where pieces end [s], increasing.
    coefficients
        Of (t - start of the piece), highest power first, for each input.
    """

    breaks: Float[np.ndarray, " m1"]
    coefficients: Float[np.ndarray, "m n k"]

    @property
    def count(self) -> int:
        """How many inputs there are."""
        return int(self.coefficients.shape[1])

    def __call__(self, t: float) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, " n"]]:
        """Inputs and their derivatives; the first and last pieces go on beyond the ends."""
        piece = min(max(int(self.breaks.searchsorted(t, "right")) - 1, 0), len(self.coefficients) - 1)
        s, value, slope = t - self.breaks[piece], np.zeros(self.count), np.zeros(self.count)
        for coefficient in self.coefficients[piece].T:
            slope = slope * s + value
            value = value * s + coefficient
        return value, slope

    def at(self, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t n"]:
        """Inputs at many times."""
        return np.asarray(PPoly(self.coefficients.transpose(2, 0, 1), self.breaks)(time))

    def beside(self, other: RecordedInputs) -> RecordedInputs:
        """These inputs, then the others, over the time that both know."""
        breaks = np.union1d(self.breaks, other.breaks)
        first, last = (pick(self.breaks[k], other.breaks[k]) for pick, k in ((max, 0), (min, -1)))
        breaks = breaks[(breaks >= first) & (breaks <= last)]
        powers = max(self.coefficients.shape[2], other.coefficients.shape[2])
        parts = [_widened(each.refined(breaks), powers) for each in (self, other)]
        return RecordedInputs(breaks, np.concatenate(parts, axis=1))

    def refined(self, breaks: Float[np.ndarray, " b1"]) -> Float[np.ndarray, "b n k"]:
        """Coefficients of the same polynomials from other breaks, among which are its own."""
        curve = PPoly(self.coefficients.transpose(2, 0, 1), self.breaks)
        powers = [(curve.derivative(j) if j else curve)(breaks[:-1]) / factorial(j) for j in range(len(curve.c))]
        return np.stack(powers[::-1], axis=2)


def recorded_inputs(
    time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t n"], *, derivatives: int = 0
) -> RecordedInputs:
    """Splines of degree 5 through recorded values, filtered as they are to be, then their derivatives.

    The order is that of `Equations.w` with `derivatives` = 2: all values, all rates, all accelerations.

    Parameters
    ----------
    time
        [s], increasing, `SMOOTH` + 1 of them at least.
    values
        One column for each input. ValueError where one is missing.
    derivatives
        How many of them follow the values.
    """
    if len(time) <= SMOOTH:
        raise ValueError(f"{len(time)} samples are too few for a spline of degree {SMOOTH}; {SMOOTH + 1} are needed")
    if not np.isfinite(values).all():
        raise ValueError("samples are missing; fill the gaps first")
    spline = make_interp_spline(time, values, k=SMOOTH)
    breaks = np.unique(spline.t)
    powers = [spline(breaks[:-1], j) / factorial(j) for j in range(SMOOTH + 1)]
    piece = np.stack(powers[::-1], axis=2)
    parts = [piece]
    for _ in range(derivatives):
        piece = _widened(piece[:, :, :-1] * np.arange(piece.shape[2] - 1, 0, -1), piece.shape[2])
        parts.append(piece)
    return RecordedInputs(breaks, np.concatenate(parts, axis=1))


def linear_inputs(time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t n"]) -> RecordedInputs:
    """Inputs that are linear between samples [s]: for what sets in at once, around which a spline would swing."""
    slopes = np.diff(values, axis=0) / np.diff(time)[:, None]
    return RecordedInputs(time, np.stack([slopes, values[:-1]], axis=2))


def stepped_inputs(breaks: Float[np.ndarray, " m1"], values: Float[np.ndarray, "m n"]) -> RecordedInputs:
    """Inputs that are constant between breaks [s]."""
    return RecordedInputs(breaks, np.asarray(values, float)[:, :, None])


def _widened(coefficients: Float[np.ndarray, "m n k"], degree: int) -> Float[np.ndarray, "m n w"]:
    """The same polynomials with powers up to one less than `degree`."""
    missing = degree - coefficients.shape[2]
    return np.ascontiguousarray(np.pad(coefficients, ((0, 0), (0, 0), (missing, 0))))
