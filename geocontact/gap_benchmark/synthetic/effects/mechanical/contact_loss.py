"""A pad that opens strip by strip, and sits closer once it was pressed until it has opened again.

planted:   u -> mean over strips at heights h of max(u - h + s g q, 0); h = (1 - e)g .. (1 + e)g, e = 0.3..0.45, the
           more of them the lower; q from 0 to 1 as u rises from 0.9 g to 1.3 g, back as it falls from 0.8 g to 0.4 g,
           s = 0.2..0.35
candidate: (v + sqrt(v^2 + r^2))/2, v = u - g
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.compile import loop
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, NotFoundError, Rng, SyntheticMagnitudes

LIFTED = 0.3
"""Of the largest deflection, how far the other way an interface may be moved that cannot pull: further, and the arm of
an exoskeleton would fall off."""
STRIPS = 24
"""Of the pad; more change nothing."""


@loop
def seated(u: Float[np.ndarray, " t"], gap: float) -> Float[np.ndarray, " t"]:
    """How closely the pad sits, 0..1; rate-independent, at first as on the way up."""
    out = np.empty(u.size)
    now = 0.0
    for i in range(u.size):
        rising = min(max((u[i] / gap - 0.9) / 0.4, 0.0), 1.0)
        falling = min(max((u[i] / gap - 0.4) / 0.4, 0.0), 1.0)
        now = min(max(now, rising), falling)
        out[i] = now
    return out


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: mean gap g [m], within the range of the deflection."""
    spread, lean, closer = rng.uniform(0.3, 0.45), rng.uniform(1.3, 1.8), rng.uniform(0.2, 0.35)
    side = 1.0 if scale.high >= -scale.low else -1.0
    low, high = (scale.low, scale.high) if side > 0.0 else (-scale.high, -scale.low)
    if low < -LIFTED * high:
        raise NotFoundError("the interface pulls as well as it pushes")
    at = (np.arange(STRIPS) + 0.5) / STRIPS

    def hooks(gap: float) -> Hooks:
        heights = gap * (1.0 + spread * (2.0 * at**lean - 1.0))

        def closed(u: Values) -> Values:
            pressed = side * u
            overlap = np.maximum((pressed + closer * gap * seated(pressed, gap))[:, None] - heights, 0.0)
            return np.asarray(side * overlap.mean(axis=1))

        return Hooks(play=(closed,))

    least = max(low, 0.02 * high)
    most = max(least + 0.6 * (high - least), 0.9 * least)
    variant = "" if scale.system == "sit_to_stand" else ("positive" if side > 0.0 else "negative")
    return Draw(0.8 * least, most, hooks, lambda g: f"the pad opens strip by strip, by {g:.3g} m in the mean", variant)


CONTACT_LOSS = InjectionPlan(
    "contact_loss", ("shoulder", "sit_to_stand"), "strips, closer once pressed", "rounded corner", draw, placed=True
)
