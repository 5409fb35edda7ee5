"""What the movements of a recording may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from geocontact.analyses.frame.marks import C3dUnit, Requires
from geocontact.analyses.frame.options import Options
from geocontact.data.plausible import TALL


@dataclass(frozen=True)
class StandingMovementsOptions(Options):
    """Cut a recording into its movements: standing up, sitting down, squats, with start and end of each.

    Parameters
    ----------
    coordinates
        Joint angles of the whole recording (.sto, .mot), with the columns of a study's `coordinates`.
    plates
        Force plates of the same recording.
    chair
        The chair's plate by name or number: without it a rise and a way down are named no further.
    feet
        The plate of the feet, for the written trials.
    height
        Body height, which makes the hip's height of the angles [m].
    c3d_unit
        Unit of places in .c3d files whose own, POINT:UNITS, is empty.
    """

    writes: ClassVar[str] = """
    Writes movements.csv (kind, start, end, seat-off or seat contact, force on the chair before and after), trials.toml
    (a [[trials]] of a study for each), a figure, report.html and run.json into OUT.
    """

    over_time: ClassVar[bool] = True

    coordinates: Path
    _: KW_ONLY
    plates: Annotated[Path | None, Requires("chair")] = None
    chair: Annotated[str | None, Requires("plates")] = None
    feet: Annotated[str | None, Requires("plates")] = None
    height: Annotated[float, TALL] = 1.75
    c3d_unit: C3dUnit = None
