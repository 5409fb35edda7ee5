"""What a study of a shoulder exoskeleton may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from geocontact.analyses.frame.marks import C3dUnit, Expression
from geocontact.analyses.frame.options import Options
from geocontact.data.plausible import CUTOFF, GAP


@dataclass(frozen=True)
class StudyOptions(Options):
    """Simulate the arms of a study along the motions with and without the device, compared with logger and
    mat.

    Parameters
    ----------
    study
        Tasks, persons and trials (.toml). Trials with a level were recorded in the device: their arms are simulated,
        against `recorded` of the dominant one and `recorded_other`, and along the motion that `without` names.
    device
        lucy, lucy_new_cylinder (32 mm, with its mass), lucy_new_cylinder_massless, or a file (.toml) with numbers.

    The motion
    ----------
    cutoff
        Zero-lag low-pass of the markers [Hz]; 0 leaves them as they are.
    gap_limit
        Longest time for which a marker may be out of sight [s].
    markers_map
        Names of recorded markers as they are called here: R_UP=humerus_rup, or a file with a pair in each line; of all
        trials.
    axes
        Which of the markers' axes are x, y (upwards) and z of OpenSim's, of all trials: x,z,-y where z is up.
    c3d_unit
        Unit of places in .c3d files whose own, POINT:UNITS, is empty.
    """

    over_time: ClassVar[bool] = True
    writes: ClassVar[str] = """
    Writes summary.csv, errors.csv, differences.csv, passive.csv, normalised.csv, figures, report.html and run.json into
    OUT.
    """

    study: Path
    _: KW_ONLY
    device: str = "lucy"
    cutoff: Annotated[float, CUTOFF] = 6.0
    gap_limit: Annotated[float, GAP] = 0.2
    markers_map: str | None = None
    axes: Expression | None = None
    c3d_unit: C3dUnit = None
