"""Contact area over a motion: what the area analysis returns."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

if TYPE_CHECKING:
    from scipy.interpolate import PchipInterpolator


@dataclass(frozen=True, eq=False)
class TiltedAreas:
    """Area over time and threshold at each offset.

    Parameters
    ----------
    offsets
        (a,) [rad], strictly increasing, at least two; the turn is about one axis of the fixed body's frame.
    area
        (t, k, a) [m^2].
    """

    offsets: Float[np.ndarray, " a"]
    area: Float[np.ndarray, "t k a"]

    @cached_property
    def _between(self) -> PchipInterpolator:
        from scipy.interpolate import PchipInterpolator  # a fifth of a second, and only calibrations call it

        return PchipInterpolator(self.offsets, self.area, axis=2)

    def at(self, offset: float) -> Float[np.ndarray, "t k"]:
        """Area with the body turned by `offset`: monotone cubic between those that were evaluated, held beyond them."""
        inside = float(np.clip(offset, self.offsets[0], self.offsets[-1]))
        return np.asarray(self._between(inside), float)


MM = 1e3
MM2 = 1e6


@dataclass(frozen=True)
class SideAreas:
    """Area [m^2] of one surface over frames and thresholds with what is known of its error.

    lower, upper
        Certified: the true area of the triangulated surface lies between them.
    error
        Estimated error of `area` [m^2].
    centroid
        Area centroid in FIXED's frame [m]; NaN where the area is zero.
    negative
        Part on the negative side of the splitting plane [m^2].
    region
        Area of the faces that count, where these were chosen [m^2]; None where all count.
    """

    area: Float[np.ndarray, "t k"]
    lower: Float[np.ndarray, "t k"]
    upper: Float[np.ndarray, "t k"]
    error: Float[np.ndarray, "t k"]
    centroid: Float[np.ndarray, "t k 3"]
    negative: Float[np.ndarray, "t k"]
    region: float | None = None

    @property
    def coverage(self) -> Float[np.ndarray, "t k"] | None:
        """Share of the region that is in contact, such as of an articular surface [-]; None without a region."""
        return None if self.region is None else self.area / self.region


@dataclass(frozen=True)
class AreaEvolution:
    """Contact of two rigid surfaces over a motion, SI units, FIXED's frame.

    Parameters
    ----------
    time
        Time of each frame [s].
    thresholds
        Largest signed distance that counts as contact [m].
    fixed, moving
        Areas of FIXED within the threshold of MOVING, and the other way round. They differ; always say which.
    min_distance
        Smallest distance between the whole surfaces, faces included [m]; negative where they overlap and a closed
        body gives the sign, zero where they overlap and none does.
    max_penetration_fixed
        How deep FIXED's counted faces reach into MOVING [m]; NaN when MOVING is open.
    signed
        Which areas are signed: "both", "fixed", "moving" or "none".
    medial_side
        +1 or -1: side of the splitting plane that is medial; 0 without a split.
    split_normal
        Unit normal of the splitting plane; zero without a split.
    sensitivity_thresholds, sensitivity
        Further thresholds [m] and FIXED's area within them [m^2], triangles cut as given, without bounds.
    undecided
        Points whose side the winding number could not decide, per frame; they count as outside.

    Examples
    --------
    >>> import geocontact as gc
    >>> femoral = gc.read_surface("meshes/femoral_component_right_coarse.stl", "mm")
    >>> insert = gc.read_surface("meshes/tibial_insert_right_coarse.stl", "mm")
    >>> settings = gc.Settings(thresholds=gc.mm(4, 5), rule="clip")
    >>> found = gc.area_evolution(femoral, insert, gc.read_motion("meshes/gait.csv"), settings)
    >>> type(found).__name__, found.moving.area.shape
    ('AreaEvolution', (101, 2))
    """

    time: Float[np.ndarray, " t"]
    thresholds: tuple[float, ...]
    fixed: SideAreas
    moving: SideAreas
    min_distance: Float[np.ndarray, " t"]
    max_penetration_fixed: Float[np.ndarray, " t"]
    signed: str
    medial_side: int = 0
    split_normal: tuple[float, float, float] = (0.0, 0.0, 0.0)
    sensitivity_thresholds: tuple[float, ...] = ()
    sensitivity: Float[np.ndarray, "t s"] = field(default_factory=lambda: np.zeros((0, 0)))
    undecided: np.ndarray = field(default_factory=lambda: np.zeros(0, np.int64))

    @property
    def medial(self) -> Float[np.ndarray, "t k"]:
        """Medial part of FIXED's area [m^2]."""
        return self.fixed.negative if self.medial_side < 0 else self.fixed.area - self.fixed.negative

    @property
    def lateral(self) -> Float[np.ndarray, "t k"]:
        """Lateral part of FIXED's area [m^2]; medial and lateral add up to the whole."""
        return np.asarray(self.fixed.area - self.medial)

    def table(self) -> pd.DataFrame:
        """Frames outer, thresholds inner, lengths in mm and areas in mm^2 as the column names say."""
        count, inner = self.fixed.area.shape

        def per_frame(values: Float[np.ndarray, " t"]) -> Float[np.ndarray, " r"]:
            return np.repeat(values, inner)

        columns: dict[str, np.ndarray | list[str]] = {
            "time [s]": per_frame(self.time),
            "threshold [mm]": np.tile(np.asarray(self.thresholds) * MM, count),
            "area_fixed [mm^2]": self.fixed.area.ravel() * MM2,
            "area_moving [mm^2]": self.moving.area.ravel() * MM2,
            "min_distance [mm]": per_frame(self.min_distance) * MM,
            "max_penetration_fixed [mm]": per_frame(self.max_penetration_fixed) * MM,
        }
        for axis, name in enumerate("xyz"):
            columns[f"centroid_{name} [mm]"] = self.fixed.centroid[:, :, axis].ravel() * MM
        columns["area_fixed_lower [mm^2]"] = self.fixed.lower.ravel() * MM2
        columns["area_fixed_upper [mm^2]"] = self.fixed.upper.ravel() * MM2
        columns["signed"] = [self.signed] * (count * inner)
        if self.medial_side:
            columns["area_fixed_medial [mm^2]"] = self.medial.ravel() * MM2
            columns["area_fixed_lateral [mm^2]"] = self.lateral.ravel() * MM2
        columns["area_fixed_error [mm^2]"] = self.fixed.error.ravel() * MM2
        columns["area_moving_lower [mm^2]"] = self.moving.lower.ravel() * MM2
        columns["area_moving_upper [mm^2]"] = self.moving.upper.ravel() * MM2
        columns["area_moving_error [mm^2]"] = self.moving.error.ravel() * MM2
        for name, side in (("fixed", self.fixed), ("moving", self.moving)):
            if side.coverage is not None:
                columns[f"coverage_{name} [-]"] = side.coverage.ravel()
        return pd.DataFrame(columns)
