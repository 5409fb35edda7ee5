"""Geometry link of a knee implant that is driven by its pose: pose → areas of the sides → what Hertz's law multiplies.

The pose is that of the femoral component F in the tibial one T, in knee angles of Grood and Suntay
(`data.multibody.knee_angles`) and the position of F's origin along the axes of T: x anterior, y proximal, z to the
right.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.law_parameters import LawParameters, Source
from geocontact.chain.links import Law, Loads, Values
from geocontact.data.multibody.knee_angles import SIGN, tibia_in_femur
from geocontact.geometry.contact_area.sided_areas import SidedAreas
from geocontact.systems.knee.contact import AREAS, KneeContact
from geocontact.systems.knee.pose_areas import Placed, PoseAreas

ANGLES, SHIFTS = ("flexion", "adduction", "rotation"), ("tx", "ty", "tz")
POSE = (*ANGLES, *SHIFTS)
AS_MEASURED = KneeContact()
"""The knee whose areas are measured."""
LEAST_AREA = 1e-7
"""Area [m^2] below which a patch has no centre of its own."""


def placed_as(side: float) -> Placed:
    """Coordinates `POSE` to X_TF; side +1 for a right and -1 for a left knee."""
    knee = next(name for name, sign in SIGN.items() if sign == side)

    def placed(pose: Float[np.ndarray, "6 t"]) -> tuple[Float[np.ndarray, "t 3 3"], Float[np.ndarray, "t 3"]]:
        femur_in_tibia = tibia_in_femur(pose[0], pose[1], pose[2], knee).inv()
        return np.ascontiguousarray(femur_in_tibia.as_matrix()), np.ascontiguousarray(pose[3:].T)

    return placed


@dataclass(frozen=True)
class PosedKnee:
    """Areas from the pose, then the geometry of the knee whose areas are measured.

    Parameters
    ----------
    areas
        Of the pair of surfaces, the side of negative z first.
    side
        +1 for a right knee, whose medial side is that of negative z; -1 for a left one.
    middle
        x of the middle of the medial and of the lateral side [m], the centre of a patch without area.
    reach
        Smallest and largest x that a centre may have [m].
    contact
        What is done with the areas.
    """

    areas: PoseAreas
    side: float
    middle: Float[np.ndarray, " 2"]
    reach: tuple[float, float]
    contact: KneeContact = AS_MEASURED

    @classmethod
    def of(cls, pair: SidedAreas, side: float, reach: tuple[float, float]) -> PosedKnee:
        """Link of a pair of surfaces that is split in medial and lateral by z = 0."""
        medial_first = int(side)
        return cls(PoseAreas(pair, placed_as(side)), side, pair.middle[::medial_first, 0].copy(), reach)

    @property
    def slots(self) -> LawParameters:
        """Its numbers."""
        return self.contact.slots

    @property
    def yields(self) -> str:
        """Angle that the geometry may depend on."""
        return self.contact.yields

    def having(self, sources: Mapping[str, Source]) -> PosedKnee:
        """The same link with more of its numbers coming from somewhere."""
        return replace(self, contact=self.contact.having(sources))

    def patches(self, movement: DifferentiatedInputs) -> tuple[Float[np.ndarray, "t 2"], Float[np.ndarray, "t 2"]]:
        """Area [m^2] and x of the centre [m] of the medial and of the lateral patch."""
        pose = np.array([movement.position[movement.row(name)] for name in POSE])
        found = self.areas.at(movement.trial, movement.time, pose)[:, :: int(self.side)]
        area = found[..., 0]
        centre = np.where(area > LEAST_AREA, found[..., 1] / np.maximum(area, LEAST_AREA), self.middle)
        return area, np.clip(centre, *self.reach)

    def by_areas(self, movement: DifferentiatedInputs, area: Float[np.ndarray, "t 2"]) -> DifferentiatedInputs:
        """Movement of the knee whose areas are measured: flexion and the two areas."""
        row = movement.row("flexion")
        rate = np.gradient(area, movement.time, axis=0)
        position = np.array([movement.position[row], *area.T])
        return DifferentiatedInputs(
            movement.time,
            ("flexion", *AREAS),
            position,
            np.array([movement.rate[row], *rate.T]),
            np.zeros_like(position),
            movement.trial,
        )

    def deflection(
        self, movement: DifferentiatedInputs, values: Values
    ) -> tuple[Float[np.ndarray, "t n"], Float[np.ndarray, "t n"]]:
        """a³/R of each side [m²] and its rate."""
        return self.contact.deflection(self.by_areas(movement, self.patches(movement)[0]), values)

    def loads(self, movement: DifferentiatedInputs, law: Law, values: Values) -> Loads:
        """Force of each side along a movement, acting at the centre of its patch."""
        area, centre = self.patches(movement)
        found = self.contact.loads(self.by_areas(movement, area), law, values)
        return replace(found, arm=centre)

    def changes(
        self, movement: DifferentiatedInputs, law: Law, values: Values, others: Sequence[Values]
    ) -> tuple[Loads, list[Loads | None]] | None:
        """Forces along a movement, and how they change towards other values (`chain.tangents`)."""
        area, centre = self.patches(movement)
        found = self.contact.changes(self.by_areas(movement, area), law, values, others)
        return None if found is None else (replace(found[0], arm=centre), found[1])
