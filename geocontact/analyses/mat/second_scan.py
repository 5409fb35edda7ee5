"""Landmarks of a mat from a second scan with the mat on: found where it stands off the scan without."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses import quantities
from geocontact.analyses.bodies import read_surface
from geocontact.analyses.checks import refuse
from geocontact.analyses.run_record import Record
from geocontact.cli.mat import MatOptions
from geocontact.data.errors import InputError
from geocontact.data.pressure_frames import PressureFrames
from geocontact.geometry.drape.geodesics import Geodesics
from geocontact.geometry.drape.rectangle import Rectangle, rectangle_on
from geocontact.geometry.drape.standing_off import StandingOff, standing_off
from geocontact.geometry.register.quality import Registration
from geocontact.geometry.register.scale_guard import compare_boxes
from geocontact.geometry.register.unguided import same_place, unguided
from geocontact.geometry.surface import Surface
from geocontact.io.recordings.mat_landmarks import MatLandmarks, read_mat_landmarks
from geocontact.io.text.units import LENGTH

FITS = 0.12  # of a side's length, by which the region may be longer or shorter than the mat
OVERLAP = 0.5  # of the second scan that lies on the first


def refuse_idle_scan(o: MatOptions) -> None:
    """Refuse none and two of the ways to say where the mat lies, and what belongs to the other."""
    refuse(
        (o.landmarks is None and o.scan_with_mat is None, "--landmarks", "is missing: nothing says where the mat lies",
         "give --landmarks, or a second scan --scan-with-mat"),
        (o.landmarks is not None and o.scan_with_mat is not None, "--scan-with-mat",
         "beside --landmarks says twice where the mat lies", "give one of them"),
        (o.scan_with_mat is None and o.first_corner is not None, "--first-corner",
         "does nothing without --scan-with-mat", "leave it out"),
        (o.scan_with_mat is None and o.mat_edge is not None, "--mat-edge", "does nothing without --scan-with-mat",
         "leave it out"),
    )  # fmt: skip


def mat_marks(record: Record, surface: Surface, frames: PressureFrames, o: MatOptions) -> MatLandmarks:
    """Where places of the mat lie on the scan, in its frame."""
    if o.landmarks is not None:
        marks = read_mat_landmarks(o.landmarks, frames.rows, frames.columns)
        record.add_input("--landmarks", o.landmarks, landmarks=len(marks.name))
        return marks
    path = Path(str(o.scan_with_mat))
    second = read_surface(record, "scan with the mat", path, o.unit, None)
    edge = 0.0 if o.mat_edge is None else quantities.length(o.mat_edge, "--mat-edge")
    try:
        compare_boxes(second.vertices, surface.vertices, ("scan with the mat", "scan"))
        found = unguided(second, surface)
        if found.overlap < OVERLAP:
            raise ValueError(f"only {found.overlap:.0%} of it lies on {surface.name}")
        raised = standing_off(same_place(second, found), surface)
        outline = rectangle_on(Geodesics(surface), raised.outline, raised.length, edge)
    except ValueError as error:
        remedy = "check that both scans are of the same body, or give --landmarks"
        raise InputError(path, "", str(error), remedy) from error
    _tell(record, found, raised, outline, frames)
    first = _first(outline, _candidates(outline, frames, o), o)
    hand = 1 if o.seen_from == "outside" else -1
    rows, columns = float(frames.rows), float(frames.columns)
    order = [first, (first + hand) % 4, (first - hand) % 4, (first + 2) % 4]
    place = np.array([[0.0, 0.0], [rows, 0.0], [0.0, columns], [rows, columns]])
    names = ("first corner", "end of column 1", "end of row 1", "last corner")
    return MatLandmarks(names, place, outline.corners[order])


def _tell(record: Record, found: Registration, raised: StandingOff, outline: Rectangle, frames: PressureFrames) -> None:
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
        remedy = "check the pitch; --mat-edge takes off a border without cells"
        what = f"the region that stands off is {seen} mm, the mat {mat}"
        raise InputError(Path(str(o.scan_with_mat)), "", what, remedy)
    return [int(k) for k in np.flatnonzero(fits)]


def _first(outline: Rectangle, candidates: list[int], o: MatOptions) -> int:
    """The corner of the first cell."""
    named = " or ".join(_text(outline.corners[k] / LENGTH[o.unit]) for k in candidates)
    if o.first_corner is None:
        what = f"the outline does not tell which corner is that of the first cell; it may be {named} {o.unit}"
        raise InputError("", "--first-corner", what, "name the one, e.g. --first-corner x,y,z")
    given = np.array(quantities.centre(o.first_corner, o.unit, "--first-corner"))
    nearest = int(np.argmin(np.linalg.norm(outline.corners - given, axis=1)))
    if nearest not in candidates:
        what = f"the corner nearest to {o.first_corner} cannot be that of the first cell, which is {named} {o.unit}"
        raise InputError("", "--first-corner", what, "check the corner and --seen-from")
    return nearest


def _text(point: Float[np.ndarray, " 3"]) -> str:
    return ",".join(f"{x:.4g}" for x in point)
