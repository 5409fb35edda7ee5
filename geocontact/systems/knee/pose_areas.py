"""Sides' contact areas of a pair of surfaces as a smooth function of pose around every recorded one.

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
from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations
from warnings import warn

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputWarning
from geocontact.geometry.contact_area.area import AS_GIVEN, Refinement
from geocontact.geometry.contact_area.sided_areas import SidedAreas

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
