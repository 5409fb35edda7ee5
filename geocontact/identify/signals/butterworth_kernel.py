"""Sections of a digital filter over many columns: what `butterworth.filtered` calls for long recordings."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.geometry.kernels.compile import kernel


@kernel
def pass_through(
    filters: Float[np.ndarray, "s six"], values: Float[np.ndarray, "t n"], state: Float[np.ndarray, "s two n"]
) -> None:
    """Each section in direct form II transposed, in place (Oppenheim & Schafer 2010, sec. 6.3)."""
    for t in range(values.shape[0]):
        for s in range(filters.shape[0]):
            b0, b1, b2, a1, a2 = filters[s, 0], filters[s, 1], filters[s, 2], filters[s, 4], filters[s, 5]
            for n in range(values.shape[1]):
                x = values[t, n]
                y = b0 * x + state[s, 0, n]
                state[s, 0, n] = b1 * x - a1 * y + state[s, 1, n]
                state[s, 1, n] = b2 * x - a2 * y
                values[t, n] = y
