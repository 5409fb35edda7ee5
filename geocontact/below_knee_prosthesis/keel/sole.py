"""The foam under the keel as spheres, each fixed to the segment above it; as columns of foam in `foam`.

24 spheres in five zones, three of them at the heel, as in the study of the variable-stiffness foot, which tells neither
places nor radii nor any number of the law: those are invented, but for the stiffness of the forefoot.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import floor

import numpy as np
from jaxtyping import Bool

from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.data.parameter import Number, Source
from geocontact.loads.sphere_set import SoleLaw, SphereSet

ZONES: dict[str, tuple[float, float, int]] = {
    "heel_back": (0.0, 0.018, 1),
    "heel_middle": (0.018, 0.038, 1),
    "heel_front": (0.038, 0.060, 1),
    "midfoot": (0.060, 0.148, 4),
    "forefoot": (0.148, 0.229, 5),
}
"""From and to along the keel [m], invented, and how many rows of spheres there are in between."""
COLUMNS = 2
"""Spheres in a row: 2 (1 + 1 + 1 + 4 + 5) = 24."""
ROWS: tuple[tuple[str, float, Source, str], ...] = (
    ("radius", 0.020, "invented", "of a sphere"),
    ("below", 0.030, "invented", "from the keel's axis to the sole"),
    ("breadth", 0.060, "invented", "of the sole; the outer quarter lies outside of the spheres' centres"),
    ("heel_stiffness", 15e3, "invented", "of a sphere: body weight presses six of them 9 mm deep"),
    ("midfoot_stiffness", 15e3, "invented", "of a sphere"),
    (
        "forefoot_stiffness",
        46e3,
        "derived",
        "of a sphere: its last row is what is in series, 92 N/mm; `vsf_foot` fits it",
    ),
    ("damping", 300.0, "invented", "of a sphere"),
    ("exponent", 1.0, "invented", "the study does not state it; a series stiffness is linear"),
    ("full_depth", 2e-3, "invented", "the law's library has such a depth, the study does not state it"),
    ("static", 0.8, "invented", ""),
    ("kinetic", 0.7, "invented", ""),
    ("threshold_speed", 0.01, "invented", "below it what sticks creeps"),
)
"""Numbers of the sole in SI, at 24 spheres."""


@dataclass(frozen=True)
class Foam:
    """How the foam under a keel is cut into columns.

    Parameters
    ----------
    breadth
        Of the sole [m].
    column
        Breadth of a column along the foot [m], nearly: every zone has a whole number of columns.
    across
        Columns side by side.
    ends
        Where each zone ends along the keel [m], by name from the heel; it begins where the one before ends.
    """

    breadth: float
    column: float
    across: int
    ends: tuple[tuple[str, float], ...]

    @property
    def cuts(self) -> dict[str, tuple[float, float, int]]:
        """From, to [m] and columns along the foot of each zone."""
        starts = (0.0, *(end for _, end in self.ends))
        return {
            zone: (start, end, max(floor((end - start) / self.column + 0.5 + WHOLE), 1))
            for (zone, end), start in zip(self.ends, starts, strict=False)
        }

    @property
    def area(self) -> dict[str, float]:
        """Area of a column of each zone [m²]."""
        strip = self.breadth / self.across
        return {zone: strip * (stop - start) / count for zone, (start, stop, count) in self.cuts.items()}


WHOLE = 1e-9
"""Share of a column that is rounding."""


@dataclass(frozen=True)
class KeelSole:
    """Spheres, or columns of foam, under a keel.

    Parameters
    ----------
    spheres
        In the frame K of the keel while it is straight.
    segment
        That carries each: 0 behind the first joint, then 1 to n.
    foam
        Whose columns these are; None for spheres.
    """

    spheres: SphereSet
    segment: tuple[int, ...]
    foam: Foam | None = None

    def on(self, segment: int, keel: Keel) -> SphereSet | None:
        """Spheres of one segment in its own frame, whose origin is its joint; None where it carries none.

        Segment 0 has the frame K.
        """
        chosen = np.array(self.segment) == segment
        if not chosen.any():
            return None
        own = self.spheres.chosen(chosen)
        origin = np.array([keel.places[segment - 1] if segment else 0.0, 0.0, 0.0])
        return replace(own, centre=own.centre - origin)


def numbers() -> dict[str, Number]:
    """All numbers of the sole by name."""
    return {name: Number(value, source, note) for name, value, source, note in ROWS}


def sole_of(keel: Keel, *, finer: int = 1, columns: int = COLUMNS) -> KeelSole:
    """Spheres in rows across the sole; zones are as long as the keel of the study is beside this one.

    Parameters
    ----------
    finer
        Factor on the rows of each zone: 2 gives 48 spheres, with 4 columns 96.
    columns
        Spheres in a row.
    """
    value = {name: number.value for name, number in numbers().items()}
    stretch = keel.length / ZONES["forefoot"][1]
    across = value["breadth"] * ((np.arange(columns) + 0.5) / columns - 0.5)
    centres, zones = [], []
    for zone, (start, stop, rows) in ZONES.items():
        count = rows * finer
        for x in stretch * (start + (stop - start) * (np.arange(count) + 0.5) / count):
            for z in across:
                centres.append((x, value["radius"] - value["below"], z))
                zones.append(zone)
    place = np.array(centres)
    spheres = SphereSet(place, np.full(len(place), value["radius"]), tuple(zones))
    return KeelSole(spheres, tuple(keel.segment_of(place[:, 0])))


def law_of(sole: KeelSole) -> SoleLaw:
    """The numbers above, stiffness and damping shared so that every zone has the same of both at any count."""
    value = {name: number.value for name, number in numbers().items()}
    usual = {zone: COLUMNS * rows for zone, (_, _, rows) in ZONES.items()}
    count = {zone: int(chosen.sum()) for zone, chosen in sole.spheres.zones.items()}
    share = np.array([usual[zone] / count[zone] for zone in sole.spheres.zone])
    stiffness = np.array([value[f"{zone.partition('_')[0]}_stiffness"] for zone in sole.spheres.zone])
    return SoleLaw(
        stiffness=stiffness * share,
        damping=value["damping"] * share,
        exponent=value["exponent"],
        full_depth=value["full_depth"],
        static=np.full(len(share), value["static"]),
        kinetic=np.full(len(share), value["kinetic"]),
        threshold_speed=value["threshold_speed"],
    )


BY_ZONE = ("stiffness", "damping", "static", "kinetic")
SHARED = ("exponent", "full_depth", "threshold_speed")
"""Numbers of a sole's law: by zone, and of all spheres."""


def sole_origin(sole: KeelSole, law: SoleLaw) -> dict[str, Number]:
    """Where the numbers of a sole of these zones are from, by their names in `foot_numbers`.

    Each zone's is that of its first sphere. The forefoot's stiffness is fitted to compressions.
    """
    known = numbers()
    fitted = "of a sphere, with EI fitted to 10, 19 and 32 N/mm in compression of the sole"
    found = {f"sole {name}": replace(known[name], value=float(getattr(law, name))) for name in SHARED}
    found |= {f"sole {name}": known[name] for name in ("radius", "below")}
    found["sole places"] = Number(0.0, "invented")
    for zone, of in sole.spheres.zones.items():
        for kind in BY_ZONE:
            own = known[f"{zone.partition('_')[0]}_stiffness" if kind == "stiffness" else kind]
            if (zone, kind) == ("forefoot", "stiffness"):
                own = Number(own.value, "derived", fitted)
            found[f"sole {zone}_{kind}"] = replace(own, value=zone_number(law, kind, of))
    return found


def zone_number(law: SoleLaw, kind: str, of: Bool[np.ndarray, " n"]) -> float:
    """One of `BY_ZONE` of a zone, which all of its spheres share."""
    return float(np.broadcast_to(getattr(law, kind), len(law.stiffness))[int(np.flatnonzero(of)[0])])
