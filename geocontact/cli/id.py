"""`geocontact id`: the options of the command; the work is in `id_analysis`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

Each = Parameter(negative="", consume_multiple=False, allow_leading_hyphen=True)
Dashed = Parameter(allow_leading_hyphen=True)


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class IdOptions:
    """Options of inverse dynamics as typed.

    Parameters
    ----------
    out
        Folder for the results.
    model
        OpenSim model (.osim): masses, inertias, joints.
    loads
        OpenSim's external loads (.xml): which force plate acts on which body. Without it nothing but gravity acts.
    plates
        File of force plates (.mot, .sto, .c3d) in place of --loads, with --plate.
    plate
        Which plate acts on which body, by name or number: 1=calcn_r. May be given again.
    axes
        Which of the plates' axes are the model's x, y and z: x,z,-y where the laboratory's z is up.
    threshold
        Force [N] below which a plate counts as unloaded, since the point of a small force means little. OpenSim has
        none; a warning names forces that pass far from their body.
    cutoff
        Low-pass of the coordinates [Hz], OpenSim's filter; 0 leaves them as they are.
    time
        First and last time [s] that are written: 0.4:1.6. The filter sees the whole recording.
    angles
        Unit of angles where the file does not say it: deg or rad.
    """

    out: Path
    model: Path
    loads: Path | None = None
    plates: Path | None = None
    plate: Annotated[tuple[str, ...], Each] = ()
    axes: Annotated[str | None, Dashed] = None
    threshold: float = 0.0
    cutoff: float = 6.0
    time: Annotated[str | None, Dashed] = None
    angles: str | None = None


def inverse_dynamics(coordinates: Path, /, *, options: IdOptions) -> int:
    """Joint moments and forces of a recorded motion: Newton and Euler, with the measured ground reactions.

    Writes id.sto (for OpenSim), id.json with what is left over at the joint to the ground, report.html and run.json
    into OUT.

    Parameters
    ----------
    coordinates
        Coordinates of the model over time (.mot, .sto, .csv), as `geocontact ik` writes them.
    """
    from geocontact.analyses.motion.inverse_dynamics.run import analyse  # numpy and friends: not for --help

    return analyse(coordinates, options)
