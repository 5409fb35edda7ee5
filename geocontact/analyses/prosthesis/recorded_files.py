"""Markers and plates of a trial, as of a right leg."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import numpy as np

from geocontact.analyses.motion.markers import markers_given, renamed_as_told
from geocontact.analyses.prosthesis.plausible_plate import require_weight
from geocontact.analyses.run_record import Record
from geocontact.below_knee_prosthesis.from_markers.sides import as_right, of_side
from geocontact.below_knee_prosthesis.model.leg_tree import GRAVITY
from geocontact.below_knee_prosthesis.simulate import GATE
from geocontact.below_knee_prosthesis.stance_errors import PlateStance
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.io.mocap.force_plates import plate_named, read_force_plates

Side = Literal["right", "left"]


def right_markers(
    record: Record,
    role: str,
    file: Path,
    side: Side,
    axes: str | None,
    markers_map: str | None,
    c3d_unit: str | None,
    time: tuple[float, float] | None = None,
) -> MarkerTrajectories:
    """Markers of a file by the names used here, mirrored where the prosthesis is on the left."""
    seen = renamed_as_told(record, markers_given(file, axes, time, c3d_unit), markers_map)
    record.add_input(role, file, frames=len(seen), markers=len(seen.names))
    return as_right(seen, side)


def plate_under_foot(
    record: Record,
    file: Path,
    name: str | None,
    side: Side,
    mass: float,
    c3d_unit: str | None,
    option: str = "plate",
) -> tuple[PlateStance, str]:
    """Force and centre of pressure of one plate of a file, and its name; InputError where nobody of that mass stands.

    Parameters
    ----------
    mass
        Of the person [kg].
    c3d_unit
        Of a .c3d file whose own is empty.
    option
        By which the plate is named.
    """
    plate = plate_named(read_force_plates(file, c3d_unit), name, file, f"`{option}`")
    record.add_input(f"`{option}s`", file, plate=plate.name)
    force = of_side(np.nan_to_num(plate.wrench.force), side)
    require_weight(file, f"`{option}`", plate.name, force[:, 1], mass * GRAVITY)
    return PlateStance(plate.time, force, of_side(plate.centre_of_pressure(GATE), side)), plate.name
