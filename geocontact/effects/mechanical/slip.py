"""The attachment creeps along the limb while its load is above a limit, and stays there.

s' = m sign(f) max(|f| - L, 0), f = k (u - s), F = F_base(u - s): the mobility m >= 0 is the amplitude, the limit L the
shape; large m is a cuff that slides freely above L (an elastic - perfectly plastic element). f is the base spring's
force: further terms do not push the cuff along. Exact over each sample for a deflection linear in time.
"""

from __future__ import annotations

from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import largest_load, with_law


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate: amplitude m, shape L."""
    scale = system.scale
    force, law = largest_load(system), system.law
    soft = scale.deflection / force
    unit = f"{law.deflection}/({law.load} s)"
    mobility = Parameter("slip.mobility", unit, 5.0 * soft / scale.duration, 0.0, 2.0 * soft / scale.step)
    limit = Parameter("slip.limit", law.load, 0.5 * force, 0.02 * force, force)
    link = with_law({"slip.mobility": mobility.name, "slip.limit": limit.name})
    others = ({mobility.name: 0.2 * soft / scale.step, limit.name: 0.7 * force},)
    none = {mobility.name: 0.0}
    return (Candidate("slip", "", "constitutive", (mobility, limit), link, none, others, settles=True),)


SLIP = Effect(
    "slip",
    "constitutive",
    offer,
    "Bingham (1922); elasto-viscoplastic element after Perzyna (1966)",
    ("slip.mobility", "slip.limit"),
)
