"""What a comparison of many stances finds: errors beside trivial predictors, ensembles, outliers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.prosthesis.compare.figure import ensemble_figure
from geocontact.analyses.prosthesis.compare.options import ProsthesisCompareOptions
from geocontact.analyses.prosthesis.compare.page import comparison_page
from geocontact.analyses.prosthesis.compare.tables import (
    ensembles_table,
    errors_table,
    summary_table,
    trials_table,
)
from geocontact.analyses.prosthesis.simulate.exports import write_coordinates, write_loads, write_spheres
from geocontact.analyses.prosthesis.simulate.tables import numbers_of, numbers_table
from geocontact.analyses.result import REPORT, Result
from geocontact.below_knee_prosthesis.evaluation.judged_stance import JudgedStance
from geocontact.below_knee_prosthesis.evaluation.outliers import Oddness
from geocontact.below_knee_prosthesis.model.leg import Side
from geocontact.io.text.results import write_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page

TRIALS = "trials"
"""Folder with what other programs read, of each stance."""


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ProsthesisCompareResult(Result):
    """Stances of a study beside their plates.

    Parameters
    ----------
    sides
        Of the prosthesis, by trial.
    odd
        How far each stance that nothing was fitted to stands out.
    """

    options: ProsthesisCompareOptions
    stances: tuple[JudgedStance, ...]
    sides: Mapping[str, Side]
    odd: Mapping[str, Oddness]

    def tables(self) -> dict[str, pd.DataFrame]:
        """`summary` by setting, `trials`, `errors` of each, `ensembles`."""
        errors = errors_table(self.stances)
        return {
            "summary": summary_table(errors),
            "trials": trials_table(self.stances, self.odd),
            "errors": errors,
            "ensembles": ensembles_table(self.stances),
        }

    def figures(self) -> dict[str, Figure]:
        """`ensembles`: means and bands over the stances of each setting."""
        return {"ensembles": ensemble_figure(self.stances)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Ensembles, errors beside trivial predictors, outliers."""
        return {REPORT: comparison_page(drawings["ensembles"], self.stances, self.tables(), self.sentences)}

    def write_files(self, folder: Path) -> None:
        """Coordinates, loads, spheres and numbers of each stance besides, as `prosthesis simulate` writes them."""
        for one in self.stances:
            place = folder / TRIALS / one.name
            place.mkdir(parents=True)
            write_coordinates(place, one.stance, self.sides[one.name])
            write_loads(place, one.stance, self.sides[one.name])
            write_spheres(place / "paraview", one.stance, self.sides[one.name])
            write_table(numbers_table(numbers_of(one.stance)), place, "numbers")
        super().write_files(folder)
