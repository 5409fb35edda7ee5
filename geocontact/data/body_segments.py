"""Mass, mass centre and radii of gyration of the segments of a human body.

De Leva (1996), Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters, J Biomech 29(9):1223-1230, table 4:
young adults, 61.9 kg and 1.735 m (15 women), 73.0 kg and 1.741 m (100 men). Shares are of the body's mass, and of the
segment's length for centre and radii.

Children of 6 to 18 years have the masses of boys: Jensen (1986), Body segment mass, radius and radius of gyration
proportions of children, J Biomech 19(5):359-368, at 12 and 15 years, and Jensen (1989), Changes in segment inertia
proportions between 4 and 20 years, J Biomech 22(6-7):529-536, at 6 and 18, as a public table prints them
(github.com/wspr/body-segment-param, data/scaled-mass). Deviations: girls have the same; we read the table, not the
papers; centres, radii and proportions of lengths stay those of adults. The papers differ from each other: the head's
line of 1989, 0.27881 - 0.021152 a + 0.00053168 a^2 of age a, is 1.2 % of the body's mass below the table at 6 years and
1.5 % above it at 15. Jensen's thighs end lower than de Leva's: 11.4 against 14.2 % at 18 years, a step of the method.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

Sex = Literal["female", "male"]


@dataclass(frozen=True)
class BodySegment:
    """One segment of the mean woman or man.

    Parameters
    ----------
    ends
        Proximal and distal end, between which the length is measured.
    length
        Of the mean person [m].
    mass
        Share of the body's mass.
    centre
        Of the mass, share of the length from the proximal end.
    radii
        Of gyration about the mass centre, shares of the length: about the sagittal axis (back to front), the
        transverse one (side to side) and the long one.
    """

    ends: tuple[str, str]
    length: float
    mass: float
    centre: float
    radii: tuple[float, float, float]

    def moments(self, mass: float, length: float) -> tuple[float, float, float]:
        """Moments of inertia about the mass centre [kg m²] of a segment of that mass [kg] and length [m]."""
        sagittal, transverse, long = (mass * (radius * length) ** 2 for radius in self.radii)
        return sagittal, transverse, long


STATURE: dict[Sex, float] = {"female": 1.735, "male": 1.741}
"""Stature of the mean person [m]."""
_ENDS = {
    "head": ("vertex", "middle of the gonia"),
    "trunk": ("suprasternale", "middle of the hip joints"),
    "upper_arm": ("shoulder joint", "elbow joint"),
    "forearm": ("elbow joint", "wrist joint"),
    "hand": ("wrist joint", "third metacarpal"),
    "thigh": ("hip joint", "knee joint"),
    "shank": ("knee joint", "lateral malleolus"),
    "foot": ("heel", "tip of the longest toe"),
}
_TABLE: dict[Sex, dict[str, tuple[float, float, float, tuple[float, float, float]]]] = {
    "female": {
        "head": (0.2002, 0.0668, 0.5894, (0.330, 0.359, 0.318)),
        "trunk": (0.5293, 0.4257, 0.4151, (0.357, 0.339, 0.171)),
        "upper_arm": (0.2751, 0.0255, 0.5754, (0.278, 0.260, 0.148)),
        "forearm": (0.2643, 0.0138, 0.4559, (0.261, 0.257, 0.094)),
        "hand": (0.0780, 0.0056, 0.7474, (0.531, 0.454, 0.335)),
        "thigh": (0.3685, 0.1478, 0.3612, (0.369, 0.364, 0.162)),
        "shank": (0.4323, 0.0481, 0.4416, (0.271, 0.267, 0.093)),
        "foot": (0.2283, 0.0129, 0.4014, (0.299, 0.279, 0.139)),
    },
    "male": {
        "head": (0.2033, 0.0694, 0.5976, (0.362, 0.376, 0.312)),
        "trunk": (0.5319, 0.4346, 0.4486, (0.372, 0.347, 0.191)),
        "upper_arm": (0.2817, 0.0271, 0.5772, (0.285, 0.269, 0.158)),
        "forearm": (0.2689, 0.0162, 0.4574, (0.276, 0.265, 0.121)),
        "hand": (0.0862, 0.0061, 0.7900, (0.628, 0.513, 0.401)),
        "thigh": (0.4222, 0.1416, 0.4095, (0.329, 0.329, 0.149)),
        "shank": (0.4340, 0.0433, 0.4459, (0.255, 0.249, 0.103)),
        "foot": (0.2581, 0.0137, 0.4415, (0.257, 0.245, 0.124)),
    },
}
SEGMENTS: dict[Sex, dict[str, BodySegment]] = {
    sex: {name: BodySegment(_ENDS[name], *numbers) for name, numbers in rows.items()} for sex, rows in _TABLE.items()
}
"""By sex and name; a body has two of each but head and trunk."""
LEVA = "de Leva 1996"
SINGLE = ("head", "trunk")
"""Segments of which a body has one."""
YOUNGEST, ADULT = 6.0, 18.0
"""Years from which masses are known, and from which they are those of adults."""
OWN_VALUES = ("mass", "length", "centre", "gyration")
_AGES = (6.0, 12.0, 15.0, 18.0)
_OF_BOYS = {
    "head": (18.2, 10.1, 6.7, 7.0),
    "trunk": (43.0, 41.7, 41.6, 44.6),
    "upper_arm": (2.4, 3.2, 3.5, 3.6),
    "forearm": (1.3, 1.7, 1.7, 1.9),
    "hand": (0.8, 0.9, 0.8, 0.9),
    "thigh": (8.5, 11.0, 12.1, 11.4),
    "shank": (4.6, 5.3, 5.6, 4.8),
    "foot": (1.9, 2.1, 2.1, 1.7),
}
"""Per cent of the body's mass at `_AGES`, the head with the neck."""


@dataclass(frozen=True)
class BodySegments:
    """Segments of one person's body by name, two of each but `SINGLE`.

    Parameters
    ----------
    sex
        Row of the table of adults.
    stature
        Of the person whose lengths the segments have [m].
    rows
        Segments by name.
    age
        Of a child [years]; None for an adult.
    own
        Names of segments with own values.
    """

    sex: Sex
    stature: float
    rows: Mapping[str, BodySegment] = field(hash=False, repr=False)
    age: float | None = None
    own: tuple[str, ...] = ()

    def __getitem__(self, name: str) -> BodySegment:
        """Segment of that name; KeyError for another one."""
        return self.rows[name]

    @property
    def whole(self) -> float:
        """Sum of all shares of mass, both sides: 1 but for rounding of the table and for own values."""
        return sum((1.0 if name in SINGLE else 2.0) * row.mass for name, row in self.rows.items())

    @property
    def source(self) -> str:
        """Where the masses are from."""
        return self._with_own(LEVA if self.age is None else f"Jensen 1986 and 1989, boys of {self.age:g} years")

    @property
    def shape_source(self) -> str:
        """Where mass centres and radii are from."""
        return self._with_own(LEVA)

    def _with_own(self, table: str) -> str:
        return f"own values of {', '.join(self.own)}, else {table}" if self.own else table


def body_segments(
    sex: Sex,
    age: float | None = None,
    *,
    mass: float | None = None,
    height: float | None = None,
    own: Mapping[str, Mapping[str, float]] | None = None,
) -> BodySegments:
    """Segments of a person: the table's of the sex, a child's masses by age, and own values in their place.

    Parameters
    ----------
    age
        [years]; from `ADULT` on, and without it, those of adults.
    mass, height
        Of the body [kg, m]; own masses are compared with the one, lengths of the table are scaled by the other.
    own
        `OWN_VALUES` by segment: mass of one side [kg], length [m], mass centre from the proximal end [m], and radius of
        gyration about it across the long axis [m]. The trunk has what is left of the mass, unless it has its own.

    ValueError for an age below `YOUNGEST`, an own mass without the body's, and a centre or radius without a length.
    """
    child = age if age is not None and age < ADULT else None
    rows = SEGMENTS[sex] if child is None else _of_child(sex, child)
    if not own:
        return BodySegments(sex, STATURE[sex], rows, child)
    ratios = [values["length"] / rows[name].length for name, values in own.items() if "length" in values]
    scale = height / STATURE[sex] if height is not None else sum(ratios) / len(ratios) if ratios else None
    found = {name: _with_own(name, row, own.get(name, {}), mass, scale) for name, row in rows.items()}
    lost = sum((1.0 if name in SINGLE else 2.0) * (rows[name].mass - found[name].mass) for name in rows)
    if "mass" not in own.get("trunk", {}):
        found["trunk"] = replace(found["trunk"], mass=found["trunk"].mass + lost)
    return BodySegments(sex, (scale or 1.0) * STATURE[sex], found, child, tuple(name for name in rows if own.get(name)))


def _of_child(sex: Sex, age: float) -> dict[str, BodySegment]:
    """Masses of boys, of which those at `_AGES` are scaled to make a whole body, linear between; the rest of adults."""
    if not age >= YOUNGEST:
        raise ValueError(f"masses of segments are known from {YOUNGEST:g} years on, not at {age:g}")
    k = max(n for n, known in enumerate(_AGES[:-1]) if known <= age)
    part = (age - _AGES[k]) / (_AGES[k + 1] - _AGES[k])
    sums = [sum((1.0 if name in SINGLE else 2.0) * row[n] for name, row in _OF_BOYS.items()) for n in (k, k + 1)]
    shares = {name: (1.0 - part) * row[k] / sums[0] + part * row[k + 1] / sums[1] for name, row in _OF_BOYS.items()}
    return {name: replace(row, mass=shares[name]) for name, row in SEGMENTS[sex].items()}


def _with_own(
    name: str, row: BodySegment, values: Mapping[str, float], mass: float | None, scale: float | None
) -> BodySegment:
    """A segment of the table with own values; `scale` is that of the table's lengths."""
    if "mass" in values and mass is None:
        raise ValueError(f"an own mass of the {name} needs the mass of the body")
    if scale is None and {"centre", "gyration"} & set(values):
        raise ValueError(f"an own centre or gyration of the {name} needs its length, or the height of the body")
    length = values.get("length", (scale or 1.0) * row.length)
    across = values["gyration"] / length if "gyration" in values else None
    return replace(
        row,
        length=length,
        mass=values["mass"] / mass if "mass" in values and mass is not None else row.mass,
        centre=values["centre"] / length if "centre" in values else row.centre,
        radii=row.radii if across is None else (across, across, row.radii[2]),
    )
