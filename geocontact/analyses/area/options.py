"""What an area analysis may be asked for, and with it the pressures of an elastic layer."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import KW_ONLY, dataclass, field
from glob import has_magic
from pathlib import Path
from typing import Annotated, ClassVar, Literal

from geocontact.analyses.area.refused import LITERATURE, refuse_comparison, refuse_errors
from geocontact.analyses.frame.marks import (
    AngleUnit,
    Excludes,
    Expression,
    Fraction,
    Length,
    Lengths,
    MeshUnit,
    Missing,
    Needs,
    Pressure,
    Requires,
    Spelled,
    Typed,
    WearRate,
)
from geocontact.analyses.frame.options import Options
from geocontact.analyses.frame.shared_options import (
    BodyPair,
    CyclePart,
    Medial,
    PoseSd,
    Programs,
    Side,
    Sweep,
    Thickness,
    medial_side,
    refuse_programs,
    refuse_thresholds,
)
from geocontact.data.errors import InputError
from geocontact.data.plausible import (
    CYCLES,
    DIFFERENCE,
    FITTED,
    FRAME_RATE,
    LAYER_RATIO,
    MERGED,
    PIECE,
    SHARE,
    SHIFT,
    THRESHOLD,
    TURN,
    WEAR,
    YOUNG,
)

FLAT = "flat"

READS_NO_FILE = Excludes("sweep", "has no effect with `sweep`, which reads no motion file")
OF_LAYER = Requires("pressure")
OF_SECOND = Requires("modulus_moving")

Turn = Annotated[tuple[str, float], Typed("rad", "turn", '("x", gc.deg(2))'), TURN]


@dataclass(frozen=True)
class AreaOptions(Options):
    """Contact area of two rigid surfaces over a motion, with certified bounds.

    Parameters
    ----------
    moving
        Mesh that moves (.stl .ply .obj .off .vtp .step).
    fixed
        Mesh in whose frame results are given.
    unit
        Unit of both meshes; never guessed.
    unit_moving
        Unit of MOVING's mesh, of `place_moving` and of `region_moving` where it is not `unit`.

    Motion
    ------
    motion
        Path of poses (.csv, or rows of 16 or 12 numbers in a .csv or .txt) or of coordinates (.mot .sto), in Python
        also a DataFrame; several, or a pattern in quotes: one sub-folder each.
    motion_fixed
        Poses of FIXED where it moves too: `motion` and these are in one frame then, such as the laboratory's. As many
        as motions, in their order; interpolated to their times.
    rate
        Frames per second [Hz] of poses without times, which rows of numbers are; 1 numbers the frames.
    osim
        OpenSim model whose joint turns coordinates into poses: FIXED is the parent body, MOVING the child.
    joint
        Name of that joint.
    moving_body
        parent: MOVING is the joint's parent body, or the femur of a knee convention; child by default.
    map
        Columns instead of a model: rz=knee_flexion,rx=knee_adduction,ry=-knee_rotation,tx=knee_tx
    order
        Order of intrinsic rotations: XYZ is R = Rx Ry Rz.
    angles
        Unit of angles where the file does not say.
    convention
        grood-suntay: columns are clinical knee angles; needs `side`.
    side
        Side of the body, for `convention`, and for `split` z: right says that medial is -z, left that it is +z, in a
        frame whose z points to the subject's right (ISB, OpenSim).
    sweep
        Instead of `motion`: turn MOVING about `axis`; name, start, stop and step, typed flexion=0:90:1 in degrees.
    axis
        x,y,z,dx,dy,dz (point in the mesh unit), a file of these, a fit.json, or two landmarks picked on MOVING,
        FILE.csv:A:B; else the cylinder fitted to MOVING.

    Placement
    ---------
    place_moving
        Pose of the mesh in its body: a file with a 4x4 matrix, or model.osim:body.
    place_fixed
        The same for FIXED.
    merge_tolerance
        Merge vertices of both meshes that lie within this distance, where corners that faces share differ by rounding;
        a warning has how many, and the largest shift. Only equal ones by default.
    adduction
        Turn MOVING in every frame about this axis of FIXED, through MOVING's origin: axis and angle, typed x=2 or x=-2
        (degrees).

    Sides and regions
    -----------------
    split
        x, y or z (or z=1.5): medial and lateral parts of FIXED apart; needs `side` or `medial`.
    medial
        Side of the splitting plane that is medial, instead of `side`.
    region
        Faces of FIXED that count: "ny>0.25" in x y z nx ny nz (mesh unit), a file of face numbers, or picked landmarks:
        polygon:FILE.csv, or sphere:FILE.csv:NAME:12mm.
    region_moving
        The same for MOVING's area; all of MOVING presses.

    How area is counted
    -------------------
    threshold
        Largest distance that counts as contact, such as 4mm, or several: 0.1,0.5,1,4 (mm). 0 counts what is inside the
        other body.
    assume_closed
        Treat a surface as closed although its edges do not show it.
    outer
        Count the outer surface alone where a file holds closed surfaces that lie inside or across others, such as a
        marrow cavity or parts exported together: moving, fixed or both.
    rule
        How area is counted; the crude rules are for comparing with papers.
    bounds
        Refine until (upper - lower) / upper is below: 0.02 or 2%; 10% by default.

    congruence
        Also compute the congruence of the two surfaces where they are in contact (columns of area.csv): the radius
        within which curvatures are fitted, several edges of the meshes, such as 4mm.

    Error of the poses
    ------------------
    pose_sd
        Standard deviations of the poses, typed t=0.5,r=1 or tx=0.5,ty=0.5,tz=1,rx=1,ry=1,rz=2 (mm, degrees; 0 unless
        named): the area of FIXED gets intervals, by draws and to first order (pose_error.csv; pose_draws.npz for E* by
        `modulus`); so do pressures, forces and the medial share (pressure_error.csv).
    pose_axes
        Axes of these: those of fixed (the default) or moving. Turns are about MOVING's origin.
    markers
        Instead of `pose_sd`: markers that MOVING's pose was fitted to, a table x [mm], y [mm], z [mm] in its frame.
    marker_sd
        Standard deviation of each coordinate of a marker.
    draws
        How many; 400 by default, of which pressures take the first 100.
    seed
        Seed of the draws; 1 by default.

    Gait cycles
    -----------
    events
        Table side, event, time [s] (heel strike, toe off), with recording and style where there are several, or a .c3d
        of the same clock: areas over the cycle (cycles.csv), and how styles differ (shifts.csv).
    cycle_side
        Side of the joint, where the events are of both.
    part
        Use only this first part of each cycle: 60%, or stance, which ends at the toe off.

    Comparison with measured areas
    ------------------------------
    compare
        Table of your own measured areas; the result is not accepted (exit 1) beyond the tolerance. literature instead:
        published areas of knees, each with its source (literature.csv); other implants accept or refuse nothing.
    tolerance
        Largest relative difference from the areas compared; 2% by default.
    flexion
        Column of the motion's file that is knee flexion, for published areas: -knee_flexion turns the sign. Known
        without it for `sweep` flexion and for `convention`.

    Results
    -------
    save_map
        Also write the distance of every vertex in every frame (distances.npz).
    paraview
        Also write both bodies with their distances over time for ParaView (folder paraview).
    export
        Also write both bodies and their motion for other programs, typed febio,abaqus,opensim (folder export).
    stills
        Also write 3-D pictures of the frame with the largest area (still_plus_y.png and others).

    Pressure of an elastic layer
    ----------------------------
    pressure
        Also press MOVING, rigid unless `modulus_moving`, into FIXED as an elastic layer: pressures and forces.
    modulus
        Young's modulus of FIXED for `pressure`: 500MPa.
    poisson
        Poisson's ratio of FIXED for `pressure`, below 0.5.
    thickness
        Thickness of FIXED's layer: a length such as 8mm, or rays (measured along the normal, which is the default).
    foundation
        linear or logarithmic (finite strain); linear by default.
    facets
        smooth: triangles stand for a smooth surface through their corners; flat: as they are. smooth by default.
    modulus_moving
        Young's modulus of MOVING, which then is an elastic layer as well; rigid by default.
    poisson_moving
        Its Poisson's ratio, below 0.5.
    thickness_moving
        Thickness of MOVING's layer: a length such as 3mm, or rays.
    piece
        Longest edge of the pieces that pressure is summed over: 0.5mm by default.
    bodies
        OpenSim bodies of MOVING and FIXED, femur_r,tibia_r: forces are also written as external loads of these.

    Wear of the layer
    -----------------
    wear_factor
        Also compute the linear wear of FIXED by Archard's law with this factor, such as 1e-7mm^3/(N m) (wear.csv): a
        volume per force and sliding path. Pressures are those of the surface that is not worn.
    cross_shear
        Instead of `wear_factor`: a table cross_shear [-], wear_factor [mm^3/(N m)] of factors by cross-shear ratio
        (Kang et al. 2008), 0 to 0.5; linear between rows.
    wear_cycles
        How often the motion, which is exactly one cycle, repeats; 1000000 by default.

    Work
    ----
    workers
        Threads; all cores by default. Results do not depend on it.
    """

    over_time: ClassVar[bool] = True
    first_frame: ClassVar[str] = "geocontact.analyses.area.first_frame"
    writes: ClassVar[str] = """
    Writes area.csv, report.html, area.png, area.svg and run.json into OUT, and pressure.csv with `pressure`. A point
    counts as in contact when its signed distance to the other body is not above the threshold; against an open body
    distances are unsigned, and the table says so.
    """

    moving: Path
    fixed: Path
    _: KW_ONLY
    unit: MeshUnit
    unit_moving: MeshUnit | None = None
    motion: Annotated[tuple[str, ...] | None, Spelled(rest=True)] = None
    motion_fixed: Annotated[
        tuple[str, ...] | None,
        READS_NO_FILE,
        Excludes("osim", "has no effect with `osim`: the joint's poses are in FIXED already"),
        Excludes("convention", "has no effect with `convention`: knee angles are in FIXED already"),
    ] = None
    rate: Annotated[float | None, READS_NO_FILE, FRAME_RATE] = None
    threshold: Annotated[Lengths, Spelled(default="4"), THRESHOLD] = (4e-3,)
    osim: Annotated[Path | None, READS_NO_FILE] = None
    joint: Annotated[str | None, READS_NO_FILE] = None
    moving_body: Annotated[Literal["child", "parent"] | None, Spelled("moving"), READS_NO_FILE] = None
    map: Annotated[
        Expression | None, READS_NO_FILE, Excludes("osim", "with `osim` names the columns twice", "give one")
    ] = None
    order: Annotated[
        str | None,
        READS_NO_FILE,
        Excludes("osim", "has no effect with `osim`: the joint gives the order"),
        Excludes("convention", "has no effect with `convention`, which gives the order"),
    ] = None
    angles: Annotated[AngleUnit | None, READS_NO_FILE] = None
    convention: Annotated[
        Literal["grood-suntay"] | None,
        READS_NO_FILE,
        Excludes("osim", "has no effect with `osim`: the joint says what its coordinates are", "give one"),
        Needs("side", "give right or left"),
    ] = None
    side: Annotated[Side | None, Requires("convention", alternative="split")] = None
    sweep: Sweep | None = None
    axis: Annotated[Expression | None, Requires("sweep")] = None
    place_moving: str | None = None
    place_fixed: str | None = None
    merge_tolerance: Annotated[Length | None, MERGED] = None
    adduction: Turn | None = None
    assume_closed: Literal["moving", "fixed", "both"] | None = None
    outer: Literal["moving", "fixed", "both"] | None = None
    split: str | None = None
    medial: Annotated[Medial | None, Requires("split")] = None
    region: Expression | None = None
    region_moving: Expression | None = None
    rule: Literal["refined", "clip", "all-vertices", "any-vertex", "centroid"] = "refined"
    bounds: Annotated[Fraction | None, SHARE] = None
    congruence: Annotated[Length | None, FITTED] = None
    pose_sd: PoseSd | None = None
    pose_axes: Annotated[Literal["fixed", "moving"] | None, Requires("pose_sd")] = None
    markers: Annotated[
        Path | None, Excludes("pose_sd", "says the error of the pose twice", "give one"), Needs("marker_sd", "as 0.5mm")
    ] = None
    marker_sd: Annotated[Length | None, Requires("markers"), SHIFT] = None
    draws: Annotated[int | None, Requires("pose_sd", alternative="markers")] = None
    seed: Annotated[int | None, Requires("pose_sd", alternative="markers")] = None
    events: Annotated[Path | None, READS_NO_FILE] = None
    cycle_side: Annotated[Side | None, Requires("events")] = None
    part: Annotated[CyclePart | None, Requires("events")] = None
    compare: Path | None = None
    tolerance: Annotated[
        Fraction | None, Requires("compare", "give your measured areas too, or leave it out"), DIFFERENCE
    ] = None
    flexion: Annotated[Expression | None, READS_NO_FILE, Requires("compare", "leave it out")] = None
    save_map: bool = False
    paraview: bool = False
    export: Programs | None = None
    stills: bool = False
    pressure: Annotated[
        bool, Needs("modulus", "give for example 500MPa"), Needs("poisson", "give for example 0.46")
    ] = False
    modulus: Annotated[Pressure | None, OF_LAYER, YOUNG] = None
    poisson: Annotated[float | None, OF_LAYER, LAYER_RATIO] = None
    thickness: Annotated[Thickness | None, OF_LAYER] = None
    foundation: Annotated[Literal["linear", "logarithmic"] | None, OF_LAYER] = None
    facets: Annotated[Literal["smooth", "flat"] | None, OF_LAYER] = None
    modulus_moving: Annotated[Pressure | None, OF_LAYER, Needs("poisson_moving", "give for example 0.46"), YOUNG] = None
    poisson_moving: Annotated[float | None, OF_SECOND, LAYER_RATIO] = None
    thickness_moving: Annotated[Thickness | None, OF_SECOND] = None
    piece: Annotated[Length | None, OF_LAYER, PIECE] = None
    bodies: Annotated[BodyPair | None, OF_LAYER] = None
    wear_factor: Annotated[WearRate | None, OF_LAYER, WEAR] = None
    cross_shear: Annotated[
        Path | None, OF_LAYER, Excludes("wear_factor", "gives the factor twice", "give one of them")
    ] = None
    wear_cycles: Annotated[float | None, Requires("wear_factor", alternative="cross_shear"), CYCLES] = None
    workers: int | None = None

    def paths(self) -> Iterator[tuple[Path, Missing]]:
        """Those of files, and of motions that are no patterns."""
        yield from (each for each in super().paths() if each[0] != LITERATURE)
        for name in (*(self.motion or ()), *(self.motion_fixed or ())):
            if not has_magic(name):
                yield Path(name), Missing()

    def refuse_impossible(self) -> None:
        """Motions that are none or two, and numbers that cannot be."""
        if (self.sweep is None) == (not self.motion):
            raise InputError("", "`motion`", "give either `motion` or `sweep`", "exactly one of them is needed")
        if self.moving_body is not None and self.osim is None and self.convention is None:
            what = f"{self.moving_body} needs a joint or a knee convention"
            raise InputError("", "`moving_body`", what, "swap the two meshes, or give `osim` and `joint`")
        if self.workers is not None and self.workers < 1:
            raise InputError("", "`workers`", f"{self.workers} is less than one thread", "give 1 or more")
        if self.split is not None:
            medial_side(self.split, self.side, self.medial)
        if self.medial is not None and self.side is not None and self.convention is None:
            raise InputError("", "`side`", "has no effect with `medial`, which says what is medial", "give one")
        refuse_comparison(self.compare, self.tolerance, self.flexion)
        refuse_thresholds(self.threshold)
        if self.pose_sd is not None or self.markers is not None:
            refuse_errors(self.rule, self.threshold, self.draws, self.seed, self.pose_sd)
        refuse_programs(self.export, self.osim)
        if self.adduction is not None and self.adduction[0] not in ("x", "y", "z"):
            raise InputError("", "`adduction`", f"{self.adduction[0]!r} is not an axis", "turn about x, y or z")


@dataclass(frozen=True, kw_only=True)
class PressureOptions(AreaOptions):
    """Pressures and forces of a body that is pressed into the elastic layer of another one over a motion.

    The same analysis as `area` with its pressures asked for; all other options are those of `area`.

    Parameters
    ----------
    pressure
        Always so.
    modulus
        Young's modulus of FIXED.
    poisson
        Poisson's ratio of FIXED, below 0.5.
    """

    pressure: Annotated[bool, Needs("modulus"), Needs("poisson")] = field(default=True, init=False)
    modulus: Annotated[Pressure, OF_LAYER, YOUNG] = field()
    poisson: Annotated[float, OF_LAYER, LAYER_RATIO] = field()
