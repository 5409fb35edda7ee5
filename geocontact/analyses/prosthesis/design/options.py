"""What the choice of a prosthetic foot may be asked for."""

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
from geocontact.analyses.prosthesis.ranges import ADULT, EDGE, FULCRUM, SLOPE
from geocontact.below_knee_prosthesis.design.aims import Aim
from geocontact.data.errors import InputError
from geocontact.data.plausible import CUTOFF, GAP, NOISE, SHIFT, TILT

FEWEST, MOST = 6, 600
"""Feet that may be drawn."""
PITCH = math.radians(0.5)


@dataclass(frozen=True)
class ProsthesisDesignOptions(Options):
    """Fulcrum, alignment or stiffness of a prosthetic foot that suits a person best, and whether the data identify it.

    Parameters
    ----------
    markers
        Walking trial (.trc, .c3d, .csv) with the markers of pelvis, socket, adapter and heel.

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
        Numbers of the sole (.toml), as `prosthesis calibrate` leaves them; built in by default. With them go height
        and pitch of the foot relative to its standing trial, where that is `static`.
    numbers
        Their intervals of 95 % (numbers.csv of `prosthesis calibrate`); the priors of any sole by default.

    Force plates
    ------------
    plates
        Ground reactions in the markers' axes (.mot, .sto, .c3d, .csv).
    plate
        Name or number of the plate under the prosthetic foot.

    The ground
    ----------
    slope
        Angle by which the ground rises forwards on which the foot is evaluated, negative downhill; the trial is on a
        floor.
    edge
        Place of a step on which the foot is evaluated, from the keel's posterior end; there is no ground behind it.

    Objective
    ---------
    vary
        What is changed: fulcrum, alignment (turn of the foot on the socket) or stiffness (of the keel).
    aim
        Peak or mean moment at ankle, socket, knee or hip, metabolic proxy (work of hip and knee over the efficiencies
        of muscle) or rate of loading: the least; energy that the keel returns: the most; radius of the roll-over
        shape: 0.3 of the leg's length.
    target
        Desired value of the aim instead [N m, J, m or N/s].
    intact
        Walking trial with a step of the intact foot; as near as can be to what it has is wanted then, of peak and
        mean ankle moment, radius and rate of loading. The standing trial shows the intact leg as well.
    intact_plates
        Ground reactions of that trial; those of the prosthetic foot's by default.
    intact_plate
        Name or number of the plate under the intact foot.
    together
        Whether the foot's alignment, 6 degrees to both sides, is varied together with fulcrum or stiffness.

    Validation
    ----------
    feet
        Drawn feet: numbers of the sole, keel and count of spheres that are not known.
    walks
        Drawn errors of markers and plate for each foot.
    seed
        Seed of the draws.
    level
        Probability of the intervals.
    marker_error
        Standard deviation of a marker's place along each axis [mm].
    pitch_error
        Standard deviation of the foot's pitch: how far it may not have stood flat. A law that knows the pitch better
        has its own.
    force_noise
        Standard deviation of a component of the plate's force [N].

    The motion
    ----------
    cutoff
        Zero-lag low-pass of the markers [Hz]; 0 leaves them as they are.
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
    Writes answers.csv (best value and interval for every aim), sweep.csv (outcomes with bands, angles or torques kept),
    ranges.csv (the limits between which each outcome lies), shapes.csv (roll-over shapes, ankle moment, energy), with
    `intact` intact.csv (values of an intact foot's step), numbers.csv (leg and foot as estimated from the trial),
    a figure, report.html and run.json into OUT.
    """

    markers: Path
    _: KW_ONLY
    static: Path
    mass: Annotated[BodyMass, ADULT]
    plates: Path
    side: Literal["right", "left"] = "right"
    foot: Path | None = None
    setting: str = "medium"
    fulcrum: Annotated[PartLength | None, FULCRUM] = None
    law: Path | None = None
    numbers: Path | None = None
    plate: str | None = None
    slope: Annotated[Degrees, SLOPE] = 0.0
    edge: Annotated[PartLength | None, EDGE] = None
    vary: Literal["fulcrum", "alignment", "stiffness"] = "fulcrum"
    aim: Aim = "radius"
    target: float | None = None
    intact: Path | None = None
    intact_plates: Path | None = None
    intact_plate: str | None = None
    together: bool = False
    feet: int = 12
    walks: int = 3
    seed: int = 0
    level: Annotated[Fraction, Spelled(default="0.95")] = 0.95
    marker_error: Annotated[Length, SHIFT, Spelled(default="0.5mm")] = 0.5e-3
    pitch_error: Annotated[Degrees, TILT, Spelled(default=0.5)] = PITCH
    force_noise: Annotated[float, NOISE] = 3.0
    cutoff: Annotated[float, CUTOFF] = 15.0
    gap_limit: Annotated[float, GAP] = 0.2
    markers_map: str | None = None
    axes: Expression | None = None
    c3d_unit: C3dUnit = None

    def refuse_impossible(self) -> None:
        """Too few draws, a probability that is none, a plate of a trial that is not named."""
        if not FEWEST <= self.feet <= MOST:
            raise InputError("", "`feet`", f"{self.feet} is not {FEWEST} to {MOST}", "give for example 12")
        if not 1 <= self.walks <= MOST:
            raise InputError("", "`walks`", f"{self.walks} is not 1 to {MOST}", "give for example 3")
        if self.together and self.vary == "alignment":
            raise InputError("", "`together`", "alignment is varied anyway", "vary fulcrum or stiffness with it")
        if not 0.0 < self.level < 1.0:
            raise InputError("", "`level`", f"{self.level:g} is not between 0 and 1", "give for example 0.95")
        if self.target is not None and not 0.0 < self.target < math.inf:
            raise InputError("", "`target`", f"{self.target:g} cannot be reached", "give a positive number")
        for name in ("intact_plates", "intact_plate"):
            if self.intact is None and getattr(self, name) is not None:
                raise InputError("", f"`{name}`", "no trial of the intact side is given", "give `intact` as well")
