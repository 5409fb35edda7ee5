"""The fit of a shape: reads, computes, writes, says what it found."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses import quantities
from geocontact.analyses.checks import refuse
from geocontact.analyses.progress import preparing
from geocontact.analyses.results_folder import written_whole
from geocontact.analyses.run_record import Record
from geocontact.analyses.shape.patch import NEEDS, Patch, axis_given, patch_given, sagittal_about
from geocontact.analyses.shape.write import Fitting, describe, write_results
from geocontact.cli.fit import FitOptions
from geocontact.data.errors import InputError
from geocontact.geometry.fit.catalogue import SHAPES
from geocontact.geometry.fit.circle import fit_cylinder_along
from geocontact.geometry.fit.found import ShapeFit
from geocontact.geometry.fit.profile import SagittalProfile, sagittal_profile
from geocontact.geometry.plane import Plane
from geocontact.view.surfaces.vtp_series import require_pyvista

FLATTEST = np.radians(60.0)  # arc below which a radius is hardly determined
WINDOW = 30.0  # deg


def analyse(mesh: Path, o: FitOptions) -> int:
    """Run the whole analysis."""
    record = Record("fit", {"mesh": mesh, **asdict(o)})
    _refuse_idle(o)
    if o.paraview:
        require_pyvista()
    with record.catching_warnings(), written_whole(o.out) as draft:
        angles = None if o.profile is None else quantities.angle_range(o.profile, "--profile", "--profile=-30:120:5")
        with preparing():
            patch = patch_given(record, mesh, o)
        held = axis_given(record, o) if o.hold_axis else None
        along = None if held is None else np.asarray(held.direction, float)
        whole = _fitted(record, patch.surface.name, patch.points, along, o)
        sides = {}
        for name, (plane, side) in patch.sides.items():
            points = patch.points
            own = points[plane.height(points) * side >= 0.0]
            sides[name] = _fitted(record, name, own, whole.axis, o)
        profiles = {} if angles is None else _profiles(record, patch, whole, angles, o)
        fitting = Fitting(patch, whole, sides, profiles, o)
        record.results["fit"] = describe(fitting)
        write_results(record, fitting, draft)
        record.write(draft)
        written = sorted(file.name for file in draft.iterdir())
    record.say(f"results in {o.out}: {', '.join(written)}")
    record.speak()
    return 0


def _refuse_idle(o: FitOptions) -> None:
    condition = "" if o.region is None or quantities.named_file(o.region) is not None else o.region
    used = {name for name in NEEDS if name in condition}
    about_axis = o.profile is not None or o.hold_axis or bool(used & {"radial", "outward", "flexion"})
    refuse(
        (o.axis is not None and o.centre is not None, "--centre", "beside --axis names two places to count from",
         "give one"),
        (o.hold_axis and (o.shape != "cylinder" or o.axis is None), "--hold-axis", "needs a cylinder and an --axis",
         "give them, or leave it out"),
        (o.axis is not None and not about_axis, "--axis",
         "does nothing here: --region does not speak of radial, outward or flexion", "leave it out"),
        (o.centre is not None and not used & {"radial", "outward"}, "--centre",
         "does nothing here: --region does not speak of radial or outward", "leave it out"),
        (o.sagittal is not None and o.profile is None and "flexion" not in used, "--sagittal",
         "does nothing here: there is no --profile and --region does not speak of flexion", "leave it out"),
        (o.other is not None and "distance" not in used, "--other",
         "does nothing here: --region does not speak of distance", "leave it out"),
        (o.place_other is not None and o.other is None, "--place-other", "does nothing without --other", "give it too"),
        (o.medial is not None and o.split is None, "--medial", "does nothing without --split", "give --split"),
        (o.profile is not None and o.shape != "cylinder" and o.axis is None, "--profile",
         f"needs an axis, and a {o.shape} has none", "give --axis, or fit a cylinder"),
        (o.window is not None and o.profile is None, "--window", "does nothing without --profile", "give --profile"),
        (o.window is not None and not 1.0 <= o.window <= 180.0, "--window",
         f"{o.window} is not between 1 and 180 degrees", "give for example 30"),
        (o.parquet and o.profile is None, "--parquet", "does nothing without --profile", "leave it out"),
    )  # fmt: skip


def _fitted(
    record: Record, name: str, points: Float[np.ndarray, "n 3"], along: Float[np.ndarray, " 3"] | None, o: FitOptions
) -> ShapeFit:
    """Shape through the points; a cylinder parallel to `along` where that is given."""
    try:
        if o.shape == "cylinder" and along is not None:
            fit = fit_cylinder_along(points, along, o.robust)
        else:
            fit = SHAPES[o.shape](np.ascontiguousarray(points), o.robust)
    except ValueError as error:
        raise InputError("", f"--shape {o.shape}", f"{name}: {error}", "choose more faces with --region") from error
    _warn_of_doubts(record, name, fit)
    q = fit.quality
    radius = "" if fit.radius is None else f"radius {fit.radius * 1e3:.3f} mm{_interval(fit)}, "
    rms = f"rms {fit.rms * 1e3:.3f} mm"
    record.say(f"{name}: {o.shape}, {radius}{rms} over {len(points)} points, {int(q.inlier.sum())} of them inliers")
    return fit


def _interval(fit: ShapeFit) -> str:
    if fit.radius_interval is None:
        return ""
    low, high = (length * 1e3 for length in fit.radius_interval)
    return f" (95 % {low:.3f} … {high:.3f})"


def _warn_of_doubts(record: Record, name: str, fit: ShapeFit) -> None:
    if not fit.quality.converged:
        record.warn(f"{name}: the search did not end by itself; the fit may not be the best")
    if fit.shape == "cylinder" and fit.arc < FLATTEST:
        record.warn(
            f"{name}: the points cover {np.degrees(fit.arc):.0f} degrees about the axis; "
            "below 60 radius and axis are hardly determined"
        )
    share = float(fit.quality.inlier.mean())
    if share < 0.7:
        record.warn(f"{name}: {1.0 - share:.0%} of the points are outliers; is it a {fit.shape}, and the right patch?")


def _profiles(
    record: Record, patch: Patch, whole: ShapeFit, angles: tuple[float, float, float], o: FitOptions
) -> dict[str, SagittalProfile]:
    """Profile of each side, or of the whole patch where it is not split."""
    sagittal = sagittal_about(axis_given(record, o) or whole.line, o)
    start, stop, step = angles
    angle = start + step * np.arange(round((stop - start) / step) + 1)
    window = np.radians(WINDOW if o.window is None else o.window)
    parts: dict[str, tuple[Plane, int] | None] = {**patch.sides} or {"whole": None}
    found = {
        name: sagittal_profile(patch.surface, patch.faces, sagittal, angle, window, s) for name, s in parts.items()
    }
    for name, profile in found.items():
        if not np.isfinite(profile.radius).any():
            raise InputError("", "--profile", f"{name}: no face of the patch lies there", "check --sagittal and --axis")
    return found
