"""Cylinder, sphere or plane fitted to a surface: `geocontact fit`, `gc.fit_shape`.

>>> import geocontact as gc
>>> result = gc.fit_shape("meshes/sphere_r20.stl", shape="sphere", unit="mm")
>>> print(result)
sphere_r20.stl: sphere, radius 20.000 mm (95 % 20.000 … 20.000), rms 0.000 mm over 1442 points, 1442 of them
inliers
>>> round(result.fit.radius, 6)
0.02
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import as_it_fits, if_it_fits, judge, listener, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.shape.fitting import ShapeInputs, describe, fit_table, profile_table, read, sagittal_about
from geocontact.analyses.shape.goodness import FEW, POOR, both_sides, goodness_of_shape, unsaid
from geocontact.analyses.shape.options import ShapeOptions
from geocontact.analyses.shape.show import fit_figure, fit_page, profile_curves
from geocontact.data.errors import InputError
from geocontact.data.version import VERSION
from geocontact.geometry.fit.catalogue import SHAPES
from geocontact.geometry.fit.circle import fit_cylinder_along
from geocontact.geometry.fit.found import ShapeFit
from geocontact.geometry.fit.patch import Fitting, Patch
from geocontact.geometry.fit.profile import SagittalProfile, sagittal_profile
from geocontact.geometry.plane import Plane
from geocontact.geometry.sweep import Axis
from geocontact.identify.goodness_of_fit import GoodnessOfFit
from geocontact.view.surfaces.points_vtp import write_fit_vtp

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.curves.declared import CurveSheet
    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ShapeResult(Result):
    """A shape fitted to a surface.

    Parameters
    ----------
    fitting
        Patch, shape of the whole and of its sides, profiles.
    """

    elsewhere: ClassVar[frozenset[str]] = frozenset({"fit"})

    options: ShapeOptions
    fitting: Fitting

    @property
    def fit(self) -> ShapeFit:
        """Shape of the whole patch: axis, point and radius [m], and how well they are known."""
        return self.fitting.whole

    @property
    def sides(self) -> Mapping[str, ShapeFit]:
        """Shapes of the medial and the lateral side; empty without a split."""
        return self.fitting.sides

    @property
    def profiles(self) -> Mapping[str, SagittalProfile]:
        """Radius over flexion by side, "whole" without a split; empty where no profile is asked for."""
        return self.fitting.profiles

    @property
    def title(self) -> str:
        """Heading of figure and page."""
        o = self.options
        region = "" if o.region is None else ", region " + Path(o.region).name
        return f"{o.shape.capitalize()} fitted to {self.fitting.patch.surface.name}{region}"

    @property
    def radius(self) -> float | None:
        """Radius of the cylinder or sphere [m]; None for a plane."""
        return self.fit.radius

    @property
    def point(self) -> Float[np.ndarray, " 3"]:
        """Centre of the sphere, or a point on the axis or the plane [m]."""
        return self.fit.point

    @property
    def axis(self) -> Float[np.ndarray, " 3"] | None:
        """Unit vector along the axis, or normal of the plane [-]; None for a sphere."""
        return self.fit.axis

    @property
    def rms(self) -> float:
        """Root mean square distance of all points from the shape [m]."""
        return self.fit.rms

    def tables(self) -> dict[str, pd.DataFrame]:
        """`fit`, and `profile` where it is asked for."""
        found = {"fit": fit_table(self.fitting)}
        return {**found, "profile": profile_table(self.profiles)} if self.profiles else found

    def figures(self) -> dict[str, Figure]:
        """`profile`, radius over flexion, where it is asked for; `fit`, the section and the residuals."""
        fit = {"fit": fit_figure(self.fit, self.fitting.patch.points, self.title)}
        return super().figures() | fit

    def curves(self) -> dict[str, CurveSheet]:
        """`profile`, radius over flexion, where it is asked for."""
        return {"profile": profile_curves(self.profiles, self.fit)} if self.profiles else {}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """The surface coloured by its distance to the shape, the numbers, and what they depend on."""
        curves = [panel for sheet in self.curves().values() for panel in sheet.panels]
        return {REPORT: fit_page(self.fitting, drawings, self.title, self.sentences, curves)}

    def write_files(self, folder: Path) -> None:
        """fit.json besides, and residuals for ParaView."""
        f = self.fitting
        text = json.dumps(as_it_fits(describe(f, self.options)), indent=2, ensure_ascii=False, allow_nan=False)
        (folder / "fit.json").write_text(text + "\n", encoding="utf-8")
        if self.options.paraview:
            s = f.patch.surface
            write_fit_vtp(folder / "fit.vtp", s.vertices, s.faces, f.residual, f.patch.faces, f"geocontact {VERSION}")
        super().write_files(folder)


FLATTEST = np.radians(60.0)  # arc below which a radius is hardly determined
WINDOW = np.radians(30.0)


def run(given: ShapeInputs, o: ShapeOptions) -> ShapeResult:
    """Fit the whole, then each side along the axis of the whole."""
    patch = given.patch
    along = np.asarray(given.axis.direction, float) if given.axis is not None and o.hold_axis else None
    with listener().stages(patch.surface.name) as at:
        at(f"{o.shape} through {len(patch.points)} points")
        whole, goodness = _fitted(patch.surface.name, patch.points, along, o)
        shell = tuple(both_sides(patch.surface.name, whole, patch))
        for doubt in shell:
            reserve(doubt.what)
        sides = {}
        for name, (plane, side) in patch.sides.items():
            at(f"{o.shape} through the {name} points")
            own = patch.points[plane.height(patch.points) * side >= 0.0]
            sides[name], of_side = _fitted(name, own, whole.axis, o)
            judge(of_side, warned=True)
        judge(replace(goodness, doubts=(*goodness.doubts, *shell)), warned=True)
        for name, fit in {patch.surface.name: whole, **sides}.items():
            _report(name, fit)
        fitting = Fitting(patch, whole, sides, _profiles(patch, given.axis, whole, o, at))
    note("fit", describe(fitting, o))
    return ShapeResult(options=o, fitting=fitting)


def _fitted(
    name: str, points: Float[np.ndarray, "n 3"], along: Float[np.ndarray, " 3"] | None, o: ShapeOptions
) -> tuple[ShapeFit, GoodnessOfFit]:
    """Shape through the points, a cylinder parallel to `along` where that is given; and its test of fit."""
    try:
        if o.shape == "cylinder" and along is not None:
            fit = fit_cylinder_along(points, along, o.robust)
        else:
            fit = SHAPES[o.shape](np.ascontiguousarray(points), o.robust)
    except ValueError as error:
        raise InputError("", f"`shape` {o.shape}", f"{name}: {error}", "choose more faces with `region`") from error
    _warn_of_doubts(name, fit)
    doubts = list(unsaid(name, fit, points))
    for doubt in doubts:
        reserve(doubt.what)
    return fit, goodness_of_shape(name, fit, points, doubts)


def _report(name: str, fit: ShapeFit) -> None:
    q = fit.quality
    radius = "" if fit.radius is None else f"radius {fit.radius * 1e3:.3f} mm{if_it_fits(_interval(fit))}, "
    rms = f"rms {fit.rms * 1e3:.3f} mm"
    count = len(q.residual)
    say(f"{name}: {fit.shape}, {radius}{rms} over {count} points, {int(q.inlier.sum())} of them inliers")


def _interval(fit: ShapeFit) -> str:
    if fit.radius_interval is None:
        return ""
    low, high = (length * 1e3 for length in fit.radius_interval)
    return f" (95 % {low:.3f} … {high:.3f})"


def _warn_of_doubts(name: str, fit: ShapeFit) -> None:
    if not fit.quality.converged:
        reserve(f"{name}: the search did not converge; the fit may not be the best")
    if fit.shape == "cylinder" and fit.arc < FLATTEST:
        reserve(
            f"{name}: the points cover {np.degrees(fit.arc):.0f} degrees about the axis; below 60 degrees radius and "
            "axis are poorly determined"
        )
    if fit.radius is not None and fit.rms > POOR * fit.radius:
        reserve(
            f"{name}: rms {fit.rms * 1e3:.2f} mm is {fit.rms / fit.radius:.0%} of the radius: "
            f"a {fit.shape} does not describe this patch; another shape, or fewer faces with `region`?"
        )
    share = float(fit.quality.inlier.mean())
    if fit.radius is not None and fit.exact_in_part:
        reserve(
            f"{name}: {share:.0%} of the points lie on the {fit.shape} exactly, the others {fit.rms * 1e3:.2f} mm off, "
            "root mean square over all: no interval of the radius, because it fits a part only; choose that part with "
            "`region`"
        )
    if share < FEW:
        reserve(f"{name}: {1.0 - share:.0%} of the points are outliers; is it a {fit.shape}, and the right patch?")


def _profiles(
    patch: Patch, axis: Axis | None, whole: ShapeFit, o: ShapeOptions, at: Callable[[str], None]
) -> dict[str, SagittalProfile]:
    """Profile of each side, or of the whole patch where it is not split."""
    if o.profile is None:
        return {}
    sagittal = sagittal_about(axis or whole.line, o)
    start, stop, step = o.profile
    angle = start + step * np.arange(round((stop - start) / step) + 1)
    window = WINDOW if o.window is None else o.window
    parts: dict[str, tuple[Plane, int] | None] = {**patch.sides} or {"whole": None}
    found = {}
    for name, s in parts.items():
        at(f"profile of the {name}, {len(angle)} angles")
        found[name] = sagittal_profile(patch.surface, patch.faces, sagittal, angle, window, s)
    for name, profile in found.items():
        if not np.isfinite(profile.radius).any():
            raise InputError("", "`profile`", f"{name}: no face of the patch lies there", "check `sagittal` and `axis`")
    return found


fit_shape = Job("fit", ShapeOptions, read, run)
