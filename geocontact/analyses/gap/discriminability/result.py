"""What trials are found to tell: tables, matrix and bars, page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.gap.discriminability.answer import answer
from geocontact.analyses.gap.discriminability.figures import confusion_figures
from geocontact.analyses.gap.discriminability.options import DiscriminabilityOptions
from geocontact.analyses.gap.discriminability.page import confusion_page
from geocontact.analyses.gap.discriminability.tables import detectability_table, separability_table
from geocontact.analyses.json_file import write_json
from geocontact.analyses.result import PARTS, REPORT, Part, Result
from geocontact.data.gap.case import GapCase
from geocontact.gap.identifiability.discriminability import Discriminability
from geocontact.io.text.written_units import CASES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class DiscriminabilityResult(Result):
    """Which effects trials would show, from which size on, and which look alike.

    Parameters
    ----------
    case
        Whose trials, SI units.
    found
        Separations of effects, smallest amplitudes, and the diagnosis that noise is known from.
    """

    options: DiscriminabilityOptions
    case: GapCase
    found: Discriminability

    @property
    def title(self) -> str:
        """Name of the case."""
        return self.case.name

    @property
    def parts(self) -> frozenset[Part]:
        """Tables alone where no more is wanted."""
        return frozenset(("tables",)) if self.options.bare else PARTS

    def units(self, table: str) -> Mapping[str, str]:
        """SI, as in the case."""
        return CASES

    def tables(self) -> dict[str, pd.DataFrame]:
        """`separability`: a row per pair of effects; `detectability`: the smallest amplitude of each."""
        return {"separability": separability_table(self.found), "detectability": detectability_table(self.found)}

    def figures(self) -> dict[str, Figure]:
        """`separability`: who is told from whom; `detectability`: from which size on effects are seen."""
        return confusion_figures(self.found)

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Sentences, matrix, smallest amplitudes."""
        return {REPORT: confusion_page(self.title, self.found, drawings)}

    def write_files(self, folder: Path) -> None:
        """Also the answer."""
        super().write_files(folder)
        write_json(folder / "confuse.json", answer(self.case, self.found, self.options.nats))
