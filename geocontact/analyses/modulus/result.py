"""What areas and forces tell of E*: numbers with intervals, curves, what they depend on, figure and page."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from geocontact.analyses.finished_page import INPUTS, OPTIONS
from geocontact.analyses.modulus.figure import modulus_figure
from geocontact.analyses.modulus.identified import Identified
from geocontact.analyses.modulus.numbers import describe
from geocontact.analyses.modulus.options import ModulusOptions
from geocontact.analyses.modulus.page import modulus_page
from geocontact.analyses.modulus.page_tables import moduli, told_apart
from geocontact.analyses.modulus.tables import curve_table, modulus_table, prediction_table, sensitivity_table
from geocontact.analyses.result import REPORT, Result
from geocontact.elastic_modulus.area_force import MODULUS
from geocontact.elastic_modulus.identify import Identification
from geocontact.view.page.tables import frame_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ModulusResult(Result):
    """Elastic modulus of a contact.

    Parameters
    ----------
    found
        Identification of each side, sensitivity, calibration, predictions.
    """

    elsewhere: ClassVar[frozenset[str]] = frozenset({"modulus"})

    options: ModulusOptions
    found: Identified

    @property
    def modulus(self) -> float:
        """E* of the first side [Pa]: of the total force, where there is one."""
        return self.found.first.modulus

    @property
    def interval(self) -> tuple[float, float]:
        """95 % interval of the same by profile likelihood [Pa]."""
        profile = self.found.first.profiles[MODULUS]
        return profile.lower, profile.upper

    @property
    def sides(self) -> Mapping[str, Identification]:
        """Model, measured force, estimates and intervals of each side."""
        return self.found.sides

    @property
    def not_identifiable(self) -> list[str]:
        """What the data cannot tell, a sentence each."""
        return self.found.not_identifiable()

    def tables(self) -> dict[str, pd.DataFrame]:
        """`modulus`, `curves`, `sensitivity`, and `prediction` of a trial that was not used."""
        f = self.found
        found = {"modulus": modulus_table(f), "curves": curve_table(f), "sensitivity": sensitivity_table(f)}
        return {**found, "prediction": prediction_table(f)} if f.predictions else found

    def figures(self) -> dict[str, Figure]:
        """`modulus`: force measured and by the law, and how well E* is known."""
        profiles = {side: i.profiles[MODULUS] for side, i in self.sides.items()}
        return {"modulus": modulus_figure(self.found.curves(), profiles)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """How well the law meets the forces, what it tells, and what it cannot tell."""
        sensitivity = frame_table("Threshold and reading: what E* depends on", self.table("sensitivity"))
        tables = [moduli(self.found), told_apart(self.found), sensitivity, INPUTS, OPTIONS]
        title = f"E* from {self.options.area[0].name} and {self.options.force.name}"
        return {REPORT: modulus_page(title, self.found, drawings["modulus"], tables)}

    def write_files(self, folder: Path) -> None:
        """modulus.json besides."""
        text = json.dumps(describe(self.found), indent=2, ensure_ascii=False, allow_nan=False)
        (folder / "modulus.json").write_text(text + "\n", encoding="utf-8")
        super().write_files(folder)
