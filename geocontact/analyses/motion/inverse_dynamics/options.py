"""What inverse dynamics may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from geocontact.analyses.frame.marks import (
    AngleUnit,
    C3dUnit,
    Excludes,
    Expression,
    ForceUnit,
    Requires,
    Texts,
    TimeSpan,
)
from geocontact.analyses.frame.options import Options
from geocontact.data.errors import InputError
from geocontact.data.plausible import CUTOFF, FORCE

TWICE = Excludes("loads", "with `loads` names the plates twice", "give one of them")


@dataclass(frozen=True)
class IdOptions(Options):
    """Joint moments and forces of a recorded motion: Newton and Euler, with the measured ground reactions.

    Parameters
    ----------
    coordinates
        Coordinates of the model over time (.mot, .sto, .csv), as `geocontact ik` writes them.
    model
        OpenSim model (.osim): masses, inertias, joints.
    loads
        OpenSim's external loads (.xml): which force plate acts on which body. Without it nothing but gravity acts.
    plates
        File of force plates (.mot, .sto, .c3d, .csv) in place of `loads`, with `plate`.
    plate
        Which plate acts on which body, by name or number: 1=calcn_r. May be given again.
    axes
        Which of the plates' axes are the model's x, y and z: x,z,-y where the laboratory's z is up.
    c3d_unit
        Unit of places in .c3d files whose own, POINT:UNITS, is empty.
    threshold
        Force [N] below which a plate counts as unloaded, since the point of a small force means little. OpenSim has
        none; a warning names forces that pass far from their body.
    cutoff
        Low-pass of the coordinates [Hz], OpenSim's filter; 0 leaves them as they are.
    time
        First and last time [s] that are written: 0.4:1.6. The filter sees the whole recording.
    events
        Heel strikes of a side [s], between which moments are averaged over the gait cycle: right=0.63,1.86. May be
        given again. Or a table side, event, time [s]. Without it the loads of the plates give them, by the side in the
        names of their bodies.
    angles
        Unit of angles where the file does not say it: deg or rad.
    exclude
        Passive forces of the model (coordinate limits, springs, bushings) that are left out, by name, by group of its
        force set, or all. May be given again. Muscles and actuators never act here.

    Muscles
    -------
    muscles
        Also estimate muscle forces: least squared activation that makes the moments. Their paths are
        asked of the opensim package, which the extra `muscles` installs.
    across
        Body beyond a joint whose contact force is computed from muscles and load: tibia_r for a knee.
    held
        Measured contact force of that joint over time (.csv .mot .sto): total, or medial and lateral, as forces.csv of
        `geocontact loadcells`. Muscles have to make it as well.
    held_unit
        Unit of these forces, unless each column says it.
    """

    over_time: ClassVar[bool] = True
    writes: ClassVar[str] = """
    Writes id.sto (for OpenSim), id.json with the residuals at the joint to the ground, cycles.csv where heel
    strikes are known, muscles.csv and contact.csv with `muscles`, report.html (a moving skeleton) and run.json into
    OUT.
    """

    coordinates: Path
    _: KW_ONLY
    model: Path
    loads: Path | None = None
    plates: Annotated[Path | None, TWICE] = None
    plate: Annotated[Texts, TWICE] = ()
    axes: Expression | None = None
    c3d_unit: C3dUnit = None
    threshold: Annotated[float, FORCE] = 0.0
    cutoff: Annotated[float, CUTOFF] = 6.0
    time: TimeSpan | None = None
    events: Texts = ()
    angles: AngleUnit | None = None
    exclude: Texts = ()
    muscles: bool = False
    across: Annotated[str | None, Requires("muscles", "give it too")] = None
    held: Annotated[Path | None, Requires("across", "say which joint")] = None
    held_unit: Annotated[ForceUnit | None, Requires("held", "leave it out")] = None

    def refuse_impossible(self) -> None:
        """Plates without bodies, axes without plates."""
        if (self.plates is None) != (not self.plate):
            what = "and `plate` belong together"
            raise InputError("", "`plates`", what, "write `plates` grf.c3d `plate` 1=calcn_r")
        if self.axes is not None and self.plates is None and self.loads is None:
            raise InputError("", "`axes`", "has no effect without plates", "leave it out")
