"""`geocontact markers`: the options of the command; the work is in `markers_analysis`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from cyclopts import Parameter


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class MarkersOptions:
    """Options of virtual markers as typed.

    Parameters
    ----------
    out
        Folder for the results.
    model
        OpenSim model (.osim) with the markers.
    angles
        Unit of angles where the file does not say it: deg or rad.
    """

    out: Path
    model: Path
    angles: str | None = None


def markers(coordinates: Path, /, *, options: MarkersOptions) -> int:
    """Where the markers of a model are along a motion: virtual markers by forward kinematics.

    Writes markers.trc [mm] and run.json into OUT.

    Parameters
    ----------
    coordinates
        Coordinates of the model over time (.mot, .sto, .csv).
    """
    from geocontact.analyses.motion.virtual_markers.run import analyse  # numpy and friends: not for --help

    return analyse(coordinates, options)
