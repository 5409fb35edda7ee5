"""`geocontact ik`: the options of the command; the work is in `ik_analysis`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

Each = Parameter(negative="", consume_multiple=False, allow_leading_hyphen=True)
Dashed = Parameter(allow_leading_hyphen=True)


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class IkOptions:
    """Options of inverse kinematics as typed.

    Parameters
    ----------
    out
        Folder for the results.
    model
        OpenSim model (.osim) with the markers.
    tasks
        OpenSim's setup of inverse kinematics or its task set (.xml): weights of markers and coordinates. Without it all
        markers of the model count alike.
    marker_set
        Markers of the model from a file of their own (.xml with a MarkerSet) in place of the model's.
    weight
        Weight of a marker over that of --tasks: R.Heel=10; 0 leaves it out. May be given again.
    hold
        Coordinate held near a value (deg, m; rad where the model couples it to others): subtalar_angle_r=5.2. May be
        given again.
    fill
        Longest gap [s] over which coordinates that no marker tells are filled by a spline; longer ones stay empty.
    knee
        Knee whose angles after Grood and Suntay are written: right=femur_r,tibia_r, the bodies as the model calls them,
        x forward, y up and z to the right in both. May be given again.
    axes
        Which of the markers' axes are the model's x, y and z: x,z,-y where the laboratory's z is up.
    time
        First and last time [s]: 0.4:1.6.
    """

    out: Path
    model: Path
    tasks: Path | None = None
    marker_set: Path | None = None
    weight: Annotated[tuple[str, ...], Each] = ()
    hold: Annotated[tuple[str, ...], Each] = ()
    fill: float = 0.1
    knee: Annotated[tuple[str, ...], Each] = ()
    axes: Annotated[str | None, Dashed] = None
    time: Annotated[str | None, Dashed] = None


def ik(markers: Path, /, *, options: IkOptions) -> int:
    """Joint angles from recorded markers: weighted least squares in every frame, limits of the model kept.

    Writes ik.mot (degrees and metres, for OpenSim), markers.csv (distance of each marker from the model), knees.csv
    with --knee, ik.json, report.html and run.json into OUT.

    Parameters
    ----------
    markers
        Marker trajectories (.trc, .c3d).
    """
    from geocontact.analyses.motion.inverse_kinematics.run import analyse  # numpy and friends: not for --help

    return analyse(markers, options)
