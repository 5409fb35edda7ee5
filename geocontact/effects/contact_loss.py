"""The interface cannot pull, or opens by a gap.

F = max(F_base(e), 0), e = (v + sqrt(v² + r²))/2, v = u - g: nothing is carried before a gap g >= 0 is closed, and
nothing is ever pulled; with g = 0 the interface only cannot pull. The shape r >= 0 rounds the corner: a pad whose edge
meets the body before the rest does. A mat on the body pushes to one side; where either side may be open ("positive",
"negative") each is a candidate of its own. At g = -infinity the contact is glued.
"""

from __future__ import annotations

import numpy as np

from geocontact.chain.candidate import Candidate, Effect
from geocontact.chain.slots import Source
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import with_law


def opening(system: System, variant: str, side: float) -> Candidate:
    """Contact that pushes to one side: amplitude g, shape r."""
    scale, unit = system.scale, system.law.deflection
    edge = scale.high if side > 0.0 else -scale.low
    most = edge if edge > 0.0 else scale.deflection
    name = f"contact_loss.{variant}" if variant else "contact_loss"
    gap = Parameter(f"{name}.gap", unit, 0.3 * most, 0.0, 0.95 * most)
    rounding = Parameter(f"{name}.rounding", unit, 0.01 * most, 0.0, 0.3 * most)
    numbers: dict[str, Source] = {"contact_loss.gap": gap.name, "contact_loss.rounding": rounding.name}
    law = with_law({**numbers, "contact_loss.side": side})
    others = ({gap.name: 0.02 * most}, {gap.name: 0.6 * most})
    neutral = {gap.name: -np.inf}
    return Candidate("contact_loss", variant, "constitutive", (gap, rounding), law, neutral, others)


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate for a mat, which is pushed; else one per side."""
    if system.name == "sit_to_stand":
        return (opening(system, "", 1.0),)
    return opening(system, "positive", 1.0), opening(system, "negative", -1.0)


CONTACT_LOSS = Effect(
    "contact_loss",
    "constitutive",
    ("shoulder", "sit_to_stand"),
    offer,
    "unilateral contact: Signorini (1933); smooth positive part of the contact laws",
    ("contact_loss.gap", "contact_loss.rounding", "contact_loss.side"),
)
