"""What a contact equilibrium may be asked for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

from geocontact.analyses.frame.marks import (
    AngleUnit,
    Excludes,
    Expression,
    Length,
    MeshUnit,
    Pressure,
    Requires,
    Spelled,
    Typed,
)
from geocontact.analyses.frame.options import Options
from geocontact.analyses.frame.shared_options import BodyPair, PoseSd, Side, Sweep, Thickness, refuse_pose_sd
from geocontact.data.errors import InputError
from geocontact.data.plausible import LAYER_RATIO, MERGED, PIECE, SOFTER, SPRING, TURNED_SPRING, ByName, N, Plausible

MAY_SETTLE = ("adduction", "anterior", "mediolateral", "rotation")
"""Coordinates besides the axial one, which always settles, and flexion, which never does."""

READS_NO_FILE = Excludes("sweep", "has no effect with `sweep`, which has no recorded times and poses")
LOAD = Plausible("the axial load", N, (1e-3, 1e5), (20.0, 10_000.0), why="a resting limb to a landing")
Free = Annotated[
    tuple[str, ...],
    Typed("-", "knee.settle.equilibrium:names", '("adduction", "rotation")'),
    Spelled(default="adduction"),
]
Springs = Annotated[
    Mapping[str, float],
    Typed("-", "knee.settle.equilibrium:springs", '{"anterior": 30e3, "rotation": 20.6}'),
    ByName(
        (
            ("anterior", SPRING),
            ("mediolateral", SPRING),
            ("rotation", TURNED_SPRING),
            ("adduction", TURNED_SPRING),
        )
    ),
]


@dataclass(frozen=True)
class SettleOptions(Options):
    """Contact equilibrium of a knee implant: flexion and load given, other coordinates settle on an elastic foundation.

    FIXED is the tibial insert in a frame with x anterior, y proximal, z to the subject's right; MOVING the femoral
    component.

    Parameters
    ----------
    moving
        Femoral component, rigid (.stl .ply .obj .off .vtp .step).
    fixed
        Tibial insert, the elastic layer, in whose frame results are given.
    unit
        Unit of both meshes; never guessed.
    unit_moving
        Unit of MOVING's mesh, of `place_moving` and of `load_point` where it is not `unit`.
    side
        Side of the body: which of +z and -z is medial, and which turns are varus and internal.

    Motion
    ------
    motion
        Poses of MOVING in FIXED (.csv) or coordinates (.mot .sto): flexion and all coordinates that do not settle.
    sweep
        Instead of `motion`, typed flexion=0:90:10 in degrees: MOVING starts where it lies lowest on FIXED at each
        flexion, turns at 0 where its axes are FIXED's.
    osim
        OpenSim model whose joint turns coordinates into poses: FIXED is the parent body, MOVING the child.
    joint
        Name of that joint.
    moving_body
        parent: MOVING is the joint's parent body, as the femur of a knee joint is; child by default.
    map
        Columns instead of a model: rz=knee_flexion,rx=knee_adduction,ry=-knee_rotation,tx=knee_tx
    order
        Order of intrinsic rotations: XYZ is R = Rx Ry Rz.
    angles
        Unit of angles where the file does not say.

    Placement
    ---------
    place_moving
        Pose of the mesh in its body: a file with a 4x4 matrix, or model.osim:body.
    place_fixed
        The same for FIXED.
    merge_tolerance
        Merge vertices of both meshes that lie within this distance, where corners that faces share differ by rounding;
        a warning has how many, and the largest shift. Only equal ones by default.
    assume_closed
        Treat a surface as closed although its edges do not show it.

    Load and coordinates
    --------------------
    load
        Axial load [N], the same in every frame: MOVING is pressed along -y of FIXED.
    forces
        Instead of `load`: forces.csv of `loadcells` or another table with `total [N]` over time.
    free
        What settles with the axial translation: none, or adduction, anterior, mediolateral, rotation.
    springs
        Springs at rest where the motion is, for what is free: anterior=30,rotation=0.36 (N/mm, N m/deg; in Python in
        N/m and N m/rad).
    load_point
        x,y,z: point of MOVING in its frame and the mesh unit that the load acts at and whose translations are the
        coordinates, or a landmark picked on it, FILE.csv:NAME; MOVING's origin by default.

    Elastic layer
    -------------
    modulus
        Young's modulus of FIXED: 463MPa.
    poisson
        Poisson's ratio of FIXED, below 0.5.
    thickness
        Thickness of FIXED's layer: a length such as 8mm, or rays (measured along the normal, which is the default).
    foundation
        linear or logarithmic (finite strain).
    region
        Faces of FIXED that are the layer: "ny>0.25" in x y z nx ny nz (mesh unit), a file of face numbers, or picked
        landmarks: polygon:FILE.csv, or sphere:FILE.csv:NAME:12mm.
    split
        Where medial and lateral meet: z, or z=1.5 (mesh unit).
    piece
        Longest edge of the pieces that pressure is summed over: 0.5mm by default.

    Error of the poses
    ------------------
    pose_sd
        Standard deviations of the poses along and about FIXED's axes, as of `area`: t=0.5,r=1 (mm, degrees). What is
        held, and where springs are at rest, is off by one error in all frames; pressures, area and medial share get
        intervals (settle_error.csv).
    draws
        How many equilibria of each frame; 40 by default.
    seed
        Seed of the draws; 1 by default.

    Results
    -------
    compare
        literature: contact areas measured on knee implants beside these, each with its source (literature.csv).
    bodies
        OpenSim bodies of MOVING and FIXED, femur_r,tibia_r: contact forces are written as external loads of these.
    paraview
        Also write FIXED with its pressures and MOVING in every frame for ParaView (folder paraview).
    """

    over_time: ClassVar[bool] = True
    writes: ClassVar[str] = """
    Writes settle.csv, poses.csv and settled.mot (motions for `geocontact area`), a figure, report.html and run.json
    into OUT, contact_loads.mot and .xml with `bodies` (external loads for OpenSim), and pressures for ParaView with
    `paraview`.
    """

    moving: Path
    fixed: Path
    _: KW_ONLY
    unit: MeshUnit
    side: Side
    modulus: Annotated[Pressure, SOFTER]
    poisson: Annotated[float, LAYER_RATIO]
    unit_moving: MeshUnit | None = None
    load: Annotated[float | None, LOAD] = None
    forces: Annotated[Path | None, Excludes("load", "says the load again", "give one"), READS_NO_FILE] = None
    free: Free = ("adduction",)
    springs: Springs | None = None
    load_point: Expression | None = None
    motion: Path | None = None
    sweep: Sweep | None = None
    osim: Annotated[Path | None, READS_NO_FILE] = None
    joint: Annotated[str | None, READS_NO_FILE] = None
    moving_body: Annotated[Literal["child", "parent"] | None, Spelled("moving"), READS_NO_FILE] = None
    map: Annotated[
        Expression | None, READS_NO_FILE, Excludes("osim", "with `osim` names the columns twice", "give one")
    ] = None
    order: Annotated[
        str | None, READS_NO_FILE, Excludes("osim", "has no effect with `osim`: the joint gives the order")
    ] = None
    angles: Annotated[AngleUnit | None, READS_NO_FILE] = None
    place_moving: str | None = None
    place_fixed: str | None = None
    merge_tolerance: Annotated[Length | None, MERGED] = None
    assume_closed: Literal["moving", "fixed", "both"] | None = None
    thickness: Thickness | None = None
    foundation: Literal["linear", "logarithmic"] = "linear"
    region: Expression | None = None
    split: str = "z"
    piece: Annotated[Length | None, PIECE] = None
    pose_sd: PoseSd | None = None
    draws: Annotated[int | None, Requires("pose_sd")] = None
    seed: Annotated[int | None, Requires("pose_sd")] = None
    compare: Literal["literature"] | None = None
    bodies: BodyPair | None = None
    paraview: bool = False

    def refuse_impossible(self) -> None:
        """A load said twice or not at all, coordinates that do not settle, springs of what is held."""
        self._refuse_motions()
        self._refuse_errors()
        if self.load is None and self.forces is None:
            raise InputError("", "`load`", "or `forces`: one says the axial load", "give for example 2000")
        if self.moving_body is not None and self.osim is None:
            what = f"{self.moving_body} needs a joint"
            raise InputError("", "`moving_body`", what, "swap the two meshes, or give `osim` and `joint`")
        for option, names in (("free", self.free), ("springs", self.springs or ())):
            for name in names:
                if name not in (*MAY_SETTLE, *(("axial",) if option == "free" else ())):
                    what = f"{name!r} is none of {', '.join(MAY_SETTLE)}"
                    raise InputError("", f"`{option}`", what, "axial always settles, flexion never")
                if name not in (*self.free, "axial"):
                    what = f"{name} is held, and its spring has no effect"
                    raise InputError("", f"`{option}`", what, f"add {name} to `free`")
        if any(not value > 0.0 for value in (self.springs or {}).values()):
            raise InputError("", "`springs`", "one is not positive", "leave it out")
        if self.split.partition("=")[0].strip() != "z":
            raise InputError("", "`split`", f"{self.split!r} does not lie across z", "write z, or for example z=1.5")

    def _refuse_errors(self) -> None:
        """Standard deviations that are none, draws that are too few or too many."""
        refuse_pose_sd(self.pose_sd)
        if self.draws is not None and not 20 <= self.draws <= 10_000:
            raise InputError("", "`draws`", f"{self.draws} is not between 20 and 10000", "give for example 40")
        if self.seed is not None and self.seed < 0:
            raise InputError("", "`seed`", f"{self.seed} is negative", "give 0 or more")

    def _refuse_motions(self) -> None:
        """Not exactly one of a motion and a sweep; a sweep of something else than flexion."""
        if (self.motion is None) == (self.sweep is None):
            raise InputError("", "`motion`", "or `sweep`: exactly one says how it flexes", "give one of them")
        if self.sweep is not None and self.sweep[0] != "flexion":
            raise InputError("", "`sweep`", f"{self.sweep[0]!r} does not sweep", "write flexion=0:90:10 (degrees)")
