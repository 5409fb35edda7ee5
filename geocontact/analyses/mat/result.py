"""A mat on a body: tables, a surface for ParaView, figure, page."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from geocontact.analyses.figure_files import drawing, save_both
from geocontact.analyses.mat.figure import mat_figure
from geocontact.analyses.mat.findings import MatFindings
from geocontact.analyses.mat.page import write_mat_report
from geocontact.analyses.mat.tables import mat_tables
from geocontact.data.errors import InputError
from geocontact.data.version import VERSION
from geocontact.io.text.results import write_table
from geocontact.io.text.written_units import CASES, RESULTS
from geocontact.view.surfaces.mat_vtp import write_mat_vtp

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MM = 1e3
REFERRED = ("wrench", "uncertainty", "segments")
"""Tables that refer to a point and a frame, which run.json names."""
OF_A_CASE = ("cells", "frames_cells")
"""Tables as gap cases hold them, in SI."""
WORDS = "forces are those of the mat on the body"


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class MatResult(MatFindings):
    """Loads of a pressure mat on a body over time; `MatFindings` has the fields."""

    def tables(self) -> dict[str, pd.DataFrame]:
        """`wrench`, `uncertainty`, `cells`, `frames_cells`; and `segments`, `registration`, `agreement` if any."""
        return mat_tables(self)

    def figure(self) -> Figure:
        """Force, pressure and area over time, and the cells with their largest pressure."""
        largest = float(self.on_faces.max())
        return mat_figure(self.frames.time, self.loads, self.drape, self.pressure, self.cells, largest)

    def write_files(self, folder: Path) -> None:
        """Tables, surface, figure and page."""
        for name, table in self.tables().items():
            units = CASES if name in OF_A_CASE else RESULTS
            write_table(table, folder, name, units)
            if name in REFERRED:
                self.record.tables[f"{name}.csv"] = self._point_and_frame()
        try:
            write_mat_vtp(
                folder / "mat_on_surface.vtp",
                self.surface.vertices,
                self.surface.faces,
                self._on_faces(),
                f"geocontact {VERSION}",
            )
        except InputError as error:
            self.record.warn(str(error))
        write_mat_report(folder / "report.html", self, save_both(self.figure(), folder, "mat"))

    def write_page(self, file: Path) -> None:
        """The animated page."""
        write_mat_report(file, self, drawing(self.figure()))

    def _point_and_frame(self) -> dict[str, object]:
        wrench = self.loads.wrench
        point = [float(f"{value * MM:.12g}") for value in wrench.origin[0]]
        return {"point_mm": point, "frame": wrench.frame, "words": WORDS}

    def _on_faces(self) -> dict[str, np.ndarray]:
        """Pressure of each face of the surface [Pa]: largest, mean, and under the largest force."""
        k = self.heaviest
        chosen = {
            "peak over time": self.pressure.max(axis=0),
            "mean over time": self.pressure.mean(axis=0),
            f"frame {k + 1}, {self.frames.time[k]:g} s": self.pressure[k],
        }
        return {
            f"pressure, {name} [Pa]": self.cells.face_pressure(values[None], self.surface.face_area)[0]
            for name, values in chosen.items()
        }
