"""A fraction of one measured channel shows up in another.

out_a → out_a + χ out_b, between force or moment channels of one device, χ of either sign. A linear coupling has no
shape.
"""

from __future__ import annotations

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.links import Channels, Modifier, Values
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import load_channels, with_sensor

RANK = 10.0


def coupled(system: System, source: str, target: str) -> Candidate:
    """What `source` adds to `target`."""
    variant = f"{source}_in_{target}"
    b, a = system.outputs.index(source), system.outputs.index(target)
    share = Parameter(f"crosstalk.{variant}.share", "-", 0.02, -0.5, 0.5)

    def change(outputs: Channels, _: DifferentiatedInputs, values: Values) -> Channels:
        out = outputs.copy()
        out[:, a] += values[share.name] * outputs[:, b]
        return out

    link = with_sensor(Modifier(f"crosstalk.{variant}", RANK, change))
    return Candidate("crosstalk", variant, "sensor", (share,), link, {share.name: 0.0}, ({share.name: -0.02},))


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate per ordered pair of force channels."""
    forces = load_channels(system)
    return tuple(coupled(system, b, a) for b in forces for a in forces if a != b)


CROSSTALK = Effect("crosstalk", "sensor", offer, "crosstalk of force plates: ISO 21595 calls it so")
