"""Options of every analysis that reads recordings of a misaligned joint."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from typing import Annotated

from geocontact.analyses.options import AngleUnit, Expression, ForceUnit, Options
from geocontact.data.ranges import CUTOFF


@dataclass(frozen=True)
class ColumnOptions(Options):
    """How the columns of recordings are read and filtered.

    Parameters
    ----------
    Columns and units
    -----------------
    map
        Columns by what they are, where they have other names: beta=elbow_flexion,force=-Fx.
    angles
        Unit of the angle where its file does not say.
    unit
        Unit of the force where its file does not say.
    cutoff
        Cut-off of a zero-lag low-pass over the measured channels [Hz]; none unless given.
    """

    _: KW_ONLY
    map: Expression | None = None
    angles: AngleUnit | None = None
    unit: ForceUnit | None = None
    cutoff: Annotated[float | None, CUTOFF] = None
