"""What the fit of a shape finds: shape with interval, residuals, radius over flexion, figures and page."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.figure_files import drawing, save_both
from geocontact.analyses.options_table import options_table
from geocontact.analyses.result import Result
from geocontact.analyses.shape.figure import fit_figure
from geocontact.analyses.shape.fitting import Fitting
from geocontact.analyses.shape.numbers import describe
from geocontact.analyses.shape.options import ShapeOptions
from geocontact.analyses.shape.page import write_fit_report
from geocontact.analyses.shape.profile_figure import profile_figure
from geocontact.analyses.shape.tables import fit_table, profile_table
from geocontact.data.version import VERSION
from geocontact.geometry.fit.found import ShapeFit
from geocontact.geometry.fit.profile import SagittalProfile
from geocontact.io.text.results import write_table
from geocontact.view.page.tables import inputs_table
from geocontact.view.surfaces.fit_vtp import write_fit_vtp

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ShapeResult(Result):
    """A shape fitted to a surface.

    Parameters
    ----------
    fitting
        Patch, shape of the whole and of its sides, profiles.
    """

    options: ShapeOptions
    fitting: Fitting

    @property
    def fit(self) -> ShapeFit:
        """Shape of the whole patch: axis, point and radius [m], and how well they are known."""
        return self.fitting.whole

    @property
    def sides(self) -> Mapping[str, ShapeFit]:
        """Shapes of the medial and the lateral side; empty without a split."""
        return self.fitting.sides

    @property
    def profiles(self) -> Mapping[str, SagittalProfile]:
        """Radius over flexion by side, "whole" without a split; empty where no profile is asked for."""
        return self.fitting.profiles

    @property
    def title(self) -> str:
        """Heading of figure and page."""
        o = self.options
        region = "" if o.region is None else ", region " + Path(o.region).name
        return f"{o.shape.capitalize()} fitted to {self.fitting.patch.surface.name}{region}"

    def tables(self) -> dict[str, pd.DataFrame]:
        """`fit`, and `profile` where it is asked for."""
        found = {"fit": fit_table(self.fitting)}
        return {**found, "profile": profile_table(self.profiles)} if self.profiles else found

    def figure(self) -> Figure:
        """Radius over flexion where it is asked for; else the section and the residuals."""
        return profile_figure(self.profiles, self.fit) if self.profiles else self._fit_figure()

    def write_files(self, folder: Path) -> None:
        """fit.json, profile, figures, residuals for ParaView, page."""
        f = self.fitting
        text = json.dumps(describe(f, self.options), indent=2, ensure_ascii=False, allow_nan=False)
        (folder / "fit.json").write_text(text + "\n", encoding="utf-8")
        if self.profiles:
            write_table(self.table("profile"), folder, "profile")
        drawings = {name: save_both(figure, folder, name) for name, figure in self._figures().items()}
        if self.options.paraview:
            s = f.patch.surface
            write_fit_vtp(folder / "fit.vtp", s.vertices, s.faces, f.residual, f.patch.faces, f"geocontact {VERSION}")
        self._write_report(folder / "report.html", drawings)

    def write_page(self, file: Path) -> None:
        """The surface coloured by its distance to the shape, the numbers, and what they depend on."""
        self._write_report(file, {name: drawing(figure) for name, figure in self._figures().items()})

    def _fit_figure(self) -> Figure:
        return fit_figure(self.fit, self.fitting.patch.points, self.title)

    def _figures(self) -> dict[str, Figure]:
        """All figures by the name of their files."""
        found = {"fit": self._fit_figure()}
        return {**found, "profile": self.figure()} if self.profiles else found

    def _write_report(self, file: Path, drawings: Mapping[str, bytes]) -> None:
        provenance = [inputs_table(self.record.inputs), options_table(self.record)]
        write_fit_report(file, self.fitting, drawings, self.title, provenance, self.warnings, self.sentences)
