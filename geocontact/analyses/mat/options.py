"""What a pressure mat on a body may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

from geocontact.analyses.frame.marks import (
    AngleUnit,
    Excludes,
    Expression,
    Fraction,
    Length,
    MeshUnit,
    Needs,
    Pressure,
    Requires,
    Spelled,
    Typed,
)
from geocontact.analyses.frame.options import Options
from geocontact.data.errors import InputError
from geocontact.data.plausible import BORDER, CLOCK, CUTOFF, DISPLACEMENT, FORCE, FRICTION, MERGED, SHARE, TOUCH

TimeWindows = Annotated[
    tuple[tuple[float, float], ...], Typed("s", "windows", "((0.0, 0.5), (9.0, 9.5))"), CLOCK, Spelled(dashed=True)
]
Displacement = Annotated[tuple[float, float], Typed("m, rad", "registration", "(gc.mm(1), gc.deg(2))"), DISPLACEMENT]
FromMotion = Requires("motion")
FromSecondScan = Requires("scan_with_mat", "leave it out")


@dataclass(frozen=True)
class MatOptions(Options):
    """Pressures of a mat on the surface of a body scan: force, moment, centre of pressure and area over time.

    Parameters
    ----------
    frames
        Recording of the mat: a grid of cells (.csv), novel pedar (.asc), Tekscan (.asf .csv) or XSENSOR (.csv).
    surface
        Scan of the body that the mat lies on.
    unit
        Length unit of the scan; never guessed.
    merge_tolerance
        Merge vertices of scan and body model that lie within this distance; only equal ones by default.

    Where the mat lies
    ------------------
    landmarks
        Places of the mat and the points of the scan that they lie on: id, row, column, x [mm], y [mm], z [mm], in the
        scan's frame; row and column count cells from the corner of the first one.
    scan_with_mat
        Instead of landmarks: a second scan of the same body with the mat on, in the same unit; this locates the mat.
    first_corner
        Place x,y,z of `surface` near the mat's corner at its first cell, in the scan's unit, or a landmark picked on
        it, FILE.csv:NAME; needed by `scan_with_mat`.
    mat_edge
        Width of the mat's border without cells, for `scan_with_mat`: 5mm; none by default.

    The mat
    -------
    layout
        layout.toml: rows, columns, pitch_mm or cell_area_mm2, order of the cells, origin, mirrored, saturation.
    kind
        Format of `frames`, where its content does not show it.
    sensor
        Which mat, where `frames` holds several ("left").
    seen_from
        Side from which the layout shows the mat where it lies: outside, with the body behind it, or body, as seat mats
        are drawn.
    lay
        geodesic: along the surface, every cell keeps its pitch. closest: a flat mat pushed down along the shortest way.
    inwards
        Faces of an open scan look into the body: turn them over. A closed scan needs none.
    belt
        The mat goes once around the body and its last rows (or columns) meet its first: rows or columns.

    Motion of the segment
    ---------------------
    motion
        Pose of the segment over time (.csv .mot .sto); forces, moments and centres are then in its reference frame.
    osim
        OpenSim model whose joint turns the motion's coordinates into poses: the segment is the joint's child body.
    joint
        Name of that joint.
    moving_body
        parent: the segment is the joint's parent body; child by default.
    map
        Columns of the motion instead of a model: rz=knee_flexion,rx=knee_adduction,tx=knee_tx
    order
        Order of the motion's intrinsic rotations: XYZ is R = Rx Ry Rz.
    angles
        Unit of the motion's angles where the file does not say.

    Frame of the results
    --------------------
    point
        Point that moments refer to, x,y,z in the scan's unit and the frame of the results; 0,0,0 by default.
    frame
        Name of the scan's frame in the results.

    The readings
    ------------
    cutoff
        Zero-lag Butterworth low-pass [Hz]; 0 for none.
    unloaded
        Times without load [s], for offset, and drift where there are two: 0:0.5,9:9.5
    dead
        Cells that never change while those around them are pressed are reported. warn: and used as they read. mask: and
        left out. fill: and filled from their neighbours, as those are that the layout lists as dead.
    touched
        Pressure from which a cell counts as touched: 1kPa by default.
    gate
        Force [N] below which there is no centre of pressure.
    shear_rows
        Shear stress on the body of a two-axis mat (.csv, a grid like `frames`, in kPa), positive from row to row.
    shear_columns
        The same from column to column.
    friction
        Static friction under the mat that shear is compared with; 1 by default.

    Comparison with a body model
    ----------------------------
    body_landmarks
        Points known on the scan and a body model: id, x [mm], y [mm], z [mm], body_x [mm], body_y [mm], body_z [mm].
        All results are in the body's frame then.
    picked_on_body
        Landmarks picked on the body model, by the same ids, instead of the columns body_x, body_y and body_z.
    body
        Surface of that body, for `icp`.
    body_unit
        Its unit; that of the scan by default.
    icp
        Fit the scan to the body's surface by shape, beginning where the landmarks put it.
    icp_engine
        own: our own search by shape. open3d: that of open3d. auto: open3d where it imports, else our own; auto by
        default.
    segment
        Part of the surface with a name; may be repeated: "upper=y > 20" (x y z nx ny nz, the scan's unit), or of picked
        landmarks, upper=polygon:FILE.csv.

    Uncertainty
    -----------
    accuracy
        Independent relative error of each cell: 10% by default.
    gain
        Relative error common to all cells.
    registration
        Position error of the mat, along and about each axis: 1mm,2deg; by default, what the residuals show of
        `landmarks`, and of `body_landmarks` or `icp`.

    Comparison with a model
    -----------------------
    compare
        Forces of a model (or of a plate) over time, columns as in wrench.csv: agreement in agreement.csv. Lines
        `# point_mm = ...` and `# frame = ...` above it are read.
    phases
        Phases of the recording for `compare`: name, start [s], end [s]; a name may come back in every cycle. Tenths of
        the recording without.
    """

    over_time: ClassVar[bool] = True
    writes: ClassVar[str] = """
    Writes wrench.csv, uncertainty.csv, cells.csv, frames_cells.csv, shear.csv with `shear_rows`, segments.csv with
    `segment`, registration.csv with `body_landmarks`, agreement.csv with `compare`, mat_on_surface.vtp, report.html,
    mat.png, mat.svg, run.json.
    """

    frames: Path
    _: KW_ONLY
    surface: Path
    unit: MeshUnit
    merge_tolerance: Annotated[Length | None, MERGED] = None
    landmarks: Path | None = None
    scan_with_mat: Annotated[
        Path | None, Excludes("landmarks", "with `landmarks` says twice where the mat lies", "give one of them")
    ] = None
    first_corner: Annotated[Expression | None, FromSecondScan] = None
    mat_edge: Annotated[Length | None, FromSecondScan, BORDER] = None
    layout: Path | None = None
    kind: Literal["grid", "pedar", "tekscan", "xsensor"] | None = None
    sensor: str | None = None
    seen_from: Literal["outside", "body"] = "outside"
    lay: Literal["geodesic", "closest"] = "geodesic"
    inwards: bool = False
    belt: Literal["rows", "columns"] | None = None
    motion: Path | None = None
    osim: Annotated[Path | None, FromMotion] = None
    joint: Annotated[str | None, FromMotion] = None
    moving_body: Annotated[
        Literal["child", "parent"] | None, Spelled("moving"), FromMotion, Requires("osim", "give `osim` and `joint`")
    ] = None
    map: Annotated[
        Expression | None, FromMotion, Excludes("osim", "with `osim` names the columns twice", "give one")
    ] = None
    order: Annotated[str | None, FromMotion, Excludes("osim")] = None
    angles: Annotated[AngleUnit | None, FromMotion] = None
    point: Expression | None = None
    frame: str | None = None
    cutoff: Annotated[float, CUTOFF] = 6.0
    unloaded: TimeWindows | None = None
    dead: Literal["warn", "mask", "fill"] = "warn"
    touched: Annotated[Pressure, Spelled(default="1kPa"), TOUCH] = 1e3
    gate: Annotated[float, FORCE] = 5.0
    shear_rows: Annotated[Path | None, Needs("shear_columns", "a two-axis mat records both")] = None
    shear_columns: Annotated[Path | None, Needs("shear_rows", "a two-axis mat records both")] = None
    friction: Annotated[float | None, Requires("shear_rows"), FRICTION] = None
    body_landmarks: Path | None = None
    picked_on_body: Annotated[
        Path | None, Needs("body_landmarks", "the same landmarks on the scan are needed as well")
    ] = None
    body: Annotated[Path | None, Requires("icp", "give `icp`, or leave it out")] = None
    body_unit: Annotated[MeshUnit | None, Requires("body", "leave it out")] = None
    icp: Annotated[
        bool, Needs("body_landmarks", "the search by shape begins where they put the scan"), Needs("body")
    ] = False
    icp_engine: Annotated[Literal["auto", "own", "open3d"] | None, Requires("icp", "give `icp`, or leave it out")] = (
        None
    )
    segment: tuple[str, ...] = ()
    accuracy: Annotated[Fraction, Spelled(default="10%"), SHARE] = 0.1
    gain: Annotated[Fraction | None, SHARE] = None
    registration: Displacement | None = None
    compare: Path | None = None
    phases: Annotated[Path | None, Requires("compare", "leave it out")] = None

    def refuse_impossible(self) -> None:
        """A mat that lies nowhere, a belt pushed down flat."""
        if self.landmarks is None and self.scan_with_mat is None:
            what = "is missing: nothing says where the mat lies"
            raise InputError("", "`landmarks`", what, "give `landmarks`, or a second scan `scan_with_mat`")
        if self.belt is not None and self.lay == "closest":
            what = "has no effect with `lay` closest, which pushes a flat mat straight down"
            raise InputError("", "`belt`", what, "leave one of them out")
