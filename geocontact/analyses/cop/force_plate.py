"""Force plates beside the spheres."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float, Int

from geocontact.analyses.cop.options import CopOptions
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.io.mocap.force_plates import ForcePlate, plate_named, read_force_plates
from geocontact.io.motion.poses import read_pose
from geocontact.loads.centre_of_pressure import CentreOfPressure

ALIGNED = 0.7  # smallest cosine between our ground's normal and the plate's
AXES = "xyz"


@dataclass(frozen=True)
class PlateCurves:
    """What a plate shows at some of our frames, in our frame; NaN below the gate."""

    frames: Int[np.ndarray, " f"]
    force: Float[np.ndarray, "f 3"]
    centre: Float[np.ndarray, "f 3"]
    free_moment: Float[np.ndarray, " f"]


def chosen_plate(record: Record, o: CopOptions) -> ForcePlate | None:
    """The plate to compare with, in our frame; None where none is asked for."""
    if o.compare is None:
        return None
    plate = plate_named(read_force_plates(o.compare, o.c3d_unit), o.plate, o.compare, "`plate`")
    record.add_input("`compare`", o.compare, plate=plate.name)
    if o.plate_pose is None:
        return plate
    pose = read_pose(o.plate_pose)
    record.add_input("`plate_pose`", o.plate_pose)
    wrench = plate.wrench.seen_from(pose, "ground")
    corners = None if plate.corners is None else pose.apply(plate.corners)
    point, normal = pose.apply(plate.point), pose.rotation.apply(plate.normal)
    return replace(plate, wrench=wrench, point=point, normal=normal, corners=corners)


def plate_curves(
    plate: ForcePlate, time: Float[np.ndarray, " t"], ours: CentreOfPressure, o: CopOptions
) -> PlateCurves:
    """The plate at our times within its own; its wrench is interpolated, and the centre follows from that."""
    path = o.compare or Path()
    inside = np.flatnonzero((time >= plate.time[0]) & (time <= plate.time[-1]))
    if not len(inside):
        what = f"runs from {plate.time[0]:g} to {plate.time[-1]:g} s, the motion from {time[0]:g} to {time[-1]:g} s"
        raise InputError(path, plate.name, what, "shift the clock of one of them")
    _refuse_other_frame(path, plate, ours)
    wrench = plate.at(time[inside])
    centre = wrench.centre_of_pressure(plate.point, plate.normal, o.gate)
    return PlateCurves(inside, wrench.force, centre, wrench.free_moment(centre, plate.normal))


def comparison_table(time: Float[np.ndarray, " t"], ours: CentreOfPressure, plate: PlateCurves) -> pd.DataFrame:
    """Ours, the plate's and the difference (ours - plate), one row per frame within the plate's recording."""
    at = plate.frames
    columns: dict[str, Float[np.ndarray, " f"]] = {"time [s]": time[at]}
    pairs = [(f"force_{axis} [N]", ours.wrench.force[at, k], plate.force[:, k]) for k, axis in enumerate(AXES)]
    pairs += [(f"cop_{axis} [m]", ours.centre[at, k], plate.centre[:, k]) for k, axis in enumerate(AXES)]
    pairs.append(("free_moment [N m]", ours.free_moment[at], plate.free_moment))
    for name, mine, theirs in pairs:
        columns |= {name: mine, f"plate_{name}": theirs, f"difference_{name}": mine - theirs}
    return pd.DataFrame(columns)


def root_mean_squares(table: pd.DataFrame) -> dict[str, float | None]:
    """Root mean square of each difference over the rows that have it; None where no row has."""
    differences = {str(name): table[name].dropna() for name in table.columns if str(name).startswith("difference_")}
    return {
        name.replace("difference_", "rms_"): float(np.sqrt(np.mean(values**2))) if len(values) else None
        for name, values in differences.items()
    }


def _refuse_other_frame(path: Path, plate: ForcePlate, ours: CentreOfPressure) -> None:
    normals = ours.normal[np.isfinite(ours.normal[:, 0])]
    if len(normals) and float((normals @ plate.normal).mean()) < ALIGNED:
        mine, theirs = (", ".join(f"{value:.2f}" for value in n) for n in (normals.mean(axis=0), plate.normal))
        what = f"its normal is ({theirs}), that of our ground ({mine})"
        raise InputError(path, plate.name, what, "give the pose of the plates' frame in ours with `plate_pose`")
