"""Errors on held-out trials: what a residual weighs there, and which share of the error is gone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from geocontact.gap.case.plain_fit import Plain
from geocontact.gap.case.whitening import Whitening


@dataclass(frozen=True)
class TrialWeight:
    """What a residual of one trial weighs: (I + B Q Bᵀ)^(-1/2) D⁻¹, D the floor, B Q Bᵀ what trials differ by."""

    present: Bool[np.ndarray, "t c"]
    whitening: Whitening

    @classmethod
    def of(
        cls, present: Bool[np.ndarray, "t c"], floor: Float[np.ndarray, " c"], varied: Float[np.ndarray, "t c q"]
    ) -> TrialWeight:
        """From derivatives with respect to what varies, times its standard deviation."""
        return cls(present, Whitening.of(Plain(present, floor), varied))

    def __call__(self, values: Float[np.ndarray, "t c"]) -> Float[np.ndarray, "t c"]:
        """Weighed; 0 where nothing was measured."""
        out = np.zeros(values.shape)
        out[self.present] = self.whitening(values[..., None])[:, 0]
        return out

    def cleared(self, values: Float[np.ndarray, "t c"]) -> Float[np.ndarray, "t c"]:
        """What is left of a residual r, in units of the floor, once the trial's own deviation d is taken out.

        The most probable d is that of the least |r - B d|² + dᵀ Q⁻¹ d; what it leaves is r - B d = (I + B Q Bᵀ)⁻¹ r.
        """
        w, out = self.whitening, np.zeros(values.shape)
        white = w.whitener(values[..., None])[:, 0]
        out[self.present] = white - w.directions @ ((1.0 - (1.0 - w.gains) ** 2) * (w.directions.T @ white))
        return out


def taken_away(before: Sequence[Float[np.ndarray, "_ c"]], after: Sequence[Float[np.ndarray, "_ c"]]) -> float:
    """The largest share of a channel's squared error that is gone, below 0 where all grow; 0 where nothing is there."""
    old, new = (np.sum([(part**2).sum(axis=0) for part in parts], axis=0) for parts in (before, after))
    return float(np.max(1.0 - new[old > 0.0] / old[old > 0.0], initial=-np.inf)) if (old > 0.0).any() else 0.0
