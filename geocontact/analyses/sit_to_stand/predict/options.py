"""What a prediction of standing up may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from geocontact.analyses.options import Options
from geocontact.data.errors import InputError
from geocontact.data.plausible import PLAIN, Plausible

NODES = Plausible("how many nodes a second has", PLAIN, (3.0, 1000.0), (10.0, 300.0))


@dataclass(frozen=True)
class StandingPredictOptions(Options):
    """Predict movement and strap force of trials that were not used, from ground reaction and torques.

    Parameters
    ----------
    study
        The trials (.toml). Their coordinates and strap are compared with, and only the first and last posture is used.
    parameters
        parameters.csv of a calibration with the exoskeleton.
    against
        Study of the trials of the calibration (.toml), whose mean is the trivial predictor.

    The search
    ----------
    nodes
        Intervals in a second.
    degree
        Collocation points in an interval (Radau).
    iterations
        At most so many.
    time_limit
        CPU time after which a search ends [s].
    """

    over_time: ClassVar[bool] = True

    study: Path
    _: KW_ONLY
    parameters: Path
    against: Path
    nodes: Annotated[float, NODES] = 45.0
    degree: int = 4
    iterations: int = 300
    time_limit: float = 300.0

    def refuse_impossible(self) -> None:
        """Numbers without a search."""
        if not 2 <= self.degree <= 9:
            raise InputError("", "`degree`", f"{self.degree} is not 2 to 9", "give for example 4")
        if self.iterations < 1 or not self.time_limit > 0.0:
            raise InputError("", "`iterations`", "nothing can be sought", "give for example 300, and a time above 0")
