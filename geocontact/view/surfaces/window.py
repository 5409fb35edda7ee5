"""An interactive window with a time slider, for a desktop."""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial.transform import RigidTransform

from geocontact.data.errors import InputError
from geocontact.view.surfaces import child
from geocontact.view.surfaces.camera import Shot, View
from geocontact.view.surfaces.child import INSTALL
from geocontact.view.surfaces.legend import DISTANCE_MAP, distance_limits
from geocontact.view.surfaces.render import MM, add_fixed, add_lines, add_moving, light, look
from geocontact.view.surfaces.scene import ContactSeries, MappedBody

if TYPE_CHECKING:
    from pyvista import Plotter

PROGRAM = "import sys; from geocontact.view.surfaces.window import main; main(sys.argv[1])"
NO_SCREEN = "there is no display to open a window on"
REMEDY = "run it on a desktop, or write stills or VTP files instead"
OBLIQUE = View("oblique", (0.5, 0.8, 0.6))


def show_window(series: ContactSeries, view: View = OBLIQUE) -> None:
    """Show both bodies in a window and return when it is closed.

    The slider and the arrow keys choose the frame. The window runs in a child process: what a graphics driver does to
    it, it does not do to the caller.

    Raises
    ------
    InputError
        There is no pyvista, no display, or the window ended otherwise than by being closed.
    """
    if find_spec("pyvista") is None:
        raise InputError("", "3-D window", "pyvista is not installed", INSTALL)
    if not has_display():
        raise InputError("", "3-D window", NO_SCREEN, REMEDY)
    with tempfile.TemporaryDirectory(prefix="geocontact-", ignore_cleanup_errors=True) as name:
        _hand_over(series, view, Path(name))
        trouble = child.outcome(child.start(PROGRAM, name), None)
    if trouble:
        raise InputError("", "3-D window", trouble, REMEDY)


def has_display() -> bool:
    """Whether this session names a display; macOS and Windows always have one."""
    return sys.platform in ("darwin", "win32") or bool(os.environ.get("DISPLAY"))


def _hand_over(series: ContactSeries, view: View, folder: Path) -> None:
    np.savez(
        folder / "series.npz",
        allow_pickle=False,
        time=series.time,
        X_FM=series.poses.as_matrix(),
        fixed_vertices=series.fixed.vertices,
        fixed_faces=series.fixed.faces,
        fixed_distance=series.fixed.distance,
        moving_vertices=series.moving.vertices,
        moving_faces=series.moving.faces,
        moving_distance=series.moving.distance,
        thresholds=np.asarray(series.thresholds),
        signed=series.signed,
        time_unit=series.time_unit,
        axes=view.axes(),
    )


def main(folder: str) -> None:
    """Open the window on what `show_window` has left in `folder`; the program of the child process."""
    with np.load(Path(folder) / "series.npz", allow_pickle=False) as stored:
        given = dict(stored)
    fixed, moving = (
        MappedBody(*(given[f"{body}_{part}"] for part in ("vertices", "faces", "distance")))
        for body in ("fixed", "moving")
    )
    series = ContactSeries(
        time=given["time"],
        poses=RigidTransform.from_matrix(given["X_FM"]),
        fixed=fixed,
        moving=moving,
        thresholds=tuple(float(t) for t in given["thresholds"]),
        signed=str(given["signed"]),
        time_unit=str(given["time_unit"]),
    )
    toward, up = given["axes"][2], given["axes"][1]
    plotter = arranged(series, View("", tuple(toward.tolist()), tuple(up.tolist())), off_screen=False)
    # where the display does not answer, VTK goes on without one
    if sys.platform not in ("darwin", "win32") and not plotter.render_window.IsA("vtkXOpenGLRenderWindow"):
        raise SystemExit(NO_SCREEN)
    plotter.show(title="geocontact")


def arranged(series: ContactSeries, view: View, off_screen: bool) -> Plotter:
    """The window's contents with its slider, not yet shown."""
    import pyvista

    plotter = pyvista.Plotter(off_screen=off_screen, window_size=[1280, 960], lighting="none")
    light(plotter)
    plotter.enable_depth_peeling(number_of_peels=6)
    plotter.enable_anti_aliasing("ssaa")  # multisampling would leave out what is translucent
    plotter.add_axes(color="black")
    show = _player(plotter, series)
    show(0)
    _add_scale(plotter, series)
    look(plotter, Shot.of(series.scene(0), view))
    plotter.camera.parallel_scale *= 1.2  # room for the slider
    if len(series) > 1:
        _add_slider(plotter, series, show)
    return plotter


def _player(plotter: Plotter, series: ContactSeries) -> Callable[[int], None]:
    """Function that replaces what is shown by another frame."""
    shown: list[Any] = []
    corners = series.fixed.vertices[series.fixed.faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), np.finfo(float).tiny)
    lift = 0.004 * float(np.ptp(corners.reshape(-1, 3), axis=0).max()) * normal

    def show(frame: int) -> None:
        scene = series.scene(frame)
        plotter.suppress_rendering = True
        for actor in shown:
            plotter.remove_actor(actor, reset_camera=False, render=False)
        shown[:] = [
            add_fixed(plotter, scene),
            *add_lines(plotter, scene, lift, width=7.0),
            *add_moving(plotter, scene.moving_vertices, scene.moving_faces),
        ]
        plotter.suppress_rendering = False

    return show


def _add_slider(plotter: Plotter, series: ContactSeries, show: Callable[[int], None]) -> None:
    current = 0

    def go(frame: int) -> None:
        nonlocal current
        if frame != current:
            current = frame
            show(frame)
            plotter.render()

    def step(by: int) -> None:
        frame = min(max(current + by, 0), len(series) - 1)
        slider.GetRepresentation().SetValue(float(series.time[frame]))
        go(frame)

    slider = plotter.add_slider_widget(
        lambda time: go(int(np.abs(series.time - time).argmin())),
        [float(series.time[0]), float(series.time[-1])],
        value=float(series.time[0]),
        title=f"time [{series.time_unit}]",
        pointa=(0.25, 0.08),
        pointb=(0.75, 0.08),
        color="#404040",
        interaction_event="always",
        title_height=0.02,
        slider_width=0.02,
        tube_width=0.004,
        fmt="%.3g",
    )
    plotter.add_key_event("Left", lambda: step(-1))
    plotter.add_key_event("Right", lambda: step(1))


def _add_scale(plotter: Plotter, series: ContactSeries) -> None:
    """Colour bar of the whole map; FIXED's own colours end where the distance is not known."""
    import pyvista

    bar = {
        "title": ("signed distance" if series.signed in ("both", "fixed") else "distance") + " [mm]",
        "vertical": True,
        "position_x": 0.88,
        "position_y": 0.3,
        "height": 0.45,
        "width": 0.05,
        "fmt": "%.1f",
        "n_labels": 6,
        "title_font_size": 18,
        "label_font_size": 16,
        "font_family": "arial",
        "color": "black",
    }
    limits = [limit * MM for limit in distance_limits(series.thresholds)]
    point = pyvista.PolyData(series.fixed.vertices[series.fixed.faces[0, :1]] * MM)
    point.point_data["distance"] = [0.0]
    plotter.add_mesh(
        point, scalars="distance", cmap=DISTANCE_MAP, clim=limits, scalar_bar_args=bar, opacity=0.0, pickable=False
    )
