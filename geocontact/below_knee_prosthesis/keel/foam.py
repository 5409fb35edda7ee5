"""The foam under the keel as an elastic foundation: flat columns side by side, none of which knows its neighbours.

The study of the variable-stiffness foot names the foundation of Jackson, Hass and Fregly (2016), Development of a
subject-specific foot-ground contact model for walking, J Biomech Eng 138, 091002, as the law to try next. Each column
is fixed to the segment above it and pressed along the ground's normal by d, the depth of its lower end:

    F = A E ((d/h)^n + tau/h max(d', 0) s(d/d_full))        A its area, h the thickness of the foam

so that a column is a point with k = A E / h^n and b = tau A E / h in the law of `contact.sphere_foot`, which all of
simulation, calibration and keel share. Friction is that law's too.

Deviation from the source: the damper stands beside the spring, and is not a factor 1 + c d' on it; it does nothing
while the foot leaves the ground. What foam does sideways, and beyond its thickness, is left out.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.keel.sole import Foam, KeelSole, zone_number
from geocontact.loads.sphere_set import SoleLaw, SphereSet

POINT = 1e-6
"""m; radius of a column's end."""


@dataclass(frozen=True)
class FoamNumbers:
    """Numbers of the foam of a zone.

    Parameters
    ----------
    thickness
        h [m].
    modulus, retardation
        E [Pa], the pressure at d = h, and tau [s], damping over stiffness.
    static, kinetic
        Coefficients of friction [-].
    """

    thickness: float
    modulus: float
    retardation: float
    static: float
    kinetic: float


def foam_sole(keel: Keel, foam: Foam, below: float, thickness: Mapping[str, float]) -> KeelSole:
    """Columns whose lower ends are `below` the keel's axis [m]; row by row from the heel, in it from left to right.

    `thickness` is that of each zone [m].
    """
    side = foam.breadth * ((np.arange(foam.across) + 0.5) / foam.across - 0.5)
    places, zones = [], []
    for zone, (start, stop, count) in foam.cuts.items():
        along = start + (stop - start) * (np.arange(count) + 0.5) / count
        places += [(x, POINT - below, z) for x in along for z in side]
        zones += [zone] * count * foam.across
    centre = np.array(places)
    thick = np.array([thickness[zone] for zone in zones])
    spheres = SphereSet(centre, np.full(len(zones), POINT), tuple(zones), thick)
    return KeelSole(spheres, tuple(keel.segment_of(centre[:, 0])), foam)


def foam_law(
    sole: KeelSole, numbers: Mapping[str, FoamNumbers], exponent: float, full_depth: float, threshold_speed: float
) -> SoleLaw:
    """The law of the columns from the numbers of the zones."""
    own, area = [numbers[zone] for zone in sole.spheres.zone], areas(sole)
    thickness, modulus = (np.array([getattr(each, name) for each in own]) for name in ("thickness", "modulus"))
    return SoleLaw(
        stiffness=area * modulus / thickness**exponent,
        damping=np.array([each.retardation for each in own]) * area * modulus / thickness,
        exponent=exponent,
        full_depth=full_depth,
        static=np.array([each.static for each in own]),
        kinetic=np.array([each.kinetic for each in own]),
        threshold_speed=threshold_speed,
    )


def areas(sole: KeelSole) -> Float[np.ndarray, " n"]:
    """Area of each column [m²]; ValueError for spheres."""
    if sole.foam is None:
        raise ValueError("spheres have no area")
    own = sole.foam.area
    return np.array([own[zone] for zone in sole.spheres.zone])


def foam_numbers(sole: KeelSole, law: SoleLaw) -> dict[str, FoamNumbers]:
    """Numbers of the zones that have this law; ValueError for spheres."""
    area, found = areas(sole), {}
    for zone, of in sole.spheres.zones.items():
        first = int(np.flatnonzero(of)[0])
        thickness = float(sole.spheres.deepest[first])
        k, b, static, kinetic = (zone_number(law, kind, of) for kind in ("stiffness", "damping", "static", "kinetic"))
        modulus = float(k * thickness**law.exponent / area[first])
        retardation = float(b * thickness / (area[first] * modulus))
        found[zone] = FoamNumbers(thickness, modulus, retardation, static, kinetic)
    return found


def on_foam(
    foot: VariableStiffnessFoot,
    foam: Foam,
    numbers: Mapping[str, FoamNumbers],
    shared: tuple[float, float, float],
) -> VariableStiffnessFoot:
    """A foot on foam in place of its sole, of the same height.

    Parameters
    ----------
    shared
        Exponent, depth of full damping [m] and threshold speed [m/s].
    """
    thickness = {zone: each.thickness for zone, each in numbers.items()}
    sole = foam_sole(foot.keel, foam, foot.record.below, thickness)
    return replace(foot, sole=sole, law=foam_law(sole, numbers, *shared))


def cut_finer(foot: VariableStiffnessFoot, finer: int) -> VariableStiffnessFoot:
    """A foot on foam with so many times the columns along it; ValueError for spheres."""
    if foot.sole.foam is None:
        raise ValueError("spheres are not cut")
    foam = replace(foot.sole.foam, column=foot.sole.foam.column / finer)
    law = foot.law
    return on_foam(foot, foam, foam_numbers(foot.sole, law), (law.exponent, law.full_depth, law.threshold_speed))
