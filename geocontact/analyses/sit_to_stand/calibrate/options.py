"""What a calibration of contacts while standing up may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from geocontact.analyses.options import Fraction, Options, Spelled
from geocontact.data.errors import InputError
from geocontact.data.plausible import PLAIN, Plausible

NODES = Plausible("how many nodes a second has", PLAIN, (3.0, 1000.0), (10.0, 300.0))
DEGREES = (2, 9)
MOST_STARTS = 1000


@dataclass(frozen=True)
class StandingCalibrateOptions(Options):
    """Find the parameters of foot and ground that let a planar chain stand up as recorded, from several trials at once.

    Parameters
    ----------
    study
        Person, noise and trials (.toml).

    The search
    ----------
    nodes
        Intervals in a second.
    degree
        Collocation points in an interval (Radau).
    iterations
        At most so many.
    time_limit
        CPU time after which the search ends [s].
    starts
        Further starts, drawn from what is believed of the parameters.
    resamples
        Calibrations of trials that the answer itself makes, whose mean error is taken off; fewer than two for none.
    seed
        Of starts and resamples.
    level
        Probability of the intervals.
    """

    over_time: ClassVar[bool] = True

    study: Path
    _: KW_ONLY
    nodes: Annotated[float, NODES] = 30.0
    degree: int = 4
    iterations: int = 300
    time_limit: float = 600.0
    starts: int = 0
    resamples: int = 6
    seed: int = 0
    level: Annotated[Fraction, Spelled(default="0.95")] = 0.95

    def refuse_impossible(self) -> None:
        """Numbers without a search, a probability that is none."""
        for name, value, low, high, example in (
            ("degree", self.degree, *DEGREES, 4),
            ("iterations", self.iterations, 1, 100_000, 300),
            ("starts", self.starts, 0, MOST_STARTS, 20),
            ("resamples", self.resamples, 0, MOST_STARTS, 6),
        ):
            if not low <= value <= high:
                raise InputError("", f"`{name}`", f"{value} is not {low} to {high}", f"give for example {example}")
        if not self.time_limit > 0.0:
            raise InputError("", "`time_limit`", f"{self.time_limit:g} s is no time", "give for example 600")
        if not 0.0 < self.level < 1.0:
            raise InputError("", "`level`", f"{self.level:g} is not between 0 and 1", "give for example 0.95")
