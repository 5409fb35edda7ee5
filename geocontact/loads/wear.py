"""Linear wear of an elastic layer: Archard's law on the pressures of a motion, with or without cross-shear.

A place x of the layer with outward normal n loses over a cycle the depth

    h = k W,   W = integral of p |v| dt,   v = (1 - n n^T)(w x x + u)

with p its pressure and v the speed at which MOVING slides over it (Archard, J Appl Phys 24 (1953) 981; of knee
implants Fregly, Sawyer, Harman & Banks, J Biomech 38 (2005) 305). Between two frames MOVING follows the screw that
joins their poses: its twist (w, u) in FIXED's frame is constant there, so that the path over a place is exact; p is
taken as linear.

Polyethylene wears faster where the direction of sliding changes. Kang, Galvin, Brown, Jin & Fisher (J Biomech 41 (2008)
340) have k as a function of the cross-shear ratio: the share of the friction work across the principal molecular
orientation. That is taken here as the direction that most work is along, over one cycle. A step at the angle a to it
counts with cos^2 a along and sin^2 a across; the two shares add up, and the ratio is between 0 and 0.5. The coefficient
of friction is the same everywhere and cancels. Deviations: k does not depend on the pressure, though measured ones do
(Abdelgaied, Fisher & Jennings, J Mech Behav Biomed Mater 78 (2018) 282), and the surface is not updated as it wears.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial.transform import RigidTransform

from geocontact.geometry.surface_quadrature import SurfaceQuadrature


@dataclass(frozen=True, eq=False)
class WearFactor:
    """Wear factor k over the cross-shear ratio, linear between; beyond its ends it is that of the end.

    Parameters
    ----------
    ratio
        Cross-shear ratios, increasing, 0 to 0.5; one where k is the same for all.
    factor
        k at these [m^2/N], volume per force and path.
    """

    ratio: Float[np.ndarray, " n"]
    factor: Float[np.ndarray, " n"]

    def __post_init__(self) -> None:
        if len(self.ratio) != len(self.factor) or len(self.ratio) == 0:
            raise ValueError("ratio and factor must have as many values, one at least")
        if not (np.diff(self.ratio) > 0.0).all() or self.ratio[0] < 0.0 or self.ratio[-1] > 0.5:
            raise ValueError("cross-shear ratios must increase, from 0 to 0.5 at most")
        if not (self.factor >= 0.0).all():
            raise ValueError("a wear factor is not negative")

    @classmethod
    def same(cls, factor: float) -> WearFactor:
        """One factor [m^2/N] for all directions of sliding."""
        return cls(np.zeros(1), np.array([factor]))

    @property
    def depends(self) -> bool:
        """Whether the ratio matters."""
        return len(self.ratio) > 1

    def at(self, ratio: Float[np.ndarray, " p"]) -> Float[np.ndarray, " p"]:
        """k at these ratios [m^2/N]."""
        return np.asarray(np.interp(ratio, self.ratio, self.factor))


class SlidingWork:
    """Pressure times sliding path of each piece, frame after frame, apart by direction.

    Parameters
    ----------
    pieces
        Of FIXED's layer.
    poses
        Of MOVING in FIXED, one per frame.
    """

    def __init__(self, pieces: SurfaceQuadrature, poses: RigidTransform) -> None:
        self.pieces, self._poses = pieces, poses
        self._twists = _twists(poses[:-1], poses[1:]) if len(poses) > 1 else np.zeros((0, 6))
        self._basis = tangents(pieces.normal)
        self._tensor = np.zeros((len(pieces.area), 3))
        self._frame = -1
        self._first = self._before = np.zeros(len(pieces.area))

    def add(self, pressure: Float[np.ndarray, " p"]) -> None:
        """Take in the pressures of the next frame [Pa]."""
        self._frame += 1
        if self._frame == 0:
            self._first = pressure
        else:
            on, found = self._step(self._twists[self._frame - 1], self._before, pressure)
            self._tensor[on] += found
        self._before = pressure

    def _step(
        self, twist: Float[np.ndarray, " 6"], before: Float[np.ndarray, " p"], after: Float[np.ndarray, " p"]
    ) -> tuple[Int[np.ndarray, " n"], Float[np.ndarray, "n 3"]]:
        """Pieces that are pressed in one of two frames, and what their tensors gain from one to the other [Pa m]."""
        on = np.flatnonzero((before > 0.0) | (after > 0.0))
        slid = np.cross(twist[:3], self.pieces.point[on]) + twist[3:]
        first, second = (np.einsum("ni,ni->n", slid, axis[on]) for axis in self._basis)
        path = np.hypot(first, second)
        weight = np.divide(0.5 * (before + after)[on], path, out=np.zeros(len(on)), where=path > 0.0)
        return on, np.column_stack([first**2, first * second, second**2]) * weight[:, None]

    @property
    def work(self) -> Float[np.ndarray, " p"]:
        """W of each piece so far [Pa m]."""
        return np.asarray(self._tensor[:, 0] + self._tensor[:, 2])

    @property
    def ratio(self) -> Float[np.ndarray, " p"]:
        """Cross-shear ratio of each piece so far [-]; 0 where nothing slid."""
        along, shear, across = self._tensor.T
        work = along + across
        spread = np.hypot(along - across, 2.0 * shear)
        return np.maximum(0.5 - 0.5 * np.divide(spread, work, out=np.ones(len(work)), where=work > 0.0), 0.0)

    @property
    def closing(self) -> Float[np.ndarray, " p"]:
        """W of the way back from the pose of the last frame to that of the first, which is not counted [Pa m]."""
        on, found = self._step(_twists(self._poses[-1:], self._poses[:1])[0], self._before, self._first)
        work = np.zeros(len(self.pieces.area))
        work[on] = found[:, 0] + found[:, 2]
        return work


def _twists(before: RigidTransform, after: RigidTransform) -> Float[np.ndarray, "n 6"]:
    """Rotation vector [rad] and translation part [m] of the screws that join poses, in FIXED's frame."""
    return np.asarray((after * before.inv()).as_exp_coords()).reshape(-1, 6)


def tangents(normal: Float[np.ndarray, "p 3"]) -> tuple[Float[np.ndarray, "p 3"], Float[np.ndarray, "p 3"]]:
    """Two unit vectors across each unit normal, at a right angle."""
    rows = np.arange(len(normal))
    axis = np.zeros_like(normal)
    axis[rows, np.argmin(np.abs(normal), axis=1)] = 1.0
    first = np.cross(normal, axis)
    first /= np.linalg.norm(first, axis=1)[:, None]
    return first, np.cross(normal, first)


@dataclass(frozen=True, eq=False)
class LayerWear:
    """What a layer loses after many cycles of one motion.

    Parameters
    ----------
    pieces
        Of the layer.
    cycles
        How many [-].
    work
        W of each piece over one cycle [Pa m].
    ratio
        Cross-shear ratio of each piece [-]; 0 where nothing slid.
    factor
        Wear factor of each piece [m^2/N].
    closing
        Work of the way from the last pose back to the first [J], per coefficient of friction, beside `total_work`.
    coarser
        Change of the work where every second frame is left out: that of each piece, as a share of all [-].
    """

    pieces: SurfaceQuadrature
    cycles: float
    work: Float[np.ndarray, " p"]
    ratio: Float[np.ndarray, " p"]
    factor: Float[np.ndarray, " p"]
    closing: float
    coarser: float

    @property
    def depth(self) -> Float[np.ndarray, " p"]:
        """Depth that each piece loses, along its normal [m]."""
        return np.asarray(self.cycles * self.factor * self.work)

    @property
    def volume(self) -> float:
        """Volume lost [m^3]."""
        return float(self.depth @ self.pieces.area)

    @property
    def total_work(self) -> float:
        """Integral of force times sliding path over one cycle [J]."""
        return float(self.work @ self.pieces.area)

    @property
    def deepest(self) -> int:
        """Piece that loses the most depth."""
        return int(np.argmax(self.depth))


class Wearing:
    """Wear of a layer, gathered frame after frame along a motion.

    Parameters
    ----------
    pieces
        Of FIXED's layer.
    poses
        Of MOVING in FIXED, one per frame.
    """

    def __init__(self, pieces: SurfaceQuadrature, poses: RigidTransform) -> None:
        self._all, self._second = SlidingWork(pieces, poses), SlidingWork(pieces, poses[::2])
        self._frame, self._halfway = -1, np.zeros(len(pieces.area))

    def add(self, pressure: Float[np.ndarray, " p"]) -> None:
        """Take in the pressures of the next frame [Pa]."""
        self._frame += 1
        self._all.add(pressure)
        if self._frame % 2 == 0:
            self._second.add(pressure)
            self._halfway = self._all.work

    def after(self, factor: WearFactor, cycles: float) -> LayerWear:
        """The wear of so many cycles of the frames taken in."""
        all_, area = self._all, self._all.pieces.area
        fine = float(self._halfway @ area)
        coarser = float(np.abs(self._second.work - self._halfway) @ area) / fine if fine > 0.0 else 0.0
        ratio = all_.ratio
        return LayerWear(all_.pieces, cycles, all_.work, ratio, factor.at(ratio), float(all_.closing @ area), coarser)
