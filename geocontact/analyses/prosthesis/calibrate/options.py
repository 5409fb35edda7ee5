"""What a calibration of a foot may be asked for."""

from __future__ import annotations

import math
from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

from geocontact.analyses.frame.marks import (
    BodyMass,
    C3dUnit,
    Degrees,
    Expression,
    Fraction,
    Length,
    PartLength,
    Spelled,
)
from geocontact.analyses.frame.options import Options
from geocontact.analyses.prosthesis.ranges import ADULT, FULCRUM
from geocontact.data.errors import InputError
from geocontact.data.plausible import CUTOFF, GAP, NOISE, SHIFT, SPEED, TILT

MOST_STARTS, PITCH = 1000, math.radians(0.5)


@dataclass(frozen=True)
class ProsthesisCalibrateOptions(Options):
    """Stiffness, damping and friction of the zones of a prosthetic foot from recorded stances.

    Parameters
    ----------
    markers
        Walking trial (.trc, .c3d, .csv) with the markers of socket, adapter and heel.
    further
        More stances of the person on this foot (.toml, as `prosthesis compare` reads it), at any setting, fitted
        together with this one: those marked as `calibrated`, or all if none is.

    The person
    ----------
    static
        Standing trial with all markers, the foot flat on the floor.
    mass
        Mass of the body with the prosthesis.
    side
        Side of the prosthesis.

    The foot
    --------
    foot
        Description of another foot (.toml), as `prosthesis keel` reads and leaves it.
    setting
        Stiffness of the foot in this trial: low, medium or high, 10, 19 or 32 N/mm.
    fulcrum
        Place of the fulcrum from the keel's posterior end in place of a setting; 66 to 151 mm on the shipped foot.
    law
        Usual numbers of the sole (.toml), around which the person's numbers are estimated; built in by default. The
        offset of the foot from its standing trial is identified anew.

    Force plates
    ------------
    plates
        Ground reactions in the markers' axes (.mot, .sto, .c3d, .csv).
    plate
        Name or number of the plate under the prosthetic foot.
    other_plate
        Name or number of the plate under the other foot: for `full`, where its force stands for the other leg.

    The search
    ----------
    full
        Refine the fit along the recorded poses, height and pitch of the foot included, with the whole model of the
        stance: the leg's inertia, the socket and the free pelvis. The trial needs the markers of pelvis and thigh too.
    starts
        Starts spread over the bounds, in addition to the usual numbers.
    seed
        Seed of the starts.
    level
        Probability of the intervals.
    machine_code
        Machine code of the equations, kept for later runs. Without it, CasADi interprets them: the same, but slower.

    What was recorded with which error
    ----------------------------------
    force_noise
        Standard deviation of a component of the plate's force [N].
    height_error
        Standard deviation of the foot's height, constant over the stance [mm].
    pitch_error
        Standard deviation of the foot's pitch, constant over the stance.
    speed_error
        Standard deviation of the foot's speed [m/s]: its error after filtering the markers.

    The motion
    ----------
    cutoff
        Zero-lag low-pass of the markers [Hz]; 0 leaves them as they are. 6 Hz would smooth the touch-down away.
    gap_limit
        Longest time for which a marker may be out of sight [s].
    markers_map
        Names of recorded markers as they are called here: R_HIP=RASI, or a file with a pair in each line.
    axes
        Which of the markers' axes are x (forward along the walk), y (upwards) and z: x,z,-y where the laboratory's z
        is up.
    c3d_unit
        Unit of places in .c3d files whose own, POINT:UNITS, is empty.
    """

    writes: ClassVar[str] = """
    Writes numbers.csv (value, interval, and whether the stance identifies it), stance.csv (plate and model), law.toml
    (the calibrated force law, as `geocontact cop` reads it, and the offset of the foot from its standing trial),
    stances.csv with `further`, a figure, report.html and run.json into OUT.
    """

    markers: Path
    _: KW_ONLY
    static: Path
    mass: Annotated[BodyMass, ADULT]
    plates: Path
    further: Path | None = None
    side: Literal["right", "left"] = "right"
    foot: Path | None = None
    setting: str = "medium"
    fulcrum: Annotated[PartLength | None, FULCRUM] = None
    law: Path | None = None
    plate: str | None = None
    other_plate: str | None = None
    full: bool = False
    starts: int = 8
    seed: int = 0
    level: Annotated[Fraction, Spelled(default="0.95")] = 0.95
    machine_code: bool = True
    force_noise: Annotated[float, NOISE] = 3.0
    height_error: Annotated[Length, SHIFT, Spelled(default="0.5mm")] = 0.5e-3
    pitch_error: Annotated[Degrees, TILT, Spelled(default=0.5)] = PITCH
    speed_error: Annotated[float, SPEED] = 20e-3
    cutoff: Annotated[float, CUTOFF] = 15.0
    gap_limit: Annotated[float, GAP] = 0.2
    markers_map: str | None = None
    axes: Expression | None = None
    c3d_unit: C3dUnit = None

    def refuse_impossible(self) -> None:
        """No starts at all, a probability that is none, a force without noise."""
        if not 0 <= self.starts <= MOST_STARTS:
            what = f"{self.starts} is not 0 to {MOST_STARTS}"
            raise InputError("", "`starts`", what, "give for example 12")
        if not 0.0 < self.level < 1.0:
            raise InputError("", "`level`", f"{self.level:g} is not between 0 and 1", "give for example 0.95")
        if self.force_noise <= 0.0:
            raise InputError("", "`force_noise`", "0 N gives samples no limit to their weight", "give for example 3")
        self._refuse_half_of_the_full_model()

    def _refuse_half_of_the_full_model(self) -> None:
        if self.full and self.other_plate is None:
            what = "the force under the other foot is not known: the pelvis, free to fall, would"
            raise InputError("", "`other_plate`", what, "name the plate under the other foot, or leave `full` out")
        if not self.full and (self.other_plate is not None or not self.machine_code):
            name = "`machine_code`" if self.other_plate is None else "`other_plate`"
            raise InputError("", name, "it is of no use along recorded poses", "give `full` as well")
        if self.full and self.plate == self.other_plate:
            what = f"{self.plate} is named for both feet"
            raise InputError("", "`plate`", what, "each foot needs a plate of its own")
