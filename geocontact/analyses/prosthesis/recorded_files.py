"""What a recording of a person with a prosthesis holds, as of a right leg: markers, plates, and the law of the sole."""

from __future__ import annotations

from dataclasses import replace
from os import fspath
from pathlib import Path

import numpy as np

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.frame.folder import digest
from geocontact.analyses.motion.markers import markers_given, renamed_as_told
from geocontact.below_knee_prosthesis.evaluation import PlateStance
from geocontact.below_knee_prosthesis.from_markers import as_right, of_side
from geocontact.below_knee_prosthesis.keel.vsf import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.leg import AS_STOOD, FootOffset, Side
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY
from geocontact.below_knee_prosthesis.plate_checks import require_weight, weight_doubt
from geocontact.below_knee_prosthesis.simulate import GATE
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.io.mocap.force_plates import ForcePlate, plate_named, read_force_plates
from geocontact.io.recordings.spheres import read_law
from geocontact.loads.sole_law import changed_law


def right_markers(
    role: str,
    file: Path,
    side: Side,
    axes: str | None,
    markers_map: str | None,
    c3d_unit: str | None,
    time: tuple[float, float] | None = None,
) -> MarkerTrajectories:
    """Markers of a file by the names used here, mirrored where the prosthesis is on the left."""
    seen = renamed_as_told(markers_given(file, axes, time, c3d_unit), markers_map)
    add_input(role, file, frames=len(seen), markers=len(seen.names))
    return as_right(seen, side)


def right_plate(
    plates: tuple[ForcePlate, ...], name: str | None, file: Path, side: Side, option: str = "plate"
) -> PlateStance:
    """One plate of a file, mirrored where the prosthesis is on the left; `option` is that by which it is named."""
    plate = plate_named(plates, name, file, f"`{option}`")
    force = of_side(np.nan_to_num(plate.wrench.force), side)
    return PlateStance(plate.time, force, of_side(plate.centre_of_pressure(GATE), side), plate.name, fspath(file))


def plate_under_foot(
    file: Path, name: str | None, side: Side, mass: float, c3d_unit: str | None, option: str = "plate"
) -> PlateStance:
    """Force and centre of pressure of one plate of a file; InputError where nobody of that mass stands on it.

    Parameters
    ----------
    mass
        Of the person [kg].
    c3d_unit
        Of a .c3d file whose own is empty.
    option
        By which the plate is named.
    """
    plate = right_plate(read_force_plates(file, c3d_unit), name, file, side, option)
    add_input(f"`{option}s`", file, plate=plate.name)
    require_weight(plate, mass * GRAVITY, f"`{option}`")
    doubt_weight(plate, mass)
    return plate


def doubt_weight(plate: PlateStance, mass: float) -> None:
    """A reservation where a walking person of that mass [kg] does not make this force."""
    if doubt := weight_doubt(plate, mass * GRAVITY):
        reserve(doubt)


def foot_with_law(foot: VariableStiffnessFoot, file: Path | None) -> VariableStiffnessFoot:
    """The foot with the numbers that a file gives, for all spheres or by zone; the rest are as they were."""
    if file is None:
        return foot
    law = read_law(file)
    add_input("`law`", file)
    zones = {zone: of.model_dump(exclude_none=True) for zone, of in law.zone.items()}
    given = law.model_dump(exclude={"zone", "foot"}, exclude_none=True)
    try:
        changed = changed_law(foot.law, foot.sole.spheres.zone, given, zones)
    except InputError as error:
        raise replace(error, file=file) from error
    except ValueError as error:
        raise InputError(file, "force law", str(error), "correct the number") from error
    return VariableStiffnessFoot(foot.keel, foot.sole, changed)


def offset_of_law(file: Path | None, standing: Path) -> FootOffset:
    """How the foot is beside a standing trial; none where the file does not say, or says it of another trial."""
    beside = None if file is None else read_law(file).foot
    if beside is None:
        return AS_STOOD
    if beside.standing is not None and beside.standing != digest(standing):
        reserve(
            f"{file}: [foot] is of another standing trial than `static`, and is left out: height and pitch "
            "are errors of that trial (if it is the same in another file, take the line `standing` out of the law)"
        )
        return AS_STOOD
    return FootOffset(beside.height, beside.pitch, beside.height_sd, beside.pitch_sd)
