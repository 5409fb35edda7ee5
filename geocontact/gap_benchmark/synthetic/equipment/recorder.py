"""What becomes of noise in a recorder: it may grow with what is measured, a quotient divides it, numbers have steps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

Outputs = Float[np.ndarray, "c t"]


@dataclass(frozen=True)
class Quotient:
    """An output that is computed as a moment over another output, `divisor`, both of them noisy.

    The noise that is stated for the channel is its own where the divisor is `reference`.
    """

    divisor: int
    reference: float


@dataclass(frozen=True)
class Recorder:
    """By row of outputs or inputs; nothing of the kind where a row is missing.

    Parameters
    ----------
    growth
        Noise grows by sqrt(1 + (growth y)²); in one over the output's unit.
    hurry
        It grows by sqrt(1 + (hurry Δy)²), Δy the output's change from sample to sample; in one over its unit.
    quotients
        Outputs that are computed from others.
    output_steps, input_steps
        What numbers are multiples of, noise and all.
    """

    growth: Mapping[int, float] = field(default_factory=dict)
    hurry: Mapping[int, float] = field(default_factory=dict)
    quotients: Mapping[int, Quotient] = field(default_factory=dict)
    output_steps: Mapping[int, float] = field(default_factory=dict)
    input_steps: Mapping[int, float] = field(default_factory=dict)

    def noisy(self, clean: Outputs, noise: Outputs) -> Outputs:
        """Outputs with noise as it arises; that of a quotient is in `noise` as if it divided by the reference."""
        out = np.asarray(clean + self._grown(clean) * noise)
        for row, one in self.quotients.items():
            moment = clean[row] * clean[one.divisor] + one.reference * noise[row]
            by = out[one.divisor]
            out[row] = np.divide(moment, by, out=np.full_like(moment, np.nan), where=by != 0.0)
        return out

    def mixing(self, clean: Outputs) -> Float[np.ndarray, "c c t"]:
        """How much of each channel's noise is in each output, as far as it is linear; 0 where there is no value."""
        mixed = np.eye(len(clean))[:, :, None] * self._grown(clean)
        for row, one in self.quotients.items():
            by = np.where(clean[one.divisor] != 0.0, clean[one.divisor], np.nan)
            mixed[row] = -clean[row] / by * mixed[one.divisor]
            mixed[row, row] = one.reference / by
        return np.asarray(np.nan_to_num(mixed))

    def rounded(self, values: Outputs, steps: Mapping[int, float]) -> Outputs:
        """The nearest numbers that it can write."""
        out = values.copy()
        for row, step in steps.items():
            out[row] = np.round(values[row] / step) * step
        return out

    def _grown(self, clean: Outputs) -> Outputs:
        factor = np.ones_like(clean)
        for row, slope in self.growth.items():
            factor[row] = np.sqrt(1.0 + (slope * clean[row]) ** 2)
        for row, slope in self.hurry.items():
            factor[row] *= np.sqrt(1.0 + (slope * np.nan_to_num(np.gradient(clean[row]))) ** 2)
        return factor


EXACT = Recorder()
"""Noise is as large everywhere, and numbers are written in full."""
