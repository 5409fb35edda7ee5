"""The scan in the frame of a body model: by landmarks that both have, and by shape where that is asked for."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.bodies import read_surface
from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.geometry.register.icp import icp
from geocontact.geometry.register.landmarks import fit_landmarks
from geocontact.geometry.register.quality import Registration
from geocontact.geometry.register.scale_guard import compare_landmarks
from geocontact.geometry.register.shape_covariance import shape_covariance
from geocontact.geometry.surface import Surface
from geocontact.io.recordings.mat_landmarks import MatLandmarks
from geocontact.io.text.side_table import read_side_table

SCAN, BODY = ("x [m]", "y [m]", "z [m]"), ("body_x [m]", "body_y [m]", "body_z [m]")
EXAMPLE = "id, x [mm], y [mm], z [mm], body_x [mm], body_y [mm], body_z [mm]"


@dataclass(frozen=True, eq=False)
class BodyModel:
    """A body model that the scan is brought to: landmarks of both [m], and the body's surface for a fit by shape."""

    names: tuple[str, ...]
    on_scan: Float[np.ndarray, "n 3"]
    on_body: Float[np.ndarray, "n 3"]
    surface: Surface | None


def read_body_model(record: Record, o: MatOptions) -> BodyModel | None:
    """Landmarks and, where the fit is by shape, the surface; None where results stay in the scan's frame."""
    if o.body_landmarks is None:
        return None
    names, on_scan, on_body = _pairs(o.body_landmarks)
    record.add_input("`body_landmarks`", o.body_landmarks, landmarks=len(names))
    body = None if o.body is None else read_surface(record, "body", o.body, o.body_unit or o.unit, None)
    return BodyModel(names, on_scan, on_body, body)


def registered(
    record: Record, scan: Surface, marks: MatLandmarks, model: BodyModel | None, o: MatOptions
) -> tuple[Surface, MatLandmarks, Registration | None]:
    """Scan and marks of the mat in the body's frame, and how well they fit; as they are without a body."""
    if model is None:
        return scan, marks, None
    try:
        guard = compare_landmarks(model.on_scan, model.on_body)
        found = fit_landmarks(model.on_scan, model.on_body, names=model.names)
        if guard.warning:
            record.warn(guard.warning)
        _tell(record, "landmarks", found)
        if model.surface is not None:
            engine, found = _by_shape(scan, model.surface, found, o)
            _tell(record, "shape", found, engine=engine)
            if not found.converged:
                record.warn("the registration by shape did not settle; look at registration.csv")
    except InputError:
        raise
    except ValueError as error:
        raise InputError(o.body_landmarks or "", "", str(error), "check landmarks, units and `body`") from error
    moved = Surface(found.pose.apply(scan.vertices), scan.faces, scan.name)
    return moved, replace(marks, point=found.pose.apply(marks.point)), found


def _by_shape(scan: Surface, body: Surface, start: Registration, o: MatOptions) -> tuple[str, Registration]:
    """The scan brought onto the body from where the landmarks put it, and by which engine."""
    engine, found = "own", None
    if o.icp_engine != "own":
        from geocontact.geometry.register.open3d_icp import open3d_icp  # heavy

        try:
            engine, found = "open3d", open3d_icp(scan, body, start.pose)
        except ImportError as error:
            if o.icp_engine == "open3d":
                raise InputError("", "`icp_engine`", str(error), "or leave it out") from error
            engine = "own"
    found = found or icp(scan, body, start.pose)
    return engine, replace(found, covariance=shape_covariance(scan, body, found.pose, start=start.covariance))


def _pairs(path: Path) -> tuple[tuple[str, ...], Float[np.ndarray, "n 3"], Float[np.ndarray, "n 3"]]:
    table = read_side_table(path, ("id", *SCAN, *BODY))
    missing = [name for name in ("id", *SCAN, *BODY) if name not in table.columns]
    if missing:
        what = f"no column {', '.join(each.replace('[m]', 'with a unit of length') for each in missing)}"
        raise InputError(path, "line 1", what, f"write {EXAMPLE}")
    return (
        tuple(str(each) for each in table["id"]),
        table[list(SCAN)].to_numpy(float),
        table[list(BODY)].to_numpy(float),
    )


def _tell(record: Record, way: str, found: Registration, **more: str) -> None:
    worst, off = found.worst
    record.results[f"registration by {way}"] = {
        "rms_mm": found.rms * 1e3,
        "overlap": found.overlap,
        "worst": worst,
        "worst_mm": off * 1e3,
        "hold": None if np.isnan(found.hold) else found.hold,
        "pose": found.pose.as_matrix().tolist(),
        **more,
    }
    record.say(
        f"registration by {way}: root mean square {found.rms * 1e3:.2f} mm, {found.overlap:.0%} of the points met"
    )
