"""Strap tension: force at zero deflection.

F += T min(max(1 + c u, 0), 1): T at rest, of either sign because the sensor's sense is; c >= 0 [1/m] lets the strap go
slack at u = -1/c, c = 0 leaves the tension constant.
"""

from __future__ import annotations

from geocontact.chain.candidate import Candidate, Effect
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import with_law


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate: amplitude T, shape c."""
    scale = system.scale
    tension = Parameter("preload.tension", "N", 0.1 * scale.of("force"), -scale.of("force"), scale.of("force"))
    slackening = Parameter("preload.slackening", "1/m", 0.0, 0.0, 20.0 / scale.deflection)
    law = with_law({"preload.tension": tension.name, "preload.slackening": slackening.name})
    others = ({tension.name: -tension.start}, {slackening.name: 3.0 / scale.deflection})
    return (Candidate("preload", "", "constitutive", (tension, slackening), law, {tension.name: 0.0}, others),)


PRELOAD = Effect(
    "preload",
    "constitutive",
    ("elbow",),
    offer,
    "a tension-only spring in parallel; strap pressure of the explicit pHRI study",
)
