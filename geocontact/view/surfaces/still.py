"""Stills of a scene: a 3-D picture with the distances, the threshold lines and what they mean."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
from jaxtyping import UInt8

from geocontact.view.surfaces import child, render
from geocontact.view.surfaces.camera import Shot, View
from geocontact.view.surfaces.child import off_screen_works
from geocontact.view.surfaces.legend import annotate
from geocontact.view.surfaces.painter import paint
from geocontact.view.surfaces.scene import ContactScene

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MM = 1e3
PATIENCE = 120.0  # s for all views of a scene


@dataclass(frozen=True)
class Still:
    """A picture that was written, by what, and if not by pyvista why not (`note`, a sentence for the user)."""

    file: Path
    renderer: Literal["pyvista", "matplotlib"]
    note: str = ""


def draw_stills(scene: ContactScene, views: Mapping[Path, View], title: str = "") -> tuple[Still, ...]:
    """Draw the scene once per view and save it under the file name of that view (png, svg, pdf by ending).

    Rendered by pyvista in a child process; where that is not possible drawn by matplotlib, and every `Still` says so.
    Views are parallel projections that take in both bodies, with a scale bar; colours have the limits of the thresholds
    in every frame.

    Parameters
    ----------
    scene
        Both bodies at one time, in FIXED's frame.
    views
        Direction of view for each file.
    title
        Line above the picture; the view and the time are added.
    """
    shots = [Shot.of(scene, view) for view in views.values()]
    pictures, trouble = _rendered(scene, shots)
    note = f"3-D stills drawn by matplotlib, because pyvista cannot render here ({trouble})" if trouble else ""
    for k, (file, view) in enumerate(views.items()):
        _save(file, scene, view, shots[k], pictures[k] if pictures else None, title)
    return tuple(Still(file, "matplotlib" if trouble else "pyvista", note) for file in views)


def _rendered(scene: ContactScene, shots: list[Shot]) -> tuple[list[UInt8[np.ndarray, "h w 3"]], str]:
    """Pictures of the shots, or why there are none."""
    probe = off_screen_works()
    if not probe.ok:
        return [], probe.reason
    with tempfile.TemporaryDirectory(prefix="geocontact-", ignore_cleanup_errors=True) as name:
        folder = Path(name)
        render.hand_over(scene, shots, folder)
        trouble = child.outcome(child.start(render.PROGRAM, name), PATIENCE)
        if trouble:
            return [], trouble
        return [np.load(folder / f"{k}.npy", allow_pickle=False) for k in range(len(shots))], ""


def _save(
    file: Path, scene: ContactScene, view: View, shot: Shot, picture: UInt8[np.ndarray, "h w 3"] | None, title: str
) -> None:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 6.4), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    _frame(axes, shot)
    if picture is None:
        paint(axes, scene, shot)
    else:
        width, height = shot.half[:2] * MM
        axes.imshow(picture, extent=(-width, width, -height, height), interpolation="antialiased")
    annotate(figure, axes, scene, view, shot, title)
    figure.savefig(file, dpi=200, metadata={"Date": None} if file.suffix == ".svg" else None)


def _frame(axes: Axes, shot: Shot) -> None:
    width, height = (float(half) * MM for half in shot.half[:2])
    axes.set_xlim(-width, width)
    axes.set_ylim(-height, height)
    axes.set_aspect("equal")
    axes.set_axis_off()
