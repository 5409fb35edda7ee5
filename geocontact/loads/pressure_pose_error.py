"""Error of the poses carried into the loads of an elastic layer, by draws."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.pose_error import ENDS, PoseError
from geocontact.geometry.surface import Surface
from geocontact.loads.foundation import Layer, Skin, pressed
from geocontact.loads.pressure_load import PressureLoad

MEDIAL = "medial"


@dataclass(frozen=True, eq=False)
class PressureUncertainty:
    """Loads of drawn poses; the same draws serve all frames, as of one constant error.

    Parameters
    ----------
    force, peak, area
        Force on the layer [N], largest pressure [Pa] and area under pressure [m^2] in each frame and draw.
    share
        Medial share of the force [-], NaN where nothing is pressed; None where the sides are not apart.
    """

    force: Float[np.ndarray, "t n"]
    peak: Float[np.ndarray, "t n"]
    area: Float[np.ndarray, "t n"]
    share: Float[np.ndarray, "t n"] | None

    @property
    def largest_force(self) -> tuple[float, float]:
        """95 % interval of the largest force over the motion [N]."""
        low, high = np.quantile(self.force.max(axis=0), ENDS)
        return float(low), float(high)

    def share_where(self, frame: int) -> tuple[float, float] | None:
        """95 % interval of the medial share in a frame, over the draws that press; None where there is none."""
        if self.share is None or not np.isfinite(self.share[frame]).any():
            return None
        low, high = np.nanquantile(self.share[frame], ENDS)
        return float(low), float(high)

    def table(self, time: Float[np.ndarray, " t"]) -> pd.DataFrame:
        """A row per frame: standard deviation and 95 % interval over the draws."""
        columns: dict[str, object] = {"time [s]": time}
        known: Mapping[str, tuple[str, float, Float[np.ndarray, "t n"] | None]] = {
            "force": ("N", 1.0, self.force),
            "peak": ("MPa", 1e-6, self.peak),
            "pressed_area": ("mm^2", 1e6, self.area),
            "medial_share": ("-", 1.0, self.share),
        }
        for name, (unit, factor, values) in known.items():
            if values is None:
                continue
            columns[f"{name}_sd [{unit}]"] = [_sd(row) * factor for row in values]
            ends = np.array([_ends(row) for row in values]) * factor
            columns |= {f"{name}_lower [{unit}]": ends[:, 0], f"{name}_upper [{unit}]": ends[:, 1]}
        return pd.DataFrame(columns)


def _sd(row: Float[np.ndarray, " n"]) -> float:
    there = row[np.isfinite(row)]
    return float(there.std(ddof=1)) if len(there) > 1 else np.nan


def _ends(row: Float[np.ndarray, " n"]) -> tuple[float, float]:
    there = row[np.isfinite(row)]
    low, high = np.quantile(there, ENDS) if len(there) else (np.nan, np.nan)
    return float(low), float(high)


def pressure_uncertainty(
    layer: Layer,
    moving: Surface,
    motion: Motion,
    skin: Skin,
    error: PoseError,
    draws: int,
    workers: int | None,
    step: Callable[[], None],
) -> PressureUncertainty:
    """Loads on the layer at the first `draws` of the poses that may be, in every frame; `step` after each frame."""
    rotation = motion.poses.rotation.as_matrix().reshape(-1, 3, 3)
    translation = np.asarray(motion.poses.translation).reshape(-1, 3)
    rows = []
    with ThreadPoolExecutor(workers or os.cpu_count() or 1) as pool:
        for r, t in zip(rotation, translation, strict=True):
            turned, shifted = error.poses(r, t)
            turned = np.ascontiguousarray(turned[:draws])
            found = list(pool.map(lambda a, b: pressed(layer, moving, a, b, skin), turned, shifted[:draws]))
            rows.append([_numbers(each.load, each.parts) for each in found])
            step()
    force, peak, area, medial = np.moveaxis(np.array(rows), -1, 0)
    share = None
    if MEDIAL in layer.parts:
        share = np.where(force > 0.0, medial / np.where(force > 0.0, force, 1.0), np.nan)
    return PressureUncertainty(force, peak, area, share)


def _numbers(load: PressureLoad, parts: Mapping[str, PressureLoad]) -> tuple[float, float, float, float]:
    medial = parts[MEDIAL].pressing if MEDIAL in parts else np.nan
    return load.pressing, load.peak, load.area, medial
