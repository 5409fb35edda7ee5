"""What is shown of a mat: static figure and animated page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, Int

from geocontact.analyses.frame.collector import spelled
from geocontact.analyses.frame.pages import INPUTS, OPTIONS, thinned
from geocontact.analyses.frame.words import NOT_A_DEVICE, headline
from geocontact.analyses.mat.loads import ALONG, SUM, MatFindings
from geocontact.data.motion import Course
from geocontact.geometry.drape.cells import Drape
from geocontact.loads.closest_point_mat import ClosestPoint
from geocontact.view.curves.declared import INK, Curve, Curves, CurveSheet, stroke
from geocontact.view.curves.drawn import draw_on
from geocontact.view.curves.style import DOUBLE, empty, in_style, panels
from geocontact.view.page.content import (
    FaceMap,
    Page,
    Picture,
    Readout,
    Row,
    Scene,
    SceneBody,
    Section,
    Table,
    Words,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


FORCE, PRESSURE, AREA = FIGURED = ("Force on the body", "Pressure", "Area under pressure")
"""Titles of the panels that the static figure shows."""


UNTOUCHED = "#c9cdd2"  # of cells without pressure, as of faces on the page


@in_style
def mat_figure(r: MatFindings) -> Figure:
    """Force, largest pressure and area over time; beside them the largest pressure of each cell."""
    figure = empty(1.3 * DOUBLE, 0.13)
    grid = figure.add_gridspec(len(FIGURED), 2, width_ratios=(3, 2))
    sheet = mat_curves(r)
    shown = [panel for panel in sheet.panels if panel.title in FIGURED]
    for k, panel in enumerate(shown):
        draw_on(figure.add_subplot(grid[k, 0]), panel, sheet.over)
    _cells(figure, figure.add_subplot(grid[:, 1]), r)
    return figure


@in_style
def cells_figure(r: MatFindings) -> Figure:
    """The mat unrolled with the largest pressure of each cell, alone."""
    figure, (axes,) = panels(1, 1, 0.11, 0.09)
    _cells(figure, axes, r)
    return figure


def _cells(figure: Figure, axes: Axes, r: MatFindings) -> None:
    """The largest pressure of each cell, in the colours of the page, which end at that of a face in all frames."""
    from matplotlib import colormaps

    grid = np.full(r.drape.area.shape, np.nan)
    grid[r.cells.cell[:, 0], r.cells.cell[:, 1]] = r.peak * KPA
    grid[grid == 0.0] = -1.0
    colours = colormaps["inferno_r"].with_extremes(under=UNTOUCHED)
    image = axes.imshow(grid, cmap=colours, vmin=0.0, vmax=float(r.on_faces.max()) * KPA or 1.0)
    figure.colorbar(image, ax=axes, label="largest pressure [kPa]", shrink=0.8)
    axes.set_xlabel("column")
    axes.set_ylabel("row")


FRAMES = 201  # frames that the page animates at most
KPA, CM2, MM = 1e-3, 1e4, 1e3
NEAR = 1e-3  # m; a scene asks for a distance, and nothing here has one
CELLS = "The mat unrolled, with the largest pressure of each cell in the colours of the picture above."
AXES: Mapping[str, Sequence[float]] = {
    "+x": (1.0, 0.0, 0.0),
    "−x": (-1.0, 0.0, 0.0),
    "+y": (0.0, 1.0, 0.0),
    "−y": (0.0, -1.0, 0.0),
    "+z": (0.0, 0.0, 1.0),
    "−z": (0.0, 0.0, -1.0),
}


def shown_frames(r: MatFindings, most: int) -> Int[np.ndarray, " k"]:
    """About so many frames at most, those with the extremes among them."""
    return thinned(len(r.frames.time), [r.loads.pressing, r.loads.peak], [r.heaviest, int(np.argmax(r.on_faces))], most)


def mat_page(r: MatFindings, shown: Int[np.ndarray, " k"], cells: bytes) -> Page:
    """The page before it becomes a file; `cells` is the drawing of `cells_figure` (SVG)."""
    sections: list[Section] = [_scene(r, shown), Readout(_rows(r, shown)), *mat_curves(r).at(shown)]
    sections.append(Picture("Largest pressure of each cell", CELLS, cells))
    if r.closest_point is not None:
        sections.append(_two_ways(r, r.closest_point))
    sections += [INPUTS, OPTIONS]
    sections.append(Words("What the numbers rest on", [*_reservations(r), NOT_A_DEVICE]))
    part = f"the page shows {len(shown)} of {len(r.frames.time)} frames; wrench.csv has them all"
    return Page(
        title=f"{r.frames.name} on {r.surface.name}",
        subtitle=f"Pressure mat of {r.frames.rows} × {r.frames.columns} cells on a body scan",
        time=r.frames.time[shown],
        time_label="time [s]",
        headline=headline(r.record.sentences, most=2),
        facts=_facts(r),
        reservations=(part,) if len(shown) < len(r.frames.time) else (),
        start_frame=int(np.flatnonzero(shown == r.heaviest)[0]),
        sections=tuple(sections),
        numbers=shown + 1,
        total=len(r.frames.time),
    )


def _scene(r: MatFindings, shown: Int[np.ndarray, " k"]) -> Scene:
    values = r.cells.face_pressure(r.pressure[shown], r.surface.face_area) * KPA
    return Scene(
        bodies=(SceneBody(r.surface.name, r.surface.vertices, r.surface.faces),),
        thresholds=(NEAR,),
        span=(0.0, NEAR),
        value_name="",
        directions=AXES,
        view=tuple(_facing(r).tolist()),
        maps=(FaceMap("pressure on each face", "kPa", 0, values),),
    )


def _facing(r: MatFindings) -> Float[np.ndarray, " 3"]:
    """Where the mat is seen from: against its mean normal; a belt has none, and is seen at the cell pressed most."""
    if np.isfinite(r.loads.normal).all():
        return r.loads.normal
    row, column = r.cells.cell[int(np.argmax(r.pressure[r.heaviest]))]
    return np.asarray(r.drape.normal[row, column])


def _rows(r: MatFindings, shown: Int[np.ndarray, " k"]) -> list[Row]:
    w = r.loads
    sd = r.deviation[shown]
    rows = [
        Row(SUM, "N", _texts(w.pressing[shown], 1)),
        Row(ALONG, "N", _texts(w.perpendicular[shown], 1)),
        *(Row(f"resultant {axis}", "N", _with(w.wrench.force[shown, k], sd[:, k], 1)) for k, axis in enumerate("xyz")),
        *(
            Row(f"moment {axis} about {_point(r)}", "N m", _with(w.wrench.moment[shown, k], sd[:, 3 + k], 2))
            for k, axis in enumerate("xyz")
        ),
        Row("largest pressure", "kPa", _texts(w.peak[shown] * KPA, 1)),
        Row("mean pressure where it touches", "kPa", _texts(w.mean[shown] * KPA, 1)),
        Row("area", "cm²", _texts(w.area[shown] * CM2, 1)),
        *(Row(f"centre of pressure {axis}", "mm", _texts(w.centre[shown, k] * MM, 1)) for k, axis in enumerate("xyz")),
    ]
    return rows + [Row(f"force, {name}", "N", _texts(part.pressing[shown], 1)) for name, part in r.segments.items()]


def mat_curves(r: MatFindings) -> CurveSheet:
    """Forces, moment, pressures, area and centre of pressure over time."""
    w = r.loads
    parts = [Curve(name, part.pressing) for name, part in r.segments.items()]
    by_axis = [(axis, stroke(k, k)) for k, axis in enumerate("xyz")]
    panels = [
        Curves(
            FORCE,
            "N",
            [
                Curve(SUM, w.pressing, stroke=INK),
                Curve(ALONG, w.perpendicular, stroke=stroke(3, 3)),
                *(
                    Curve(f"resultant {axis}", w.wrench.force[:, k], stroke=own)
                    for k, (axis, own) in enumerate(by_axis)
                ),
            ],
        ),
        *([Curves("Force of each segment", "N", parts)] if parts else []),
        Curves(
            f"Moment about {_point(r)}",
            "N m",
            [Curve(axis, w.wrench.moment[:, k], stroke=own) for k, (axis, own) in enumerate(by_axis)],
        ),
        Curves(
            PRESSURE,
            "kPa",
            [Curve("largest", w.peak * KPA, stroke=INK), Curve("mean where it touches", w.mean * KPA, stroke=0)],
        ),
        Curves(AREA, "cm²", [Curve("area", w.area * CM2, stroke=INK)]),
        Curves(
            "Centre of pressure",
            "mm",
            [Curve(axis, w.centre[:, k] * MM, stroke=own) for k, (axis, own) in enumerate(by_axis)],
        ),
    ]
    return CurveSheet(panels, Course("time", "s", r.frames.time))


TWO_SIZES = (
    f"The {SUM} counts every cell, whichever way it looks. The resultant adds forces as vectors: it is smaller where "
    "the mat bends; x, y and z are its components."
)


def _point(r: MatFindings) -> str:
    """The point that moments refer to: "the origin", else its place in mm."""
    places = np.reshape(r.loads.wrench.origin, (-1, 3)) * MM
    if np.ptp(places, axis=0).max() > 1e-6:
        return "a point that moves"
    x, y, z = places[0] + 0.0
    return "the origin" if not places[0].any() else f"({x:.4g}, {y:.4g}, {z:.4g}) mm"


def _facts(r: MatFindings) -> list[tuple[str, str]]:
    k, w = r.heaviest, r.loads
    peak = int(np.argmax(w.peak))
    along = [] if np.isnan(w.perpendicular[k]) else [(f"R{ALONG[1:]}, then", f"{w.perpendicular[k]:.1f} N")]
    lines = [
        (
            "Largest force",
            f"{w.pressing[k]:.1f} N at {r.frames.time[k]:.2f} s ({SUM})",
        ),
        *along,
        ("Largest pressure", f"{w.peak[peak] * KPA:.1f} kPa at {r.frames.time[peak]:.2f} s"),
        ("Area under the largest force", f"{w.area[k] * CM2:.0f} cm²"),
    ]
    if np.isfinite(w.centre[k, 0]):
        x, y, z = w.centre[k] * MM
        lines.append(("Centre of pressure then", f"x {x:.1f}, y {y:.1f}, z {z:.1f} mm"))
    return lines


def _reservations(r: MatFindings) -> list[str]:
    known = np.abs(r.drape.distortion[r.drape.covered])
    sd = np.sqrt(np.trace(r.uncertainty[r.heaviest][:3, :3]))
    met = r.drape.misses[np.isfinite(r.drape.misses)]
    miss = f"{met.max() * MM:.1f} mm" if len(met) else "an unknown distance"
    frame = r.loads.wrench.frame
    still = "" if frame == r.home else f" The picture stands still in the frame {r.home}, with which the segment moves."
    return [
        f"Forces, moments and centres of pressure are in the frame {frame}, moments about {_point(r)} in it.{still}",
        TWO_SIZES,
        "A mat measures forces perpendicular to its cells. Friction along the skin is not included.",
        f"Cells are up to {known.max():.1%} larger or smaller on the scan than flat; each keeps its own sensing area.",
        f"Landmarks are missed by up to {miss}.",
        f"The errors that were stated make the largest force uncertain by {sd:.1f} N (standard deviation).",
        spelled(
            "What was neither stated (`gain`, `registration`) nor estimated by registration is not in that number."
        ),
        "The scan does not deform: where soft tissue yields under load, pressures are shown on its unloaded shape.",
    ]


def _two_ways(r: MatFindings, flat: ClosestPoint) -> Table:
    """The mat as it is laid, and as closest points would lay it."""
    at, drapes, both = flat.frame, (r.drape, flat.drape), (flat.used, flat.projected)
    rows = [
        ("area of a cell, largest change", *(f"{_largest(r, each):.1%}" for each in drapes)),
        ("cells off the scan", *(str(int((r.frames.valid & ~each.covered).sum())) for each in drapes)),
        *((f"force {axis} [N]", *(f"{each.wrench.force[at, k]:.2f}" for each in both)) for k, axis in enumerate("xyz")),
        *(
            (f"centre of pressure {axis} [mm]", *(f"{each.centre[at, k] * MM:.1f}" for each in both))
            for k, axis in enumerate("xyz")
        ),
    ]
    title = f"Laid along the surface, and pushed straight down (frame {at + 1}, axes of the scan)"
    return Table(title, ("", "along the surface (used)", "closest points"), rows)


def _largest(r: MatFindings, laid: Drape) -> float:
    return float(np.abs(laid.distortion[laid.covered & r.frames.valid]).max())


def _texts(values: Float[np.ndarray, " k"], digits: int) -> list[str]:
    return ["–" if np.isnan(value) else f"{value:.{digits}f}" for value in values]


def _with(values: Float[np.ndarray, " k"], sd: Float[np.ndarray, " k"], digits: int) -> list[str]:
    return [f"{value:.{digits}f} ± {one:.{digits}f}" for value, one in zip(values, sd, strict=True)]
