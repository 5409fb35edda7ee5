"""What a scaling of a person with a prosthesis may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

from geocontact.analyses.frame.marks import BodyMass, C3dUnit, Expression, Fraction, PartLength, PartMass, Spelled
from geocontact.analyses.frame.options import Options
from geocontact.analyses.prosthesis.ranges import (
    FULCRUM,
    LIMB,
    PERSON,
    PROSTHESIS,
    RESIDUAL,
    STATURE,
    require_one_residual,
)
from geocontact.data.errors import InputError
from geocontact.data.plausible import AGE


@dataclass(frozen=True)
class ProsthesisScaleOptions(Options):
    """A model of both legs of a person with a below-knee prosthesis, from markers while standing, for OpenSim.

    Parameters
    ----------
    static
        Standing trial (.trc, .c3d, .csv) with the markers of pelvis and both legs, both feet flat on the floor.
    functional
        Trial in which hips and knees of both legs and the intact ankle are moved: gives centres and axes, else a
        regression gives the hips, and markers give the rest.

    The person
    ----------
    mass
        Mass of the body with the prosthesis.
    height
        Height of the person [m]: how far trunk, head and arms reach, and compared with the lengths of the legs; from
        these by default.
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

    The prosthesis
    --------------
    prosthesis_mass
        Mass of socket, pylon and foot together; else invented.
    foot
        Description of another foot (.toml), as `prosthesis keel` reads and leaves it.
    setting
        Setting of the foot: low, medium or high, 10, 19 or 32 N/mm, or one of its own file.
    fulcrum
        Place of the fulcrum from the keel's posterior end in place of a setting; 66 to 151 mm on the shipped foot.

    The markers
    -----------
    markers_map
        Names of recorded markers as they are called here: R_HIP=RASI, or a file with a pair in each line.
    axes
        Which of the markers' axes are x (forward), y (upwards) and z: x,z,-y where the laboratory's z is up.
    c3d_unit
        Unit of places in .c3d files whose own, POINT:UNITS, is empty.
    """

    writes: ClassVar[str] = """
    Writes amputee.osim (socket and keel free, with springs), amputee_ik.osim (both held, for ik), segments.csv,
    joints.csv, markers.csv, numbers.csv, report.html and run.json into OUT.
    """

    static: Path
    _: KW_ONLY
    functional: Path | None = None
    mass: Annotated[BodyMass | None, PERSON] = None
    height: Annotated[float | None, STATURE] = None
    side: Literal["right", "left"] = "right"
    sex: Literal["male", "female"] = "male"
    age: Annotated[float | None, AGE] = None
    residual: Annotated[Fraction, RESIDUAL, Spelled(default="45%")] = 0.45
    residual_length: Annotated[PartLength | None, LIMB] = None
    residual_markers: str | None = None
    prosthesis_mass: Annotated[PartMass | None, PROSTHESIS] = None
    foot: Path | None = None
    setting: str = "medium"
    fulcrum: Annotated[PartLength | None, FULCRUM] = None
    markers_map: str | None = None
    axes: Expression | None = None
    c3d_unit: C3dUnit = None

    def refuse_impossible(self) -> None:
        """Nobody to weigh."""
        require_one_residual(self.residual, self.residual_length, self.residual_markers)
        if self.mass is None:
            raise InputError("", "`mass`", "the mass of the person is not known", "give for example 77.3")
