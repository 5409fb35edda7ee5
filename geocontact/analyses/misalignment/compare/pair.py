"""One channel of one trial, measured and by the model."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.analyses.misalignment.labels import CONSTRAINT
from geocontact.identify.signals.agreement import Agreement
from geocontact.identify.signals.angle_bins import angle_bins, edges_over
from geocontact.view.curves.quantity import Quantity

QUANTITIES = {"force": CONSTRAINT, "displacement": Quantity("displacement of the joint", "mm", 1e3)}
"""What channels are called and shown in."""


@dataclass(frozen=True, eq=False)
class Pair:
    """Measured and model at the trial's even times, SI units, and how they agree."""

    trial: str
    channel: str
    time: Float[np.ndarray, " t"]
    beta: Float[np.ndarray, " t"]
    measured: Float[np.ndarray, " t"]
    model: Float[np.ndarray, " t"]
    agreement: Agreement

    def binned(self, width: float) -> Float[np.ndarray, "b 3"]:
        """Means of angle, measured and model over bins of the angle [rad]."""
        there = np.isfinite(self.measured)
        edges = edges_over([self.beta[there]], width)
        values = np.column_stack([self.beta, self.measured, self.model])[there]
        return np.asarray(angle_bins([self.time[there]], [values], edges, np.inf).cells().means)
