"""The mat on its surface: what is read, the surface under the mat and its named parts, the mat as it lies."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from geocontact.analyses.frame.bodies import chosen_faces, read_input_surface
from geocontact.analyses.frame.collector import add_input, note, reserve
from geocontact.analyses.frame.landmarks import check_picked, region_kind
from geocontact.analyses.frame.places import centre
from geocontact.analyses.frame.quantities import named_file
from geocontact.analyses.mat.comparison import ModelForces, Phase, read_model, read_phases
from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.mat.placement import (
    BodyModel,
    SecondScan,
    flat_mat,
    marks_found,
    open_belt,
    outwards,
    read_body_model,
    read_second_scan,
    registered,
    say_how_it_closes,
    say_which_side,
)
from geocontact.analyses.mat.recording import read_recording, read_shear
from geocontact.analyses.mat.travel import read_segment_motion
from geocontact.data.errors import InputError
from geocontact.data.motion import Motion
from geocontact.data.pressure_frames import PressureFrames
from geocontact.geometry.drape.belt import NotAroundError
from geocontact.geometry.drape.cells import Drape
from geocontact.geometry.drape.closest_point import project
from geocontact.geometry.drape.lay import lay
from geocontact.geometry.drape.mat import Marks, Mat
from geocontact.geometry.drape.spread import Geodesics
from geocontact.geometry.register.quality import Registration
from geocontact.geometry.surface import Surface
from geocontact.io.recordings.mat_results import MatLandmarks, read_mat_landmarks
from geocontact.io.text.units import LENGTH
from geocontact.loads.closest_point_mat import ClosestPoint, beside_closest_point
from geocontact.loads.mat_map import MatMap, mat_map

Parts = Mapping[str, str | Bool[np.ndarray, " f"]]


def read_segments(scan: Surface, o: MatOptions) -> Parts:
    """Expression of each part, or the faces that a file lists."""
    found: dict[str, str | Bool[np.ndarray, " f"]] = {}
    for text in o.segment:
        name, sign, expression = (part.strip() for part in text.partition("="))
        if not sign or not name.replace("_", "").replace("-", "").isalnum() or name in found:
            raise InputError("", "`segment`", f"{text!r} has no name of its own", 'write for example "upper=y > 20"')
        of_scan = bool(region_kind(expression)[0]) or named_file(expression) is not None
        faces = chosen_faces("`segment`", expression, scan, o.unit) if of_scan else None
        found[name] = expression if faces is None else faces
    return found


def cells_of(parts: Parts, surface: Surface, placed: MatMap, o: MatOptions) -> dict[str, Bool[np.ndarray, " n"]]:
    """Cells of each part: those that lie for the most part on its faces, which are chosen in the frame of `surface`."""
    found: dict[str, Bool[np.ndarray, " n"]] = {}
    for name, part in parts.items():
        faces = chosen_faces("`segment`", part, surface, o.unit) if isinstance(part, str) else part
        found[name] = placed.lying_on(np.asarray(faces, bool))
        if not found[name].any():
            raise InputError("", "`segment`", f"no cell lies on '{name}'", "check the expression and the frame")
    if found:
        counted = np.sum(list(found.values()), axis=0)
        for what, cells in (("in no segment", counted == 0), ("in more than one segment", counted > 1)):
            if cells.any():
                reserve(f"{int(cells.sum())} cells are {what}: segments do not add up to the whole")
    return found


@dataclass(frozen=True, eq=False)
class MatInputs:
    """Everything that was read; None for what was not asked for.

    Parameters
    ----------
    recorded
        Frames of the mat as they were read.
    shear
        Shear stresses from row to row and from column to column, ready; None without any.
    listed_dead
        Row and column of cells that the layout lists as dead.
    motion
        Poses of the segment that carries the mat.
    scan
        Surface that the mat lies on, its faces as the file has them.
    landmarks
        Places of the mat and their points of the scan [m].
    second_scan
        Instead of landmarks: the scan with the mat on.
    point
        That moments refer to [m], in the frame of the results.
    body
        Body model that the scan is registered to.
    segments
        Expression of each named part, or the faces that belong to it where a file names them.
    phases
        Of the recording, for a comparison.
    model
        Forces to compare with.
    """

    recorded: PressureFrames
    shear: tuple[PressureFrames, PressureFrames] | None
    listed_dead: tuple[tuple[int, int], ...]
    motion: Motion | None
    scan: Surface
    landmarks: MatLandmarks | None
    second_scan: SecondScan | None
    point: Float[np.ndarray, " 3"]
    body: BodyModel | None
    segments: Mapping[str, str | Bool[np.ndarray, " f"]]
    phases: tuple[Phase, ...] | None
    model: ModelForces | None


def read(o: MatOptions) -> MatInputs:
    """Everything the options name."""
    recorded, listed_dead = read_recording(o)
    motion = read_segment_motion(o)
    scan = read_input_surface("surface", o.surface, o.unit, None, merge_tolerance=o.merge_tolerance)
    return MatInputs(
        recorded,
        read_shear(recorded, o),
        listed_dead,
        motion,
        scan,
        _landmarks(recorded, scan, o),
        read_second_scan(scan, o),
        np.zeros(3) if o.point is None else np.array(centre(o.point, o.unit, "`point`")),
        read_body_model(scan, o),
        read_segments(scan, o),
        read_phases(o),
        read_model(o),
    )


def _landmarks(frames: PressureFrames, scan: Surface, o: MatOptions) -> MatLandmarks | None:
    if o.landmarks is None:
        return None
    marks = read_mat_landmarks(o.landmarks, frames.rows, frames.columns)
    add_input("`landmarks`", o.landmarks, landmarks=len(marks.name))
    if marks.picked is not None:
        check_picked(marks.picked, scan, o.unit)
    return marks


LOST = 3.0  # times the pitch; a mat that misses a landmark by more does not lie there
FAR = 0.25  # of the mat's pitch; landmarks that miss their points by more deserve a word
SMALL, LARGE = 0.05, 4.0  # m, of a scan of a body segment or a body
SHRUNK = 0.05  # of a cell's area


@dataclass(frozen=True, eq=False)
class PlacedMat:
    """A mat on its surface, in the frame of the scan or of the body that it is registered to."""

    surface: Surface
    drape: Drape
    cells: MatMap
    landmarks: MatLandmarks
    registration: Registration | None


def placed(given: MatInputs, frames: PressureFrames, o: MatOptions) -> PlacedMat:
    """The mat where landmarks or the second scan show it."""
    scan = outwards(given.scan, o)
    _guard(scan, frames, o)
    marks = given.landmarks
    if given.second_scan is not None:
        marks = marks_found(scan, given.second_scan, frames, o)
    if marks is None:
        raise InputError("", "`landmarks`", "is missing: nothing says where the mat lies", "give `landmarks`")
    surface, marks, registration = registered(scan, marks, given.body, o)
    laid = _laid(surface, frames, marks, o)
    return PlacedMat(surface, laid, _mapped(surface, laid, frames), marks, registration)


def mat_and_marks(frames: PressureFrames, landmarks: MatLandmarks, o: MatOptions) -> tuple[Mat, Marks]:
    """The flat mat, and where its places were seen, as geometry takes them."""
    return flat_mat(frames, o), Marks(landmarks.place, landmarks.point, landmarks.name)


def _guard(surface: Surface, frames: PressureFrames, o: MatOptions) -> None:
    """Refuse a scan that is no body, or that the mat cannot lie on: a unit is wrong then."""
    span = float(np.linalg.norm(np.ptp(surface.vertices, axis=0)))
    mat = float(np.hypot(frames.rows * frames.pitch[0], frames.columns * frames.pitch[1]))
    if SMALL <= span <= LARGE and mat < 3.0 * span:
        return
    likely = [unit for unit, factor in LENGTH.items() if SMALL <= span / LENGTH[o.unit] * factor <= LARGE]
    named = f"; the file looks like {' or '.join(likely)}, pass `unit` {likely[0]}" if likely else ""
    what = f"the scan spans {span * 1e3:.4g} mm and the mat {mat * 1e3:.4g} mm{named}"
    raise InputError(o.surface, "", what, "check `unit` and the mat's pitch")


def _laid(surface: Surface, frames: PressureFrames, marks: MatLandmarks, o: MatOptions) -> Drape:
    mat, at = mat_and_marks(frames, marks, o)
    geodesics = Geodesics(surface)
    try:
        laid = lay(geodesics, mat, at, o.belt) if o.lay == "geodesic" else project(geodesics, mat, at)
    except NotAroundError as error:
        raise open_belt(o, error) from error
    except ValueError as error:
        inside = "" if surface.closed else ", and `inwards` where faces look into the body"
        remedy = f"check landmarks, unit and `seen_from`{inside}"
        raise InputError(o.landmarks or "", "", str(error), remedy) from error
    _report_drape(laid, frames, marks)
    _warn_how_it_lies(laid, frames, marks)
    say_which_side(surface, laid, at, o)
    say_how_it_closes(mat, laid, o)
    return laid


def _report_drape(laid: Drape, frames: PressureFrames, marks: MatLandmarks) -> None:
    largest, rms = laid.distortion_of(frames.valid)
    note(
        "mat",
        {
            "cells": int(frames.valid.sum()),
            "uncovered_cells": np.argwhere(frames.valid & ~laid.covered).tolist(),
            "folded_cells": np.argwhere(laid.folded & frames.valid).tolist(),
            "area_distortion_largest": largest if np.isfinite(largest) else None,
            "area_distortion_rms": rms if np.isfinite(rms) else None,
            "landmark_residual_mm": {
                n: float(m) * 1e3 if np.isfinite(m) else None for n, m in zip(marks.name, laid.misses, strict=True)
            },
        },
    )


def _warn_how_it_lies(laid: Drape, frames: PressureFrames, marks: MatLandmarks) -> None:
    """Refuse a mat that does not lie at its landmarks; warn of one that hardly does, or hangs over, folds, shrinks."""
    missed = np.nan_to_num(laid.misses, nan=np.inf)
    worst, farthest = int(np.argmax(missed)), int(np.argmax(np.where(np.isfinite(missed), missed, -1.0)))
    if LOST * max(frames.pitch) < missed[farthest] < np.inf:
        what = f"landmark {marks.name[farthest]} is missed by {missed[farthest] * 1e3:.0f} mm"
        raise InputError("", "`landmarks`", what, "check places and points of the landmarks, the pitch and the unit")
    if missed[worst] > FAR * min(frames.pitch):
        where = f"{missed[worst] * 1e3:.1f} mm" if np.isfinite(missed[worst]) else "the edge of the scan"
        reserve(f"landmark {marks.name[worst]} is missed by {where}")
    off, folded = (int((frames.valid & which).sum()) for which in (~laid.covered, laid.folded))
    if off:
        reserve(f"{off} cells reach beyond the edge of the scan; their readings are left out")
    if folded:
        reserve(f"{folded} cells are folded over others: check the landmarks")
    change = laid.distortion_of(frames.valid)[0]
    if change > SHRUNK:
        reserve(f"cells are up to {change:.1%} larger or smaller on the scan than on the flat mat")


def _mapped(surface: Surface, laid: Drape, frames: PressureFrames) -> MatMap:
    try:
        return mat_map(surface, laid.nodes, frames.valid & laid.covered, frames.cell_area)
    except ValueError as error:
        raise InputError("", "`landmarks`", str(error), "check the landmarks and the unit of the scan") from error


MM = 1e3
HERE = "closest_point_projection"


def closest_point(p: PlacedMat, frames: PressureFrames, o: MatOptions) -> ClosestPoint | None:
    """The same marks and pressures on a mat that is pushed down flat; how it differs goes to the record.

    None where the mat is laid that way, or where it cannot be: two marks do not place a flat mat.
    """
    if o.lay == "closest":
        return None
    mat, marks = mat_and_marks(frames, p.landmarks, o)
    try:
        found = beside_closest_point(p.surface, mat, marks, p.cells, frames, o.gate)
    except ValueError as error:
        note(HERE, {"not_possible": str(error)})
        return None
    _report_distance(found, frames)
    return found


def _report_distance(found: ClosestPoint, frames: PressureFrames) -> None:
    at, flat = found.frame, found.drape
    force, centre = found.force_apart, found.centre_apart * MM
    largest, rms = flat.distortion_of(frames.valid)
    note(
        HERE,
        {
            "area_distortion_largest": largest,
            "area_distortion_rms": rms,
            "uncovered_cells": int((frames.valid & ~flat.covered).sum()),
            "force_differs_N": float(force[at]),
            "force_differs_at_most_N": float(force.max()),
            "centre_of_pressure_differs_mm": float(centre[at]) if np.isfinite(centre[at]) else None,
            "centre_of_pressure_differs_at_most_mm": float(np.nanmax(centre)) if np.isfinite(centre).any() else None,
        },
    )
