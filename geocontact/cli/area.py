"""`geocontact area`: the options of the command; the work is in `area_analysis`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

Dashed = Parameter(allow_leading_hyphen=True)
Flag = Parameter(negative="")


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class AreaOptions:
    """Options of the area analysis as typed.

    Parameters
    ----------
    motion
        Poses (.csv) or coordinates (.mot .sto); several, or a pattern in quotes: one sub-folder each.
    unit
        Unit of both meshes; never guessed.
    out
        Folder for the results.
    threshold
        Largest distance that counts, or several: 0.1,0.5,1,4 (mm unless a unit is given).
    osim
        OpenSim model whose joint turns coordinates into poses: FIXED is the parent body, MOVING the child.
    joint
        Name of that joint.
    moving_body
        parent: MOVING is the joint's parent body, or the femur of a knee convention; child unless given.
    map
        Columns instead of a model: rz=knee_flexion,rx=knee_adduction,ry=-knee_rotation,tx=knee_tx
    order
        Order of intrinsic rotations: XYZ is R = Rx Ry Rz.
    angles
        Unit of angles where the file does not say.
    convention
        grood-suntay: columns are clinical knee angles; needs --side.
    side
        Side of the knee.
    sweep
        Instead of --motion: turn MOVING about --axis, flexion=0:90:1 in degrees.
    axis
        x,y,z,dx,dy,dz (point in the mesh unit), a file of these, or a fit.json; else the cylinder fitted to MOVING.
    place_moving
        Where the mesh sits in its body: a file with a 4x4 matrix, or model.osim:body.
    place_fixed
        The same for FIXED.
    adduction
        Turn MOVING in every frame about this axis of FIXED, through MOVING's origin: x=2 or x=-2 (degrees).
    assume_closed
        Treat a surface as closed although its edges do not show it.
    split
        x, y or z (or z=1.5): medial and lateral parts of FIXED apart.
    medial
        Side of the splitting plane that is medial; - unless given.
    region
        Faces of FIXED that count: "ny>0.25" in x y z nx ny nz (mesh unit), or a file of face numbers.
    region_moving
        The same for MOVING.
    rule
        How area is counted; the crude rules are for comparing with papers.
    bounds
        Refine until (upper - lower) / upper is below: 0.02 or 2%; 10% unless given.
    compare
        Table of your own measured areas; exit 1 beyond the tolerance.
    tolerance
        Largest relative difference from the areas compared; 2% unless given.
    save_map
        Also write the distance of every vertex in every frame (distances.npz).
    paraview
        Also write both bodies with their distances over time for ParaView (folder paraview).
    stills
        Also write 3-D pictures of the frame with the largest area (still_superior.png and others).
    pressure
        Also press MOVING, rigid unless --modulus-moving, into FIXED as an elastic layer: pressures and forces.
    modulus
        Young's modulus of FIXED for --pressure: 500MPa.
    poisson
        Poisson's ratio of FIXED for --pressure, below 0.5.
    thickness
        Of FIXED's layer: a length such as 8mm, or rays (measured along the normal, which is the default).
    foundation
        linear or logarithmic (finite strain); linear unless given.
    facets
        smooth: triangles stand for a smooth surface through their corners; flat: as they are. smooth unless given.
    modulus_moving
        Young's modulus of MOVING, which then is an elastic layer as well; rigid unless given.
    poisson_moving
        Its Poisson's ratio, below 0.5.
    thickness_moving
        Of its layer: a length such as 3mm, or rays.
    piece
        Longest edge of the pieces that pressure is summed over: 0.5mm unless given.
    parquet
        Also write area.parquet.
    workers
        Threads; all cores by default. Results do not depend on it.
    """

    unit: Literal["m", "cm", "mm", "in"]
    out: Path
    motion: Annotated[list[str] | None, Parameter(consume_multiple=False, negative="")] = None
    threshold: str = "4"
    osim: Path | None = None
    joint: str | None = None
    moving_body: Annotated[Literal["child", "parent"] | None, Parameter(name="--moving")] = None
    map: Annotated[str | None, Dashed] = None
    order: str | None = None
    angles: Literal["deg", "rad"] | None = None
    convention: Literal["grood-suntay"] | None = None
    side: Literal["right", "left"] | None = None
    sweep: Annotated[str | None, Dashed] = None
    axis: Annotated[str | None, Dashed] = None
    place_moving: str | None = None
    place_fixed: str | None = None
    adduction: str | None = None
    assume_closed: Literal["moving", "fixed", "both"] | None = None
    split: str | None = None
    medial: Annotated[Literal["-", "+"] | None, Dashed] = None
    region: Annotated[str | None, Dashed] = None
    region_moving: Annotated[str | None, Dashed] = None
    rule: Literal["refined", "clip", "all-vertices", "any-vertex", "centroid"] = "refined"
    bounds: str | None = None
    compare: Path | None = None
    tolerance: str | None = None
    save_map: Annotated[bool, Flag] = False
    paraview: Annotated[bool, Flag] = False
    stills: Annotated[bool, Flag] = False
    pressure: Annotated[bool, Flag] = False
    modulus: str | None = None
    poisson: float | None = None
    thickness: str | None = None
    foundation: Literal["linear", "logarithmic"] | None = None
    facets: Literal["smooth", "flat"] | None = None
    modulus_moving: str | None = None
    poisson_moving: float | None = None
    thickness_moving: str | None = None
    piece: str | None = None
    parquet: Annotated[bool, Flag] = False
    workers: int | None = None


def area(moving: Path, fixed: Path, /, *more_motions: str, options: AreaOptions) -> int:
    """Contact area of two rigid surfaces over a motion, with certified bounds.

    Writes area.csv, report.html, area.png, area.svg and run.json into OUT. A point counts as in contact when its signed
    distance to the other body is not above the threshold; against an open body distances are unsigned, and the table
    says so.

    Parameters
    ----------
    moving
        Mesh that moves (.stl .ply .obj .vtp).
    fixed
        Mesh in whose frame results are given.
    more_motions
        Further motion files, as a shell glob after --motion gives them.
    """
    from geocontact.analyses.area.run import analyse  # numba and friends: not for --help

    return analyse(moving, fixed, more_motions, options)
