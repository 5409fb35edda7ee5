"""What a study of a shoulder exoskeleton may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from geocontact.analyses.options import Options
from geocontact.data.ranges import CUTOFF, GAP


@dataclass(frozen=True)
class StudyOptions(Options):
    """Simulate the arms of a study twice, with the motion recorded in the device and without it, beside logger and mat.

    Parameters
    ----------
    study
        A .toml file: device = "lucy" and one table [[trial]] each with name, person, task, level = "100%", side (of
        logger and mat) and files: markers, tool, recorded (elevation and force), wearer; without = another trial's
        markers and without_tool its tool, recorded without the device.

    The motion
    ----------
    cutoff
        Zero-lag low-pass of the markers [Hz]; 0 leaves them as they are.
    gap_limit
        Longest time for which a marker may be out of sight [s].
    """

    over_time: ClassVar[bool] = True

    study: Path
    _: KW_ONLY
    cutoff: Annotated[float, CUTOFF] = 6.0
    gap_limit: Annotated[float, GAP] = 0.2
