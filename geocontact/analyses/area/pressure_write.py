"""What an analysis writes of pressures."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geocontact.analyses.area.pressure import PressureEvolution, pressure_table
from geocontact.analyses.area.pressure_figure import PressureMap, pressure_figure
from geocontact.analyses.area.pressure_page import Pressures
from geocontact.analyses.figure_files import save_both
from geocontact.data.motion import Motion
from geocontact.geometry.surface import Surface
from geocontact.io.text.results import write_table
from geocontact.view.page.content import Picture

FILE = "pressure.npz"
WORDS = (
    "Force and largest pressure over the motion; right, the mean pressure of each face of the fixed body in the frame "
    "with the largest force, and the way of the centre of pressure. Each place of the layer gives way by itself."
)


def write_pressures(
    e: PressureEvolution, fixed: Surface, motion: Motion, folder: Path, parquet: bool, save_map: bool
) -> Pressures:
    """Table, figure and maps; returns what the page shows."""
    write_table(pressure_table(motion, e), folder, parquet, "pressure")
    if save_map:
        np.savez_compressed(
            folder / FILE, allow_pickle=False, frames=np.array(e.frames), time=motion.time[e.frames],
            pressure=e.pressure, vertices=fixed.vertices, faces=fixed.faces,
        )  # fmt: skip
    sides = {side: np.array([load.pressing for load in loads]) for side, loads in e.parts.items()}
    force = {**sides, "total": e.pressing}
    peak = np.array([load.peak for load in e.loads])
    centre = np.array([load.centre for load in e.loads])
    at = PressureMap(fixed.vertices, fixed.faces, e.pressure[e.frames.index(e.heaviest)], centre, e.heaviest)
    figure = pressure_figure(motion.course, force, peak, at)
    drawing = save_both(figure, folder, "pressure")
    return Pressures(
        force=force,
        centre={
            **{side: np.array([load.centre for load in loads]) for side, loads in e.parts.items()},
            "total": centre,
        },
        peak=peak,
        area=np.array([load.area for load in e.loads]),
        maps=dict(zip(e.frames, e.pressure, strict=True)),
        law=e.layer.law,
        modulus=e.layer.modulus,
        thickness=e.thickness,
        other_modulus=e.skin.modulus,
        finer=e.finer,
        picture=Picture("Pressure", WORDS, drawing, wide=True),
    )
