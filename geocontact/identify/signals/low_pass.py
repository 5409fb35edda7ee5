"""Noise that has been through the low-pass filter that motion data usually come through.

A second-order Butterworth filter run both ways over a recording (Winter, Biomechanics and Motor Control, 2009, ch. 3)
lets the power 1/(1 + (tan(π f Δ)/tan(π f_c Δ))^4)² through, Δ the time between two samples: the tangents are what the
bilinear transform makes of frequencies (Oppenheim & Schafer, Discrete-Time Signal Processing, 2010, ch. 7).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

BELOW_NYQUIST = 0.9  # highest corner that a recording can tell


@dataclass(frozen=True)
class LowPass:
    """The filter.

    Parameters
    ----------
    corner
        Frequency at which a quarter of the power passes both ways [Hz]; from Nyquist's on nothing was filtered.
    step
        Time between two samples [s].
    """

    corner: float
    step: float

    @classmethod
    def none(cls, step: float) -> LowPass:
        """Nothing was filtered."""
        return cls(0.5 / step, step)

    def power(self, frequency: Float[np.ndarray, " f"]) -> Float[np.ndarray, " f"]:
        """Share of the power that passes at each frequency [Hz], none from Nyquist's on."""
        nyquist = 0.5 / self.step
        if self.corner >= nyquist:
            return np.where(frequency < nyquist, 1.0, 0.0)
        corner = min(self.corner, BELOW_NYQUIST * nyquist)
        angle = np.pi * np.minimum(frequency, (1.0 - 1e-9) * nyquist) * self.step
        return np.asarray(1.0 / (1.0 + (np.tan(angle) / np.tan(np.pi * corner * self.step)) ** 4) ** 2)
