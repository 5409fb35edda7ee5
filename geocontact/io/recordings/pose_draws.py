"""Areas of drawn poses, as `area` writes them with an error of the pose, and `modulus` reads them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from zipfile import BadZipFile

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.io.text.file_preflight import MAX_BYTES, open_file
from geocontact.io.text.unpacked import refuse_arrays_that_lie, refuse_unpacked

POSE_DRAWS = "pose_draws.npz"


@dataclass(frozen=True, eq=False)
class PoseDraws:
    """Areas (t, k, n) [m^2] of n poses that may be, at times (t,) [s] within thresholds (k,) [m], which increase."""

    time: Float[np.ndarray, " t"]
    thresholds: Float[np.ndarray, " k"]
    area: Float[np.ndarray, "t k n"]

    def written(self, file: Path) -> None:
        """Arrays time, thresholds and area, in SI units."""
        order = np.argsort(self.thresholds)
        levels, area = self.thresholds[order], self.area[:, order]
        np.savez_compressed(file, allow_pickle=False, time=self.time, thresholds=levels, area=area)


def read_pose_draws(path: Path) -> PoseDraws:
    """Those of a file; InputError for another one."""
    try:
        refuse_unpacked(path, MAX_BYTES)
        refuse_arrays_that_lie(path)
        with open_file(path) as stream, np.load(stream, allow_pickle=False) as arrays:
            found = PoseDraws(*(np.asarray(arrays[name], float) for name in ("time", "thresholds", "area")))
    except (OSError, ValueError, KeyError, EOFError, BadZipFile) as error:
        what = f"is no {POSE_DRAWS} ({' '.join(str(error).split())})"
        raise InputError(path, "", what, "give that of geocontact area with `pose_sd`") from error
    shape = len(found.time), len(found.thresholds)
    if found.area.shape[:2] != shape or found.area.ndim != 3 or not np.isfinite(found.area).all():
        raise InputError(path, "", f"areas of shape {found.area.shape} for {shape}", "run the area analysis again")
    return found
