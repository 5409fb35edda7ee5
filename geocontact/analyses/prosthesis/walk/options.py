"""What a walk of both legs may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

from geocontact.analyses.frame.marks import BodyMass, C3dUnit, Expression, Fraction, PartLength, Spelled, TimeSpan
from geocontact.analyses.frame.options import Options
from geocontact.analyses.prosthesis.ranges import (
    FULCRUM,
    LIMB,
    PERSON,
    RESIDUAL,
    STATURE,
    require_one_residual,
)
from geocontact.data.errors import InputError
from geocontact.data.multibody.joint_angle_forms import JointAngleForm
from geocontact.data.plausible import AGE, CUTOFF, GAP


@dataclass(frozen=True)
class ProsthesisWalkOptions(Options):
    """Both legs in motion: along recorded angles, and by the torques that make them; forces and joint moments.

    Parameters
    ----------
    markers
        Walking trial (.trc, .c3d, .csv) with the markers of pelvis and both legs, as `prosthesis scale` has them.
    by
        angles: recorded; the pelvis' advance and height, socket and keel are found. torques: from the beginning of
        single support on the prosthesis all coordinates are free, and the torques of that motion, with the residuals on
        the pelvis, have to make it again.
    intact
        Load of the ground on the intact foot: that of its plate, or that of spheres under it.

    The person
    ----------
    static
        Standing trial with the markers of both legs, both feet flat on the floor.
    functional
        Trial in which hips and knees of both legs and the intact ankle are moved: gives centres and axes.
    mass
        Mass of the body with the prosthesis.
    height
        Height of the person [m]; from the lengths of the legs by default.
    side
        Side of the prosthesis.
    sex
        Row of the table of segment masses.
    age
        Age of a child [years], 6 or more: masses of segments are those of boys of that age.
    residual
        Share of the shank's length that is left; 45% by default, which is invented.
    residual_length
        Length of the residual limb from the knee's centre to its end, in place of a share.
    residual_markers
        Two markers of the standing trial at the residual limb's ends, such as RKNE,REND, in place of a length.

    The foot
    --------
    foot
        Description of another foot (.toml), as `prosthesis keel` reads and leaves it.
    setting
        Setting of the foot: low, medium or high, 10, 19 or 32 N/mm, or one of its own file.
    fulcrum
        Place of the fulcrum from the keel's posterior end in place of a setting; 66 to 151 mm on the shipped foot.
    law
        Numbers of the sole (.toml), as `prosthesis calibrate` leaves them; built in by default.

    Force plates
    ------------
    plates
        Ground reactions in the markers' axes (.mot, .sto, .c3d, .csv).
    other_plate
        Name or number of the plate under the intact foot.
    plate
        Name or number of the plate under the prosthetic foot, to compare with.

    The motion
    ----------
    cutoff
        Zero-lag low-pass of the coordinates [Hz]; 0 leaves them as they are.
    gap_limit
        Longest time for which a coordinate may be unknown [s].
    joint_angles
        Form of the angles in angles.csv, of joints that turn about several axes: ISB (ZXY: flexion, adduction,
        rotation; by its name, of a shoulder YXY), another sequence of the turned axes of the joint's frames such as
        XYZ, or quaternion.
    machine_code
        Machine code of the equations, kept for later runs. Without it, CasADi interprets them: the same, but slower.
    markers_map
        Names of recorded markers as they are called here: R_HIP=RASI, or a file with a pair in each line.
    axes
        Which of the markers' axes are x (forward along the walk), y (upwards) and z: x,z,-y where the laboratory's z
        is up.
    c3d_unit
        Unit of places in .c3d files whose own, POINT:UNITS, is empty.
    time
        First and last time [s]: 0.4:1.6. It has to begin before touch-down of the prosthesis.
    """

    over_time: ClassVar[bool] = True
    writes: ClassVar[str] = """
    Writes walk.csv (forces, centres of pressure, joint moments, residuals on the pelvis), moments.csv (peak and mean of
    each joint), work.csv (of each joint), angles.csv, coordinates.sto, errors.csv (beside the plates), played_back.csv
    with torques, a figure, report.html and run.json into OUT.
    """

    markers: Path
    _: KW_ONLY
    static: Path
    mass: Annotated[BodyMass, PERSON]
    plates: Path
    other_plate: str
    plate: str
    by: Literal["angles", "torques"] = "angles"
    intact: Literal["plate", "spheres"] = "plate"
    functional: Path | None = None
    height: Annotated[float | None, STATURE] = None
    side: Literal["right", "left"] = "right"
    sex: Literal["male", "female"] = "male"
    age: Annotated[float | None, AGE] = None
    residual: Annotated[Fraction, RESIDUAL, Spelled(default="45%")] = 0.45
    residual_length: Annotated[PartLength | None, LIMB] = None
    residual_markers: str | None = None
    foot: Path | None = None
    setting: str = "medium"
    fulcrum: Annotated[PartLength | None, FULCRUM] = None
    law: Path | None = None
    cutoff: Annotated[float, CUTOFF] = 6.0
    gap_limit: Annotated[float, GAP] = 0.2
    joint_angles: JointAngleForm = "ISB"
    machine_code: bool = True
    markers_map: str | None = None
    axes: Expression | None = None
    c3d_unit: C3dUnit = None
    time: TimeSpan | None = None

    def refuse_impossible(self) -> None:
        """One plate for both feet, two lengths of one limb."""
        require_one_residual(self.residual, self.residual_length, self.residual_markers)
        if self.plate == self.other_plate:
            what = f"{self.plate} is named for both feet"
            raise InputError("", "`plate`", what, "each foot needs a plate of its own")
