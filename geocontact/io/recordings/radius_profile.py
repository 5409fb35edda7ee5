"""profile.csv of `geocontact fit`: radius over flexion, by side."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.io.text.frame import read_frame

NAMES = ("side", "flexion [deg]", "radius [mm]")


@dataclass(frozen=True, eq=False)
class RadiusProfile:
    """Radius [m] over flexion [rad], flexion increasing; places where the patch had no face are left out."""

    flexion: Float[np.ndarray, " m"]
    radius: Float[np.ndarray, " m"]


def read_radius_profile(path: Path) -> dict[str, RadiusProfile]:
    """Profiles by side, in the order of the file."""
    table = read_frame(path, NAMES, "give a profile.csv")
    if missing := [name for name in NAMES if name not in table]:
        raise InputError(path, "line 1", f"no column {', '.join(missing)}", "give the profile.csv of geocontact fit")
    found = {}
    for side, rows in table.groupby("side", sort=False):
        numbers = rows[list(NAMES[1:])].apply(pd.to_numeric, errors="coerce").dropna().sort_values(NAMES[1])
        flexion, radius = np.radians(numbers[NAMES[1]].to_numpy(float)), numbers[NAMES[2]].to_numpy(float) * 1e-3
        sound = np.isfinite([flexion, radius]).all() and (radius > 0.0).all() and (np.diff(flexion) > 0.0).all()
        if len(flexion) < 2 or not sound:
            what = f"side {side!r:.60}: radii must be above 0 at 2 angles or more, each angle once"
            raise InputError(path, "", what, "give the profile.csv of geocontact fit")
        found[str(side)] = RadiusProfile(flexion, radius)
    if not found:
        raise InputError(path, "", "no rows", "give the profile.csv of geocontact fit")
    return found
