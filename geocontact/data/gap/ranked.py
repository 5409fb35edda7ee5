"""A model that a diagnosis tried, and what it gains."""

from __future__ import annotations

from dataclasses import dataclass


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
