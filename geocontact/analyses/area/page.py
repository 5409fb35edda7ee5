"""What the page of a contact-area analysis shows: where, how much, in which frame, and how far to trust it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Int

from geocontact.analyses.area.congruence.along import CongruenceEvolution
from geocontact.analyses.area.meshes_table import meshes_table
from geocontact.analyses.area.page_answer import facts, headline
from geocontact.analyses.area.page_sections import (
    Told,
    area_curves,
    comparison_tables,
    distance_curve,
    in_mm,
    rows,
    scene,
    strip,
    uncertainty_curves,
)
from geocontact.analyses.area.pose_error.along import AreaUncertainty
from geocontact.analyses.area.pressure.page import Pressures, pressure_sections, pressure_words
from geocontact.analyses.area.reference_areas import Compared
from geocontact.analyses.area.words import reviewers_words
from geocontact.analyses.finished_page import INPUTS, OPTIONS, Thinned
from geocontact.analyses.page_words import counted
from geocontact.data.evolution import AreaEvolution
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.evolution import Settings
from geocontact.geometry.contact_area.maps import DistanceMaps
from geocontact.geometry.surface import Surface
from geocontact.view.page.content import Choices, Page, PageChoice, Readout, Section, Words

FRAMES = 201  # frames that the page animates at most; longer motions are thinned out, and the page says so


def thinned_page(
    moving: Surface,
    fixed: Surface,
    motion: Motion,
    settings: Settings,
    evolution: AreaEvolution,
    maps: DistanceMaps,
    title: str = "",
    pressures: Pressures | None = None,
    compared: Compared | None = None,
    uncertainty: AreaUncertainty | None = None,
    congruence: CongruenceEvolution | None = None,
) -> Thinned:
    """The page of one contact-area analysis, of as many frames as its file holds.

    Parameters
    ----------
    moving, fixed, motion, settings
        What was analysed, and how.
    evolution
        The areas, from `area_evolution`; with `Settings.sensitivity` the page shows how much the threshold matters.
    maps
        Distance maps gathered by the same call (`each=maps.add`).
    title
        Heading of the page; the names of the bodies if not given.
    pressures
        Pressures on FIXED; the page then opens with their map, in the frame with the largest force.
    compared
        Measured areas beside these.
    uncertainty
        Error of the poses carried into the area.
    congruence
        How alike the surfaces are curved in contact; read out in each frame.
    """
    if not maps.frames:
        raise ValueError("the distance maps hold no frame; gather them with area_evolution(..., each=maps.add)")

    def of(most: int) -> Page:
        shown = shown_frames(maps, most, () if pressures is None else (pressures.heaviest,))
        told = Told(
            moving, fixed, motion, settings, evolution, maps, shown, pressures, compared, uncertainty, congruence
        )
        return contact_page(told, title)

    return Thinned(of, FRAMES)


def shown_frames(maps: DistanceMaps, most: int, also: Sequence[int] = ()) -> Int[np.ndarray, " k"]:
    """Places in `maps` of about `most` frames, evenly spread, with that of most contact and of smallest distance.

    Frames in `also` are shown where `maps` holds them.
    """
    regular = np.arange(0, len(maps.frames), -(-len(maps.frames) // most))
    wanted = [maps.largest, maps.nearest, *(frame for frame in also if frame in maps.frames)]
    places: Int[np.ndarray, " k"] = np.unique([*regular, *map(maps.frames.index, wanted)])
    return places


def contact_page(told: Told, title: str) -> Page:
    """The page before it becomes a file: about the largest threshold, the others to be chosen."""
    e, frames, main, pressures = told.evolution, told.frames, told.main, told.pressures
    course = told.motion.course
    before = [scene(told)]
    shared = [strip(told)] if e.sensitivity_thresholds else []
    after = [meshes_table(told.moving, told.fixed), *comparison_tables(told), INPUTS, OPTIONS]
    pressed = [] if pressures is None else pressure_sections(pressures, frames)
    distance = distance_curve(e, frames)
    foundation = [] if pressures is None else [pressure_words(pressures)]

    def sections(k: int) -> list[Section]:
        words = reviewers_words(told.moving, told.fixed, told.settings, e, k, len(frames), pressures is not None)
        numbers = Readout(rows(told, k), title=f"This frame, threshold {in_mm(e, k)}")
        return [
            *before,
            numbers,
            *pressed,
            area_curves(told, k),
            *uncertainty_curves(told, k),
            distance,
            *shared,
            *after,
            *words[:2],
            *foundation,
            *words[2:],
        ]

    own, others = sections(main), [k for k in np.argsort(e.thresholds)[::-1].tolist() if k != main]
    return Page(
        title=title or f"{told.moving.name} on {told.fixed.name}",
        subtitle=_subtitle(told),
        time=course.values[frames],
        time_label=course.label,
        headline=headline(told, main),
        facts=facts(told, main),
        start_frame=int(
            np.argmax(e.fixed.area[frames, main] if pressures is None else pressures.force["total"][frames])
        ),
        sections=own,
        numbers=frames + 1,
        total=len(told.motion),
        choices=Choices("threshold", in_mm(e, main), [_choice(told, k, own, sections(k)) for k in others]),
    )


def _choice(told: Told, k: int, own: Sequence[Section], other: Sequence[Section]) -> PageChoice:
    """The page about another threshold."""
    instead = {n: new for n, (old, new) in enumerate(zip(own, other, strict=True)) if not _same(old, new)}
    name, level = in_mm(told.evolution, k), told.evolution.thresholds[k]
    return PageChoice(name, headline(told, k), facts(told, k), instead, level)


def _same(one: Section, other: Section) -> bool:
    """Whether two sections say the same."""
    if isinstance(one, Words) and isinstance(other, Words):
        return (one.title, list(one.paragraphs)) == (other.title, list(other.paragraphs))
    return one is other


def _subtitle(told: Told) -> str:
    said = f"Contact area over {counted(len(told.motion), 'frame')}, parts that overlap included"
    if told.crude:
        said += f", counted in whole triangles ({told.settings.rule})"
    if told.settings.fixed_faces is not None:
        said += "; only a region of the fixed body counts"
    return said
