"""Strap tension: force at zero deflection.

F += T min(max(1 + c u, 0), 1): T at rest, of either sign because the sensor's sense is; c >= 0 [1/m] lets the strap go
slack at u = -1/c, c = 0 leaves the tension constant.
"""

from __future__ import annotations

from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import largest_load, with_law


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate: amplitude T, shape c."""
    scale, law, most = system.scale, system.law, largest_load(system)
    tension = Parameter("preload.tension", law.load, 0.1 * most, -most, most)
    slackening = Parameter("preload.slackening", f"1/{law.deflection}", 0.0, 0.0, 20.0 / scale.deflection)
    link = with_law({"preload.tension": tension.name, "preload.slackening": slackening.name})
    others = ({tension.name: -tension.start}, {slackening.name: 3.0 / scale.deflection})
    return (Candidate("preload", "", "constitutive", (tension, slackening), link, {tension.name: 0.0}, others),)


PRELOAD = Effect(
    "preload",
    "constitutive",
    offer,
    "a tension-only spring in parallel; strap pressure of the explicit pHRI study",
    ("preload.tension", "preload.slackening"),
)
