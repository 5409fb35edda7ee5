"""Markers and plates of a trial, of a right leg; refused where they cannot be those of a walking person's foot."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.collector import add_input
from geocontact.analyses.motion.markers import markers_given, renamed_as_told
from geocontact.below_knee_prosthesis.evaluation import PlateStance
from geocontact.below_knee_prosthesis.from_markers import as_right, of_side
from geocontact.below_knee_prosthesis.leg import Side
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY
from geocontact.below_knee_prosthesis.simulate import GATE
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.io.mocap.force_plates import plate_named, read_force_plates

LEAST, MOST = 0.3, 5.0
"""Shares of the body weight between which the largest vertical force of a step lies."""
BESIDE = 1.0
"""Lengths of the foot from its middle beyond which a centre of pressure is not its."""
APART = 0.06
"""s by which clocks may differ: a foot that hovers before it lands, and a plate's threshold, make up to that."""


def require_weight(file: Path, option: str, name: str, load: Float[np.ndarray, " t"], weight: float) -> None:
    """InputError for a vertical force [N] that no step of a person of that weight [N] makes."""
    most = float(np.max(load, initial=0.0)) / weight
    if LEAST <= most <= MOST:
        return
    what = f"the vertical force on {name} is {most:.3g} times body weight at most"
    raise InputError(file, option, what, "is it in N, `mass` in kg, and y up?")


def require_one_clock(file: Path, option: str, name: str, offset: float) -> None:
    """InputError where the plate is later than the markers by more than clocks on one time can differ [s]."""
    if abs(offset) > APART:
        what = (
            f"{name} is loaded {abs(offset):.2f} s {'after' if offset > 0.0 else 'before'} the markers touch the floor"
        )
        raise InputError(file, option, what, "markers and forces need one clock: shift one of them")


def require_under_foot(file: Path, name: str, centre: Float[np.ndarray, " t"]) -> None:
    """InputError where a centre of pressure is not under the foot; in lengths of the foot from its heel."""
    known = centre[np.isfinite(centre)]
    if not len(known) or np.median(np.abs(known - 0.5)) > BESIDE:
        what = f"no plate under the foot: the centre of pressure of {name} is not under it"
        raise InputError(file, "`plate`", what, "check frame, side and clock, and that this plate is meant")


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


def plate_under_foot(
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
    add_input(f"`{option}s`", file, plate=plate.name)
    force = of_side(np.nan_to_num(plate.wrench.force), side)
    require_weight(file, f"`{option}`", plate.name, force[:, 1], mass * GRAVITY)
    return PlateStance(plate.time, force, of_side(plate.centre_of_pressure(GATE), side)), plate.name
