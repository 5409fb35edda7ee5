"""What recordings are gathered."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import ClassVar

from geocontact.analyses.frame.marks import C3dUnit, Expression
from geocontact.analyses.frame.options import Options


@dataclass(frozen=True)
class GatherOptions(Options):
    """Make a gap case of recordings: pressure mats, force plates under a foot, loads of a knee, angles and moments.

    Parameters
    ----------
    settings
        A case.toml with a table [from.<trial>] for each trial: inputs = "inputs.csv" (time and input channels) and
        what was measured with them: <site> = "folder" that `geocontact mat` wrote, for each site;
        plates = "grf.mot" with plate = "name", for a foot; forces = "forces.csv" and areas = "area.csv", for a knee;
        inputs = "ik.mot" and outputs = "id.sto" with a table [columns]; outputs = "logger.csv" with units in its head.
    axes
        Which of the plates' axes are the foot's: x,z,-y where the laboratory's z is up.
    c3d_unit
        Unit of places in .c3d files whose own, POINT:UNITS, is empty.
    """

    over_time: ClassVar[bool] = True
    writes: ClassVar[str] = """
    Writes case.toml, trials/<id>.csv, for mats trials/<id>_<site>_cells.csv and <site>_layout.csv, the tables that
    SETTINGS names, and run.json into OUT, ready for `geocontact gap diagnose OUT`.
    """
    folder_help: ClassVar[str] = "Folder for the case."
    last_line: ClassVar[str] = "next: geocontact gap diagnose {out} `out` …"

    settings: Path
    _: KW_ONLY
    axes: Expression | None = None
    c3d_unit: C3dUnit = None
