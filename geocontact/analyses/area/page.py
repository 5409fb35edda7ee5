"""What the page of a contact-area analysis shows: where, how much, in which frame, and how far to trust it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Int

from geocontact.analyses.area.meshes_table import meshes_table
from geocontact.analyses.area.page_sections import Told, curves, in_mm, rows, scene, strip
from geocontact.analyses.area.pressure.page import Pressures, headline, pressure_sections, pressure_words
from geocontact.analyses.area.words import reviewers_words
from geocontact.analyses.page_words import counted
from geocontact.data.evolution import MM, MM2, AreaEvolution
from geocontact.data.motion import Course, Motion
from geocontact.geometry.contact_area.evolution import Settings
from geocontact.geometry.contact_area.maps import DistanceMaps
from geocontact.geometry.surface import Surface
from geocontact.view.page.content import Page, Readout, Section, Table
from geocontact.view.page.write import write_page

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
        scene(told),
        Readout(rows(told), title=f"This frame, threshold {in_mm(e, main)}"),
        *curves(e, frames, main),
    ]
    if pressures is not None:
        sections[2:2] = pressure_sections(pressures, frames)
    if e.sensitivity_thresholds:
        sections.append(strip(told))
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
    said += f"what lies within {in_mm(told.evolution, told.main)} of the other body"
    if told.crude:
        said += f", counted in whole triangles ({told.settings.rule})"
    if told.settings.fixed_faces is not None:
        said += "; only a region of the fixed body counts"
    return said


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
