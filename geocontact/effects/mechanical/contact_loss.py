"""The interface cannot pull, or opens by a gap.

F = (x + sqrt(x² + r²))/2, x = F_base - L: nothing is carried below what would be the load L >= 0 (stiffness times gap),
and nothing is ever pulled; with L = 0 the interface only cannot pull. The shape r >= 0 rounds the corner: a pad whose
edge meets the body before the rest does; r = 0 is max(x, 0). A mat on the body pushes to one side; where either side
may be open ("positive", "negative") each is a candidate of its own. At L = -infinity the contact is glued.
"""

from __future__ import annotations

import numpy as np

from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.links import Source
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import largest_load, with_law


def one_sided(system: System, variant: str, side: float) -> Candidate:
    """Contact that pushes to one side: amplitude L, shape r."""
    most, unit = largest_load(system), system.law.load
    name = f"contact_loss.{variant}" if variant else "contact_loss"
    opening = Parameter(f"{name}.opening", unit, 0.3 * most, 0.0, 2.0 * most)
    rounding = Parameter(f"{name}.rounding", unit, 0.01 * most, 0.0, 0.3 * most)
    numbers: dict[str, Source] = {"contact_loss.opening": opening.name, "contact_loss.rounding": rounding.name}
    law = with_law({**numbers, "contact_loss.side": side})
    others = ({opening.name: 0.02 * most}, {opening.name: most})
    neutral = {opening.name: -np.inf}
    return Candidate("contact_loss", variant, "constitutive", (opening, rounding), law, neutral, others)


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate for what only pushes, such as a mat; else one per side."""
    if system.traits.pushes_only:
        return (one_sided(system, "", 1.0),)
    return one_sided(system, "positive", 1.0), one_sided(system, "negative", -1.0)


CONTACT_LOSS = Effect(
    "contact_loss",
    "constitutive",
    offer,
    "unilateral contact: Signorini (1933); smooth positive part of the contact laws",
    ("contact_loss.opening", "contact_loss.rounding", "contact_loss.side"),
)
