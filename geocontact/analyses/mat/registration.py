"""The scan in the frame of a body model: by landmarks that both have, and by shape where that is asked for."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.bodies import read_surface
from geocontact.analyses.checks import refuse
from geocontact.analyses.run_record import Record
from geocontact.cli.mat import MatOptions
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


def registered(
    record: Record, scan: Surface, marks: MatLandmarks, o: MatOptions
) -> tuple[Surface, MatLandmarks, Registration | None]:
    """Scan and marks of the mat in the body's frame, and how well they fit; as they are without --body-landmarks."""
    _refuse_idle(o)
    if o.body_landmarks is None:
        return scan, marks, None
    names, on_scan, on_body = _pairs(o.body_landmarks)
    record.add_input("--body-landmarks", o.body_landmarks, landmarks=len(names))
    try:
        guard = compare_landmarks(on_scan, on_body)
        found = fit_landmarks(on_scan, on_body, names=names)
        if guard.warning:
            record.warn(guard.warning)
        _tell(record, "landmarks", found)
        if o.icp:
            engine, found = _by_shape(scan, _body(record, o), found, o)
            _tell(record, "shape", found, engine=engine)
            if not found.converged:
                record.warn("the registration by shape did not settle; look at registration.csv")
    except InputError:
        raise
    except ValueError as error:
        raise InputError(o.body_landmarks, "", str(error), "check landmarks, units and --body") from error
    moved = Surface(found.pose.apply(scan.vertices), scan.faces, scan.name)
    return moved, replace(marks, point=found.pose.apply(marks.point)), found


def _refuse_idle(o: MatOptions) -> None:
    """Refuse options of a registration that is not made."""
    none = o.body_landmarks is None
    refuse(
        (o.icp_engine is not None and not o.icp, "--icp-engine", "does nothing without --icp",
         "give --icp, or leave it out"),
        (none and o.body is not None, "--body", "needs landmarks to begin with", "give --body-landmarks"),
        (none and o.icp, "--icp", "needs landmarks to begin with", "give --body-landmarks"),
        (not none and o.body is not None and not o.icp, "--body", "does nothing without --icp",
         "give --icp, or leave it out"),
        (not none and o.body_unit is not None and o.body is None, "--body-unit", "does nothing without --body",
         "leave it out"),
    )  # fmt: skip


def _by_shape(scan: Surface, body: Surface, start: Registration, o: MatOptions) -> tuple[str, Registration]:
    """The scan brought onto the body from where the landmarks put it, and by which engine."""
    engine, found = "own", None
    if o.icp_engine != "own":
        from geocontact.geometry.register.open3d_icp import open3d_icp  # heavy

        try:
            engine, found = "open3d", open3d_icp(scan, body, start.pose)
        except ImportError as error:
            if o.icp_engine == "open3d":
                raise InputError("", "--icp-engine", str(error), "or leave it out") from error
            engine = "own"
    found = found or icp(scan, body, start.pose)
    return engine, replace(found, covariance=shape_covariance(scan, body, found.pose, start=start.covariance))


def registration_table(found: Registration) -> pd.DataFrame:
    """The residual map: the points of the scan that were compared, in the body's frame."""
    return pd.DataFrame(
        {
            **{f"{axis} [mm]": found.points[:, k] * 1e3 for k, axis in enumerate("xyz")},
            "residual [mm]": found.residual * 1e3,
        }
    )


def _body(record: Record, o: MatOptions) -> Surface:
    if o.body is None:
        raise InputError("", "--icp", "has no body to fit the scan to", "give --body")
    return read_surface(record, "body", o.body, o.body_unit or o.unit, None)


def _pairs(path: Path) -> tuple[tuple[str, ...], Float[np.ndarray, "n 3"], Float[np.ndarray, "n 3"]]:
    table = read_side_table(path)
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
