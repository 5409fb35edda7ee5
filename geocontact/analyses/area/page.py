"""What the page of a contact-area analysis shows: where, how much, in which frame, and how far to trust it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.analyses.area.pressure_page import Pressures, face_map, headline, pressure_sections, pressure_words
from geocontact.analyses.area.words import reviewers_words
from geocontact.analyses.page_words import counted
from geocontact.data.evolution import MM, MM2, AreaEvolution
from geocontact.data.motion import Course, Motion
from geocontact.geometry.contact_area.evolution import Settings
from geocontact.geometry.contact_area.maps import DistanceMaps
from geocontact.geometry.contact_area.rules import CLIP, REFINED
from geocontact.geometry.surface import Surface
from geocontact.view.page.content import Body, Curve, Curves, Page, Readout, Row, Scene, Section, Strip, Table
from geocontact.view.page.tables import meshes_table
from geocontact.view.page.write import write_page
from geocontact.view.surfaces.directions import camera_directions

TICK = 0.5e-3  # m; the colours end at a round number
FRAMES = 201  # frames that the page animates at most; longer motions are thinned out, and the page says so
FEWEST = 21  # frames below which a page is not thinned any further
LARGEST_FILE = 5_000_000  # bytes; larger pages are thinned out until they fit


def write_report(
    path: Path,
    moving: Surface,
    fixed: Surface,
    motion: Motion,
    settings: Settings,
    evolution: AreaEvolution,
    maps: DistanceMaps,
    title: str = "",
    provenance: Sequence[Table] = (),
    warnings: Sequence[str] = (),
    pressures: Pressures | None = None,
) -> int:
    """Write the self-contained page of one contact-area analysis; returns its size in bytes.

    Parameters
    ----------
    path
        HTML file to write.
    moving, fixed, motion, settings
        What was analysed, and how.
    evolution
        The areas, from `area_evolution`; with `Settings.sensitivity` the page shows how much the threshold matters.
    maps
        Distance maps gathered by the same call (`each=maps.add`).
    title
        Heading of the page; the names of the bodies if not given.
    provenance
        Further tables: inputs with hashes, options, versions.
    warnings
        Reservations that came up on the way.
    pressures
        Pressures on FIXED; the page then opens with their map, in the frame with the largest force.
    """
    if not maps.frames:
        raise ValueError("the distance maps hold no frame; gather them with area_evolution(..., each=maps.add)")
    most = FRAMES
    while True:
        shown = shown_frames(maps, most, () if pressures is None else (pressures.heaviest,))
        told = Told(moving, fixed, motion, settings, evolution, maps, shown, pressures)
        size = write_page(contact_page(told, title, provenance, warnings), Path(path))
        most = min(most, len(told.kept)) // 2
        if size <= LARGEST_FILE or most < FEWEST:
            return size


@dataclass(frozen=True, eq=False)
class Told:
    """What a page tells: an analysis, and which of the frames kept in `maps` are shown (`kept`, places in there)."""

    moving: Surface
    fixed: Surface
    motion: Motion
    settings: Settings
    evolution: AreaEvolution
    maps: DistanceMaps
    kept: Int[np.ndarray, " k"]
    pressures: Pressures | None = None

    @property
    def frames(self) -> Int[np.ndarray, " k"]:
        """Numbers of the frames shown."""
        return np.asarray(np.asarray(self.maps.frames, np.int64)[self.kept])

    @property
    def main(self) -> int:
        """Place of the largest threshold, which the page is about."""
        return int(np.argmax(self.evolution.thresholds))

    @property
    def crude(self) -> bool:
        """Whether areas were counted by a rule that does not cut triangles."""
        return self.settings.rule not in (REFINED, CLIP)


def shown_frames(maps: DistanceMaps, most: int, also: Sequence[int] = ()) -> Int[np.ndarray, " k"]:
    """Places in `maps` of about `most` frames, evenly spread, with that of most contact and of smallest distance.

    Frames in `also` are shown where `maps` holds them.
    """
    regular = np.arange(0, len(maps.frames), -(-len(maps.frames) // most))
    wanted = [maps.largest, maps.nearest, *(frame for frame in also if frame in maps.frames)]
    places: Int[np.ndarray, " k"] = np.unique([*regular, *map(maps.frames.index, wanted)])
    return places


def contact_page(
    told: Told,
    title: str,
    provenance: Sequence[Table],
    warnings: Sequence[str],
) -> Page:
    """The page before it becomes a file."""
    e, frames, main, pressures = told.evolution, told.frames, told.main, told.pressures
    course = told.motion.course
    sections: list[Section] = [
        _scene(told),
        Readout(_rows(told), title=f"This frame, threshold {_mm(e, main)}"),
        *_curves(e, frames, main),
    ]
    if pressures is not None:
        sections[2:2] = pressure_sections(pressures, frames)
    if e.sensitivity_thresholds:
        sections.append(_strip(told))
    sections += [meshes_table(told.moving, told.fixed), *provenance]
    pressed = pressures is not None
    words = reviewers_words(told.moving, told.fixed, told.settings, e, main, len(frames), warnings, pressed)
    sections += words if pressures is None else [*words[:2], pressure_words(pressures), *words[2:]]
    return Page(
        title=title or f"{told.moving.name} on {told.fixed.name}",
        subtitle=_subtitle(told),
        time=course.values[frames],
        time_label=course.label,
        headline=[*(headline(pressures, course) if pressures is not None else ()), *_headline(e, main, course)],
        start_frame=int(
            np.argmax(e.fixed.area[frames, main] if pressures is None else pressures.force["total"][frames])
        ),
        sections=tuple(sections),
        numbers=frames + 1,
        total=len(told.motion),
    )


def _subtitle(told: Told) -> str:
    said = f"Contact area over {counted(len(told.motion), 'frame')}: "
    said += f"what lies within {_mm(told.evolution, told.main)} of the other body"
    if told.crude:
        said += f", counted in whole triangles ({told.settings.rule})"
    if told.settings.fixed_faces is not None:
        said += "; only a region of the fixed body counts"
    return said


def _mm(evolution: AreaEvolution, k: int) -> str:
    return f"{evolution.thresholds[k] * MM:g} mm"


def _headline(e: AreaEvolution, main: int, course: Course) -> list[tuple[str, str]]:
    """How much, when, where."""
    area = e.fixed.area[:, main] * MM2
    largest, nearest = int(np.argmax(area)), int(np.argmin(e.min_distance))

    def when(frame: int) -> str:
        return f"at {course.at(frame)} (frame {frame + 1} of {len(e.time)})"

    lines = [
        ("Largest contact area on the fixed body", f"{area[largest]:.0f} mm² {when(largest)}"),
        ("Range over the motion", f"{area.min():.0f} … {area.max():.0f} mm² (mean {area.mean():.0f} mm²)"),
    ]
    if area[largest] > 0.0:
        x, y, z = e.fixed.centroid[largest, main] * MM
        where = f"centroid x {x:.1f}, y {y:.1f}, z {z:.1f} mm"
        if e.medial_side:
            medial = e.medial[largest, main] / e.fixed.area[largest, main]
            where += f"; {medial:.0%} medial, {1.0 - medial:.0%} lateral"
        lines.append(("Where, in that frame", where))
    word = "Deepest overlap" if e.min_distance[nearest] < 0.0 else "Smallest distance"
    lines.append((word, f"{abs(e.min_distance[nearest]) * MM:.2f} mm {when(nearest)}"))
    return lines


def _scene(told: Told) -> Scene:
    e, kept = told.evolution, told.kept
    farthest = max((*e.thresholds, *e.sensitivity_thresholds, TICK))
    deepest = min(-0.25 * max(e.thresholds), float(e.min_distance.min()), -TICK)
    signed = {"fixed": e.signed in ("both", "fixed"), "moving": e.signed in ("both", "moving")}
    unsigned = 0.0 if min(e.thresholds) > 0.0 else -TICK
    return Scene(
        bodies=(
            Body(
                told.fixed.name, told.fixed.vertices, told.fixed.faces, signed=signed["fixed"],
                distance=_counted(told.maps.fixed[kept], told.fixed, told.settings.fixed_faces),
            ),
            Body(
                told.moving.name, told.moving.vertices, told.moving.faces, told.motion.poses[told.frames],
                signed=signed["moving"],
                distance=_counted(told.maps.moving[kept], told.moving, told.settings.moving_faces),
            ),
        ),
        thresholds=e.thresholds,
        span=(unsigned if e.signed == "none" else float(-np.ceil(-deepest / TICK) * TICK), farthest),
        value_name="distance to the other body" if e.signed == "none" else "signed distance to the other body",
        directions=camera_directions(np.asarray(e.split_normal) * e.medial_side),
        maps=() if told.pressures is None else (face_map(told.pressures, told.frames, 0),),
    )  # fmt: skip


def _counted(
    distance: Float[np.ndarray, "t n"], body: Surface, faces: Bool[np.ndarray, " f"] | None
) -> Float[np.ndarray, "t n"]:
    """Distances with vertices of no counted face taken as far away, so that only what counts is coloured."""
    if faces is None:
        return distance
    counts = np.zeros(len(body.vertices), bool)
    counts[body.faces[faces]] = True
    return np.where(counts, distance, np.inf)


def _rows(told: Told) -> list[Row]:
    """The table's row of each frame, rounded to what a reader can use."""
    e = told.evolution
    columns = e.table().iloc[told.frames * len(e.thresholds) + told.main]
    rule = f", {told.settings.rule}" if told.crude else ""
    rows = []
    for label, column, digits in (
        (f"area of the fixed body{rule}", "area_fixed [mm^2]", 2),
        ("certainly at least", "area_fixed_lower [mm^2]", 2),
        ("certainly at most", "area_fixed_upper [mm^2]", 2),
        ("medial part", "area_fixed_medial [mm^2]", 2),
        ("lateral part", "area_fixed_lateral [mm^2]", 2),
        ("area of the moving body", "area_moving [mm^2]", 2),
        ("smallest distance", "min_distance [mm]", 3),
        ("penetration of the fixed body", "max_penetration_fixed [mm]", 3),
        ("centroid x", "centroid_x [mm]", 2),
        ("centroid y", "centroid_y [mm]", 2),
        ("centroid z", "centroid_z [mm]", 2),
    ):
        if column in columns:
            unit = column[column.index("[") + 1 : -1].replace("^2", "²")
            texts = ["–" if np.isnan(value) else f"{value:.{digits}f}" for value in columns[column]]
            rows.append(Row(label, unit, texts))
    return rows


def _curves(e: AreaEvolution, frames: Int[np.ndarray, " k"], main: int) -> list[Curves]:
    def within(k: int) -> Curve:
        side = e.fixed
        name = f"fixed body, {_mm(e, k)}"
        return Curve(name, side.area[frames, k] * MM2, side.lower[frames, k] * MM2, side.upper[frames, k] * MM2)

    areas = [within(main)]
    if e.medial_side:
        areas += [
            Curve(f"medial, {_mm(e, main)}", e.medial[frames, main] * MM2),
            Curve(f"lateral, {_mm(e, main)}", e.lateral[frames, main] * MM2),
        ]
    areas += [within(k) for k in range(len(e.thresholds)) if k != main]
    distance = [Curve("smallest distance", e.min_distance[frames] * MM)]
    return [Curves("Contact area", "mm²", areas), Curves("Smallest distance (negative: overlap)", "mm", distance)]


def _strip(told: Told) -> Strip:
    e = told.evolution
    order = np.argsort(e.sensitivity_thresholds)
    thresholds = np.asarray(e.sensitivity_thresholds)[order]
    values = e.sensitivity[np.ix_(told.frames, order)] * MM2
    if not told.crude:  # the refined area is the better number, where there is one
        values[:, np.isclose(thresholds, e.thresholds[told.main])] = e.fixed.area[told.frames, told.main, None] * MM2
    return Strip(
        title="How much the threshold matters (fixed body, triangles cut)",
        thresholds=thresholds * MM,
        values=values,
        unit="mm²",
        current=e.thresholds[told.main] * MM,
    )
