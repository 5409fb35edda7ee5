"""What inverse kinematics may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from geocontact.analyses.frame.marks import C3dUnit, Excludes, Expression, Requires, Texts, TimeSpan
from geocontact.analyses.frame.options import Options
from geocontact.analyses.frame.shared_options import CyclePart
from geocontact.data.bids_name import BidsName
from geocontact.data.multibody.joint_angle_forms import JointAngleForm
from geocontact.data.plausible import GAP


@dataclass(frozen=True)
class IkOptions(Options):
    """Joint angles from recorded markers, segments or sensors: weighted least squares within the limits of the model.

    Parameters
    ----------
    markers
        Marker trajectories (.trc, .c3d, .csv), poses of segments (Theia's .c3d), or orientations of sensors
        (OpenSense's .sto).
    model
        OpenSim model (.osim) with the markers, or the bodies that segments and sensors belong to.
    tasks
        OpenSim's setup of inverse kinematics or its task set (.xml): weights of markers and coordinates. Without it all
        markers of the model count alike.
    follow
        Coordinates over time (.mot, .sto, .csv) that tasks of OpenSim's kind from_file track.
    marker_set
        Markers of the model from a file of their own (.xml with a MarkerSet) in place of the model's.
    markers_map
        Names of recorded markers as the model calls them: RHEE=R.Heel,LHEE=L.Heel, or a file with a pair in each line.
        For segments and sensors their bodies: l_thigh=femur_l.
    naming
        Recorded markers known by their marker set: auto recognises it from the labels, or its name (plug-in-gait,
        helen-hayes, opencap, …). The model's markers take the recording's labels, missing ones are placed from a table.
    model_setup
        Set-up of a public full-body model: weights of markers. auto knows the model by its name or bodies; or
        gait2392, hamner, rajagopal, laiuhlrich. Includes `naming` auto.
    weight
        Weight of a marker over that of `tasks`, of a segment's orientation or its origin: R.Heel=10, pelvis_origin=0;
        0 leaves it out. May be given again.
    hold
        Coordinate held near a value (deg, m; rad where the model couples it to others): subtalar_angle_r=5.2. May be
        given again.
    fill
        Longest gap [s] over which coordinates that no marker determines are filled by a spline; longer ones stay empty.
    analog
        Write the other analog channels of a .c3d, EMG among them, at their own rate: analog.sto.
    bids
        Also write markers and coordinates as a BIDS dataset of motion (folder bids), named by subject, task and, if
        any, ses, acq, run: sub-P1_task-walk_run-1.
    axes
        Which of the markers' axes are the model's x, y and z: x,z,-y where the laboratory's z is up.
    c3d_unit
        Unit of places in .c3d files whose own, POINT:UNITS, is empty.
    time
        First and last time [s]: 0.4:1.6.

    Gait cycles
    -----------
    events
        Heel strikes of a side [s], between which the coordinates are averaged over the gait cycle: right=0.63,1.86. May
        be given again. Or a table side, event, time [s] (heel strike, toe off), with recording where it is for several.
        Those of a .c3d file count without it.
    part
        Use only this first part of each cycle: 60%, or stance, which ends at the toe off.

    Segments and sensors
    --------------------
    calibration
        File like the recording, in whose first frame the person stands as the model does by default; by default the
        recording itself. How segments lie in their bodies comes from it.
    heading
        Segment and its axis that points where its body's x axis does in the calibration: pelvis_imu=-z. Without it the
        person faces the x axis of the recording.

    Angles of joints
    ----------------
    knee
        Knee whose angles after Grood and Suntay are written: right=femur_r,tibia_r, the bodies as the model calls them,
        x forward, y up and z to the right in both. May be given again.
    joint_angles
        Write the angles of joints that turn about several axes in this form as well: ISB (ZXY: flexion, adduction,
        rotation; by its name, of a shoulder YXY), another sequence of the turned axes of the joint's frames such as
        XYZ, or quaternion.
    """

    over_time: ClassVar[bool] = True
    writes: ClassVar[str] = """
    Writes ik.mot (degrees and metres, for OpenSim), markers.csv (distance of each marker from the model),
    MARKERS_ik_marker_errors.sto (squared error, RMS and largest of each frame, as OpenSim has them), segments.csv in
    place of both for segments and sensors (angle and distance of each from the model), knees.csv with `knee`,
    angles.csv with `joint_angles`, cycles.csv where heel strikes are known, a dataset in bids with `bids`, ik.json,
    report.html (a moving skeleton) and run.json into OUT.
    """

    markers: Path
    _: KW_ONLY
    model: Path
    tasks: Path | None = None
    follow: Annotated[Path | None, Requires("tasks")] = None
    marker_set: Path | None = None
    markers_map: str | None = None
    naming: Annotated[str | None, Excludes("markers_map"), Excludes("tasks")] = None
    model_setup: Annotated[str | None, Excludes("markers_map"), Excludes("tasks")] = None
    weight: Texts = ()
    hold: Texts = ()
    fill: Annotated[float, GAP] = 0.1
    calibration: Path | None = None
    heading: Expression | None = None
    knee: Texts = ()
    joint_angles: JointAngleForm | None = None
    events: Texts = ()
    part: CyclePart | None = None
    analog: bool = False
    bids: str | None = None
    axes: Expression | None = None
    c3d_unit: C3dUnit = None
    time: TimeSpan | None = None

    def refuse_impossible(self) -> None:
        """Names that BIDS does not allow."""
        if self.bids is not None:
            BidsName.of(self.bids)
