"""What a shape is fitted to and what is found of it: patch and axis read, the fit in numbers and tables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame import places
from geocontact.analyses.frame.bodies import check_surfaces, chosen_faces, read_input_surface, typed_axis, typed_centre
from geocontact.analyses.frame.collector import listener, reserve, say
from geocontact.analyses.frame.json_file import finite
from geocontact.analyses.frame.shared_options import medial_side, refuse_other_axes
from geocontact.analyses.shape.options import NEEDS, ShapeOptions
from geocontact.data.errors import InputError
from geocontact.geometry.fit.found import ShapeFit
from geocontact.geometry.fit.patch import Fitting, Patch
from geocontact.geometry.fit.profile import SagittalProfile
from geocontact.geometry.regions import Values, about, about_flexion, about_other
from geocontact.geometry.sagittal import Sagittal
from geocontact.geometry.surface import Surface
from geocontact.geometry.sweep import Axis
from geocontact.io.text.units import LENGTH
from geocontact.view.surfaces.vtp_series import require_pyvista


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
        for what, points in (("crest", p.crest), ("centre", p.centre)):
            columns |= {f"{what}_{axis} [mm]": points[:, k] * 1e3 for k, axis in enumerate("xyz")}
        parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)


@dataclass(frozen=True, eq=False)
class ShapeInputs:
    """A patch, and the axis as given."""

    patch: Patch
    axis: Axis | None


def read(o: ShapeOptions) -> ShapeInputs:
    """Everything the options name."""
    if o.paraview:
        require_pyvista()
    with listener().preparing():
        surface = read_input_surface("mesh", o.mesh, o.unit, o.place, merge_tolerance=o.merge_tolerance)
        if surface.inside_out:
            reserve(f"{surface.name}: faces point inwards; taken the other way round")
        axis = _axis(surface, o)
        faces = chosen_faces("`region`", o.region, surface, o.unit, _names(surface, axis, o))
    counted = np.ones(len(surface.faces), bool) if faces is None else faces
    if o.split is None:
        return ShapeInputs(Patch(surface, counted, o.points == "vertices", None, 0), axis)
    plane, side = places.splitting_plane(o.split, o.unit), medial_side(o.split, o.side, o.medial)
    refuse_other_axes(surface.space, surface.name, o.side, o.medial)
    say(f"medial is {side.words} of {surface.name}")
    return ShapeInputs(Patch(surface, counted, o.points == "vertices", plane, side.sign), axis)


def sagittal_about(axis: Axis, o: ShapeOptions) -> Sagittal:
    """Flexion angles about an axis, by the directions given."""
    if o.sagittal is None:
        remedy = "say where 0 and 90 degrees are, for example `sagittal`=-y,x"
        raise InputError("", "`sagittal`", "is missing: which way the mesh's axes point is not known", remedy)
    try:
        return Sagittal(axis, *places.directions(o.sagittal, "`sagittal`"))
    except ValueError as error:
        raise InputError("", "`sagittal`", str(error), "name two directions across the axis") from error


def _axis(surface: Surface, o: ShapeOptions) -> Axis | None:
    if o.axis is None:
        return None
    return typed_axis("`axis`", o.axis, surface, o.unit)


def _names(surface: Surface, axis: Axis | None, o: ShapeOptions) -> Mapping[str, Values]:
    """Names beside places and normals that a region may use; those that lack an option say which."""
    found: dict[str, Values] = {name: _missing(name, option) for name, option in NEEDS.items()}
    if axis is not None:
        found |= about(surface, axis.point, axis.direction, LENGTH[o.unit])
        if o.sagittal is not None:
            found |= about_flexion(surface, sagittal_about(axis, o))
    if o.centre is not None:
        found |= about(surface, typed_centre("`centre`", o.centre, surface, o.unit), None, LENGTH[o.unit])
    if o.other is not None:
        other = read_input_surface(
            "other", o.other, o.unit_other or o.unit, o.place_other, merge_tolerance=o.merge_tolerance
        )
        check_surfaces(surface, other, ("mesh", "`other`"))
        found |= about_other(surface, other, LENGTH[o.unit])
        if not other.closed and o.region is not None and "distance" in o.region:
            reserve(f"{other.name} is open ({other.topology.why_open}): distance to it has no sign")
    return found


def _missing(name: str, option: str) -> Values:
    def refuse() -> Float[np.ndarray, " m"]:
        raise ValueError(f"{name} needs {option}")

    return refuse
