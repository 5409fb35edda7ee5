"""A pressure mat on a body scan: reads, lays, maps, writes, says what it found."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Bool

from geocontact.analyses import quantities
from geocontact.analyses.bodies import chosen_faces, read_surface
from geocontact.analyses.mat.agreement import compared
from geocontact.analyses.mat.belt import open_belt, refuse_belt, say_how_it_closes
from geocontact.analyses.mat.closest_point import projection_beside
from geocontact.analyses.mat.motion import Travel, followed, refuse_idle_motion
from geocontact.analyses.mat.recording import Recording, recording
from geocontact.analyses.mat.registration import registered
from geocontact.analyses.mat.second_scan import mat_marks, refuse_idle_scan
from geocontact.analyses.mat.sides import outwards, say_which_side
from geocontact.analyses.mat.uncertainty import stated_errors
from geocontact.analyses.mat.write import Result, write_results
from geocontact.analyses.progress import preparing
from geocontact.analyses.results_folder import written_whole
from geocontact.analyses.run_record import Record
from geocontact.cli.mat import MatOptions
from geocontact.data.errors import InputError
from geocontact.data.pressure_frames import PressureFrames
from geocontact.geometry.drape.belt import NotAroundError
from geocontact.geometry.drape.cells import Drape
from geocontact.geometry.drape.closest_point import project
from geocontact.geometry.drape.geodesics import Geodesics
from geocontact.geometry.drape.lay import lay
from geocontact.geometry.drape.mat import Marks, Mat
from geocontact.geometry.drape.slip import slip_covariance
from geocontact.geometry.register.quality import Registration
from geocontact.geometry.register.uncertainty import PoseCovariance
from geocontact.geometry.surface import Surface
from geocontact.io.recordings.mat_landmarks import MatLandmarks
from geocontact.io.text.units import LENGTH
from geocontact.loads.mat.errors import wrench_covariance
from geocontact.loads.mat.fill import filling_covariance
from geocontact.loads.mat.load import mat_load, segment_loads
from geocontact.loads.mat.map import MatMap, mat_map

LOST = 3.0  # times the pitch; a mat that misses a landmark by more does not lie there
FAR = 0.25  # of the mat's pitch; landmarks that miss their points by more deserve a word
SMALL, LARGE = 0.05, 4.0  # m, of a scan of a body segment or a body
SHRUNK = 0.05  # of a cell's area


def analyse(path: Path, o: MatOptions) -> int:
    """Run the whole analysis."""
    record = Record("mat", {"frames": path, **asdict(o)})
    _refuse_idle(o)
    with record.catching_warnings(), written_whole(o.out) as draft:
        seen, travel = followed(record, recording(record, path, o), o)
        surface = outwards(read_surface(record, "surface", o.surface, o.unit, None), o)
        _guard(surface, seen.frames, o)
        with preparing():
            marks = mat_marks(record, surface, seen.frames, o)
            surface, marks, found = registered(record, surface, marks, o)
            laid = _laid(record, surface, seen.frames, marks, o)
            placed = _mapped(surface, laid, seen.frames)
        result = _loads(record, Placed(surface, laid, placed, marks, found), seen, travel, o)
        agreed = compared(record, result, o)
        write_results(record, result, agreed, projection_beside(record, result, o), o, draft)
        record.write(draft)
        written = sorted(file.name for file in draft.iterdir())
    record.say(f"results in {o.out}: {', '.join(written)}")
    record.speak()
    return 0


@dataclass(frozen=True, eq=False)
class Placed:
    """A mat on its surface."""

    surface: Surface
    laid: Drape
    map: MatMap
    marks: MatLandmarks
    registration: Registration | None


def _refuse_idle(o: MatOptions) -> None:
    rows = (
        (not (np.isfinite(o.gate) and o.gate >= 0.0), "--gate", f"{o.gate:g} is not a force of 0 N or more", "e.g. 5"),
        (not (np.isfinite(o.cutoff) and o.cutoff >= 0.0), "--cutoff", f"{o.cutoff:g} is not a frequency", "e.g. 6"),
    )  # fmt: skip
    for wrong, option, what, remedy in rows:
        if wrong:
            raise InputError("", option, what, remedy)
    refuse_idle_scan(o)
    refuse_belt(o)
    refuse_idle_motion(o)


def _guard(surface: Surface, frames: PressureFrames, o: MatOptions) -> None:
    """Refuse a scan that is no body, or that the mat cannot lie on: a unit is wrong then."""
    span = float(np.linalg.norm(np.ptp(surface.vertices, axis=0)))
    mat = float(np.hypot(frames.rows * frames.pitch[0], frames.columns * frames.pitch[1]))
    if SMALL <= span <= LARGE and mat < 3.0 * span:
        return
    likely = [unit for unit, factor in LENGTH.items() if SMALL <= span / LENGTH[o.unit] * factor <= LARGE]
    named = f"; the file looks like {' or '.join(likely)}, pass --unit {likely[0]}" if likely else ""
    what = f"the scan spans {span * 1e3:.4g} mm and the mat {mat * 1e3:.4g} mm{named}"
    raise InputError(o.surface, "", what, "check --unit and the mat's pitch")


def _laid(record: Record, surface: Surface, frames: PressureFrames, marks: MatLandmarks, o: MatOptions) -> Drape:
    mat, at = _mat(frames, marks, o)
    geodesics = Geodesics(surface)
    try:
        laid = lay(geodesics, mat, at, o.belt) if o.lay == "geodesic" else project(geodesics, mat, at)
    except NotAroundError as error:
        raise open_belt(o, error) from error
    except ValueError as error:
        inside = "" if surface.closed else ", and --inwards where faces look into the body"
        remedy = f"check landmarks, unit and --seen-from{inside}"
        raise InputError(o.landmarks or "", "", str(error), remedy) from error
    _say_how_it_lies(record, laid, frames, marks)
    say_which_side(record, surface, laid, marks, o)
    say_how_it_closes(record, mat, laid, o)
    return laid


def _mat(frames: PressureFrames, marks: MatLandmarks, o: MatOptions) -> tuple[Mat, Marks]:
    mat = Mat(frames.rows, frames.columns, frames.pitch, mirrored=o.seen_from == "body")
    return mat, Marks(marks.place, marks.point, marks.name)


def _slip(p: Placed, frames: PressureFrames, o: MatOptions) -> PoseCovariance | None:
    mat, marks = _mat(frames, p.marks, o)
    return slip_covariance(mat, p.laid, marks, o.belt)


def _say_how_it_lies(record: Record, laid: Drape, frames: PressureFrames, marks: MatLandmarks) -> None:
    missed = np.nan_to_num(laid.misses, nan=np.inf)
    worst = int(np.argmax(missed))
    off = frames.valid & ~laid.covered
    known = laid.distortion[laid.covered & frames.valid]
    record.results["mat"] = {
        "cells": int(frames.valid.sum()),
        "uncovered_cells": np.argwhere(off).tolist(),
        "folded_cells": np.argwhere(laid.folded & frames.valid).tolist(),
        "area_distortion_largest": float(np.abs(known).max()) if known.size else None,
        "area_distortion_rms": float(np.sqrt(np.mean(known**2))) if known.size else None,
        "landmark_residual_mm": {
            n: float(m) * 1e3 if np.isfinite(m) else None for n, m in zip(marks.name, laid.misses, strict=True)
        },
    }
    farthest = int(np.argmax(np.where(np.isfinite(missed), missed, -1.0)))
    if LOST * max(frames.pitch) < missed[farthest] < np.inf:
        what = f"landmark {marks.name[farthest]} is missed by {missed[farthest] * 1e3:.0f} mm"
        raise InputError("", "--landmarks", what, "check places and points of the landmarks, the pitch and the unit")
    if missed[worst] > FAR * min(frames.pitch):
        where = f"{missed[worst] * 1e3:.1f} mm" if np.isfinite(missed[worst]) else "the edge of the scan"
        record.warn(f"landmark {marks.name[worst]} is missed by {where}")
    if off.any():
        record.warn(f"{int(off.sum())} cells hang over the edge of the scan; what they read is left out")
    if (laid.folded & frames.valid).any():
        record.warn(f"{int((laid.folded & frames.valid).sum())} cells are folded over others: check the landmarks")
    if known.size and np.abs(known).max() > SHRUNK:
        record.warn(f"cells are up to {np.abs(known).max():.1%} larger or smaller on the scan than on the flat mat")


def _mapped(surface: Surface, laid: Drape, frames: PressureFrames) -> MatMap:
    try:
        return mat_map(surface, laid.nodes, frames.valid & laid.covered, frames.cell_area)
    except ValueError as error:
        raise InputError("", "--landmarks", str(error), "check the landmarks and the unit of the scan") from error


def _loads(record: Record, p: Placed, seen: Recording, travel: Travel | None, o: MatOptions) -> Result:
    point = np.zeros(3) if o.point is None else np.array(quantities.centre(o.point, o.unit, "--point"))
    whose = o.surface if p.registration is None else o.body or o.body_landmarks or o.surface
    frame = o.frame or f"of {whose.name}"
    origin = point if travel is None else np.zeros(3)  # of the segment
    touched = quantities.modulus(o.touched, "--touched")
    pressure = p.map.of(seen.frames.pressure)
    whole = mat_load(p.map, pressure, origin, frame, o.gate, touched)
    parts = segment_loads(p.map, pressure, origin, frame, _segments(record, p, o), o.gate, touched)
    errors = stated_errors(record, p.map, p.registration, _slip(p, seen.frames, o), o)
    spread = wrench_covariance(p.map, pressure, whole.wrench, errors)
    spread += filling_covariance(p.map, pressure, whole.wrench, seen.gaps)
    if travel is not None:
        whole, parts, spread = travel.carried(whole, parts, spread, point)
    heaviest = int(np.argmax(whole.pressing))
    record.results["load"] = {
        "frame": whole.wrench.frame,
        "point_mm": (point * 1e3).tolist(),
        "frames": len(seen.frames.time),
        "largest_force_N": round(float(whole.pressing[heaviest]), 6),
        "at_s": round(float(seen.frames.time[heaviest]), 6),
        "perpendicular_N": None if np.isnan(whole.normal[0]) else round(float(whole.perpendicular[heaviest]), 6),
        "interface_normal": None if np.isnan(whole.normal[0]) else whole.normal.tolist(),
        "peak_Pa": float(whole.peak.max()),
        "segments": list(parts),
    }
    record.say(
        f"force up to {whole.pressing[heaviest]:.1f} N at {seen.frames.time[heaviest]:g} s, pressure up to "
        f"{whole.peak.max() * 1e-3:.1f} kPa, area up to {whole.area.max() * 1e4:.0f} cm²"
    )
    return Result(
        p.surface, p.laid, p.map, p.marks, seen, pressure, whole, parts, spread, errors, p.registration, frame
    )


def _segments(record: Record, p: Placed, o: MatOptions) -> dict[str, Bool[np.ndarray, " n"]]:
    """Cells of each segment: those that lie for the most part on its faces."""
    found: dict[str, Bool[np.ndarray, " n"]] = {}
    for text in o.segment:
        name, sign, expression = text.partition("=")
        name = name.strip()
        if not sign or not name.replace("_", "").replace("-", "").isalnum() or name in found:
            raise InputError("", "--segment", f"{text!r} has no name of its own", 'write for example "upper=y > 20"')
        faces = chosen_faces(record, "--segment", expression.strip(), p.surface, o.unit)
        inside = p.map.share.T @ np.asarray(faces, float)
        found[name] = np.asarray(inside >= 0.5)
        if not found[name].any():
            raise InputError("", "--segment", f"no cell lies on {text!r}", "check the expression and the frame")
    if found:
        counted = np.sum(list(found.values()), axis=0)
        for what, cells in (("in no segment", counted == 0), ("in more than one segment", counted > 1)):
            if cells.any():
                record.warn(f"{int(cells.sum())} cells are {what}: segments do not add up to the whole")
    return found
