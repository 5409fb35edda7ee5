"""Tables of a fit: the shapes, and the radius over flexion."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from geocontact.analyses.shape.fitting import Fitting
from geocontact.geometry.fit.found import ShapeFit
from geocontact.geometry.fit.profile import SagittalProfile


def fit_table(f: Fitting) -> pd.DataFrame:
    """A row for the whole patch and for each side; radius and interval are empty for a plane."""
    return pd.DataFrame([_row(name, fit) for name, fit in {"whole": f.whole, **f.sides}.items()])


def _row(name: str, fit: ShapeFit) -> dict[str, object]:
    low, high = fit.radius_interval or (np.nan, np.nan)
    return {
        "side": name,
        "radius [mm]": np.nan if fit.radius is None else fit.radius * 1e3,
        "radius_lower [mm]": low * 1e3,
        "radius_upper [mm]": high * 1e3,
        "rms [mm]": fit.rms * 1e3,
        "max_abs [mm]": fit.max_abs * 1e3,
        "points [-]": len(fit.quality.residual),
        "inliers [-]": int(fit.quality.inlier.sum()),
        "arc [deg]": float(np.degrees(fit.arc)),
    }


def profile_table(profiles: Mapping[str, SagittalProfile]) -> pd.DataFrame:
    """A row per side and flexion angle; empty cells where the patch has no face."""
    parts = []
    for name, p in profiles.items():
        columns: dict[str, Any] = {
            "side": name,
            "flexion [deg]": np.degrees(p.angle),
            "radius [mm]": p.radius * 1e3,
            "radius_lower [mm]": (p.radius - p.half_width) * 1e3,
            "radius_upper [mm]": (p.radius + p.half_width) * 1e3,
            "rms [mm]": p.rms * 1e3,
            "normal [deg]": np.degrees(p.normal),
        }
        for what, places in (("crest", p.crest), ("centre", p.centre)):
            columns |= {f"{what}_{axis} [mm]": places[:, k] * 1e3 for k, axis in enumerate("xyz")}
        parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)
