"""The numbers of a fit as `fit.json` holds them, with their units in the names."""

from __future__ import annotations

from typing import Any

import numpy as np

from geocontact.analyses.json_file import finite
from geocontact.analyses.shape.fitting import Fitting
from geocontact.analyses.shape.options import ShapeOptions
from geocontact.geometry.fit.found import ShapeFit


def describe(f: Fitting, o: ShapeOptions) -> dict[str, Any]:
    """Lengths in mm, angles in degrees, the covariance in SI units."""
    q = f.whole.quality
    content = {
        "shape": o.shape,
        **_numbers(f.whole),
        "facing": f.facing,
        "region": o.region,
        "faces": int(f.patch.faces.sum()),
        "fitted_to": o.points,
        "robust": o.robust,
        "converged": q.converged,
        "parameters": list(q.names),
        "covariance": [[finite(float(value)) for value in row] for row in q.covariance],
    }
    if f.sides:
        content["sides"] = {name: _numbers(fit) for name, fit in f.sides.items()}
    return content


def _numbers(fit: ShapeFit) -> dict[str, Any]:
    q, interval = fit.quality, fit.radius_interval
    return {
        "radius_mm": None if fit.radius is None else fit.radius * 1e3,
        "radius_ci95_mm": None if interval is None else [bound * 1e3 for bound in interval],
        "axis": None if fit.axis is None else fit.axis.tolist(),
        "point_mm": (fit.point * 1e3).tolist(),
        "rms_mm": fit.rms * 1e3,
        "rms_inliers_mm": fit.rms_inliers * 1e3,
        "mean_abs_mm": fit.mean_abs * 1e3,
        "max_abs_mm": fit.max_abs * 1e3,
        "noise_mm": q.noise * 1e3,
        "points": len(q.residual),
        "inliers": int(q.inlier.sum()),
        "arc_deg": float(np.degrees(fit.arc)),
    }
