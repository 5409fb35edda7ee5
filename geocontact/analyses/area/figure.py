"""Static figures of areas, stills and series for 3-D viewers, and the limits of their colours."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, Int

from geocontact.analyses.area.bodies import Bodies
from geocontact.analyses.area.contact import MotionResult
from geocontact.analyses.area.wear import face_depths
from geocontact.data.evolution import MM, MM2, AreaEvolution
from geocontact.data.motion import Course
from geocontact.data.version import VERSION
from geocontact.view.curves.declared import Curve, Curves, stroke
from geocontact.view.curves.drawn import draw_on
from geocontact.view.curves.sheet import plain
from geocontact.view.curves.style import COLOURS, empty, in_style
from geocontact.view.surfaces.camera import View, camera_directions
from geocontact.view.surfaces.legend import distance_colours
from geocontact.view.surfaces.scene import ContactScene, ContactSeries, MappedBody
from geocontact.view.surfaces.still import draw_stills
from geocontact.view.surfaces.vtp_series import write_vtp_series

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


TICK = 0.5e-3  # m; the colours end at a round number


def colour_span(e: AreaEvolution) -> tuple[float, float]:
    """Lower and upper end [m]: below the deepest overlap where it is known, up to the largest threshold evaluated."""
    farthest = max((*e.thresholds, *e.sensitivity_thresholds, TICK))
    if e.signed == "none":
        return (0.0 if min(e.thresholds) > 0.0 else -TICK), farthest
    deepest = min(-0.25 * max(e.thresholds), float(e.min_distance.min()), -TICK)
    return float(-np.ceil(-deepest / TICK) * TICK), farthest


WIDE = 0.22
"""Width of the figure [m]: curves beside a map."""


@in_style
def area_figure(
    evolution: AreaEvolution,
    vertices: Float[np.ndarray, "n 3"],
    faces: Int[np.ndarray, "m 3"],
    distance: Float[np.ndarray, " n"],
    frame: int,
    title: str,
    course: Course,
    span: tuple[float, float],
) -> Figure:
    """Areas and separation over the motion, and FIXED in one frame.

    Parameters
    ----------
    evolution
        What to draw.
    vertices, faces, distance
        FIXED [m] and the signed distance of its vertices to MOVING at `frame` [m]; infinite where far.
    course
        Along what the frames follow each other.
    span
        Ends of the colours [m], those of the page.
    """
    figure = empty(WIDE, 0.115)
    panels = figure.subplot_mosaic([["area", "map"], ["gap", "map"]], height_ratios=[3, 2], width_ratios=[3, 2])
    draw_on(panels["area"], area_curves(evolution, int(np.argmax(evolution.thresholds))), course)
    panels["area"].set_ylim(bottom=0.0)
    draw_on(panels["gap"], distance_curves(evolution), course)
    _patch(panels["map"], evolution, vertices, faces, distance, span)
    panels["map"].set_title(f"FIXED at {plain(course.at(frame))},\n{panels['map'].get_title()}")
    figure.suptitle(f"{plain(title)}; signed: {evolution.signed}, shaded: certified bounds", fontsize=9.0)
    return figure


def area_curves(e: AreaEvolution, main: int, moving: bool = True) -> Curves:
    """Areas with their bounds, those of threshold `main` first; of MOVING where that is wanted."""

    def within(k: int) -> Curve:
        name = f"fixed body, {e.thresholds[k] * MM:g} mm"
        own, lower, upper = (side[:, k] * MM2 for side in (e.fixed.area, e.fixed.lower, e.fixed.upper))
        return Curve(name, own, lower, upper, stroke(_hue(e, main, k)))

    parts = {"medial": e.medial, "lateral": e.lateral} if e.medial_side else {}
    if moving:
        parts["moving body"] = e.moving.area
    areas = [within(main)]
    areas += [
        Curve(f"{name}, {e.thresholds[main] * MM:g} mm", part[:, main] * MM2, stroke=stroke(0, 1 + j))
        for j, (name, part) in enumerate(parts.items())
    ]
    areas += [within(k) for k in range(len(e.thresholds)) if k != main]
    return Curves("Contact area", "mm²", areas)


def _hue(e: AreaEvolution, main: int, k: int) -> int:
    """Colour of threshold `k`, of its curve and of its contour: that of `main` comes first."""
    return ([main, *(j for j in range(len(e.thresholds)) if j != main)].index(k)) % len(COLOURS)


def distance_curves(e: AreaEvolution) -> Curves:
    """The smallest distance, and how deep FIXED is penetrated where that is known."""
    curves = [Curve("smallest distance", e.min_distance * MM)]
    if np.isfinite(e.max_penetration_fixed).any():
        curves.append(Curve("− penetration of the fixed body", -e.max_penetration_fixed * MM))
    return Curves("Smallest distance (negative: overlap)", "mm", curves)


def _patch(
    axes: Axes,
    e: AreaEvolution,
    vertices: Float[np.ndarray, "n 3"],
    faces: Int[np.ndarray, "m 3"],
    distance: Float[np.ndarray, " n"],
    span: tuple[float, float],
) -> None:
    """FIXED seen along the direction in which its patch looks, coloured by distance, with the threshold's contour."""
    from matplotlib.tri import Triangulation

    largest = max(e.thresholds)
    lower, upper = (limit * 1e3 for limit in span)
    corners = vertices[faces] * 1e3
    shown = np.where(np.isfinite(distance), distance, largest * 4.0 + 1.0)
    near = (shown[faces] <= largest).any(axis=1)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    view = normal[near].sum(axis=0) if near.any() else normal.sum(axis=0)
    axis = int(np.argmax(np.abs(view)))
    sign = 1.0 if view[axis] >= 0.0 else -1.0
    right, up = ((1, 2), (2, 0), (0, 1))[axis]
    visible = normal[:, axis] * sign > 0.0
    height = corners[visible][:, :, axis].mean(axis=1) * sign
    seen = faces[visible][np.argsort(height, kind="stable")]  # what lies on top is drawn last
    x, y = vertices[:, right] * 1e3, vertices[:, up] * 1e3
    far = ~np.isfinite(distance[seen]).all(axis=1)
    grey = np.full(len(seen), 0.85)
    if far.any():
        axes.tripcolor(
            Triangulation(x, y, seen[far]), facecolors=grey[far], cmap="Greys_r", vmin=0.0, vmax=1.0, rasterized=True
        )
    if not far.all():
        colours = axes.tripcolor(
            Triangulation(x, y, seen[~far]),
            np.clip(shown * 1e3, lower, upper),
            shading="gouraud",
            rasterized=True,
            cmap=distance_colours(lower, upper),
            vmin=lower,
            vmax=upper,
        )
        signed = "signed distance [mm]" if e.signed in ("both", "fixed") else "distance [mm]"
        axes.figure.colorbar(colours, ax=axes, label=signed, shrink=0.7)
    for k, threshold in enumerate(e.thresholds):
        if near.any() and shown.min() < threshold < shown.max():
            colour, level = COLOURS[_hue(e, int(np.argmax(e.thresholds)), k)], [threshold * 1e3]
            axes.tricontour(Triangulation(x, y, seen), shown * 1e3, levels=level, colors=colour, linewidths=1.2)
    axes.set_aspect("equal")
    axes.set_xlabel(f"{'xyz'[right]} [mm]")
    axes.set_ylabel(f"{'xyz'[up]} [mm]")
    axes.set_title(f"seen along {'-' if sign > 0 else '+'}{'xyz'[axis]}")


STILL = "still_"


def write_paraview(folder: Path, bodies: Bodies, one: MotionResult) -> None:
    """Write the frames whose distances are kept as .vtp files with .pvd collections, pressures of FIXED's faces too."""
    kept, e, motion = one.maps.frames, one.evolution, one.motion
    frames = np.asarray(kept, np.int64)
    pressure = None if one.pressure is None else np.array([one.pressure.maps[k] for k in kept])
    wear = None if one.wear is None else face_depths(one.wear, len(bodies.fixed.faces))
    series = ContactSeries(
        time=motion.time[frames],
        poses=motion.poses[frames],
        fixed=MappedBody(bodies.fixed.vertices, bodies.fixed.faces, one.maps.fixed, pressure, wear),
        moving=MappedBody(bodies.moving.vertices, bodies.moving.faces, one.maps.moving),
        thresholds=e.thresholds,
        signed=e.signed,
        time_unit=motion.time_unit,
    )
    write_vtp_series(series, folder, f"geocontact {VERSION}")


def write_stills(folder: Path, bodies: Bodies, one: MotionResult, title: str) -> list[str]:
    """Draw the frame with the largest area from each side; returns what has to be said about it."""
    k, evolution, motion = one.maps.largest, one.evolution, one.motion
    scene = ContactScene(
        fixed_vertices=bodies.fixed.vertices,
        fixed_faces=bodies.fixed.faces,
        distance=one.maps.fixed_at_largest,
        moving_vertices=motion.poses[k].apply(bodies.moving.vertices),
        moving_faces=bodies.moving.faces,
        thresholds=evolution.thresholds,
        time=float(motion.course.values[k]),
        signed=evolution.signed in ("both", "fixed"),
        time_unit=motion.course.unit,
    )
    directions = camera_directions(np.asarray(evolution.split_normal) * evolution.medial_side)
    views = {folder / f"{STILL}{_word(name)}.png": View(name, way) for name, way in directions.items()}
    return list(dict.fromkeys(still.note for still in draw_stills(scene, views, title) if still.note))


def _word(direction: str) -> str:
    """First word of a direction, fit for a file name: "medial (+z)", "−x" to "medial", "minus_x"."""
    return direction.split(maxsplit=1)[0].replace("+", "plus_").replace("−", "minus_")
