"""Everything a fit writes."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from geocontact.analyses.json_file import finite
from geocontact.analyses.options_table import options_table
from geocontact.analyses.run_record import Record
from geocontact.analyses.shape.figure import fit_figure
from geocontact.analyses.shape.page import FittedSurface, write_fit_report
from geocontact.analyses.shape.patch import Patch
from geocontact.analyses.shape.profile_figure import profile_figure
from geocontact.cli.fit import FitOptions
from geocontact.data.version import VERSION
from geocontact.geometry.fit.found import ShapeFit
from geocontact.geometry.fit.profile import SagittalProfile
from geocontact.io.text.results import write_table
from geocontact.view.curves.save import save
from geocontact.view.page.tables import inputs_table
from geocontact.view.surfaces.fit_vtp import write_fit_vtp


@dataclass(frozen=True, eq=False)
class Fitting:
    """A patch, the shape fitted to all of it and to its sides, and its profiles."""

    patch: Patch
    whole: ShapeFit
    sides: Mapping[str, ShapeFit]
    profiles: Mapping[str, SagittalProfile]
    options: FitOptions

    @property
    def title(self) -> str:
        """Heading of figure and page."""
        region = "" if self.options.region is None else ", region " + Path(self.options.region).name
        return f"{self.options.shape.capitalize()} fitted to {self.patch.surface.name}{region}"


def write_results(record: Record, f: Fitting, folder: Path) -> None:
    """Numbers, figures, page, and what was asked for beside them."""
    text = json.dumps(describe(f), indent=2, ensure_ascii=False, allow_nan=False)
    (folder / "fit.json").write_text(text + "\n", encoding="utf-8")
    surface, counted = f.patch.surface, f.patch.vertices
    residual = np.where(counted, f.whole.distance(surface.vertices), np.nan)
    figures = {"fit": fit_figure(f.whole, f.patch.points, f.title)}
    if f.profiles:
        table = profile_table(f.profiles)
        write_table(table, folder, f.options.parquet, "profile")
        figures["profile"] = profile_figure(f.profiles, f.whole)
    for name, figure in figures.items():
        for ending in ("png", "svg"):
            save(figure, folder / f"{name}.{ending}")
    if f.options.paraview:
        write_fit_vtp(folder / "fit.vtp", surface, residual, f.patch.faces, f"geocontact {VERSION}")
    shown = FittedSurface(surface, residual, f.patch.faces, f.whole, f.sides, f.profiles)
    drawings = {name: (folder / f"{name}.svg").read_bytes() for name in figures}
    tables = [inputs_table(record.inputs), options_table(record)]
    write_fit_report(folder / "report.html", shown, drawings, f.title, tables, record.warnings)


def describe(f: Fitting) -> dict[str, Any]:
    """`fit.json`: lengths in mm, angles in degrees, the covariance in SI units."""
    o, q = f.options, f.whole.quality
    content = {
        "shape": o.shape,
        **_numbers(f.whole),
        "facing": _facing(f),
        "region": None if o.region is None else str(o.region),
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


def _facing(f: Fitting) -> str | None:
    """Whether the faces look away from the centre of curvature, by area; None for a plane."""
    if f.whole.radius is None:
        return None
    surface, faces = f.patch.surface, f.patch.faces
    way = surface.vertices[surface.faces[faces]].mean(axis=1) - f.whole.point
    if f.whole.axis is not None:
        way = way - (way @ f.whole.axis)[:, None] * f.whole.axis
    looks = np.einsum("ij,ij->i", way, surface.face_normal[faces])
    return "convex" if float(np.sign(looks) @ surface.face_area[faces]) >= 0.0 else "concave"
