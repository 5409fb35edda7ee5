"""Noise of outputs that are a moment over another output: it grows where the divisor is small.

A centre of pressure is q = M/F. Noise of the force of standard deviation s moves the moment about the middle of the
foot by about s a, a the half-range of q; so q has the noise (s a / F) beside what it has at large forces.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from geocontact.chain.system import System
from geocontact.gap.case.usual_range import usual_range


def noise_spread(
    system: System, outputs: Sequence[Float[np.ndarray, "_ c"]], rough: Float[np.ndarray, " c"]
) -> list[Float[np.ndarray, "_ c"]]:
    """Per trial, how many times its median each sample's sensor noise is; 1 for outputs that are no quotient.

    Parameters
    ----------
    outputs
        Measured, per trial.
    rough
        Noise of each output where it is typical.
    """
    spread = [np.ones_like(each) for each in outputs]
    for name, divisor in system.quotients.items():
        c, d = system.outputs.index(name), system.outputs.index(divisor)
        together = np.concatenate([each[:, c] for each in outputs])
        if not np.isfinite(together).any():
            continue
        low, high = usual_range(together)
        moment = rough[d] * 0.5 * (high - low)
        own = [np.hypot(rough[c], moment / np.maximum(np.abs(each[:, d]), rough[d])) for each in outputs]
        measured = np.concatenate([s[np.isfinite(each[:, c])] for s, each in zip(own, outputs, strict=True)])
        typical = float(np.nanmedian(measured))
        for made, each in zip(spread, own, strict=True):
            made[:, c] = np.where(np.isfinite(each), each / typical, 1.0)
    return spread
