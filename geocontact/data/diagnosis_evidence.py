"""What figures of a diagnosis show beside the answer: trials that were held out, and every model that was tried."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True, eq=False)
class HeldOut:
    """One held-out trial, SI units; NaN where nothing was measured.

    Parameters
    ----------
    name
        Of the trial.
    time
        Of each sample [s].
    measured, base
        As recorded, and as the base model, refitted to the calibration trials, predicts it.
    named
        With the effects of the answer, or of the most probable candidate where there are too many; None without.
    """

    name: str
    time: Float[np.ndarray, " t"]
    measured: Float[np.ndarray, "t c"]
    base: Float[np.ndarray, "t c"]
    named: Float[np.ndarray, "t c"] | None

    @property
    def phase(self) -> Float[np.ndarray, " t"]:
        """Time as a fraction of the trial."""
        return np.asarray((self.time - self.time[0]) / (self.time[-1] - self.time[0]))


@dataclass(frozen=True)
class Ranked:
    """A model that was tried.

    Parameters
    ----------
    label
        Its candidates, "none" for the base model, "unknown" for the surrogate of anything that has no name.
    effects
        Of the vocabulary, joined by " + ".
    gain
        Logarithm of the evidence over that of the base model, all trials [nats].
    calibration
        The same on the calibration trials alone.
    probability
        Of this answer, at the best of its models; None at the others, and for pairs, whose probability is in their two.
    """

    label: str
    effects: str
    gain: float
    calibration: float
    probability: float | None
