"""`geocontact elbow design`: the options of the command; the work is in `elbow_design_analysis`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

Dashed = Parameter(allow_leading_hyphen=True)
Flag = Parameter(negative="")


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class DesignOptions:
    """Options of a design as typed.

    Parameters
    ----------
    k
        Stiffness of the attachment [N/m].
    l_mm
        Length of the exoskeleton's link, from its hinge to the attachment.
    z_mm
        Distance of the attachment from the limb's line.
    range
        Angles of the exoskeleton, with their unit: 0:120deg.
    limit
        Largest |F| [N] that is allowed on the limb.
    out
        Folder for the results.
    stroke_mm
        Ends between which a compensation joint slides freely: -20:35. Locked unless given.
    offset_mm
        Offsets x,y of the axes that the design is made for; 0,0 unless given.
    uncertainty_mm
        How far the offsets may be from these, in any direction: what the stroke has to cover.
    map_mm
        The map goes this far from the offsets in x and in y.
    step_mm
        Step of the map.
    drift
        How the joint's axis wanders with the angle: x=0:-8:2,y=0:5 (mm, mm/rad, mm/rad², …, over the exoskeleton's
        angle), or a .csv with the columns beta or alpha [deg], x [mm], y [mm], or alpha [deg], instant_centre_x [mm],
        instant_centre_y [mm]; alpha is the joint's own angle.
    parquet
        Also write the tables as .parquet.
    """

    k: float
    l_mm: float
    z_mm: Annotated[float, Dashed]
    range: Annotated[str, Dashed]
    limit: float
    out: Path
    stroke_mm: Annotated[str | None, Dashed] = None
    offset_mm: Annotated[str, Dashed] = "0,0"
    uncertainty_mm: float = 0.0
    map_mm: float = 60.0
    step_mm: float = 2.0
    drift: Annotated[str | None, Dashed] = None
    parquet: Annotated[bool, Flag] = False


def design(*, options: DesignOptions) -> int:
    """Which offsets of an exoskeleton's axis, and which stroke of a compensation joint, keep |F| under a limit.

    For the elbow, and for the knee, the hip or any joint of one degree of freedom; slow motion. Writes design.json,
    map.csv, boundary.csv, sensitivity.csv, force.csv, design.png, design.svg, report.html and run.json into OUT.
    """
    from geocontact.analyses.misalignment.design.run import analyse  # numpy and friends: not for --help

    return analyse(options)
