"""`geocontact mat`: the options of the command; the work is in `mat_analysis`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

Dashed = Parameter(allow_leading_hyphen=True)
Flag = Parameter(negative="")


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class MatOptions:
    """Options of a pressure mat as typed.

    Parameters
    ----------
    surface
        Scan of the body that the mat lies on.
    unit
        Length unit of the scan; never guessed.
    landmarks
        Places of the mat and the points of the scan that they lie on: id, row, column, x [mm], y [mm], z [mm], in the
        scan's frame; row and column count cells from the corner of the first one.
    scan_with_mat
        Instead of landmarks: a second scan of the same body with the mat on, in the same unit; the mat is found there.
    first_corner
        Place x,y,z of --surface near the mat's corner at its first cell, in the scan's unit; needed by --scan-with-mat.
    mat_edge
        Width of the mat's border without cells, for --scan-with-mat: 5mm; none unless given.
    out
        Folder for the results.
    layout
        layout.toml: rows, columns, pitch_mm or cell_area_mm2, order of the cells, origin, mirrored, saturation.
    kind
        Format of FRAMES, where its content does not tell.
    sensor
        Which mat, where FRAMES holds several ("left").
    inwards
        Faces of an open scan look into the body: turn them over. A closed scan needs none.
    seen_from
        Side from which the layout shows the mat where it lies: outside, with the body behind it, or body, as seat mats
        are drawn.
    lay
        geodesic: along the surface, every cell keeps its pitch. closest: a flat mat pushed down along the shortest way.
    belt
        The mat goes once around the body and its last rows (or columns) meet its first: rows or columns.
    motion
        Pose of the segment over time (.csv .mot .sto); forces, moments and centres are in the frame it leads to then.
    osim
        OpenSim model whose joint turns the motion's coordinates into poses: the segment is the joint's child body.
    joint
        Name of that joint.
    moving_body
        parent: the segment is the joint's parent body; child unless given.
    map
        Columns of the motion instead of a model: rz=knee_flexion,rx=knee_adduction,tx=knee_tx
    order
        Order of the motion's intrinsic rotations: XYZ is R = Rx Ry Rz.
    angles
        Unit of the motion's angles where the file does not say.
    point
        Point that moments refer to, x,y,z in the scan's unit and the frame of the results; 0,0,0 unless given.
    frame
        Name of the scan's frame in the results.
    cutoff
        Zero-lag Butterworth low-pass [Hz]; 0 for none.
    unloaded
        Times without load [s], for offset, and drift where there are two: 0:0.5,9:9.5
    dead
        Cells that never change while those around them are pressed are told. warn: and used as they read. mask: and
        left out. fill: and filled from their neighbours, as those are that the layout lists as dead.
    touched
        Pressure from which a cell counts as touched: 1kPa unless given.
    gate
        Force [N] below which there is no centre of pressure.
    body_landmarks
        Points seen on the scan and on a body model: id, x [mm], y [mm], z [mm], body_x [mm], body_y [mm], body_z [mm].
        All results are in the body's frame then.
    body
        Surface of that body, for --icp.
    body_unit
        Its unit; that of the scan unless given.
    icp
        Fit the scan to the body's surface by shape, beginning where the landmarks put it.
    icp_engine
        own: our own search by shape. open3d: that of open3d. auto: open3d where it imports, else our own; auto unless
        given.
    segment
        Part of the surface with a name, as often as there are parts: "upper=y > 20" (x y z nx ny nz, the scan's unit).
    accuracy
        How far each cell is off by itself: 10% unless given.
    gain
        How far all cells are off together.
    registration
        How far the mat may lie elsewhere, along and about each axis: 1mm,2deg; unless given, what the residuals tell of
        --landmarks, and of --body-landmarks or --icp.
    compare
        Forces of a model (or of a plate) over time, columns as in wrench.csv: agreement in agreement.csv. Lines
        `# point_mm = ...` and `# frame = ...` above it are heeded.
    phases
        Phases of the recording for --compare: name, start [s], end [s]; a name may come back in every cycle. Tenths of
        the recording without.
    parquet
        Also write the tables as .parquet.
    """

    surface: Path
    unit: Literal["m", "cm", "mm", "in"]
    landmarks: Path | None = None
    scan_with_mat: Path | None = None
    first_corner: Annotated[str | None, Dashed] = None
    mat_edge: str | None = None
    out: Path
    layout: Path | None = None
    kind: Literal["grid", "pedar", "tekscan", "xsensor"] | None = None
    sensor: str | None = None
    seen_from: Literal["outside", "body"] = "outside"
    lay: Literal["geodesic", "closest"] = "geodesic"
    inwards: Annotated[bool, Flag] = False
    belt: Literal["rows", "columns"] | None = None
    motion: Path | None = None
    osim: Path | None = None
    joint: str | None = None
    moving_body: Annotated[Literal["child", "parent"] | None, Parameter(name="--moving")] = None
    map: Annotated[str | None, Dashed] = None
    order: str | None = None
    angles: Literal["deg", "rad"] | None = None
    point: Annotated[str | None, Dashed] = None
    frame: str | None = None
    cutoff: float = 6.0
    unloaded: Annotated[str | None, Dashed] = None
    dead: Literal["warn", "mask", "fill"] = "warn"
    touched: str = "1kPa"
    gate: float = 5.0
    body_landmarks: Path | None = None
    body: Path | None = None
    body_unit: Literal["m", "cm", "mm", "in"] | None = None
    icp: Annotated[bool, Flag] = False
    icp_engine: Literal["auto", "own", "open3d"] | None = None
    segment: tuple[str, ...] = ()
    accuracy: str = "10%"
    gain: str | None = None
    registration: str | None = None
    compare: Path | None = None
    phases: Path | None = None
    parquet: Annotated[bool, Flag] = False


def mat(frames: Path, /, *, options: MatOptions) -> int:
    """Pressures of a mat on the surface of a body scan: force, moment, centre of pressure and area over time.

    Writes wrench.csv, uncertainty.csv, cells.csv, frames_cells.csv, segments.csv with --segment, registration.csv with
    --body-landmarks, agreement.csv with --compare, mat_on_surface.vtp, report.html, mat.png, mat.svg, run.json.

    Parameters
    ----------
    frames
        Recording of the mat: a grid of cells (.csv), novel pedar (.asc), Tekscan (.asf .csv) or XSENSOR (.csv).
    """
    from geocontact.analyses.mat.run import analyse  # numpy and friends: not for --help

    return analyse(frames, options)
