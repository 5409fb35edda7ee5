"""What the coordinates of the planar chain may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

from geocontact.analyses.frame.marks import C3dUnit, Expression, Needs, Requires, TimeSpan
from geocontact.analyses.frame.options import Options
from geocontact.data.plausible import TALL, Plausible
from geocontact.data.units import Unit

BELT = Plausible("the speed of a belt", Unit("m/s", "m/s", 1.0), (0.0, 8.0))

APART = "without its force a strap's stiffness and place and the person's torques are not separable"


@dataclass(frozen=True)
class StandingCoordinatesOptions(Options):
    """Planar coordinates of standing up from a whole body's joint angles, with plates and person: a study to calibrate.

    Parameters
    ----------
    motion
        Joint angles of the whole body (.mot, .sto, .csv), such as ik.mot.
    model
        Their OpenSim model (.osim).
    leg
        Both legs about their mean, or one leg, whose stances of walking are cut by its plate.
    joints
        Beginnings of the coordinates of hip, knee and ankle, which end in _r and _l.
    plates
        Force plates of the same recording.
    feet
        Plates under the feet by name or number, added up; by default those whose centre of pressure is under the feet.
    chair
        The chair's plate by name or number; by default the one that lies under the hips.
    worn
        Angles of the hinges of an exoskeleton that was worn, exo_ankle, exo_knee, exo_hip (.mot, .sto), on the clock of
        the motion: the study then has phases A and B, and is what `predict` takes.
    torques
        Torques of all joints and hinges of both legs (.sto), with `worn`.
    strap
        Normal force of the thigh's strap (.csv), which `worn` needs: else contacts and torques are not separable.
    belt
        Speed backwards of the treadmill that is walked on [m/s]: x is then that of the belt.
    height
        Body height [m]; from the lengths of shank and thigh by default.
    axes
        Which of the plates' axes are the model's x, y and z: x,z,-y where the laboratory's z is up.
    c3d_unit
        Unit of places in .c3d files whose own, POINT:UNITS, is empty.
    time
        First and last time [s]: 0.4:1.6.
    """

    writes: ClassVar[str] = """
    Writes coordinates.mot, deviations.csv (from the plane, and of the legs from each other), segments.csv, plates.mot
    (loads in the plane, with `plates`), copies of `torques` and `strap` under these names (with `worn`), study.toml
    for `sit-to-stand calibrate` with a trial for each movement or stance, a figure, report.html and run.json into OUT.
    """

    over_time: ClassVar[bool] = True

    motion: Path
    _: KW_ONLY
    model: Path
    leg: Literal["both", "right", "left"] = "both"
    joints: str = "hip_flexion,knee_angle,ankle_angle"
    plates: Path | None = None
    feet: Annotated[str | None, Requires("plates")] = None
    chair: Annotated[str | None, Requires("plates")] = None
    worn: Annotated[Path | None, Needs("plates"), Needs("torques"), Needs("strap", APART)] = None
    torques: Annotated[Path | None, Requires("worn")] = None
    strap: Annotated[Path | None, Requires("worn")] = None
    belt: Annotated[float, BELT] = 0.0
    height: Annotated[float | None, TALL] = None
    axes: Annotated[Expression | None, Requires("plates")] = None
    c3d_unit: C3dUnit = None
    time: TimeSpan | None = None
