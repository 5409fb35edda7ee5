"""The page of a pressure mat on a scan: where it presses, how much, when, and how far to trust it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int

from geocontact.analyses.page_words import NOT_A_DEVICE
from geocontact.data.pressure_frames import PressureFrames
from geocontact.geometry.drape.cells import Drape
from geocontact.geometry.surface import Surface
from geocontact.loads.mat.load import MatLoad
from geocontact.loads.mat.map import MatMap
from geocontact.view.page.content import (
    Body,
    Curve,
    Curves,
    FaceMap,
    Page,
    Picture,
    Readout,
    Row,
    Scene,
    Section,
    Table,
    Words,
)
from geocontact.view.page.write import write_page

FRAMES = 201  # frames that the page animates at most
FEWEST = 21  # frames below which a page is not thinned any further
LARGEST_FILE = 5_000_000  # bytes
KPA, CM2, MM = 1e-3, 1e4, 1e3
NEAR = 1e-3  # m; a scene asks for a distance, and nothing here has one
FIGURE = "Force, pressure and area over time; right, the mat unrolled with the largest pressure of each cell."
AXES: Mapping[str, Sequence[float]] = {
    "+x": (1.0, 0.0, 0.0), "−x": (-1.0, 0.0, 0.0), "+y": (0.0, 1.0, 0.0), "−y": (0.0, -1.0, 0.0),
    "+z": (0.0, 0.0, 1.0), "−z": (0.0, 0.0, -1.0),
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class MatStory:
    """What the page tells; `pressure` is that of the cells of the map, `drawing` the static figure.

    `home` names the frame that the scene is in, which is not that of the loads where the segment moves.
    """

    surface: Surface
    frames: PressureFrames
    map: MatMap
    laid: Drape
    pressure: Float[np.ndarray, "t n"]
    whole: MatLoad
    parts: Mapping[str, MatLoad]
    covariance: Float[np.ndarray, "t six six"]
    drawing: bytes
    home: str = ""

    @property
    def heaviest(self) -> int:
        """Frame with the largest force."""
        return int(np.argmax(self.whole.pressing))


def write_mat_report(
    path: Path, title: str, story: MatStory, tables: Sequence[Table] = (), warnings: Sequence[str] = ()
) -> int:
    """Write the self-contained page; returns its size in bytes. Long recordings are thinned out, as the page says."""
    most = FRAMES
    while True:
        every = -(-len(story.frames.time) // most)
        shown = np.unique([*range(0, len(story.frames.time), every), story.heaviest])
        size = write_page(mat_page(title, story, shown, tables, warnings), path)
        most = len(shown) // 2
        if size <= LARGEST_FILE or most < FEWEST:
            return size


def mat_page(
    title: str, s: MatStory, shown: Int[np.ndarray, " k"], tables: Sequence[Table], warnings: Sequence[str]
) -> Page:
    """The page before it becomes a file."""
    sections: list[Section] = [_scene(s, shown), Readout(_rows(s, shown)), *_curves(s, shown)]
    sections += [Picture("The mat", FIGURE, s.drawing, wide=True), *tables]
    sections.append(Words("What the numbers rest on", [*_reservations(s), NOT_A_DEVICE]))
    if len(shown) < len(s.frames.time):
        warnings = [*warnings, f"the page shows {len(shown)} of {len(s.frames.time)} frames; wrench.csv has them all"]
    if warnings:
        sections.append(Words("Reservations of this run", list(warnings)))
    return Page(
        title=title,
        subtitle=f"Pressure mat of {s.frames.rows} × {s.frames.columns} cells on a body scan",
        time=s.frames.time[shown],
        time_label="time [s]",
        headline=_headline(s),
        start_frame=int(np.flatnonzero(shown == s.heaviest)[0]),
        sections=tuple(sections),
        numbers=shown + 1,
        total=len(s.frames.time),
    )


def _scene(s: MatStory, shown: Int[np.ndarray, " k"]) -> Scene:
    values = s.map.face_pressure(s.pressure[shown], s.surface.face_area) * KPA
    return Scene(
        bodies=(Body(s.surface.name, s.surface.vertices, s.surface.faces),),
        thresholds=(NEAR,),
        span=(0.0, NEAR),
        value_name="",
        directions=AXES,
        view=tuple(_facing(s).tolist()),
        maps=(FaceMap("pressure on each face", "kPa", 0, values),),
    )


def _facing(s: MatStory) -> Float[np.ndarray, " 3"]:
    """Where the mat is seen from: against its mean normal; a belt has none, and is seen at the cell pressed most."""
    if np.isfinite(s.whole.normal).all():
        return s.whole.normal
    row, column = s.map.cell[int(np.argmax(s.pressure[s.heaviest]))]
    return np.asarray(s.laid.normal[row, column])


def _rows(s: MatStory, shown: Int[np.ndarray, " k"]) -> list[Row]:
    w = s.whole
    sd = np.sqrt(np.maximum(np.diagonal(s.covariance, axis1=1, axis2=2), 0.0))[shown]
    rows = [
        Row("force, perpendicular", "N", _texts(w.perpendicular[shown], 1)),
        *(Row(f"force {axis}", "N", _with(w.wrench.force[shown, k], sd[:, k], 1)) for k, axis in enumerate("xyz")),
        *(
            Row(f"moment {axis}", "N m", _with(w.wrench.moment[shown, k], sd[:, 3 + k], 2))
            for k, axis in enumerate("xyz")
        ),
        Row("largest pressure", "kPa", _texts(w.peak[shown] * KPA, 1)),
        Row("mean pressure where it touches", "kPa", _texts(w.mean[shown] * KPA, 1)),
        Row("area", "cm²", _texts(w.area[shown] * CM2, 1)),
        *(Row(f"centre of pressure {axis}", "mm", _texts(w.centre[shown, k] * MM, 1)) for k, axis in enumerate("xyz")),
    ]
    return rows + [Row(f"force, {name}", "N", _texts(part.pressing[shown], 1)) for name, part in s.parts.items()]


def _curves(s: MatStory, shown: Int[np.ndarray, " k"]) -> list[Curves]:
    w = s.whole
    parts = [Curve(name, part.pressing[shown]) for name, part in s.parts.items()]
    return [
        Curves(
            "Force on the body",
            "N",
            [
                Curve("perpendicular", w.perpendicular[shown]),
                *(Curve(axis, w.wrench.force[shown, k]) for k, axis in enumerate("xyz")),
            ],
        ),
        *([Curves("Force of each segment", "N", parts)] if parts else []),
        Curves("Moment", "N m", [Curve(axis, w.wrench.moment[shown, k]) for k, axis in enumerate("xyz")]),
        Curves("Largest pressure", "kPa", [Curve("largest pressure", w.peak[shown] * KPA)]),
        Curves("Centre of pressure", "mm", [Curve(axis, w.centre[shown, k] * MM) for k, axis in enumerate("xyz")]),
    ]


def _headline(s: MatStory) -> list[tuple[str, str]]:
    k, w = s.heaviest, s.whole
    peak = int(np.argmax(w.peak))
    along = "" if np.isnan(w.perpendicular[k]) else f" ({w.perpendicular[k]:.0f} N perpendicular)"
    lines = [
        (
            "Largest force",
            f"{w.pressing[k]:.0f} N at {s.frames.time[k]:.2f} s{along}",
        ),
        ("Largest pressure", f"{w.peak[peak] * KPA:.1f} kPa at {s.frames.time[peak]:.2f} s"),
        ("Area under the largest force", f"{w.area[k] * CM2:.0f} cm²"),
    ]
    if np.isfinite(w.centre[k, 0]):
        x, y, z = w.centre[k] * MM
        lines.append(("Centre of pressure then", f"x {x:.1f}, y {y:.1f}, z {z:.1f} mm"))
    return lines


def _reservations(s: MatStory) -> list[str]:
    known = np.abs(s.laid.distortion[s.laid.covered])
    sd = np.sqrt(np.trace(s.covariance[s.heaviest][:3, :3]))
    met = s.laid.misses[np.isfinite(s.laid.misses)]
    miss = f"{met.max() * MM:.1f} mm" if len(met) else "an unknown distance"
    frame = s.whole.wrench.frame
    still = "" if frame == s.home else f" The picture stands still in the frame {s.home}, with which the segment moves."
    return [
        f"Forces, moments and centres of pressure are in the frame {frame}.{still}",
        "A mat measures what is perpendicular to its cells. Friction along the skin is in none of these forces.",
        f"Cells are up to {known.max():.1%} larger or smaller on the scan than flat; each keeps its own sensing area.",
        f"Landmarks are missed by up to {miss}.",
        f"The errors that were stated make the largest force uncertain by {sd:.1f} N (standard deviation).",
        "What was neither stated (--gain, --registration) nor told by a registration is not in that number.",
        "The scan is one shape: where soft tissue gives way under the load, pressures sit where it was before.",
    ]


def _texts(values: Float[np.ndarray, " k"], digits: int) -> list[str]:
    return ["–" if np.isnan(value) else f"{value:.{digits}f}" for value in values]


def _with(values: Float[np.ndarray, " k"], sd: Float[np.ndarray, " k"], digits: int) -> list[str]:
    return [f"{value:.{digits}f} ± {one:.{digits}f}" for value, one in zip(values, sd, strict=True)]
