"""Where the markers of a model are: a table, and a file for OpenSim."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.motion.figure import curves_figure
from geocontact.analyses.motion.virtual_markers.options import MarkersOptions
from geocontact.analyses.motion.virtual_markers.page import markers_page
from geocontact.analyses.result import REPORT, Result
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.io.mocap.trc_writer import write_trc

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class MarkersResult(Result):
    """Markers of a model over time, in the ground's frame [m].

    `values` are the coordinates of `model` that they follow [rad, m].
    """

    elsewhere: ClassVar[frozenset[str]] = frozenset({"markers"})

    options: MarkersOptions
    markers: MarkerTrajectories
    model: Multibody
    values: Float[np.ndarray, "t n"]

    def tables(self) -> dict[str, pd.DataFrame]:
        """`markers` [m]."""
        places = self.markers.positions
        columns = {
            f"{name}_{axis} [m]": places[:, k, i]
            for k, name in enumerate(self.markers.names)
            for i, axis in enumerate("xyz")
        }
        return {"markers": pd.DataFrame({"time [s]": self.markers.time, **columns})}

    def figure(self) -> Figure:
        """Every axis over time."""
        table = self.table()
        return curves_figure(self.markers.time, {f"{axis} [m]": table.filter(like=f"_{axis} [") for axis in "xyz"})

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """The model as it moves, with its markers."""
        title = f"Virtual markers along {self.options.coordinates.name}"
        return {REPORT: markers_page(title, self.model, self.values, self.markers)}

    def write_files(self, folder: Path) -> None:
        """markers.trc [mm] besides."""
        write_trc(folder / "markers.trc", self.markers)
        super().write_files(folder)
