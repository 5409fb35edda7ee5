"""Tables of every number that ran, and of where the intervals of each motion begin and end."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from geocontact.dynamics.collocation.motion import CollocatedMotion
from geocontact.standing_up.numbers_that_ran import Ran
from geocontact.standing_up.phase import PhaseProblem, PhaseSizes

Meshes = Sequence[tuple[str, Sequence[CollocatedMotion]]]
"""Motions by the name of their phase, predictor or design."""
GIVEN = "as the file of parameters gives it"


def ran_table(rows: Sequence[Ran]) -> pd.DataFrame:
    """Every number in SI, and where it is from."""
    return pd.DataFrame(rows, columns=list(Ran._fields))


def mesh_table(of: str, meshes: Meshes) -> pd.DataFrame:
    """Ends of the intervals, from the start of each motion to its end; `of` is what the motions are named by."""
    rows = [(name, motion.name, float(at)) for name, motions in meshes for motion in motions for at in motion.breaks]
    return pd.DataFrame(rows, columns=[of, "trial", "break [s]"])


def sizes_of(phase: PhaseProblem) -> PhaseSizes:
    """What its cost is measured by. ValueError where that is of another kind."""
    if phase.sizes is None:
        raise ValueError("this phase does not say what its cost is measured by")
    return phase.sizes
