"""Where a mat lies: landmarks of a second scan, registration to a body, sides, belts."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.bodies import check_surfaces, read_input_surface, typed_centre
from geocontact.analyses.frame.collector import add_input, judge, note, reserve, say
from geocontact.analyses.frame.landmarks import check_picked
from geocontact.analyses.mat.goodness import goodness_of_registration
from geocontact.analyses.mat.options import MatOptions
from geocontact.data.errors import InputError
from geocontact.data.pressure_frames import PressureFrames
from geocontact.geometry.drape.belt import NotAroundError
from geocontact.geometry.drape.cells import Drape
from geocontact.geometry.drape.mat import Marks, Mat
from geocontact.geometry.drape.scan_difference import Rectangle, ScanDifference, rectangle_on, scan_difference
from geocontact.geometry.drape.spread import Geodesics
from geocontact.geometry.register.icp import same_place, unguided
from geocontact.geometry.register.landmarks import fit_landmarks
from geocontact.geometry.register.open3d_icp import shape_registration
from geocontact.geometry.register.quality import Registration
from geocontact.geometry.register.scale_guard import compare_boxes, compare_landmarks
from geocontact.geometry.surface import Surface
from geocontact.io.recordings.landmarks import EXAMPLE as LANDMARKS
from geocontact.io.recordings.landmarks import Landmarks, read_landmarks
from geocontact.io.recordings.mat_results import MatLandmarks
from geocontact.io.text.units import LENGTH


def open_belt(o: MatOptions, error: NotAroundError) -> InputError:
    """The line for a belt that does not close."""
    remedy = "check landmarks, pitch and unit; a mat with two ends, or one that overlaps itself, is no `belt`"
    return InputError("", f"`belt` {o.belt}", str(error), remedy)


def say_how_it_closes(mat: Mat, laid: Drape, o: MatOptions) -> None:
    """Length of the belt and of the way around that it took; cells share the difference."""
    if o.belt is None:
        return
    along = 0 if o.belt == "rows" else 1
    length = (mat.rows, mat.columns)[along] * mat.pitch[along]
    stretch = laid.stretch[..., along]
    around = length * (1.0 + np.nanmean(stretch))
    note("belt", {"around": o.belt, "length_mm": length * 1e3, "way_around_mm": float(around) * 1e3})
    say(f"belt of {length * 1e3:.0f} mm closes around {around * 1e3:.0f} mm of the body")


HOLLOW = -0.1
"""Least `Drape.bulge`; a scan below it looks as if it were seen from inside."""


def outwards(surface: Surface, o: MatOptions) -> Surface:
    """The scan with its faces turned over where `inwards` says that they look into the body."""
    if not o.inwards:
        return surface
    if surface.closed:
        raise InputError("", "`inwards`", "has no effect on a closed scan: its sides are known", "leave it out")
    return replace(surface, faces=np.ascontiguousarray(surface.faces[:, ::-1]))


def say_which_side(surface: Surface, laid: Drape, marks: Marks, o: MatOptions) -> None:
    """Warn where landmarks cannot show the side, and where an open scan looks as if it were seen from inside."""
    if o.landmarks is not None and marks.in_line:
        reserve(
            f"the landmarks lie on one line of the mat: they do not show which side of it faces the body, and "
            f"`seen_from` {o.seen_from} is used"
        )
    if not surface.closed and laid.bulge < HOLLOW:
        reserve(
            "the scan is hollow under the mat, as its faces look: if they look into the body, every force has the "
            "wrong sign; pass `inwards` then"
        )


BODY = ("body_x [m]", "body_y [m]", "body_z [m]")
EXAMPLE = "id, x [mm], y [mm], z [mm], body_x [mm], body_y [mm], body_z [mm]"


@dataclass(frozen=True, eq=False)
class BodyModel:
    """A body model that the scan is brought to: landmarks of both [m], and the body's surface for a fit by shape."""

    names: tuple[str, ...]
    on_scan: Float[np.ndarray, "n 3"]
    on_body: Float[np.ndarray, "n 3"]
    surface: Surface | None


def read_body_model(scan: Surface, o: MatOptions) -> BodyModel | None:
    """Landmarks and, where the fit is by shape, the surface; None where results stay in the scan's frame."""
    if o.body_landmarks is None:
        return None
    body = (
        None
        if o.body is None
        else read_input_surface("body", o.body, o.body_unit or o.unit, None, merge_tolerance=o.merge_tolerance)
    )
    more = () if o.picked_on_body else BODY
    seen = read_landmarks(o.body_landmarks, more, LANDMARKS if o.picked_on_body else EXAMPLE)
    add_input("`body_landmarks`", o.body_landmarks, landmarks=len(seen.names))
    check_picked(seen, scan, o.unit)
    if o.picked_on_body is None:
        return BodyModel(seen.names, seen.points, seen.table[list(BODY)].to_numpy(float), body)
    there = read_landmarks(o.picked_on_body)
    add_input("`picked_on_body`", o.picked_on_body, landmarks=len(there.names))
    if body is not None:
        check_picked(there, body, o.body_unit or o.unit)
    names, on_scan, on_body = _of_both(seen, there)
    return BodyModel(names, on_scan, on_body, body)


def registered(
    scan: Surface, marks: MatLandmarks, model: BodyModel | None, o: MatOptions
) -> tuple[Surface, MatLandmarks, Registration | None]:
    """Scan and marks of the mat in the body's frame, and how well they fit; as they are without a body."""
    if model is None:
        return scan, marks, None
    try:
        guard = compare_landmarks(model.on_scan, model.on_body)
        found = fit_landmarks(model.on_scan, model.on_body, names=model.names)
        if guard.warning:
            reserve(guard.warning)
        judge(goodness_of_registration("landmarks", found))
        _report_fit("landmarks", found)
        if model.surface is not None:
            engine, found = _by_shape(scan, model.surface, found, o)
            judge(goodness_of_registration("shape", found), warned=not found.converged)
            _report_fit("shape", found, engine=engine)
            if not found.converged:
                reserve("the registration by shape did not converge; look at registration.csv")
    except InputError:
        raise
    except ValueError as error:
        raise InputError(o.body_landmarks or "", "", str(error), "check landmarks, units and `body`") from error
    moved = Surface(found.pose.apply(scan.vertices), scan.faces, scan.name)
    return moved, replace(marks, point=found.pose.apply(marks.point)), found


def _by_shape(scan: Surface, body: Surface, start: Registration, o: MatOptions) -> tuple[str, Registration]:
    """The scan brought onto the body from where the landmarks put it, and by which engine."""
    try:
        return shape_registration(scan, body, start, o.icp_engine or "auto")
    except ImportError as error:
        raise InputError("", "`icp_engine`", str(error), "or leave it out") from error


def _of_both(
    seen: Landmarks, there: Landmarks
) -> tuple[tuple[str, ...], Float[np.ndarray, "n 3"], Float[np.ndarray, "n 3"]]:
    """Landmarks with an id in both files, and a reservation for those with an id in one."""
    names = tuple(name for name in seen.names if name in there.names)
    alone = sorted({*seen.names} ^ {*there.names})
    if len(names) < 3:
        what = f"has {len(names)} ids of {seen.path.name}; only one of the two has {', '.join(alone)}"
        raise InputError(there.path, "", what, "give three landmarks or more the same ids in both")
    if alone:
        reserve(f"landmarks with an id in only one of {seen.path.name} and {there.path.name}: {', '.join(alone)}")
    on_scan, on_body = (np.array([each.point(name) for name in names]) for each in (seen, there))
    return names, on_scan, on_body


def _report_fit(way: str, found: Registration, **more: str) -> None:
    worst, off = found.worst
    note(
        f"registration by {way}",
        {
            "rms_mm": found.rms * 1e3,
            "overlap": found.overlap,
            "worst": worst,
            "worst_mm": off * 1e3,
            "hold": None if np.isnan(found.hold) else found.hold,
            "pose": found.pose.as_matrix().tolist(),
            **more,
        },
    )
    say(f"registration by {way}: root mean square {found.rms * 1e3:.2f} mm, {found.overlap:.0%} of the points met")


OVERLAP = 0.5  # of the second scan that lies on the first


@dataclass(frozen=True, eq=False)
class SecondScan:
    """The scan with the mat on, and a point near the mat's corner at its first cell [m], where one is named."""

    surface: Surface
    corner: Float[np.ndarray, " 3"] | None


def read_second_scan(scan: Surface, o: MatOptions) -> SecondScan | None:
    """The scan with the mat on; None where there is none."""
    if o.scan_with_mat is None:
        return None
    surface = read_input_surface("scan with the mat", o.scan_with_mat, o.unit, None, merge_tolerance=o.merge_tolerance)
    corner = None if o.first_corner is None else np.array(typed_centre("`first_corner`", o.first_corner, scan, o.unit))
    return SecondScan(surface, corner)


def marks_found(scan: Surface, second: SecondScan, frames: PressureFrames, o: MatOptions) -> MatLandmarks:
    """Where the mat's corners lie on the scan, in its frame."""
    try:
        check_surfaces(second.surface, scan, ("scan with the mat", "scan"))
        compare_boxes(second.surface.vertices, scan.vertices, ("scan with the mat", "scan"))
        found = unguided(second.surface, scan)
        if found.overlap < OVERLAP:
            raise ValueError(f"only {found.overlap:.0%} of it lies on {scan.name}")
        raised = scan_difference(same_place(second.surface, found), scan)
        outline = rectangle_on(Geodesics(scan), raised.outline, raised.length, o.mat_edge or 0.0)
    except ValueError as error:
        remedy = "check that both scans are of the same body, or give `landmarks`"
        raise InputError(o.scan_with_mat or "", "", str(error), remedy) from error
    _report_raised(found, raised, outline, frames)
    mat = flat_mat(frames, o)
    marks = outline.marks(mat, _first(outline, _candidates(outline, mat, o), second.corner, o))
    return MatLandmarks(marks.names, marks.cells, marks.points)


def flat_mat(frames: PressureFrames, o: MatOptions) -> Mat:
    """The mat before it is laid down."""
    return Mat(frames.rows, frames.columns, frames.pitch, mirrored=o.seen_from == "body")


def _report_raised(found: Registration, raised: ScanDifference, outline: Rectangle, frames: PressureFrames) -> None:
    note(
        "second scan",
        {
            "rms_mm": found.rms * 1e3,
            "overlap": found.overlap,
            "pose": found.pose.as_matrix().tolist(),
            "noise_mm": raised.noise * 1e3,
            "mat_thickness_mm": raised.thickness * 1e3,
            "outline_rms_mm": outline.rms * 1e3,
            "sides_mm": (outline.sides * 1e3).tolist(),
            "mat_mm": [frames.rows * frames.pitch[0] * 1e3, frames.columns * frames.pitch[1] * 1e3],
            "corners_mm": (outline.corners * 1e3).tolist(),
        },
    )
    say(
        f"second scan: {found.overlap:.0%} on the first, the mat {raised.thickness * 1e3:.1f} mm high, its outline "
        f"within {outline.rms * 1e3:.2f} mm of a rectangle"
    )
    if not found.converged:
        reserve("the registration of the second scan did not converge")


def _candidates(outline: Rectangle, mat: Mat, o: MatOptions) -> list[int]:
    """Corners that may be the first, at least one."""
    found = outline.first_corners(mat)
    if not found:
        down, across = mat.rows * mat.pitch[0], mat.columns * mat.pitch[1]
        a, b = (outline.sides[k] + outline.sides[k + 2] for k in (0, 1))
        seen = f"{500.0 * max(a, b):.0f} × {500.0 * min(a, b):.0f}"
        size = f"{1e3 * max(down, across):.0f} × {1e3 * min(down, across):.0f}"
        remedy = "check the pitch; `mat_edge` takes off a border without cells"
        what = f"the region that stands off is {seen} mm, the mat {size}"
        raise InputError(o.scan_with_mat or "", "", what, remedy)
    return found


def _first(outline: Rectangle, candidates: list[int], given: Float[np.ndarray, " 3"] | None, o: MatOptions) -> int:
    """The corner of the first cell."""
    named = " or ".join(_text(outline.corners[k] / LENGTH[o.unit]) for k in candidates)
    if given is None:
        what = f"the outline does not show which corner is that of the first cell; it may be {named} {o.unit}"
        raise InputError("", "`first_corner`", what, "name the one, e.g. `first_corner` x,y,z")
    nearest = int(np.argmin(np.linalg.norm(outline.corners - given, axis=1)))
    if nearest not in candidates:
        what = f"the corner nearest to {o.first_corner} cannot be that of the first cell, which is {named} {o.unit}"
        raise InputError("", "`first_corner`", what, "check the corner and `seen_from`")
    return nearest


def _text(point: Float[np.ndarray, " 3"]) -> str:
    return ",".join(f"{x:.4g}" for x in point)
