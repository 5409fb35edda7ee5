"""Geometry link of a knee implant that is driven by its pose: pose → areas of the sides → what Hertz's law multiplies.

The pose is that of the femoral component F in the tibial one T, in knee angles of Grood and Suntay
(`data.multibody.knee_angles`) and the position of F's origin along the axes of T: x anterior, y proximal, z to the
right.

A diagnosis asks for the areas thousands of times, each time at poses that differ a little from the recorded ones: by an
offset that is tried, by noise that was taken off, by a step of a difference quotient. So the first time that a trial is
seen its surfaces are evaluated at every recorded pose p and on a grid of offsets around it. With z the offset over its
reach, and for the areas and for their first moments alike,

    A(p + offset) = A(p) + Σ_k Σ_m c_km z_k^m + Σ_k<l c_kl z_k z_l,   m = 1 … 4.

c_km is the polynomial through the offsets -1, -1/2, 1/2 and 1 times the reach of one coordinate, so along each of them
the interpolation is of fifth order; c_kl is the mixed difference of two coordinates, from (1/2, 1/2) and (-1/2, -1/2).
At p itself the area is that of `geocontact area`; differences are taken of triangles cut once as given. A pose beyond
the reach of a recorded one is evaluated on the surfaces themselves.

Areas bend where contact begins, a threshold above touching, so the reach is a share of the threshold. What the
interpolation costs is measured on every trial and warned of where it is more than `TOLERATED`.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from warnings import warn

import numpy as np
from jaxtyping import Float

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.links import Law, LawParameters, Loads, Source, Values
from geocontact.data.errors import InputWarning
from geocontact.data.multibody.knee_angles import SIGN, tibia_in_femur
from geocontact.geometry.contact_area.area import AS_GIVEN, Refinement
from geocontact.geometry.contact_area.sided_areas import SidedAreas
from geocontact.systems.knee import AREAS, KneeContact

SHARE, MOST = 0.6, 2.5e-3
"""Reach of lengths over the threshold, and the largest one [m]."""
PER_LENGTH = 28.0
"""Reach of angles over that of lengths [rad/m]: an angle of 0.07 rad moves a condyle by about 2 mm."""
COORDINATES = 6
NODES = np.array([-1.0, -0.5, 0.5, 1.0])
CROSS = 0.5
ROUNDING = 1e-9
PAIRS = tuple(combinations(range(COORDINATES), 2))
PROBES, WITHIN = 12, 0.5
"""Poses at which the error is measured, with random offsets of so much of the reach."""
TOLERATED = 0.02
"""Root mean square error of an area over the largest one of the trial."""
REMEMBERED = 512
"""Recordings of poses beyond reach that are remembered."""

Placed = Callable[[Float[np.ndarray, "6 t"]], tuple[Float[np.ndarray, "t 3 3"], Float[np.ndarray, "t 3"]]]
"""Coordinates of MOVING in FIXED to rotations and translations [m]."""


@dataclass(frozen=True, eq=False)
class PoseGrid:
    """Areas and moments around the recorded poses of one trial: t samples, 2 sides, 4 values (area, moment)."""

    pose: Float[np.ndarray, "6 t"]
    value: Float[np.ndarray, "t 2 4"]
    cut: Float[np.ndarray, "6 4 t 2 4"]
    mixed: Float[np.ndarray, "15 t 2 4"]

    def at(self, z: Float[np.ndarray, "6 t"]) -> Float[np.ndarray, "t 2 4"]:
        """Values at offsets of z times the reach."""
        powers = z[:, None] ** np.arange(1, len(NODES) + 1)[:, None]
        found = self.value + np.einsum("kmt,kmtsv->tsv", powers, self.cut)
        products = np.array([z[k] * z[m] for k, m in PAIRS])
        return np.asarray(found + np.einsum("pt,ptsv->tsv", products, self.mixed))


class PoseAreas:
    """Areas of a pair of surfaces by trial and pose; grids are made when a trial is first seen, and kept.

    Parameters
    ----------
    pair
        The surfaces.
    placed
        What the six coordinates mean.
    """

    def __init__(self, pair: SidedAreas, placed: Placed) -> None:
        self.pair = pair
        self.placed = placed
        length = min(SHARE * pair.threshold, MOST)
        self.reach = np.repeat([PER_LENGTH * length, length], COORDINATES // 2)[:, None]
        self._grids: dict[tuple[str, bytes], PoseGrid] = {}
        self._far: OrderedDict[bytes, np.ndarray] = OrderedDict()

    def at(
        self, trial: str, time: Float[np.ndarray, " t"], pose: Float[np.ndarray, "6 t"]
    ) -> Float[np.ndarray, "t 2 4"]:
        """Area of each side [m^2] and its first moment [m^3] at every sample.

        Of a trial that was not seen before `pose` is taken for the recorded one.
        """
        key = (trial, time.tobytes())
        grid = self._grids.get(key)
        if grid is None:
            grid = self._grids[key] = self.grid(pose)
            self._warn_of(self.error(grid), trial)
        z = (pose - grid.pose) / self.reach
        near = (np.abs(z) <= 1.0 + ROUNDING).all(axis=0)
        found = grid.at(np.where(near, z, 0.0))
        if not near.all():
            found[~near] = self._directly(np.ascontiguousarray(pose[:, ~near]))
        found[..., 0] = np.maximum(found[..., 0], 0.0)
        return found

    def direct(
        self, pose: Float[np.ndarray, "6 t"], refinement: Refinement = Refinement()
    ) -> Float[np.ndarray, "t 2 4"]:
        """The same from the surfaces themselves."""
        rotation, translation = self.placed(pose)
        return self.pair.along(rotation, translation, refinement)

    def grid(self, pose: Float[np.ndarray, "6 t"]) -> PoseGrid:
        """Grid of offsets around recorded poses."""
        value, given = self.direct(pose), self.direct(pose, AS_GIVEN)

        def rise(z: Float[np.ndarray, " 6"]) -> Float[np.ndarray, "t 2 4"]:
            return np.asarray(self.direct(pose + z[:, None] * self.reach, AS_GIVEN) - given)

        unit = np.eye(COORDINATES)
        power = np.linalg.inv(NODES[:, None] ** np.arange(1, len(NODES) + 1))
        cut = np.array([np.tensordot(power, [rise(n * unit[k]) for n in NODES], axes=1) for k in range(COORDINATES)])
        mixed = []
        for k, m in PAIRS:
            both = 0.5 * (rise(CROSS * (unit[k] + unit[m])) + rise(-CROSS * (unit[k] + unit[m])))
            even = sum(cut[one, order - 1] * CROSS**order for one in (k, m) for order in (2, 4))
            mixed.append((both - even) / CROSS**2)
        return PoseGrid(pose.copy(), value, cut, np.array(mixed))

    def error(self, grid: PoseGrid) -> float:
        """Root mean square error of the interpolated areas over the largest one, at poses drawn around the recorded."""
        rng = np.random.default_rng(0)
        at = rng.integers(grid.pose.shape[1], size=PROBES)
        z = np.zeros(grid.pose.shape)
        z[:, at] = rng.uniform(-WITHIN, WITHIN, (COORDINATES, PROBES))
        exact = self.direct(grid.pose[:, at] + z[:, at] * self.reach)[..., 0]
        largest = max(float(grid.value[..., 0].max()), float(exact.max()), 1e-12)
        return float(np.sqrt(np.mean((grid.at(z)[at, :, 0] - exact) ** 2))) / largest

    def _warn_of(self, error: float, trial: str) -> None:
        if error > TOLERATED:
            what = f"trial {trial}: areas around its poses are interpolated with an error of {100.0 * error:.1f} %"
            warn(InputWarning(f"{what}; a larger threshold or finer meshes make it smaller"), stacklevel=2)

    def _directly(self, pose: Float[np.ndarray, "6 n"]) -> Float[np.ndarray, "n 2 4"]:
        key = pose.tobytes()
        found = self._far.get(key)
        if found is None:
            found = self._far[key] = self.direct(pose)
            while len(self._far) > REMEMBERED:
                self._far.popitem(last=False)
        return found


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
        """Places of the numbers that the kernel reads."""
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
        """Forces along a movement, and how they change towards other values (`chain.system`)."""
        area, centre = self.patches(movement)
        found = self.contact.changes(self.by_areas(movement, area), law, values, others)
        return None if found is None else (replace(found[0], arm=centre), found[1])
