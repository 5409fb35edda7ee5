"""What an identification finds: numbers of the law with intervals, what is not told, tables, figures, page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from geocontact.analyses.json_file import write_json
from geocontact.analyses.misalignment.identify.figure import (
    Boxes,
    Over,
    conditions_figure,
    force_figure,
    residual_figure,
    told_figure,
)
from geocontact.analyses.misalignment.identify.fitted import Fitted
from geocontact.analyses.misalignment.identify.free_joint import Free
from geocontact.analyses.misalignment.identify.options import IdentifyOptions
from geocontact.analyses.misalignment.identify.page import fit_page
from geocontact.analyses.misalignment.identify.tables import QUANTILE_COLUMNS, tables_of
from geocontact.analyses.result import REPORT, Result
from geocontact.axis_misalignment.bins import Binned
from geocontact.axis_misalignment.end_stop import bin_means

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class IdentifyResult(Result):
    """Stiffness, link and offsets of an exoskeleton, and what these recordings cannot tell.

    Parameters
    ----------
    fit
        What recordings with a locked joint tell.
    free
        What those with a free joint tell; None without.
    summary
        What `elbow.json` holds, with units in the keys.
    """

    options: IdentifyOptions
    fit: Fitted
    free: Free | None
    summary: dict[str, Any]

    @property
    def numbers(self) -> dict[str, float]:
        """k, x, y, l, z, b and s in SI; where nothing sets the scale, one point of the line that fits alike."""
        return self.fit.estimate.named

    def figures(self) -> dict[str, Figure]:
        """`forces`, `identifiability`, `residuals`, and `conditions` with a free joint."""
        return {name: self.figure(name) for name in self._drawn}

    def tables(self) -> dict[str, pd.DataFrame]:
        """`intervals`, `bins`, `boxes`, `scale_line`, `held_out`; `conditions` and `boxes_free` with a free joint."""
        return tables_of(self.fit, self.free)

    def figure(self, name: str = "forces") -> Figure:
        """One of the figures: force over the angle unless named."""
        f = self.fit
        if name == "forces":
            return force_figure(_over(f), self._boxes("boxes", f.boxes))
        if name == "identifiability":
            profiles = {each.words: each.profile for each in f.intervals}
            return told_figure(f.all_directions, f.line.numbers, f.line.r2, f.line.alone_r2, profiles)
        if name == "residuals":
            r = f.residuals
            return residual_figure(r.beta, r.off, r.standard, f"Lilliefors {r.normality.shown}")
        if name == "conditions" and self.free is not None:
            boxes = self._boxes("boxes", f.boxes), self._boxes("boxes_free", self.free.boxes)
            return conditions_figure(bin_means(f.data), self.free.stroke, *boxes)
        raise KeyError(f"no figure {name!r}; there are {', '.join(self._drawn)}")

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Force over the angle, what the data tell, figures and tables."""
        return {REPORT: fit_page(self.record, self.fit, self.free, self.tables(), drawings)}

    def write_files(self, folder: Path) -> None:
        """elbow.json besides."""
        write_json(folder / "elbow.json", self.summary)
        super().write_files(folder)

    @property
    def _drawn(self) -> tuple[str, ...]:
        own = ("forces", "identifiability", "residuals")
        return own if self.free is None else (*own, "conditions")

    def _boxes(self, name: str, data: Binned) -> Boxes:
        table = self.table(name)
        table = table[table["samples"] > 0]
        width = float(data.visits.edges[1] - data.visits.edges[0])
        return Boxes(np.radians(table["beta [deg]"].to_numpy()), table[list(QUANTILE_COLUMNS)].to_numpy(), width)


def _over(f: Fitted) -> Over:
    law = f.estimate.problem.law
    order = np.argsort(law.beta)
    return Over(law.beta, f.estimate.problem.force, law.beta[order], f.estimate.predicted[order])
