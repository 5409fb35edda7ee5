"""What a simulation of a shoulder exoskeleton may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

from geocontact.analyses.frame.marks import (
    BodyMass,
    C3dUnit,
    Expression,
    Length,
    Needs,
    PartMass,
    Requires,
    Spelled,
    TimeSpan,
    Typed,
)
from geocontact.analyses.frame.options import Options
from geocontact.analyses.shoulder.shared_options import (
    ANKLES,
    CURRENT,
    HAND_TOOL,
    HEIGHT,
    PUSH,
    Level,
    require_share,
)
from geocontact.data.errors import InputError
from geocontact.data.plausible import AGE, CUTOFF, GAP, JOINT_ANGLE, MASS, SHIFT

FEWEST_DRAWS, MOST_DRAWS = 20, 1000
"""Numbers of draws of marker errors: the outer ones of 20 hold 90 %, more than 1000 take minutes."""

Elevations = Annotated[
    tuple[float, ...],
    Typed("rad", "shoulder.shared_options:elevations", "gc.deg(39, 129)"),
    Spelled("elevations-deg", "elevations_deg", dashed=True),
    JOINT_ANGLE,
]


@dataclass(frozen=True)
class ShoulderSimulateOptions(Options):
    """Motion and interface forces of a shoulder exoskeleton along recorded human motion, by its own dynamics.

    Parameters
    ----------
    markers
        Marker trajectories (.trc, .c3d, .csv), of a laboratory or of a model (`geocontact markers`): humerus_rup,
        humerus_rdn, humerus_lup, humerus_ldn, Lucy_MC, Lucy_Mleft, T10; a person without the device by markers of
        trunk, shoulders and elbows, to which it is attached virtually.

    The device
    ----------
    device
        lucy, lucy_new_cylinder (32 mm, with its mass), lucy_new_cylinder_massless, or a file (.toml) with numbers.
    person
        Lengths of the wearer (.toml) to which the device is adjusted: upper_arm, shoulder_width, torso.
    level
        Support level: share of the cylinder's force, 0 to 100%.
    profile
        Support profile (factors.csv of `geocontact shoulder optimise`): a factor on the level in each work phase, as
        the device's controller detects it from its own arm and the tool's current.
    profile_name
        Which of its profiles; the first by default.
    task
        Task whose factors count, where the profile has several.
    dominant
        Side of the dominant hand; right by default.
    seed
        Seed of the noise of the controller's sensors, where the device's file states it, and of marker errors; 0 by
        default.
    side
        Arms that are simulated.
    cuff
        How the cuff holds the arm: point, a sphere in a tube as in the paper, or surface, a padded cuff around the arm
        (its first run compiles for half a minute).
    sensitivity
        Also write the sensitivity to each number of the device.
    elevations
        Elevations of the shoulder at which the device's joints and forces are listed while the arm is lifted, such as
        39,129; the page opens at the first one.

    The person
    ----------
    mass
        Mass of the body: adds person.csv, loads of shoulder, elbow and lower back and sway, without and with the
        device, while the person keeps the motion or the shoulder's torque. Markers of elbow, wrist and finger are
        needed.
    sex
        Of the table of segments; male by default.
    age
        Age of a child [years], 6 or more: masses of segments are those of boys of that age.
    height
        Stature [m], for the sway; the mean of the sex by default.
    tool_mass
        Of the tool, in the dominant hand.
    push
        Upward force of the dominant hand on the work while the tool runs [N].
    ankle_stiffness
        Stiffness of the ankles with their reflexes over m g h, more than 1; 1.5 by default (invented).

    The motion
    ----------
    cutoff
        Zero-lag low-pass of the markers [Hz]; 0 leaves them as they are.
    marker_error
        Standard deviation of how far each arm marker sits from its place, along each axis of the upper arm: adds
        marker_band.csv, 95% bands of elevation and forces.
    draws
        Draws of these errors; 40 by default.
    gap_limit
        Longest time for which a marker may be out of sight [s].
    upright
        First and last time of an upright stance [s], such as 0:0.5: it fixes the inclination of T10. Without it T10 is
        taken to lie straight below Lucy_MC.
    tool
        When the tool runs (.csv): a column event [-] of 0 and 1, or current [A].
    tool_current
        Current from which it runs [A]; 1 by default.
    markers_map
        Names of recorded markers as they are called here: R_UP=humerus_rup, or a file with a pair in each line.
    axes
        Which of the markers' axes are x, y (upwards) and z of OpenSim's: x,z,-y where the laboratory's z is up.
    c3d_unit
        Unit of places in .c3d files whose own, POINT:UNITS, is empty.
    time
        First and last time [s]: 0.4:1.6.
    """

    over_time: ClassVar[bool] = True
    writes: ClassVar[str] = """
    Writes right.csv and left.csv, numbers.csv with the source of every number of the device, levers.csv with length and
    lever of its cylinder, person.csv with `mass`, marker_band.csv with `marker_error`, sensitivity.csv with
    `sensitivity`, at_elevation.csv with `elevations`, angles.sto, interface_forces.mot and .xml (external loads for
    OpenSim and `geocontact id`), paraview, plane (for `geocontact gap gather`), a figure, report.html (moving arms with
    forces) and run.json into OUT.
    """

    markers: Path
    _: KW_ONLY
    device: str = "lucy"
    person: Path | None = None
    level: Level = 1.0
    profile: Annotated[Path | None, Needs("tool", "give the tool's current, which the controller needs")] = None
    profile_name: Annotated[str | None, Requires("profile")] = None
    task: Annotated[str | None, Requires("profile")] = None
    dominant: Annotated[Literal["right", "left"] | None, Requires("profile", alternative="mass")] = None
    seed: Annotated[int | None, Requires("profile", alternative="marker_error")] = None
    side: Literal["both", "right", "left"] = "both"
    cuff: Literal["point", "surface"] = "point"
    sensitivity: bool = False
    elevations: Elevations | None = None
    mass: Annotated[BodyMass | None, MASS] = None
    sex: Annotated[Literal["female", "male"] | None, Requires("mass")] = None
    age: Annotated[float | None, Requires("mass"), AGE] = None
    height: Annotated[float | None, Requires("mass"), HEIGHT] = None
    tool_mass: Annotated[PartMass | None, Requires("mass"), HAND_TOOL] = None
    push: Annotated[
        float | None, Requires("mass"), Needs("tool", "give `tool`, which says when it is pushed"), PUSH
    ] = None
    ankle_stiffness: Annotated[float | None, Requires("mass"), ANKLES] = None
    cutoff: Annotated[float, CUTOFF] = 6.0
    marker_error: Annotated[Length | None, SHIFT] = None
    draws: Annotated[int | None, Requires("marker_error")] = None
    gap_limit: Annotated[float, GAP] = 0.2
    upright: TimeSpan | None = None
    tool: Path | None = None
    tool_current: Annotated[float | None, Requires("tool"), CURRENT] = None
    markers_map: str | None = None
    axes: Expression | None = None
    c3d_unit: C3dUnit = None
    time: TimeSpan | None = None

    def refuse_impossible(self) -> None:
        """A level that no cylinder has, draws that are too few for a band or take too long."""
        require_share(self.level, "level", "50%")
        if self.draws is not None and not FEWEST_DRAWS <= self.draws <= MOST_DRAWS:
            what = f"{self.draws} is not between {FEWEST_DRAWS} and {MOST_DRAWS}"
            raise InputError("", "`draws`", what, "give for example 40")
