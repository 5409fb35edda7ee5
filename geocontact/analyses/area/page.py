"""The page of a contact-area analysis: answer, bodies, curves, numbers, and the words that a reviewer looks for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from jaxtyping import Int

from geocontact.analyses.area.figure import distance_curves
from geocontact.analyses.area.headline import facts, headline
from geocontact.analyses.area.page_sections import (
    Told,
    compared_areas,
    comparison_tables,
    congruence_curves,
    in_mm,
    rows,
    scene,
    strip,
    uncertainty_curves,
)
from geocontact.analyses.area.pressure_page import Pressures, pressure_sections, pressure_words
from geocontact.analyses.area.wear import wear_words
from geocontact.analyses.frame.pages import INPUTS, OPTIONS, Thinned
from geocontact.analyses.frame.words import NOT_A_DEVICE, counted
from geocontact.data.evolution import MM, MM2, AreaEvolution
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.area import CLIP, REFINED
from geocontact.geometry.contact_area.comparison import Compared
from geocontact.geometry.contact_area.congruence import CongruenceEvolution
from geocontact.geometry.contact_area.evolution import Settings
from geocontact.geometry.contact_area.maps import DistanceMaps
from geocontact.geometry.contact_area.pose_error import AreaUncertainty
from geocontact.geometry.surface import Surface
from geocontact.loads.wear import LayerWear
from geocontact.view.page.content import Choices, Page, PageChoice, Readout, Section, Table, Words

HEADER = ("body", "vertices", "faces", "edge, median [mm]", "edge, longest [mm]", "size [mm]", "closed")


def meshes_table(moving: Surface, fixed: Surface) -> Table:
    """What the areas rest on."""
    return Table("The two surfaces", HEADER, [_row("moving", moving), _row("fixed", fixed)])


def _row(role: str, body: Surface) -> tuple[str, ...]:
    used = body.vertices[body.used]
    size = np.ptp(used, axis=0) * MM
    edges = body.edge_length * MM
    return (
        f"{role}: {body.name}",
        f"{len(used)}",
        f"{len(body.faces)}",
        f"{np.median(edges):.2f}",
        f"{edges.max():.2f}",
        " × ".join(f"{length:.1f}" for length in size),
        "yes" if body.topology.closed else ("assumed" if body.closed else "no: distances to it are unsigned"),
    )


def reviewers_words(
    moving: Surface,
    fixed: Surface,
    settings: Settings,
    e: AreaEvolution,
    main: int,
    shown: int,
    pressed: bool = False,
) -> list[Words]:
    """Question, context of use, numerical error, and what was not checked."""
    return [
        Words("Question", [_question(moving, fixed, settings, e, main)]),
        Words("Context of use", [_context(e, pressed), NOT_A_DEVICE]),
        Words("Numerical error", _error(settings, e, main)),
        Words("What the numbers do not contain", _missing(len(e.time), shown)),
    ]


def _question(moving: Surface, fixed: Surface, settings: Settings, e: AreaEvolution, main: int) -> str:
    said = (
        f"How much of the surface of {fixed.name} (fixed) lies within {e.thresholds[main] * MM:g} mm of {moving.name} "
        f"(moving), where, and how does it change over the motion? Parts that overlap count as contact."
    )
    for body, faces in ((fixed, settings.fixed_faces), (moving, settings.moving_faces)):
        if faces is not None:
            said += f" Of {body.name} only {int(faces.sum())} of {len(faces)} faces count; the others are left grey."
    return said


def _context(e: AreaEvolution, pressed: bool) -> str:
    signs = {
        "both": "Both surfaces are closed, so distances carry a sign and overlap is known on both.",
        "fixed": "The moving surface is closed, the fixed one is not: overlap is known on the fixed surface only.",
        "moving": "The fixed surface is closed, the moving one is not: overlap is known on the moving surface only.",
        "none": "Neither surface is closed: distances are unsigned and overlap cannot be distinguished from closeness.",
    }
    forces = (
        "areas and distances are those of undeformed bodies, and pressures those of a layer that they overlap in. "
        if pressed
        else "nothing deforms, no force is computed. "
    )
    return (
        f"Geometric contact of two rigid triangulated surfaces in given poses: {forces}"
        "An area within a threshold measures congruence. It is the area that carries load only if the threshold "
        f"equals the deformation. {signs[e.signed]}"
    )


def _error(settings: Settings, e: AreaEvolution, main: int) -> list[str]:
    area, lower, upper = (values[:, main] * MM2 for values in (e.fixed.area, e.fixed.lower, e.fixed.upper))
    widest = int(np.argmax(upper - lower))
    bounds = (
        f"The true area of the two triangulated surfaces lies between the bounds shown in every frame; they are "
        f"{upper[widest] - lower[widest]:.1f} mm² apart at most (frame {widest + 1}, area {area[widest]:.1f} mm²). "
        "They follow from the distances of the corners of each triangle: between them, a point of it can be neither "
        "farther from the other surface nor nearer to it than these and the size of the triangle allow. "
    )
    if settings.rule == REFINED:
        bounds += (
            f"Triangles in doubt were divided; the estimated error of the area is "
            f"{e.fixed.error[:, main].max() * MM2:.2g} mm² at most."
        )
    elif settings.rule == CLIP:
        bounds += "Triangles were cut once where the distance, taken as linear between corners, is the threshold."
    else:
        bounds += (
            f"The areas themselves were counted in whole triangles (rule {settings.rule}): they may lie outside the "
            "bounds, and they change with the mesh in the first order of its edges."
        )
    sides = f"Up to {int(e.undecided.max(initial=0))} points per frame have no decidable side and count as outside."
    picture = (
        "The colours and the threshold contour on the picture interpolate 8-bit distances between vertices; the "
        "numbers do not come from the picture."
    )
    return [bounds, sides, picture] if e.undecided.any() else [bounds, picture]


def _missing(frames: int, shown: int) -> list[str]:
    inputs = (
        "How well the triangles resemble the parts, how well the parts resemble worn or loaded ones, and how well the "
        "motion was measured: tenths of a millimetre there matter more than all of the above. Repeat with another mesh "
        "resolution and see the strip of thresholds before concluding."
    )
    validation = (
        "Validation against measured contact areas is not part of this page unless a comparison table is shown."
    )
    thinned = f"The page shows {shown} of {frames} frames; the table file holds all of them."
    return [inputs, validation, thinned] if shown < frames else [inputs, validation]


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
    published: pd.DataFrame | None = None,
    wear: LayerWear | None = None,
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
    published
        Published areas beside these.
    wear
        Wear of FIXED by these pressures: a second map.
    """
    if not maps.frames:
        raise ValueError("the distance maps hold no frame; gather them with area_evolution(..., each=maps.add)")

    def of(most: int) -> Page:
        shown = shown_frames(maps, most, () if pressures is None else (pressures.heaviest,))
        further = pressures, compared, uncertainty, congruence, published, wear
        told = Told(moving, fixed, motion, settings, evolution, maps, shown, *further)
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
    distance = distance_curves(e).at(frames)
    foundation = [] if pressures is None else [pressure_words(pressures)]
    worn = [] if told.wear is None else [wear_words(told.wear)]

    def sections(k: int) -> list[Section]:
        words = reviewers_words(told.moving, told.fixed, told.settings, e, k, len(frames), pressures is not None)
        numbers = Readout(rows(told, k), title=f"This frame, threshold {in_mm(e, k)}")
        return [
            *before,
            numbers,
            *pressed,
            compared_areas(told, k),
            *uncertainty_curves(told, k),
            *congruence_curves(told, k),
            distance,
            *shared,
            *after,
            *words[:2],
            *foundation,
            *worn,
            *words[2:],
        ]

    own, others = sections(main), [k for k in np.argsort(e.thresholds)[::-1].tolist() if k != main]
    return Page(
        title=title or f"{told.moving.name} on {told.fixed.name}",
        subtitle=_subtitle(told),
        time=course.values[frames],  # noqa: PD011
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
