"""What the fit of a shape finds: shape with interval, residuals, radius over flexion, figures and page."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from geocontact.analyses.result import REPORT, Result
from geocontact.analyses.shape.figure import fit_figure
from geocontact.analyses.shape.fitting import Fitting
from geocontact.analyses.shape.numbers import describe
from geocontact.analyses.shape.options import ShapeOptions
from geocontact.analyses.shape.page import fit_page
from geocontact.analyses.shape.profile_figure import profile_figure
from geocontact.analyses.shape.tables import fit_table, profile_table
from geocontact.data.version import VERSION
from geocontact.geometry.fit.found import ShapeFit
from geocontact.geometry.fit.profile import SagittalProfile
from geocontact.view.surfaces.fit_vtp import write_fit_vtp

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ShapeResult(Result):
    """A shape fitted to a surface.

    Parameters
    ----------
    fitting
        Patch, shape of the whole and of its sides, profiles.
    """

    elsewhere: ClassVar[frozenset[str]] = frozenset({"fit"})

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

    def figures(self) -> dict[str, Figure]:
        """`profile`, radius over flexion, where it is asked for; `fit`, the section and the residuals."""
        fit = {"fit": fit_figure(self.fit, self.fitting.patch.points, self.title)}
        return {"profile": profile_figure(self.profiles, self.fit), **fit} if self.profiles else fit

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """The surface coloured by its distance to the shape, the numbers, and what they depend on."""
        return {REPORT: fit_page(self.fitting, drawings, self.title, self.sentences)}

    def write_files(self, folder: Path) -> None:
        """fit.json besides, and residuals for ParaView."""
        f = self.fitting
        text = json.dumps(describe(f, self.options), indent=2, ensure_ascii=False, allow_nan=False)
        (folder / "fit.json").write_text(text + "\n", encoding="utf-8")
        if self.options.paraview:
            s = f.patch.surface
            write_fit_vtp(folder / "fit.vtp", s.vertices, s.faces, f.residual, f.patch.faces, f"geocontact {VERSION}")
        super().write_files(folder)
