"""What a comparison of a simulated arm may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from geocontact.analyses.frame.marks import AngleUnit, Expression, ForceUnit, Spelled, Typed
from geocontact.analyses.frame.options import Options
from geocontact.data.plausible import DELAY, FRICTION

Clock = Annotated[float, Typed("s", "finite", "0.02", "[s]", float), Spelled(dashed=True), DELAY]


@dataclass(frozen=True)
class ShoulderCompareOptions(Options):
    """Errors of a simulated exoskeleton arm against its logger, mat and measured shear, by channel and work phase.

    Parameters
    ----------
    simulated
        right.csv or left.csv of `geocontact shoulder simulate`.
    recorded
        Table over time (.csv, .mot, .sto) with one or more of: elevation of the exoskeleton's arm from its logger,
        force of a pressure mat in the cuff, angles passive_1 and passive_2 of the passive joints; of a two-axis mat or
        load cells in the strap normal, shear_along (towards the hand), shear_around, or the size shear.
    map
        Columns by what they are, where they have other names: elevation=exo_right,force=mat,passive_1=encoder.
    angles
        Unit of the angles where the file does not say.
    unit
        Unit of the force where its file does not say.
    delay
        How much the recording's clock is late [s].
    friction
        Static friction of the cuff that measured shear is compared with; by default that of the simulated device.
    """

    writes: ClassVar[str] = """
    Writes comparison.csv, friction.csv where shear is recorded, a figure, report.html and run.json into OUT.
    """

    simulated: Path
    recorded: Path
    _: KW_ONLY
    map: Expression | None = None
    angles: AngleUnit | None = None
    unit: ForceUnit | None = None
    delay: Clock = 0.0
    friction: Annotated[float | None, FRICTION] = None
