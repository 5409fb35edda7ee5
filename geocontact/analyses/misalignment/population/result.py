"""What a population tells: quantiles, exceedance, where the spread comes from, figure, page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from geocontact.analyses.json_file import write_json
from geocontact.analyses.misalignment.population.drawn import Drawn
from geocontact.analyses.misalignment.population.figure import population_figure
from geocontact.analyses.misalignment.population.options import PopulationOptions
from geocontact.analyses.misalignment.population.page import population_page
from geocontact.analyses.misalignment.population.tables import (
    exceedance_table,
    influence_table,
    quantile_table,
    sample_table,
)
from geocontact.analyses.result import REPORT, Result

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


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

    def figures(self) -> dict[str, Figure]:
        """`population`: density of the largest force, and the probability of more."""
        d = self.drawn
        return {"population": population_figure(d.peak[np.isfinite(d.peak)], d.levels, d.exceedance, d.limit)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Exceedance, figure, quantiles, where the spread comes from."""
        return {REPORT: population_page(self.drawn, drawings["population"])}

    def write_files(self, folder: Path) -> None:
        """population.json besides."""
        write_json(folder / "population.json", self.summary)
        super().write_files(folder)
