"""A pressure mat on a body scan: `geocontact mat`, `gc.mat`.

>>> import geocontact as gc
>>> mat = "meshes/mat_thigh_16x8/"
>>> given = {"layout": mat + "layout.toml", "landmarks": mat + "landmarks.csv", "cutoff": 0.0}
>>> result = gc.mat(mat + "frames.csv", surface="meshes/thigh.stl", unit="mm", **given)
>>> print(result)
force up to 79.6 N at 1.1 s (sum of pressure × area), pressure up to 29.1 kPa, area up to 76 cm²
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import listener, reserve
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.pages import Thinned, drawing
from geocontact.analyses.frame.result import REPORT
from geocontact.analyses.mat.comparison import compared
from geocontact.analyses.mat.loads import MatFindings, loads, mat_tables
from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.mat.placed import MatInputs, closest_point, placed, read
from geocontact.analyses.mat.recording import made_ready
from geocontact.analyses.mat.shear import mat_shear
from geocontact.analyses.mat.show import FRAMES, cells_figure, mat_figure, mat_page, shown_frames
from geocontact.analyses.mat.travel import followed
from geocontact.data.errors import InputError
from geocontact.data.frame_blocks import parts
from geocontact.data.version import VERSION
from geocontact.io.text.results import CASES
from geocontact.view.surfaces.points_vtp import write_faces_vtp

if TYPE_CHECKING:
    from matplotlib.figure import Figure


MM = 1e3
REFERRED = ("wrench", "uncertainty", "segments", "shear")
"""Tables that refer to a point and a frame, which run.json names."""
OF_A_CASE = ("cells", "frames_cells")
"""Tables as gap cases hold them, in SI."""
WORDS = "forces are those of the mat on the body"


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class MatResult(MatFindings):
    """Loads of a pressure mat on a body over time; `MatFindings` has the fields."""

    @property
    def force(self) -> Float[np.ndarray, "t 3"]:
        """Force of the mat on the body over time, in the frame of the results [N]."""
        return self.loads.wrench.force

    @property
    def normal_force(self) -> Float[np.ndarray, " t"]:
        """Sum of pressure times area of all cells over time, whichever way they look [N]."""
        return self.loads.pressing

    @property
    def area(self) -> Float[np.ndarray, " t"]:
        """Area under pressure over time [m^2]."""
        return self.loads.area

    def tables(self) -> dict[str, pd.DataFrame]:
        """`wrench`, `uncertainty`, `cells`, `frames_cells`; and `segments`, `registration`, `agreement` if any."""
        return mat_tables(self)

    def figures(self) -> dict[str, Figure]:
        """`mat`: force, pressure and area over time, and the cells with their largest pressure."""
        return {"mat": mat_figure(self)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Thinned]:
        """The animated page."""
        cells = drawing(cells_figure(self))
        return {REPORT: Thinned(lambda most: mat_page(self, shown_frames(self, most), cells), FRAMES)}

    def units(self, table: str) -> Mapping[str, str]:
        """Those of gap cases for cells, which such cases hold."""
        return CASES if table in OF_A_CASE else super().units(table)

    def refers_to(self, table: str) -> Mapping[str, object] | None:
        """Point and frame of loads."""
        return self._point_and_frame() if table in REFERRED else None

    def write_files(self, folder: Path) -> None:
        """A surface for ParaView besides."""
        named, s = f"geocontact {VERSION}", self.surface
        try:
            write_faces_vtp(folder / "mat_on_surface.vtp", s.vertices, s.faces, self._on_faces(), named)
        except InputError as error:
            reserve(str(error))
        super().write_files(folder)

    def _point_and_frame(self) -> dict[str, object]:
        wrench = self.loads.wrench
        point = [float(f"{value * MM:.12g}") for value in wrench.origin[0]]
        return {"point_mm": point, "frame": wrench.frame, "words": WORDS}

    def _on_faces(self) -> dict[str, np.ndarray]:
        """Pressure of each face of the surface [Pa]: largest, mean, and under the largest force."""
        k = self.heaviest
        chosen = {
            "peak over time": self.peak,
            "mean over time": np.sum([part.sum(axis=0) for (part,) in parts(self.pressure)], axis=0)
            / len(self.pressure),
            f"frame {k + 1}, {self.frames.time[k]:g} s": self.pressure[k],
        }
        return {
            f"pressure, {name} [Pa]": self.cells.face_pressure(values[None], self.surface.face_area)[0]
            for name, values in chosen.items()
        }


def run(given: MatInputs, o: MatOptions) -> MatResult:
    """Loads of every frame that has a pose, or of every frame where nothing moves."""
    with listener().stages(o.frames.name) as at:
        return _evaluated(given, o, at)


def _evaluated(given: MatInputs, o: MatOptions, at: Callable[[str], None]) -> MatResult:
    at("recording made ready")
    seen, travel = followed(made_ready(given.recorded, given.listed_dead, o), given.motion, o)
    frames = seen.frames
    at("mat laid on its surface")
    with listener().preparing():
        there = placed(given, frames, o)
    at(f"loads of {len(frames.time)} frames")
    found = loads(given, there, seen, travel, o)
    shear = mat_shear(given, there, frames, (found.pressure, found.whole), travel, o)
    model, agreement = given.model, None
    if model is not None:
        at("comparison with the model")
        agreement = compared(model, given.phases, found.whole, frames.time, o)
    return MatResult(
        options=o,
        frames=frames,
        saturated=seen.saturated,
        surface=there.surface,
        landmarks=there.landmarks,
        drape=there.drape,
        cells=there.cells,
        pressure=found.pressure,
        loads=found.whole,
        segments=found.segments,
        uncertainty=found.covariance,
        errors=found.errors,
        home=found.home,
        registration=there.registration,
        closest_point=closest_point(there, frames, o),
        agreement=agreement,
        shear=shear,
    )


mat = Job("mat", MatOptions, read, run)
