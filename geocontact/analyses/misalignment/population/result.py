"""What a population tells: quantiles, exceedance, where the spread comes from, figure, page."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from geocontact.analyses.figure_files import drawing, save_both
from geocontact.analyses.json_file import write_json
from geocontact.analyses.misalignment.population.drawn import Drawn
from geocontact.analyses.misalignment.population.figure import population_figure
from geocontact.analyses.misalignment.population.options import PopulationOptions
from geocontact.analyses.misalignment.population.page import write_population_report
from geocontact.analyses.misalignment.population.tables import (
    exceedance_table,
    influence_table,
    quantile_table,
    sample_table,
)
from geocontact.analyses.result import Result
from geocontact.io.text.results import write_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class PopulationResult(Result):
    """Largest forces of synthetic people: drawn, not measured.

    Parameters
    ----------
    drawn
        People, forces, and everything found of them, in SI.
    summary
        What `population.json` holds, with units in the keys.
    """

    options: PopulationOptions
    drawn: Drawn
    summary: dict[str, Any]

    def tables(self) -> dict[str, pd.DataFrame]:
        """`quantiles`, `exceedance`, `influence`, and `samples` with `keep`."""
        d = self.drawn
        found = {"quantiles": quantile_table(d), "exceedance": exceedance_table(d), "influence": influence_table(d)}
        return {**found, "samples": sample_table(d)} if self.options.keep else found

    def figure(self) -> Figure:
        """Density of the largest force, and the probability of more."""
        d = self.drawn
        return population_figure(d.peak[np.isfinite(d.peak)], d.levels, d.exceedance, d.limit)

    def write_files(self, folder: Path) -> None:
        """population.json, tables, figure, page."""
        write_json(folder / "population.json", self.summary)
        for name, rows in self.tables().items():
            write_table(rows, folder, name)
        picture = save_both(self.figure(), folder, "population")
        write_population_report(folder / "report.html", self.record, self.drawn, picture)

    def write_page(self, file: Path) -> None:
        """Exceedance, figure, quantiles, where the spread comes from."""
        write_population_report(file, self.record, self.drawn, drawing(self.figure()))
