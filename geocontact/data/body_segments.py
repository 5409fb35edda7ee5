"""Mass, mass centre and radii of gyration of the segments of a human body.

De Leva (1996), Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters, J Biomech 29(9):1223-1230, table 4:
young adults, 61.9 kg and 1.735 m (15 women), 73.0 kg and 1.741 m (100 men). Shares are of the body's mass, and of the
segment's length for centre and radii.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
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
SINGLE = ("head", "trunk")
"""Segments of which a body has one."""


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
    """

    sex: Sex
    stature: float
    rows: Mapping[str, BodySegment] = field(hash=False, repr=False)

    def __getitem__(self, name: str) -> BodySegment:
        """Segment of that name; KeyError for another one."""
        return self.rows[name]

    @property
    def whole(self) -> float:
        """Sum of all shares of mass, both sides: 1 but for rounding of the table."""
        return sum((1.0 if name in SINGLE else 2.0) * row.mass for name, row in self.rows.items())


def body_segments(sex: Sex) -> BodySegments:
    """Segments of the mean woman or man."""
    return BodySegments(sex, STATURE[sex], SEGMENTS[sex])
