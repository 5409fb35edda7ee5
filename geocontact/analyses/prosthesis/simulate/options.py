"""What a simulation of a prosthetic stance may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

from geocontact.analyses.frame.marks import (
    BodyMass,
    C3dUnit,
    Excludes,
    Expression,
    Fraction,
    Length,
    Needs,
    PartLength,
    Requires,
    Spelled,
    TimeSpan,
)
from geocontact.analyses.frame.options import Options
from geocontact.analyses.prosthesis.ranges import (
    FULCRUM,
    LIMB,
    PERSON,
    RESIDUAL,
    TURNS,
    require_one_residual,
    require_one_socket,
    require_turns,
    require_walks,
)
from geocontact.data.errors import InputError
from geocontact.data.plausible import AGE, CUTOFF, GAP, SHIFT


@dataclass(frozen=True)
class ProsthesisSimulateOptions(Options):
    """Ground reaction under a variable-stiffness prosthetic foot along a recorded walk, prosthetic side alone.

    Parameters
    ----------
    markers
        Walking trial (.trc, .c3d, .csv): markers of pelvis, thigh, socket and foot. With `coordinates` only compared.

    The person
    ----------
    static
        Standing trial with all markers, the foot flat on the floor.
    mass
        Mass of the body with the prosthesis; that of `model` where there is one.
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
    functional
        Trial in which the thigh swings in all directions: gives the hip's centre, else a regression does.

    The foot
    --------
    foot
        Description of another foot (.toml), as `prosthesis keel` reads and leaves it.
    setting
        Setting of the foot: low, medium or high, 10, 19 or 32 N/mm, or one of its own file.
    fulcrum
        Place of the fulcrum from the keel's posterior end in place of a setting; 66 to 151 mm on the shipped foot.
    schedule
        Of a semi-active foot, in place of a setting (.csv): what setting or fulcrum [mm] from which stride [-],
        time [s], speed [m/s] or phase [%] on. Every whole stance on `plate` is simulated, each at its own fulcrum.
    law
        Numbers of the sole (.toml), as `prosthesis calibrate` leaves them; built in by default. With them go height
        and pitch of the foot relative to its standing trial, where that is `static`.
    socket
        Bushing between residual limb and socket: as_meant (10 N m/deg) or as_printed (10 N mm/deg).
    socket_numbers
        Stiffness and damping of the socket in a file (.toml), in place of `socket`.

    The ground
    ----------
    ground
        plane:nx,ny,nz,offset (all x with n.x = offset [m]), or stairs:h0,x1:h1,x2:h2 (height h1 [m] from x1 on, y up),
        in the markers' axes; the floor y = 0 by default.

    Force plates
    ------------
    plates
        Ground reactions in the markers' axes (.mot, .sto, .c3d, .csv).
    other_plate
        Name or number of the plate under the other foot: its force stands for the other leg.
    plate
        Name or number of the plate under the prosthetic foot, to compare with.
    score
        What is compared with the plate: its stance, or as the study of the variable-stiffness foot does, also 0.25 s
        of swing on both sides, with centres of pressure low-passed at 6 Hz, which makes errors smaller.

    The motion
    ----------
    coordinates
        Motion of `model` (.mot, .sto, .csv) as `ik` writes it, in place of markers: its pelvis, thigh and socket.
        Lengths in m, angles in the unit that the file states; x forward, y up, as the plates.
    model
        Model of both legs that `prosthesis scale` made of `static`; gives hip, knee and mass as well.
    cutoff
        Zero-lag low-pass of the recorded coordinates [Hz]; 0 leaves them as they are.
    socket_turns
        Most fits after the first, each with the socket's simulated motion removed from its markers. With 0 that motion
        is counted twice: in the leg's angles and again in the bushing.
    gap_limit
        Longest time for which a coordinate may be unknown [s].
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
        First and last time [s]: 0.4:1.6. It has to begin before touch-down.

    Errors of the markers
    ---------------------
    walks
        Draws of the markers' errors, along each of which the stance is simulated again: a band of forces, centre of
        pressure and ankle moment. A draw takes as long as the stance.
    marker_error
        Standard deviation of each coordinate of a marker [mm], half of its variance from frame to frame and half
        slowly; 0.5 mm by default, which is invented. Skin moves by millimetres.
    seed
        Seed of the draws.

    Check of the model
    ------------------
    stand_still
        Simulate 10 s of standing still as well, the other foot under half of the weight: how much of the other half
        the foot's force misses in the end.
    """

    over_time: ClassVar[bool] = True
    writes: ClassVar[str] = """
    Writes stance.csv, errors.csv and curves.csv with a force plate, strides.csv with `schedule`, band.csv with `walks`,
    numbers.csv with the source of every number, coordinates.sto, ground_reaction.mot and .xml (external loads for
    OpenSim and `geocontact id`), paraview, a figure, report.html (moving foot with forces) and run.json into OUT.
    """

    markers: Path | None = None
    _: KW_ONLY
    static: Path | None = None
    mass: Annotated[BodyMass | None, PERSON] = None
    side: Literal["right", "left"] = "right"
    sex: Literal["male", "female"] = "male"
    age: Annotated[float | None, AGE] = None
    residual: Annotated[Fraction, RESIDUAL, Spelled(default="45%")] = 0.45
    residual_length: Annotated[PartLength | None, LIMB] = None
    residual_markers: str | None = None
    functional: Annotated[Path | None, Excludes("model", "the hip's centre is the model's")] = None
    foot: Path | None = None
    setting: str = "medium"
    fulcrum: Annotated[PartLength | None, FULCRUM] = None
    schedule: Annotated[Path | None, Requires("plate")] = None
    law: Path | None = None
    socket: Literal["as_meant", "as_printed"] = "as_meant"
    socket_numbers: Path | None = None
    ground: Expression | None = None
    plates: Path | None = None
    other_plate: str | None = None
    plate: str | None = None
    score: Literal["stance", "study"] = "stance"
    coordinates: Annotated[Path | None, Needs("model", "such as amputee_ik.osim of `prosthesis scale`")] = None
    model: Annotated[Path | None, Requires("coordinates")] = None
    cutoff: Annotated[float, CUTOFF] = 6.0
    gap_limit: Annotated[float, GAP] = 0.2
    socket_turns: int = TURNS
    machine_code: bool = True
    markers_map: str | None = None
    axes: Expression | None = None
    c3d_unit: C3dUnit = None
    time: TimeSpan | None = None
    walks: Annotated[int | None, Excludes("coordinates", "the markers are those of a fit, without its errors")] = None
    marker_error: Annotated[Length | None, SHIFT, Requires("walks")] = None
    seed: Annotated[int | None, Requires("walks")] = None
    stand_still: bool = False

    @property
    def motion(self) -> Path:
        """The file that the motion is of."""
        return self.coordinates or self.markers or Path()

    def refuse_impossible(self) -> None:
        """No motion, nothing to scale with, or nothing that stands for the other leg."""
        if self.markers is None and self.coordinates is None:
            remedy = "give a walking trial, or `coordinates` with `model`"
            raise InputError("", "`markers`", "neither markers nor `coordinates` are given", remedy)
        require_one_residual(self.residual, self.residual_length, self.residual_markers)
        if self.static is None:
            what = "no standing trial: the leg's lengths and the markers' places are not known"
            raise InputError(self.motion, "`static`", what, "give a trial of quiet standing with all markers")
        if self.mass is None and self.model is None:
            raise InputError("", "`mass`", "the mass of the person is not known", "give for example 77.3")
        if self.plates is None or self.other_plate is None:
            what = "the force under the other foot is not known: the pelvis, free to fall, would"
            raise InputError("", "`other_plate`", what, "give `plates` and the name of the plate under the other foot")
        if self.plate == self.other_plate:
            what = f"{self.plate} is named for both feet"
            raise InputError("", "`plate`", what, "each foot needs a plate of its own")
        if self.plate is None and self.score != "stance":
            raise InputError("", "`score`", "without a plate nothing is compared", "name the `plate`")
        if self.schedule is not None and (self.fulcrum is not None or self.setting != "medium"):
            raise InputError("", "`schedule`", "it stands in place of `setting` and `fulcrum`", "give one of them")
        require_turns(self.socket_turns)
        require_walks(self.walks)
        require_one_socket(self.socket, self.socket_numbers)
