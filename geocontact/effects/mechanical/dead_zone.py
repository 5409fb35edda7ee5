"""Slack or backlash: no force inside a play around rest.

F = F_base(u - min(max(u, -(1 - a) w), a w)): w >= 0 is the whole play, a in 0..1 the share of it on the positive side.
"""

from __future__ import annotations

from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import with_law


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate: amplitude w, shape a."""
    stroke = system.scale.high - system.scale.low
    width = Parameter("dead_zone.width", system.law.deflection, 0.1 * stroke, 0.0, stroke)
    share = Parameter("dead_zone.share", "-", 0.5, 0.0, 1.0)
    law = with_law({"dead_zone.width": width.name, "dead_zone.share": share.name})
    others = ({share.name: 0.9}, {share.name: 0.1})
    return (Candidate("dead_zone", "", "constitutive", (width, share), law, {width.name: 0.0}, others),)


DEAD_ZONE = Effect(
    "dead_zone",
    "constitutive",
    offer,
    "Nordin & Gutman (2002) Automatica 38:1633 (backlash models)",
    ("dead_zone.width", "dead_zone.share"),
)
