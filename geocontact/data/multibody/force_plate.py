"""A force plate: its load on the foot over time, its surface, and where the load acts on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import Rotation

from geocontact.data.wrench import Wrench

LOADED = 20.0
"""Load [N] from which a sample tells in which direction a plate is loaded."""

HEAVY = 0.2
"""Share of the largest force from which samples count: below it the centre of pressure is not sharp."""


def lengths_outside(
    centre: Float[np.ndarray, "t 3"], load: Float[np.ndarray, " t"], corners: Float[np.ndarray, "4 3"], gate: float
) -> float:
    """Median distance of the loaded centre of pressure beyond the plate's edge, in its lengths; below 0 inside.

    Parameters
    ----------
    centre
        Centre of pressure [m], NaN where there is none.
    load
        Normal force [N].
    corners
        Of the surface [m], one after another around it.
    gate
        Normal force [N] from which a sample counts, at least.

    NaN for a plate that is never loaded.
    """
    heavy = (load >= max(gate, HEAVY * float(np.nanmax(load, initial=0.0)))) & np.isfinite(centre).all(axis=1)
    if not heavy.any():
        return float("nan")
    a, b, c, d = corners
    edges = np.stack([(a - b + d - c) / 2.0, (a - d + b - c) / 2.0])
    along = (centre[heavy] - corners.mean(axis=0)) @ edges.T / np.sum(edges**2, axis=1)
    return float(np.median(np.abs(along).max(axis=1)) - 0.5)


@dataclass(frozen=True)
class ForcePlate:
    """Reaction of one plate on the foot.

    Parameters
    ----------
    name
        Name to choose it by.
    time
        [s].
    wrench
        Force on the foot [N] with its moment [N m], in the file's frame; NaN where the file has nothing.
    point, normal
        A point of the plate's surface [m] and its unit normal, out of the floor.
    corners
        Of its surface [m], one after another around it; None where the file does not have them.
    """

    name: str
    time: Float[np.ndarray, " t"]
    wrench: Wrench
    point: Float[np.ndarray, " 3"]
    normal: Float[np.ndarray, " 3"]
    corners: Float[np.ndarray, "4 3"] | None = None

    def centre_of_pressure(self, gate: float = LOADED) -> Float[np.ndarray, "t 3"]:
        """Centre of pressure on the plate's surface [m]; NaN where the normal force is below `gate` [N]."""
        return self.wrench.centre_of_pressure(self.point, self.normal, gate)

    def at(self, time: Float[np.ndarray, " f"]) -> Wrench:
        """Reaction at other times [s], linear between samples, moment about the frame's origin; NaN outside its own."""
        about = self.wrench.moved_to(np.zeros(3))
        force, moment = (
            np.column_stack([np.interp(time, self.time, column, np.nan, np.nan) for column in values.T])
            for values in (about.force, about.moment)
        )
        return Wrench(force, moment, np.zeros_like(force), about.frame)

    def heavy(self, begin: float, end: float) -> Bool[np.ndarray, " t"]:
        """Samples between two times [s] under load out of the floor, with a known centre of pressure."""
        load = np.nan_to_num(self.wrench.force @ self.normal)
        found = (load >= max(LOADED, HEAVY * float(load.max(initial=0.0)))) & (self.time >= begin) & (self.time <= end)
        return np.asarray(found & np.isfinite(self.centre_of_pressure()).all(axis=1))

    def free_moment(self, gate: float = LOADED) -> Float[np.ndarray, " t"]:
        """Moment about the plate's normal through the centre of pressure [N m]; NaN below the gate."""
        return self.wrench.free_moment(self.centre_of_pressure(gate), self.normal)

    def usual_load(self, plates: tuple[ForcePlate, ...] = ()) -> float:
        """Force out of the floor under load [N], the median: below 0 for the force on the plate.

        0 for a plate that is not loaded, and for a force whose opposite is among `plates`, which acts between bodies.
        """
        out = self.wrench.force @ self.normal
        loaded = out[np.abs(out) >= LOADED]
        between = any(np.array_equal(other.wrench.force, -self.wrench.force) for other in plates)
        return float(np.median(loaded)) if len(loaded) and not between else 0.0

    def steepness(self) -> float:
        """Share of the force that is along the plate's normal under load, in the median; NaN without any."""
        size = np.linalg.norm(self.wrench.force, axis=1)
        loaded = size >= LOADED
        shares = np.abs(self.wrench.force[loaded] @ self.normal) / size[loaded]
        return float(np.median(shares)) if len(shares) else float("nan")

    def outside(self) -> float:
        """How far the centre of pressure lies beyond the plate's edge under load, in the median, in its lengths.

        Below 0 on the plate; NaN where nobody stands on it or its corners are not known.
        """
        if self.corners is None:
            return float("nan")
        load = self.wrench.force @ self.normal
        return lengths_outside(self.centre_of_pressure(), load, self.corners, LOADED)

    def turned(self, turn: Rotation) -> ForcePlate:
        """The same plate in axes that this rotation turns those of the file into: force, moment, points and surface."""
        w = self.wrench
        wrench = Wrench(turn.apply(w.force), turn.apply(w.moment), turn.apply(w.origin), w.frame)
        corners = None if self.corners is None else turn.apply(self.corners)
        return replace(
            self, wrench=wrench, point=turn.apply(self.point), normal=turn.apply(self.normal), corners=corners
        )


def sum_of(wrenches: Sequence[Wrench]) -> tuple[Float[np.ndarray, "t 3"], Float[np.ndarray, "t 3"]]:
    """Sum of forces [N] and of moments about their common origin [N m]; NaN where a sample of any of them is lost.

    A plate below `LOADED` has no centre: a moment that is not a number there counts as none.
    """
    moments = []
    for one in wrenches:
        idle = np.linalg.norm(one.force, axis=1, keepdims=True) < LOADED
        moments.append(np.where(idle & np.isnan(one.moment), 0.0, one.moment))
    return np.sum([one.force for one in wrenches], axis=0), np.sum(moments, axis=0)
