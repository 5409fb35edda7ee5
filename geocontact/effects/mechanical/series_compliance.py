"""A spring in series: the input gives way in proportion to the load.

Elbow: β → β - c F; foot: y → y + c F_y (a pylon or liner under the sensor of motion); shoulder and strapped-on sites:
u → u - c F; a joint: the angle likewise to its moment. c F is generalised to
c F* (F/F*)^p, F* the largest measured force and p the shape. c >= 0. Implicit; the load of every sample is solved for
to 1e-10, the spring's rate is its change over the sample. The pylon lies between the sole and the origin that is
measured, so the lever of the rolling speed x' - pitch' (h - radius - y) grows with it.
"""

from __future__ import annotations

from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.parts import largest_load, with_geometry


def offer(system: System) -> tuple[Candidate, ...]:
    """One candidate: amplitude c, shape p."""
    scale = system.scale
    way, yields = system.traits.way, system.geometry.yields
    force = scale.of(way.load) if way.load else largest_load(system)
    per = {"input": scale.span.get(yields, 1.0), "deflection": scale.deflection, "unit": 1.0}[way.of]
    most = way.most * per / force
    unit = system.law.deflection if way.of == "deflection" else system.unit(yields)
    load = f"({system.law.load})" if " " in system.law.load else system.law.load
    c = Parameter("series_compliance.compliance", f"{unit}/{load}", 0.05 * most, 0.0, most)
    p = Parameter("series_compliance.exponent", "-", 1.0, 0.5, 2.0)
    link = with_geometry({c.name: c.name, p.name: p.name, "series_compliance.reference": force})
    others = ({c.name: 0.3 * most},)
    return (Candidate("series_compliance", "", "geometry", (c, p), link, {c.name: 0.0}, others),)


SERIES_COMPLIANCE = Effect(
    "series_compliance",
    "geometry",
    offer,
    "springs in series; prosthetic pylon and socket liner",
    tuple(f"series_compliance.{number}" for number in ("compliance", "exponent", "reference")),
)
