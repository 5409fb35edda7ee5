"""What a functional joint may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from geocontact.analyses.frame.marks import C3dUnit, Expression, Requires, TimeSpan
from geocontact.analyses.frame.options import Options


@dataclass(frozen=True)
class JointOptions(Options):
    """Centre or axis of a joint from how the markers of two segments move against each other (SCoRE, SARA).

    Parameters
    ----------
    trial
        Markers while the joint moves through its range (.trc, .c3d, .csv).
    first
        Markers of one segment, three at the least, not on a line: R.ASIS,L.ASIS,V.Sacral.
    second
        Markers of the other one.
    axis
        Look for an axis, as of a knee, and not for a centre, as of a hip.
    static
        Markers while the subject stands still (.trc, .c3d, .csv): the joint is written as a marker of it, or as two on
        an axis; without it, as a marker of the trial.
    name
        Name of that marker; on an axis NAME_1 and NAME_2, 5 cm on either side.
    near
        Markers whose midpoint, projected onto the axis, gives its place: the epicondyles. All markers of both segments
        by default.
    markers_map
        Names of recorded markers as they are called here: RASI=R.ASIS, or a file with a pair in each line.
    axes
        Which of the markers' axes are x, y and z of the output: x,z,-y where the laboratory's z is up.
    c3d_unit
        Unit of places in .c3d files whose own, POINT:UNITS, is empty.
    time
        First and last time of the trial [s].
    """

    over_time: ClassVar[bool] = True
    writes: ClassVar[str] = """
    Writes joint.json, joint.csv, markers.trc [mm] with the joint as a marker, and run.json into OUT.
    """

    trial: Path
    _: KW_ONLY
    first: str
    second: str
    axis: bool = False
    static: Path | None = None
    name: str = "JOINT"
    near: Annotated[str | None, Requires("axis")] = None
    markers_map: str | None = None
    axes: Expression | None = None
    c3d_unit: C3dUnit = None
    time: TimeSpan | None = None
