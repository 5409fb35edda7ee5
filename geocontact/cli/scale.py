"""`geocontact scale`: the options of the command; the work is in `scale_analysis`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

Each = Parameter(negative="", consume_multiple=False, allow_leading_hyphen=True)
Dashed = Parameter(allow_leading_hyphen=True)


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class ScaleOptions:
    """Options of scaling as typed.

    Parameters
    ----------
    out
        Folder for the results.
    model
        Generic OpenSim model (.osim) with markers.
    scale
        Bodies and the pairs of markers whose distances tell their size: femur_r,femur_l=R.Hip/R.Knee,L.Hip/L.Knee.
        May be given again; bodies that are not named keep their size. The factor is the same along all axes.
    marker_set
        Markers of the model from a file of their own (.xml with a MarkerSet) in place of the model's.
    mass
        Of the subject [kg], shared among the bodies as in the model.
    keep_markers
        Leave markers where scaling puts them; otherwise they are moved to where they were seen in the static trial,
        but for those that the model calls fixed.
    tasks
        OpenSim's setup of inverse kinematics or its task set (.xml) for the static pose; without it all markers alike.
    axes
        Which of the markers' axes are the model's x, y and z: x,z,-y where the laboratory's z is up.
    time
        First and last time [s] of standing still.
    """

    out: Path
    model: Path
    scale: Annotated[tuple[str, ...], Each] = ()
    marker_set: Path | None = None
    mass: float | None = None
    keep_markers: bool = False
    tasks: Path | None = None
    axes: Annotated[str | None, Dashed] = None
    time: Annotated[str | None, Dashed] = None


def scale(static: Path, /, *, options: ScaleOptions) -> int:
    """A model made to measure from a static trial: sizes of bodies, mass, places of markers.

    Writes scaled.osim (for ik, id and OpenSim; its defaults are the static pose), scale.json and run.json into OUT.

    Parameters
    ----------
    static
        Markers while the subject stands still (.trc, .c3d).
    """
    from geocontact.analyses.motion.scale.run import analyse  # numpy and friends: not for --help

    return analyse(static, options)
