"""Loads of a mat that lies on its surface, their uncertainty, and the tables of both."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import pandas as pd
from jaxtyping import Bool, Float

from geocontact.analyses.frame.collector import note, say, spelled
from geocontact.analyses.frame.result import Result
from geocontact.analyses.mat.comparison import AXES, load_table
from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.mat.placed import MatInputs, PlacedMat, cells_of, mat_and_marks
from geocontact.analyses.mat.recording import PreparedFrames
from geocontact.analyses.mat.shear import MatShear, shear_table
from geocontact.analyses.mat.travel import Travel
from geocontact.data.frame_blocks import parts, worked
from geocontact.data.pressure_frames import PressureFrames
from geocontact.geometry.drape.cells import Drape
from geocontact.geometry.drape.slip import slip_covariance
from geocontact.geometry.register.quality import PoseCovariance, Registration
from geocontact.geometry.surface import Surface
from geocontact.io.recordings.mat_results import MatLandmarks
from geocontact.loads.closest_point_mat import ClosestPoint
from geocontact.loads.dead_cells import filling_covariance
from geocontact.loads.mat_load import MatErrors, MatLoad, mat_load, segment_loads, wrench_covariance
from geocontact.loads.mat_map import MatMap

SUM, ALONG = "sum of pressure × area", "resultant along the mean normal"
"""Two sizes of a mat's force: of all cells, whichever way they look, and of their resultant along one direction."""


def stated_errors(
    placed: MatMap, registration: Registration | None, slip: PoseCovariance | None, o: MatOptions
) -> MatErrors:
    """Errors of cells, and of the place: as `registration` states it, else as the residuals tell.

    Those are of the registration, if there is one, and of the mat's landmarks (`slip`); they are independent.
    """
    cell, gain = o.accuracy, o.gain or 0.0
    nothing = spelled("not stated: no `registration`, and no residual")
    told: dict[str, object] = {"cell": cell, "gain": gain, "place": nothing}
    note("uncertainty", told)
    if o.registration is not None:
        shift, turn = o.registration
        told["place"] = spelled("`registration`")
        told.update({"sd_shift_mm": [shift * 1e3] * 3, "sd_turn_deg": [np.degrees(turn)] * 3})
        return MatErrors(cell, gain, shift, turn)
    middle = placed.middle
    known = None if registration is None else registration.covariance
    if registration is not None and known is not None:
        way = "landmarks" if registration.names else "shape"
        told.update(_pose_errors(f"residual of the registration by {way}", known, middle))
    if slip is not None:
        own = _pose_errors("residual of the mat's landmarks", slip, middle)
        told.update(own if known is None else {"mat_on_scan": own})
        known = slip if known is None else known.plus(slip)
    return MatErrors(cell, gain, pose=known)


def _pose_errors(place: str, covariance: PoseCovariance, middle: Float[np.ndarray, " 3"]) -> dict[str, object]:
    """At the middle of the mat."""
    sd = np.sqrt(np.maximum(np.diag(covariance.at(middle)), 0.0))
    return {
        "place": place,
        "sd_shift_mm": (sd[:3] * 1e3).tolist(),
        "sd_turn_deg": np.degrees(sd[3:]).tolist(),
        "degrees_of_freedom": covariance.freedom,
    }


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


def loads(given: MatInputs, p: PlacedMat, seen: PreparedFrames, travel: Travel | None, o: MatOptions) -> MatLoads:
    """Loads about the point that was asked for; carried along where the segment moves."""
    whose = o.surface if p.registration is None else o.body or o.body_landmarks or o.surface
    home = o.frame or f"of {whose.name}"
    origin = given.point if travel is None else np.zeros(3)  # of the segment
    pressure = p.cells.of(seen.frames.pressure)
    whole = mat_load(p.cells, pressure, origin, home, o.gate, o.touched)
    chosen = cells_of(given.segments, p.surface, p.cells, o)
    parts = segment_loads(p.cells, pressure, origin, home, chosen, o.gate, o.touched)
    mat, marks = mat_and_marks(seen.frames, p.landmarks, o)
    errors = stated_errors(p.cells, p.registration, slip_covariance(mat, p.drape, marks, o.belt), o)
    spread = wrench_covariance(p.cells, pressure, whole.wrench, errors)
    if seen.gaps:
        spread = worked(np.add, spread, filling_covariance(p.cells, pressure, whole.wrench, seen.gaps))
    if travel is not None:
        whole, parts, spread = travel.carried(whole, parts, spread, given.point)
    found = MatLoads(pressure, whole, parts, spread, errors, home)
    _report(found, seen.frames.time, given.point)
    return found


def _report(found: MatLoads, time: Float[np.ndarray, " t"], point: Float[np.ndarray, " 3"]) -> None:
    whole = found.whole
    heaviest = int(np.argmax(whole.pressing))
    round_about = np.isnan(whole.normal[0])  # a belt looks to no side
    note(
        "load",
        {
            "frame": whole.wrench.frame,
            "point_mm": (point * 1e3).tolist(),
            "frames": len(time),
            "largest_force_N": round(float(whole.pressing[heaviest]), 6),
            "at_s": round(float(time[heaviest]), 6),
            "perpendicular_N": None if round_about else round(float(whole.perpendicular[heaviest]), 6),
            "interface_normal": None if round_about else whole.normal.tolist(),
            "peak_Pa": float(whole.peak.max()),
            "segments": list(found.segments),
        },
    )
    say(
        f"force up to {whole.pressing[heaviest]:.1f} N at {time[heaviest]:g} s ({SUM}), pressure up to "
        f"{whole.peak.max() * 1e-3:.1f} kPa, area up to {whole.area.max() * 1e4:.0f} cm²"
    )


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class MatFindings(Result):
    """Fields of a `MatResult`, which tables, figure and page are made of.

    Parameters
    ----------
    frames
        Pressures as they are used: offset taken off, smoothed, dead cells seen to.
    saturated
        Cells that count and clip.
    surface
        Scan, in the frame of the body where it is registered to one.
    landmarks
        Places of the mat and their points of the surface [m].
    drape, cells
        How the mat lies, and where its cells are on the faces.
    pressure
        Of each of these cells [Pa].
    loads, segments
        Force, moment, centre of pressure and area of the whole mat, and of each named part.
    uncertainty
        Covariance of force [N] and moment [N m].
    errors
        What it rests on.
    home
        Name of the frame that surface and cells are in; that of the loads is another where the segment moves.
    registration
        How well scan and body fit; None without a body.
    closest_point
        The mat as a flat one would lie; None where it is laid that way or cannot be.
    agreement
        With the forces of a model, by channel and phase; None without one.
    shear
        Of a two-axis mat; None of one that has pressures only.
    """

    options: MatOptions
    frames: PressureFrames
    saturated: Bool[np.ndarray, "t r c"]
    surface: Surface
    landmarks: MatLandmarks
    drape: Drape
    cells: MatMap
    pressure: Float[np.ndarray, "t n"]
    loads: MatLoad
    segments: Mapping[str, MatLoad]
    uncertainty: Float[np.ndarray, "t six six"]
    errors: MatErrors
    home: str
    registration: Registration | None
    closest_point: ClosestPoint | None
    agreement: pd.DataFrame | None
    shear: MatShear | None = None

    @property
    def heaviest(self) -> int:
        """Frame with the largest force."""
        return int(np.argmax(self.loads.pressing))

    @cached_property
    def on_faces(self) -> Float[np.ndarray, " t"]:
        """Largest pressure of a face in each frame [Pa]: colours of page and figure end at the largest of all."""
        under = np.flatnonzero(np.diff(self.cells.share.indptr))  # faces that carry no cell have no pressure
        cells, area = replace(self.cells, share=self.cells.share[under]), self.surface.face_area[under]
        return worked(
            lambda part: cells.face_pressure(part, area).max(axis=1, initial=0.0), self.pressure, each=len(under)
        )

    @cached_property
    def peak(self) -> Float[np.ndarray, " n"]:
        """Largest pressure of each cell over time [Pa]."""
        return np.asarray(np.max([part.max(axis=0, initial=0.0) for (part,) in parts(self.pressure)], axis=0))

    @property
    def deviation(self) -> Float[np.ndarray, "t six"]:
        """Standard deviations of force [N] and moment [N m]."""
        return worked(lambda part: np.sqrt(np.maximum(np.diagonal(part, axis1=1, axis2=2), 0.0)), self.uncertainty)


MM = 1e3


def mat_tables(r: MatFindings) -> dict[str, pd.DataFrame]:
    """`wrench`, `uncertainty`, `cells`, `frames_cells`; and `shear`, `segments`, `registration`, `agreement` if any."""
    found = {
        "wrench": _wrench_table(r),
        "uncertainty": _uncertainty_table(r),
        "cells": _cell_table(r),
        "frames_cells": _frames_table(r),
    }
    if r.shear is not None:
        found["shear"] = shear_table(r.shear, r.loads.pressing, r.frames.time)
    if r.segments:
        found["segments"] = _segments_table(r)
    if r.registration is not None:
        found["registration"] = _registration_table(r.registration)
    if r.agreement is not None:
        found["agreement"] = r.agreement
    return found


def _wrench_table(r: MatFindings) -> pd.DataFrame:
    """Load of every frame, and how many cells clip: forces are too low then."""
    row, column = r.cells.cell.T
    table = load_table(r.loads, r.frames.time)
    return table.assign(**{"saturated [-]": worked(lambda part: part[:, row, column].sum(axis=1), r.saturated)})


def _uncertainty_table(r: MatFindings) -> pd.DataFrame:
    """Standard deviations of force and moment."""
    names = [f"sd_f{axis} [N]" for axis in AXES] + [f"sd_m{axis} [N m]" for axis in AXES]
    deviation = r.deviation
    return pd.DataFrame({"time [s]": r.frames.time, **{name: deviation[:, k] for k, name in enumerate(names)}})


def _cell_table(r: MatFindings) -> pd.DataFrame:
    """Where each cell lies, which way it looks, how its area changed: in the form that gap cases name a layout."""
    row, column = r.cells.cell.T
    normal, beside = r.drape.normal[row, column], r.closest_point
    return pd.DataFrame(
        {
            "id": [f"c{k}" for k in range(len(row))],
            "row": row,
            "column": column,
            **{f"{axis} [m]": r.cells.centre[:, k] for k, axis in enumerate(AXES)},
            **{f"n{axis} [-]": normal[:, k] for k, axis in enumerate(AXES)},
            "area [m^2]": r.cells.area,
            "distortion [-]": r.drape.distortion[row, column],
            **({} if beside is None else {"distortion_projected [-]": beside.distortion[row, column]}),
            "peak [Pa]": r.peak,
            "saturated_frames": np.sum([part[:, row, column].sum(axis=0) for (part,) in parts(r.saturated)], axis=0),
        }
    )


def _frames_table(r: MatFindings) -> pd.DataFrame:
    """Pressure of each cell over time, as gap cases hold cell channels."""
    table = pd.DataFrame(r.pressure, columns=[f"c{k} [Pa]" for k in range(r.pressure.shape[1])], copy=False)
    table.insert(0, "time [s]", r.frames.time)
    return table


def _segments_table(r: MatFindings) -> pd.DataFrame:
    """Load of each part, one below the other."""
    tables = [load_table(part, r.frames.time).assign(segment=name) for name, part in r.segments.items()]
    return pd.concat(tables, ignore_index=True).loc[:, ["segment", *tables[0].columns[:-1]]]


def _registration_table(found: Registration) -> pd.DataFrame:
    """The residual map: the points of the scan that were compared, in the body's frame."""
    return pd.DataFrame(
        {
            **{f"{axis} [mm]": found.points[:, k] * MM for k, axis in enumerate(AXES)},
            "residual [mm]": found.residual * MM,
        }
    )
