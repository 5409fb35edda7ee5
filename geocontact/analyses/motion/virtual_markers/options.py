"""What virtual markers may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import ClassVar

from geocontact.analyses.frame.marks import AngleUnit
from geocontact.analyses.frame.options import Options


@dataclass(frozen=True)
class MarkersOptions(Options):
    """Where the markers of a model are along a motion: virtual markers by forward kinematics.

    Parameters
    ----------
    coordinates
        Coordinates of the model over time (.mot, .sto, .csv).
    model
        OpenSim model (.osim) with the markers.
    angles
        Unit of angles where the file does not say it: deg or rad.
    """

    over_time: ClassVar[bool] = True
    writes: ClassVar[str] = """
    Writes markers.trc [mm] and run.json into OUT.
    """

    coordinates: Path
    _: KW_ONLY
    model: Path
    angles: AngleUnit | None = None
