"""Segments of somebody who stands up: by de Leva's table for men or women, or the person's own values.

Masses, mass centres and radii of gyration are fractions of body mass and segment length (de Leva (1996), Adjustments to
Zatsiorsky-Seluyanov's segment inertia parameters, J Biomech 29, 1223-1230); shanks end at the ankle's centre, by
whose row the women's are. Head, arms and trunk are one rigid body over the hips, as long as from these to the seventh
cervical vertebra, rounded from that table with the arms hanging from 0.818 of the stature (Drillis & Contini 1966). In
men its radius of gyration is 0.44 of that length, where the table gives 0.37, and the shank has the fractions to the
malleolus, 2.8 mm nearer to the ankle: shipped trials were made with both. Children have the masses of
`data.body_segments`, whose heavier head moves the mass centre of what is over the hips.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from geocontact.data.body_segments import ADULT, SEGMENTS, BodySegments, Sex, body_segments

LEG = ("foot", "shank", "thigh")
"""Segments of which there are two."""
VALUES = ("mass", "length", "centre", "gyration")


@dataclass(frozen=True)
class PersonSegment:
    """Mass (both sides), length, mass centre and radius of gyration about z, from the lower joint upwards; of the foot
    from the ankle forwards, of the trunk from the hip.

    In kg and m, or as fractions of body mass, height, length and length.
    """

    mass: float
    length: float
    centre: float
    gyration: float


SHARES: dict[Sex, dict[str, PersonSegment]] = {
    "male": {
        "foot": PersonSegment(2 * 0.0137, 0.1482, 0.20, 0.245),
        "shank": PersonSegment(2 * 0.0433, 0.2529, 1.0 - 0.4459, 0.249),
        "thigh": PersonSegment(2 * 0.1416, 0.2425, 1.0 - 0.4095, 0.329),
        "trunk": PersonSegment(1.0 - 2 * (0.0137 + 0.0433 + 0.1416), 0.3465, 0.53, 0.44),
    },
    "female": {
        "foot": PersonSegment(2 * 0.0129, 0.1316, 0.16, 0.279),
        "shank": PersonSegment(2 * 0.0481, 0.2528, 1.0 - 0.4352, 0.263),
        "thigh": PersonSegment(2 * 0.1478, 0.2124, 1.0 - 0.3612, 0.364),
        "trunk": PersonSegment(1.0 - 2 * (0.0129 + 0.0481 + 0.1478), 0.3543, 0.57, 0.36),
    },
}


SHOULDERS, ANKLES = 0.818, 0.039
"""Heights over the stature (Drillis & Contini 1966)."""
ARM = ("upper_arm", "forearm", "hand")


def shares_of(sex: Sex, age: float | None) -> dict[str, PersonSegment]:
    """Fractions of an adult of that sex, or of a child of that age [years]; ValueError below 6 years."""
    table = SHARES[sex]
    if age is None or age >= ADULT:
        return table
    body = body_segments(sex, age)
    found = {name: replace(table[name], mass=2.0 * body[name].mass) for name in LEG}
    centre, gyration = _over_hips(body, table)
    mass = 1.0 - sum(each.mass for each in found.values())
    return found | {"trunk": replace(table["trunk"], mass=mass, centre=centre, gyration=gyration)}


def _over_hips(body: BodySegments, table: Mapping[str, PersonSegment]) -> tuple[float, float]:
    """Mass centre above the hips and radius of gyration of trunk, head and hanging arms, over the trunk's length."""
    tall = body.stature
    hips = tall * (table["thigh"].length + table["shank"].length + ANKLES)
    tops = {"trunk": body["trunk"].length, "head": tall - hips}
    below = SHOULDERS * tall - hips
    for name in ARM:
        tops[name] = below
        below -= body[name].length
    mass = {name: (2.0 if name in ARM else 1.0) * body[name].mass for name in tops}
    place = {name: top - body[name].centre * body[name].length for name, top in tops.items()}
    whole = sum(mass.values())
    centre = sum(mass[name] * place[name] for name in tops) / whole
    own = {name: (body[name].radii[1] * body[name].length) ** 2 + (place[name] - centre) ** 2 for name in tops}
    length = tall * table["trunk"].length
    return centre / length, math.sqrt(sum(mass[name] * own[name] for name in tops) / whole) / length


def from_proximal(own: Mapping[str, Mapping[str, float]], height: float, sex: Sex) -> dict[str, dict[str, float]]:
    """Own values as `segments_of` takes them, of segments that count from their proximal ends.

    The heel is as far behind the ankle as both tables have the foot's mass centre from the one and from the other.

    Parameters
    ----------
    own
        `VALUES` of thigh and shank from the upper joint, of the foot from the heel, of the trunk, with head and arms,
        from the hips [kg, m].
    height
        Of the body, for lengths that are not among them [m].
    """
    return _turned(own, height, sex, 1.0)


def to_proximal(own: Mapping[str, Mapping[str, float]], height: float, sex: Sex) -> dict[str, dict[str, float]]:
    """Own values that count from proximal ends, of those that `segments_of` takes: the inverse of `from_proximal`."""
    return _turned(own, height, sex, -1.0)


def _turned(
    own: Mapping[str, Mapping[str, float]], height: float, sex: Sex, sign: float
) -> dict[str, dict[str, float]]:
    """With centres of thigh and shank from their other ends, and those of the foot from ankle (1) or heel (-1)."""
    found = {name: dict(values) for name, values in own.items()}
    for name, values in found.items():
        if "centre" in values and name in LEG:
            length = values.get("length", SHARES[sex][name].length * height)
            behind = SEGMENTS[sex][name].centre - SHARES[sex][name].centre
            if name == "foot":
                values["centre"] -= sign * behind * length
            else:
                values["centre"] = length - values["centre"]
    return found


def segments_of(
    mass: float, height: float, sex: Sex, own: Mapping[str, Mapping[str, float]], age: float | None = None
) -> dict[str, PersonSegment]:
    """Segments of a person in kg and m.

    Parameters
    ----------
    mass, height
        Of the body [kg, m].
    own
        The person's own `VALUES` by segment, masses of one leg; the rest is the table's, centre and radius in
        proportion to the length, and the trunk has what the legs leave of the mass.
    age
        Of a child [years].
    """
    found: dict[str, PersonSegment] = {}
    for name, share in shares_of(sex, age).items():
        given, sides = own.get(name, {}), 2.0 if name in LEG else 1.0
        length = given.get("length", share.length * height)
        heavy = sides * given["mass"] if "mass" in given else share.mass * mass
        if name == "trunk" and "mass" not in given and any("mass" in own.get(leg, {}) for leg in LEG):
            heavy = mass - sum(found[leg].mass for leg in LEG)
        centre, gyration = given.get("centre", share.centre * length), given.get("gyration", share.gyration * length)
        found[name] = PersonSegment(heavy, length, centre, gyration)
    return found
