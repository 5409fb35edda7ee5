"""Options of every search for motions that stand up."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from geocontact.analyses.frame.marks import C3dUnit, Expression
from geocontact.analyses.frame.options import Options
from geocontact.data.errors import InputError
from geocontact.data.plausible import PLAIN, SEARCH, Plausible

NODES = Plausible("how many nodes a second has", PLAIN, (3.0, 1000.0), (10.0, 300.0))
DEGREES = (2, 9)


@dataclass(frozen=True)
class StandingSearchOptions(Options):
    """How motions are discretised and sought.

    Parameters
    ----------
    The search
    ----------
    nodes
        Initial intervals per second; those with too large an error of the balance are halved.
    degree
        Collocation points per interval (Radau).
    iterations
        Largest number of iterations.
    time_limit
        CPU time after which a search ends [s].
    axes
        Which of the plates' axes are x (forwards), y (up) and z: x,z,-y where the laboratory's z is up.
    c3d_unit
        Unit of places in .c3d files whose own, POINT:UNITS, is empty.
    device
        The exoskeleton (.toml), such as device.toml of `sit-to-stand device`; that of the study by default.
    """

    over_time: ClassVar[bool] = True

    _: KW_ONLY
    nodes: Annotated[float, NODES] = 45.0
    degree: int = 4
    iterations: int = 300
    time_limit: Annotated[float, SEARCH] = 300.0
    axes: Expression | None = None
    c3d_unit: C3dUnit = None
    device: Path | None = None

    def refuse_impossible(self) -> None:
        """Numbers without a search."""
        within("degree", self.degree, *DEGREES, 4)
        within("iterations", self.iterations, 1, 100_000, 300)


def within(name: str, value: int | float, low: int | float, high: int | float, example: int | float) -> None:
    """InputError where an option is not between two numbers."""
    if not low <= value <= high:
        raise InputError("", f"`{name}`", f"{value} is not {low} to {high}", f"give for example {example}")
