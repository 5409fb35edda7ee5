"""What a calibration of a foot may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, Literal

from geocontact.analyses.options import Degrees, Excludes, Fraction, Length, Options, Spelled
from geocontact.data.errors import InputError
from geocontact.data.plausible import Plausible
from geocontact.data.ranges import MASS, NOISE, SHIFT, SPEED, TILT
from geocontact.data.units import mm

FULCRUM = Plausible("the place of a fulcrum on a keel", mm, (1.0, 400.0), (66.0, 151.0))
MOST_STARTS = 1000


@dataclass(frozen=True)
class ProsthesisCalibrateOptions(Options):
    """Stiffness, damping and friction of five zones of a variable-stiffness foot from one recorded stance.

    Parameters
    ----------
    motion
        Poses of the keel's straight frame in the ground's over time (.csv): x forward from the keel's posterior end, y
        up, floor at y = 0.
    plates
        Ground reactions of force plates (.mot .sto .c3d) in the same frame and on the same clock.

    The foot and its wearer
    -----------------------
    setting
        low, medium or high, whose fulcrum is taken where beam theory puts it; medium unless `fulcrum` is given.
    fulcrum
        Its place from the keel's posterior end [mm].
    mass
        Of the wearer [kg].
    plate
        Name or number of the plate; needed when there are several.

    The search
    ----------
    starts
        Starts spread over the bounds, beside the usual numbers.
    seed
        Of these starts.
    level
        Probability of the intervals.

    What was recorded with which error
    ----------------------------------
    force_noise
        Standard deviation of a component of the plate's force [N].
    height_error
        Of the foot's height, constant over the stance [mm].
    pitch_error
        Of the foot's pitch, constant over the stance.
    speed_error
        Of the foot's speed [m/s]: what markers and their filter leave of it.
    """

    motion: Path
    _: KW_ONLY
    plates: Path
    mass: Annotated[float, MASS]
    setting: Annotated[
        Literal["low", "medium", "high"] | None, Excludes("fulcrum", "tells where the fulcrum is as well")
    ] = None
    fulcrum: Annotated[Length | None, FULCRUM] = None
    plate: str | None = None
    starts: int = 8
    seed: int = 0
    level: Annotated[Fraction, Spelled(default="0.95")] = 0.95
    force_noise: Annotated[float, NOISE] = 3.0
    height_error: Annotated[Length, SHIFT, Spelled(default="0.5mm")] = 0.5e-3
    pitch_error: Annotated[Degrees, TILT, Spelled(default=0.2)] = 0.0034906585
    speed_error: Annotated[float, SPEED] = 20e-3

    def refuse_impossible(self) -> None:
        """No starts at all, a probability that is none, a force without noise."""
        if not 0 <= self.starts <= MOST_STARTS:
            what = f"{self.starts} is not 0 to {MOST_STARTS}"
            raise InputError("", "`starts`", what, "give for example 12")
        if not 0.0 < self.level < 1.0:
            raise InputError("", "`level`", f"{self.level:g} is not between 0 and 1", "give for example 0.95")
        if self.force_noise <= 0.0:
            raise InputError("", "`force_noise`", "0 N gives samples no limit to their weight", "give for example 3")
