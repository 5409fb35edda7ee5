"""A mat on its surface: registered, laid, and mapped onto the faces under it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.mat.placement.belt import open_belt, say_how_it_closes
from geocontact.analyses.mat.placement.registration import registered
from geocontact.analyses.mat.placement.second_scan import marks_found
from geocontact.analyses.mat.placement.sides import outwards, say_which_side
from geocontact.analyses.mat.read import MatInputs
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.data.pressure_frames import PressureFrames
from geocontact.geometry.drape.belt import NotAroundError
from geocontact.geometry.drape.cells import Drape
from geocontact.geometry.drape.closest_point import project
from geocontact.geometry.drape.geodesics import Geodesics
from geocontact.geometry.drape.lay import lay
from geocontact.geometry.drape.mat import Marks, Mat
from geocontact.geometry.register.quality import Registration
from geocontact.geometry.surface import Surface
from geocontact.io.recordings.mat_landmarks import MatLandmarks
from geocontact.io.text.units import LENGTH
from geocontact.loads.mat.map import MatMap, mat_map

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


def placed(record: Record, given: MatInputs, frames: PressureFrames, o: MatOptions) -> PlacedMat:
    """The mat where landmarks or the second scan show it."""
    scan = outwards(given.scan, o)
    _guard(scan, frames, o)
    marks = given.landmarks
    if given.second_scan is not None:
        marks = marks_found(record, scan, given.second_scan, frames, o)
    if marks is None:
        raise InputError("", "`landmarks`", "is missing: nothing says where the mat lies", "give `landmarks`")
    surface, marks, registration = registered(record, scan, marks, given.body, o)
    laid = _laid(record, surface, frames, marks, o)
    return PlacedMat(surface, laid, _mapped(surface, laid, frames), marks, registration)


def mat_and_marks(frames: PressureFrames, landmarks: MatLandmarks, o: MatOptions) -> tuple[Mat, Marks]:
    """The flat mat, and where its places were seen, as geometry takes them."""
    mat = Mat(frames.rows, frames.columns, frames.pitch, mirrored=o.seen_from == "body")
    return mat, Marks(landmarks.place, landmarks.point, landmarks.name)


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


def _laid(record: Record, surface: Surface, frames: PressureFrames, marks: MatLandmarks, o: MatOptions) -> Drape:
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
    _tell_how_it_lies(record, laid, frames, marks)
    _warn_how_it_lies(record, laid, frames, marks)
    say_which_side(record, surface, laid, marks, o)
    say_how_it_closes(record, mat, laid, o)
    return laid


def _tell_how_it_lies(record: Record, laid: Drape, frames: PressureFrames, marks: MatLandmarks) -> None:
    known = laid.distortion[laid.covered & frames.valid]
    record.results["mat"] = {
        "cells": int(frames.valid.sum()),
        "uncovered_cells": np.argwhere(frames.valid & ~laid.covered).tolist(),
        "folded_cells": np.argwhere(laid.folded & frames.valid).tolist(),
        "area_distortion_largest": float(np.abs(known).max()) if known.size else None,
        "area_distortion_rms": float(np.sqrt(np.mean(known**2))) if known.size else None,
        "landmark_residual_mm": {
            n: float(m) * 1e3 if np.isfinite(m) else None for n, m in zip(marks.name, laid.misses, strict=True)
        },
    }


def _warn_how_it_lies(record: Record, laid: Drape, frames: PressureFrames, marks: MatLandmarks) -> None:
    """Refuse a mat that does not lie at its landmarks; warn of one that hardly does, or hangs over, folds, shrinks."""
    missed = np.nan_to_num(laid.misses, nan=np.inf)
    worst, farthest = int(np.argmax(missed)), int(np.argmax(np.where(np.isfinite(missed), missed, -1.0)))
    if LOST * max(frames.pitch) < missed[farthest] < np.inf:
        what = f"landmark {marks.name[farthest]} is missed by {missed[farthest] * 1e3:.0f} mm"
        raise InputError("", "`landmarks`", what, "check places and points of the landmarks, the pitch and the unit")
    if missed[worst] > FAR * min(frames.pitch):
        where = f"{missed[worst] * 1e3:.1f} mm" if np.isfinite(missed[worst]) else "the edge of the scan"
        record.warn(f"landmark {marks.name[worst]} is missed by {where}")
    off, folded = (int((frames.valid & which).sum()) for which in (~laid.covered, laid.folded))
    if off:
        record.warn(f"{off} cells hang over the edge of the scan; what they read is left out")
    if folded:
        record.warn(f"{folded} cells are folded over others: check the landmarks")
    change = np.abs(laid.distortion[laid.covered & frames.valid]).max(initial=0.0)
    if change > SHRUNK:
        record.warn(f"cells are up to {change:.1%} larger or smaller on the scan than on the flat mat")


def _mapped(surface: Surface, laid: Drape, frames: PressureFrames) -> MatMap:
    try:
        return mat_map(surface, laid.nodes, frames.valid & laid.covered, frames.cell_area)
    except ValueError as error:
        raise InputError("", "`landmarks`", str(error), "check the landmarks and the unit of the scan") from error
