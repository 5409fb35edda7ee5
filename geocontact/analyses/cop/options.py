"""What a centre of pressure may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

from geocontact.analyses.frame.marks import (
    AngleUnit,
    C3dUnit,
    Excludes,
    Expression,
    Length,
    MeshUnit,
    PartLength,
    Requires,
    Spelled,
    Typed,
)
from geocontact.analyses.frame.options import Options
from geocontact.data.plausible import (
    CUTOFF,
    DAMPING,
    DEPTH,
    EXPONENT,
    FORCE,
    FRICTION,
    MERGED,
    SPEED,
    SPHERE,
    Plausible,
)
from geocontact.data.units import mm

FOOT_LENGTH = Plausible("the length of a foot", mm, (10.0, 1000.0), (100.0, 400.0))
Friction = Annotated[tuple[float, float], Typed("-", "friction", "(0.9, 0.7)"), FRICTION]


@dataclass(frozen=True)
class CopOptions(Options):
    """Centre of pressure, force and free moment of a foot that stands on spheres, over a motion.

    Parameters
    ----------
    spheres
        Table of the spheres in the foot's frame: px [m], py [m], pz [m], radius [m], zone; or an OpenSim model (.osim)
        with contact spheres on `body`.
    motion
        Poses of the foot in the ground's frame (.csv), or coordinates (.mot .sto) with `osim` and `joint`, or `map`.
        Without these they go through all joints of the model that `spheres` is.

    The foot
    --------
    body
        Body of the OpenSim model whose contact spheres are the foot's, each a zone. Several bodies of a foot are joined
        by +, several feet by a comma: calcn_r+toes_r,calcn_l+toes_l.

    The ground
    ----------
    ground
        plane:nx,ny,nz,offset (all x with n.x = offset [m], n made a unit vector), stairs:h0,x1:h1,x2:h2 (height h1 [m]
        from x1 on, y up), or a mesh; by default that of the model's contact forces, else plane:0,1,0,0.
    unit
        Unit of the ground's mesh; never guessed.
    merge_tolerance
        Merge vertices of the mesh that lie within this distance; only equal ones by default.

    The centre
    ----------
    point
        What is averaged, weighted by normal force: points on the ground, or centres of spheres.
    gate
        Normal force [N] below which there is no centre of pressure.
    toe
        Axis of the foot's frame that points from heel to toe: adds the centre in the foot, from the heel.
    foot_length
        From heel to toe; from the rearmost to the foremost point of the spheres by default.
    stances
        Add every complete stance, from where the normal force reaches the gate until it falls below, at 0, 1, … 100 %.

    Filters
    -------
    motion_cutoff
        Zero-lag low-pass of the motion [Hz], 6 in the study of the variable-stiffness foot; none by default.
    force_cutoff
        Zero-lag low-pass of forces and moments, the plate's as well [Hz], 40 there; none by default.

    The force law
    -------------
    law
        Numbers of the force law in a .toml: k, b, n, delta_full, mu_s, mu_k, v_th, and k, b in [zone.NAME].
    stiffness
        k [N/m^n] of every sphere; 8e4 by default, else as given here, in `law` or as a column `k [N/m^n]`.
    damping
        b [N s/m] of every sphere; 200 by default, else as given here, in `law` or as a column `b [N s/m]`.
    exponent
        n of F = k depth^n; 1.2 by default.
    full_depth
        Depth from which damping acts fully: 2 mm by default.
    friction
        Static and kinetic coefficient: 0.9,0.7 by default.
    threshold_speed
        Speed [m/s] at which static friction is reached; 0.25 by default.

    Comparison with a force plate
    -----------------------------
    compare
        Ground reactions of force plates (.mot .sto .c3d .csv) to compare with.
    plate
        Name or number of the plate; needed when there are several. Of several feet one for each, joined by commas; by
        default the plates that lie under each foot.
    c3d_unit
        Unit of places in .c3d files whose own, POINT:UNITS, is empty.
    axes
        Which of the plates' axes are ours: x,z,-y where the laboratory's z is up and our y.
    plate_pose
        File with the 4x4 pose of the plates' frame in ours (translation in m), as for a laboratory with z up.

    Motion
    ------
    osim
        OpenSim model whose joint turns coordinates into poses: its parent body is the ground, its child the foot.
    joint
        Name of that joint.
    moving_body
        parent: the foot is the joint's parent body; child by default.
    map
        Columns instead of a model: rz=pitch,tx=x,ty=y
    order
        Order of intrinsic rotations: XYZ is R = Rx Ry Rz.
    angles
        Unit of angles where the file does not say.
    """

    over_time: ClassVar[bool] = True
    writes: ClassVar[str] = """
    Writes cop.csv, zones.csv, cop.png, cop.svg, report.html and run.json into OUT, comparison.csv with `compare`,
    feet.csv of several feet.
    """

    spheres: Path
    _: KW_ONLY
    motion: Path
    body: str | None = None
    ground: Expression | None = None
    unit: MeshUnit | None = None
    merge_tolerance: Annotated[Length | None, MERGED, Requires("unit", "it is for a mesh")] = None
    point: Literal["ground", "sphere"] = "ground"
    gate: Annotated[float, FORCE] = 20.0
    toe: Literal["x", "-x", "y", "-y", "z", "-z"] | None = None
    foot_length: Annotated[PartLength | None, Requires("toe", "say where the toe is"), FOOT_LENGTH] = None
    stances: bool = False
    motion_cutoff: Annotated[float | None, CUTOFF] = None
    force_cutoff: Annotated[float | None, CUTOFF] = None
    law: Path | None = None
    stiffness: Annotated[float | None, SPHERE] = None
    damping: Annotated[float | None, DAMPING] = None
    exponent: Annotated[float | None, EXPONENT] = None
    full_depth: Annotated[Length | None, DEPTH] = None
    friction: Friction | None = None
    threshold_speed: Annotated[float | None, SPEED] = None
    compare: Path | None = None
    plate: Annotated[str | None, Requires("compare", "name the file of force plates")] = None
    c3d_unit: C3dUnit = None
    axes: Annotated[Expression | None, Requires("compare", "name the file of force plates")] = None
    plate_pose: Annotated[
        Path | None,
        Requires("compare", "name the file of force plates"),
        Excludes("axes", "with `axes` turns the plates twice", "give one of them"),
    ] = None
    osim: Path | None = None
    joint: str | None = None
    moving_body: Annotated[
        Literal["child", "parent"] | None, Spelled("moving"), Requires("osim", "give `osim` and `joint`")
    ] = None
    map: Annotated[Expression | None, Excludes("osim", "with `osim` names the columns twice", "give one")] = None
    order: Annotated[str | None, Excludes("osim")] = None
    angles: AngleUnit | None = None
