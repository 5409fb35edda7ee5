"""Loads of a mat that lies on its surface, their uncertainty, and where both refer to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.analyses.mat.motion import Travel
from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.mat.placed import PlacedMat, mat_and_marks
from geocontact.analyses.mat.read import MatInputs
from geocontact.analyses.mat.recording import PreparedFrames
from geocontact.analyses.mat.segments import cells_of
from geocontact.analyses.mat.uncertainty import stated_errors
from geocontact.analyses.run_record import Record
from geocontact.geometry.drape.slip import slip_covariance
from geocontact.loads.mat.errors import MatErrors, wrench_covariance
from geocontact.loads.mat.fill import filling_covariance
from geocontact.loads.mat.load import MatLoad, mat_load, segment_loads


@dataclass(frozen=True, eq=False)
class MatLoads:
    """Loads on the body, frame by frame.

    Parameters
    ----------
    pressure
        Of each cell that lies on the surface [Pa].
    whole, segments
        Of all cells, and of each named part.
    covariance
        Of force [N] and moment [N m] of `whole`.
    errors
        What it rests on.
    home
        Name of the frame that surface and cells are in; that of the loads is another where the segment moves.
    """

    pressure: Float[np.ndarray, "t n"]
    whole: MatLoad
    segments: Mapping[str, MatLoad]
    covariance: Float[np.ndarray, "t six six"]
    errors: MatErrors
    home: str


def loads(
    record: Record, given: MatInputs, p: PlacedMat, seen: PreparedFrames, travel: Travel | None, o: MatOptions
) -> MatLoads:
    """Loads about the point that was asked for; carried along where the segment moves."""
    whose = o.surface if p.registration is None else o.body or o.body_landmarks or o.surface
    home = o.frame or f"of {whose.name}"
    origin = given.point if travel is None else np.zeros(3)  # of the segment
    pressure = p.cells.of(seen.frames.pressure)
    whole = mat_load(p.cells, pressure, origin, home, o.gate, o.touched)
    chosen = cells_of(record, given.segments, p.surface, p.cells, o)
    parts = segment_loads(p.cells, pressure, origin, home, chosen, o.gate, o.touched)
    mat, marks = mat_and_marks(seen.frames, p.landmarks, o)
    errors = stated_errors(record, p.cells, p.registration, slip_covariance(mat, p.drape, marks, o.belt), o)
    spread = wrench_covariance(p.cells, pressure, whole.wrench, errors)
    spread += filling_covariance(p.cells, pressure, whole.wrench, seen.gaps)
    if travel is not None:
        whole, parts, spread = travel.carried(whole, parts, spread, given.point)
    found = MatLoads(pressure, whole, parts, spread, errors, home)
    _tell(record, found, seen.frames.time, given.point)
    return found


def _tell(record: Record, found: MatLoads, time: Float[np.ndarray, " t"], point: Float[np.ndarray, " 3"]) -> None:
    whole = found.whole
    heaviest = int(np.argmax(whole.pressing))
    round_about = np.isnan(whole.normal[0])  # a belt looks to no side
    record.results["load"] = {
        "frame": whole.wrench.frame,
        "point_mm": (point * 1e3).tolist(),
        "frames": len(time),
        "largest_force_N": round(float(whole.pressing[heaviest]), 6),
        "at_s": round(float(time[heaviest]), 6),
        "perpendicular_N": None if round_about else round(float(whole.perpendicular[heaviest]), 6),
        "interface_normal": None if round_about else whole.normal.tolist(),
        "peak_Pa": float(whole.peak.max()),
        "segments": list(found.segments),
    }
    record.say(
        f"force up to {whole.pressing[heaviest]:.1f} N at {time[heaviest]:g} s, pressure up to "
        f"{whole.peak.max() * 1e-3:.1f} kPa, area up to {whole.area.max() * 1e4:.0f} cm²"
    )
