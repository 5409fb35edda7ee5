"""Landmarks of a mat from a second scan with the mat on: found where it stands off the scan without."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.analyses.bodies import read_surface
from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.quantities import centre
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.data.pressure_frames import PressureFrames
from geocontact.geometry.drape.geodesics import Geodesics
from geocontact.geometry.drape.rectangle import Rectangle, rectangle_on
from geocontact.geometry.drape.scan_difference import ScanDifference, scan_difference
from geocontact.geometry.register.quality import Registration
from geocontact.geometry.register.scale_guard import compare_boxes
from geocontact.geometry.register.unguided import same_place, unguided
from geocontact.geometry.surface import Surface
from geocontact.io.recordings.mat_landmarks import MatLandmarks
from geocontact.io.text.units import LENGTH

FITS = 0.12  # of a side's length, by which the region may be longer or shorter than the mat
OVERLAP = 0.5  # of the second scan that lies on the first


@dataclass(frozen=True, eq=False)
class SecondScan:
    """The scan with the mat on, and a point near the mat's corner at its first cell [m], where one is named."""

    surface: Surface
    corner: Float[np.ndarray, " 3"] | None


def read_second_scan(record: Record, o: MatOptions) -> SecondScan | None:
    """The scan with the mat on; None where there is none."""
    if o.scan_with_mat is None:
        return None
    surface = read_surface(record, "scan with the mat", o.scan_with_mat, o.unit, None)
    corner = None if o.first_corner is None else np.array(centre(o.first_corner, o.unit, "`first_corner`"))
    return SecondScan(surface, corner)


def marks_found(
    record: Record, scan: Surface, second: SecondScan, frames: PressureFrames, o: MatOptions
) -> MatLandmarks:
    """Where the mat's corners lie on the scan, in its frame."""
    try:
        compare_boxes(second.surface.vertices, scan.vertices, ("scan with the mat", "scan"))
        found = unguided(second.surface, scan)
        if found.overlap < OVERLAP:
            raise ValueError(f"only {found.overlap:.0%} of it lies on {scan.name}")
        raised = scan_difference(same_place(second.surface, found), scan)
        outline = rectangle_on(Geodesics(scan), raised.outline, raised.length, o.mat_edge or 0.0)
    except ValueError as error:
        remedy = "check that both scans are of the same body, or give `landmarks`"
        raise InputError(o.scan_with_mat or "", "", str(error), remedy) from error
    _tell(record, found, raised, outline, frames)
    first = _first(outline, _candidates(outline, frames, o), second.corner, o)
    hand = 1 if o.seen_from == "outside" else -1
    rows, columns = float(frames.rows), float(frames.columns)
    order = [first, (first + hand) % 4, (first - hand) % 4, (first + 2) % 4]
    place = np.array([[0.0, 0.0], [rows, 0.0], [0.0, columns], [rows, columns]])
    names = ("first corner", "end of column 1", "end of row 1", "last corner")
    return MatLandmarks(names, place, outline.corners[order])


def _tell(
    record: Record, found: Registration, raised: ScanDifference, outline: Rectangle, frames: PressureFrames
) -> None:
    record.results["second scan"] = {
        "rms_mm": found.rms * 1e3,
        "overlap": found.overlap,
        "pose": found.pose.as_matrix().tolist(),
        "noise_mm": raised.noise * 1e3,
        "mat_thickness_mm": raised.thickness * 1e3,
        "outline_rms_mm": outline.rms * 1e3,
        "sides_mm": (outline.sides * 1e3).tolist(),
        "mat_mm": [frames.rows * frames.pitch[0] * 1e3, frames.columns * frames.pitch[1] * 1e3],
        "corners_mm": (outline.corners * 1e3).tolist(),
    }
    record.say(
        f"second scan: {found.overlap:.0%} on the first, the mat {raised.thickness * 1e3:.1f} mm high, its outline "
        f"within {outline.rms * 1e3:.2f} mm of a rectangle"
    )
    if not found.converged:
        record.warn("the registration of the second scan did not settle")


def _candidates(outline: Rectangle, frames: PressureFrames, o: MatOptions) -> list[int]:
    """Corners that may be the first: from them rows and columns are as long as the sides, and turn the right way."""
    down, across = frames.rows * frames.pitch[0], frames.columns * frames.pitch[1]
    ahead, behind = outline.sides, np.roll(outline.sides, 1)
    by_row, by_column = (ahead, behind) if o.seen_from == "outside" else (behind, ahead)
    fits = (np.abs(by_row / down - 1.0) < FITS) & (np.abs(by_column / across - 1.0) < FITS)
    if not fits.any():
        a, b = (outline.sides[k] + outline.sides[k + 2] for k in (0, 1))
        seen = f"{500.0 * max(a, b):.0f} × {500.0 * min(a, b):.0f}"
        mat = f"{1e3 * max(down, across):.0f} × {1e3 * min(down, across):.0f}"
        remedy = "check the pitch; `mat_edge` takes off a border without cells"
        what = f"the region that stands off is {seen} mm, the mat {mat}"
        raise InputError(o.scan_with_mat or "", "", what, remedy)
    return [int(k) for k in np.flatnonzero(fits)]


def _first(outline: Rectangle, candidates: list[int], given: Float[np.ndarray, " 3"] | None, o: MatOptions) -> int:
    """The corner of the first cell."""
    named = " or ".join(_text(outline.corners[k] / LENGTH[o.unit]) for k in candidates)
    if given is None:
        what = f"the outline does not tell which corner is that of the first cell; it may be {named} {o.unit}"
        raise InputError("", "`first_corner`", what, "name the one, e.g. `first_corner` x,y,z")
    nearest = int(np.argmin(np.linalg.norm(outline.corners - given, axis=1)))
    if nearest not in candidates:
        what = f"the corner nearest to {o.first_corner} cannot be that of the first cell, which is {named} {o.unit}"
        raise InputError("", "`first_corner`", what, "check the corner and `seen_from`")
    return nearest


def _text(point: Float[np.ndarray, " 3"]) -> str:
    return ",".join(f"{x:.4g}" for x in point)
