"""Thickness between two surfaces: `geocontact thickness`, `gc.thickness`.

>>> import geocontact as gc
>>> result = gc.thickness("meshes/sphere_r20.stl", "meshes/sphere_r18.stl", unit="mm")
>>> print(result.sentences[0].partition(":")[0], result.sentences[-1])
thickness, along the normal 100.0% of 5015.8 mm^2 has a thickness along the normal
>>> round(1e3 * float(result.nearest.mean()), 2)
2.0
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Bool

from geocontact.analyses.frame.bodies import chosen_faces, read_input_surface, refuse_two_spaces
from geocontact.analyses.frame.collector import listener, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.thickness.options import ThicknessOptions
from geocontact.analyses.thickness.show import MEASURES, on_faces, thickness_curves, thickness_page
from geocontact.data.errors import InputError
from geocontact.data.version import VERSION
from geocontact.geometry.surface import Surface
from geocontact.geometry.thickness import ThicknessMap, thickness_map
from geocontact.view.surfaces.points_vtp import write_faces_vtp
from geocontact.view.surfaces.vtp_series import require_pyvista

if TYPE_CHECKING:
    from geocontact.view.curves.declared import CurveSheet
    from geocontact.view.page.content import Page

MM = 1e3


@dataclass(frozen=True, eq=False)
class Layered:
    """Two surfaces in one frame, and the faces of OUTER that count; None for all."""

    outer: Surface
    inner: Surface
    faces: Bool[np.ndarray, " f"] | None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ThicknessResult(Result):
    """Thickness at the faces of the outer surface.

    Parameters
    ----------
    layered
        The surfaces.
    found
        The map.
    """

    options: ThicknessOptions
    layered: Layered
    found: ThicknessMap

    @property
    def title(self) -> str:
        """The surfaces."""
        return f"Thickness from {self.layered.outer.name} to {self.layered.inner.name}"

    @property
    def along(self) -> np.ndarray:
        """Thickness along the normal of each face that counts [m]; NaN where there is none."""
        return self.found.along

    @property
    def nearest(self) -> np.ndarray:
        """Nearest distance of each face that counts [m]; NaN where there is none."""
        return self.found.nearest

    def tables(self) -> dict[str, pd.DataFrame]:
        """`thickness`: a row per face that counts, its centroid, area and both measures."""
        f = self.found
        x, y, z = f.point.T * MM
        columns = {"face": f.face, "x [mm]": x, "y [mm]": y, "z [mm]": z, "area [mm^2]": f.area * MM**2}
        measures = {"along_normal [mm]": f.along * MM, "nearest [mm]": f.nearest * MM}
        return {"thickness": pd.DataFrame({**columns, **measures})}

    def curves(self) -> dict[str, CurveSheet]:
        """`thickness`: how it is distributed over the area."""
        return {"thickness": thickness_curves(self.found)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """OUTER coloured by its thickness, and the numbers."""
        return {REPORT: thickness_page(self.layered.outer, self.layered.inner, self.found, self.title, self.sentences)}

    def write_files(self, folder: Path) -> None:
        """OUTER for ParaView besides; faces without a thickness have NaN there, as in the table."""
        if self.options.paraview:
            outer, f = self.layered.outer, self.found
            count = len(outer.faces)
            values = {
                f"thickness {words} [mm]": on_faces(f, getattr(f, name) * MM, count, np.nan)
                for name, words in MEASURES.items()
            }
            write_faces_vtp(folder / "thickness.vtp", outer.vertices, outer.faces, values, f"geocontact {VERSION}")
        super().write_files(folder)


def read(o: ThicknessOptions) -> Layered:
    """Both surfaces."""
    if o.paraview:
        require_pyvista()
    with listener().preparing():
        outer = read_input_surface("outer", o.outer, o.unit, None, merge_tolerance=o.merge_tolerance)
        inner = read_input_surface(
            "inner", o.inner, o.unit_inner or o.unit, o.place_inner, merge_tolerance=o.merge_tolerance
        )
        refuse_two_spaces(inner, outer)
        return Layered(outer, inner, chosen_faces("`region`", o.region, outer, o.unit))


def run(given: Layered, o: ThicknessOptions) -> ThicknessResult:
    """Both measures at every face that counts."""
    found = thickness_map(given.outer, given.inner, o.most, given.faces)
    if found.inside.all():
        what = f"lies inside {given.inner.name} everywhere"
        raise InputError(given.outer.name, "", what, "exchange OUTER and INNER, or check `place_inner`")
    if not np.isfinite(found.along).any() and not np.isfinite(found.nearest).any():
        what = f"{given.inner.name} is nowhere within {o.most * MM:g} mm of {given.outer.name}"
        raise InputError("", "`most`", what, "check unit and frames (`place_inner`), or give a larger one")
    _doubt(given, found)
    summary: dict[str, object] = {"area_mm2": float(found.area.sum()) * MM**2, "covered": found.covered}
    for name, words in MEASURES.items():
        values = getattr(found, name)
        mean, sd = found.mean_sd(values)
        if not np.isfinite(mean):
            continue
        low, high = float(np.nanmin(values)), float(np.nanmax(values))
        summary[name] = {"mean_mm": mean * MM, "sd_mm": sd * MM, "least_mm": low * MM, "most_mm": high * MM}
        say(
            f"thickness, {words}: mean {mean * MM:.3f} mm, SD {sd * MM:.3f} mm, {low * MM:.3f} … {high * MM:.3f} mm "
            "over the area that has one"
        )
    note("thickness", {**summary, "thickness_times_area_mm3": found.volume * MM**3})
    say(f"{found.covered:.1%} of {found.area.sum() * MM**2:.1f} mm^2 has a thickness along the normal")
    return ThicknessResult(options=o, layered=given, found=found)


FEW = 0.95
"""Share of the area that has a thickness, or lies inside INNER, below which a warning says so."""
APART, MUCH = 1.25, 0.05
"""Times the nearest distance from which on the one along the normal is another thickness, and the share of the area
that may be so without a warning."""
TOUCHING, SOME = 1e-6, 0.01
"""Distance [m] below which a face lies on INNER, and the share of the area that may."""


def _doubt(given: Layered, found: ThicknessMap) -> None:
    """Reservations: what has no thickness, or two, or lies on the inner surface or inside it."""
    whole, outer, inner = float(found.area.sum()), given.outer.name, given.inner.name
    if found.outwards and given.outer.closed:
        reserve(f"{outer}: {inner} lies on the outside of this closed surface; are OUTER and INNER exchanged?")
    elif found.outwards:
        reserve(f"{outer}: lines go along its normals, as {inner} lies there; its faces are wound inwards")
    inside = float(found.area[found.inside].sum()) / whole
    if inside > 0.0:
        where = "inside" if given.inner.closed else "beyond"
        reserve(f"{inside:.1%} of the area of {outer} lies {where} {inner}: the surfaces cross, there is no thickness")
    nowhere = 1.0 - found.covered - inside
    if nowhere > 1.0 - FEW:
        reserve(
            f"{nowhere:.0%} of the area of {outer} meets {inner} nowhere within {found.most * MM:g} mm "
            "along its normal; choose the faces of the layer with `region`, or give a larger `most`"
        )
    on_it = float(found.area[found.nearest < TOUCHING].sum()) / whole
    if on_it > SOME:
        reserve(
            f"{on_it:.0%} of the area of {outer} lies on {inner}: is it the whole boundary of the layer? "
            "choose its outer side with `region`"
        )
    apart = float(found.area[found.along > APART * found.nearest].sum()) / whole
    if apart > MUCH:
        reserve(
            f"{apart:.0%} of the area is {APART:g} times as thick along the normal as by the nearest distance, or "
            "more: the surfaces are not parallel there; say which measure you report"
        )


thickness = Job("thickness", ThicknessOptions, read, run)
