"""What is shown of several pairs: all bodies in one scene, areas and distances by pair, and how far to trust them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, Int

from geocontact.analyses.area.contact import MotionResult
from geocontact.analyses.area.figure import colour_span
from geocontact.analyses.area.page_sections import in_mm, seen_distances
from geocontact.analyses.area.pairs.bodies import TouchingBodies, TouchingPair
from geocontact.analyses.area.pairs.totals import body_loads, pair_loads, total_area
from geocontact.analyses.frame.pages import INPUTS, OPTIONS, Thinned
from geocontact.analyses.frame.result import REPORT
from geocontact.analyses.frame.words import NOT_A_DEVICE, counted, rounded
from geocontact.data.evolution import MM, MM2
from geocontact.geometry.surface import Surface
from geocontact.view.curves.declared import INK, Curve, Curves, CurveSheet
from geocontact.view.page.content import Page, Readout, Row, Scene, SceneBody, Section, Table, Words
from geocontact.view.surfaces.camera import camera_directions

FRAMES = 101
"""Frames that the page animates at most."""
LOADS = "Loads at {}, in the common frame; the other body of a pair bears the opposite"
WRENCH_HEADER = ("pair", "on", "fx, fy, fz [N]", "mx, my, mz [N m] about the origin")


def pair_curves(pairs: TouchingBodies, motions: Sequence[MotionResult]) -> CurveSheet:
    """Area on FIXED by pair and in total at the largest threshold, least distance by pair, force where there is one."""
    e = motions[0].evolution
    k = int(np.argmax(e.thresholds))
    areas = [Curve("total", total_area(motions)[:, k] * MM2, stroke=INK)]
    areas += [Curve(one.name, one.evolution.fixed.area[:, k] * MM2, stroke=n) for n, one in enumerate(motions)]
    distances = [Curve(one.name, one.evolution.min_distance * MM, stroke=n) for n, one in enumerate(motions)]
    forces = [
        Curve(one.name, one.pressure.pressing, stroke=n) for n, one in enumerate(motions) if one.pressure is not None
    ]
    panels = [
        Curves(f"Contact area on the fixed body, within {in_mm(e, k)}", "mm²", areas),
        Curves("Smallest distance of the whole bodies (negative: overlap)", "mm", distances),
    ]
    if forces:
        panels.append(Curves("Contact force", "N", forces))
    return CurveSheet(panels, pairs.pairs[0].motion.course, columns=1)


def thinned_page(title: str, pairs: TouchingBodies, motions: Sequence[MotionResult]) -> Thinned:
    """The page of all pairs, of as many frames as its file holds."""
    kept = [set(one.maps.frames) for one in motions]
    common = np.array(sorted(set.intersection(*kept)), np.int64)

    def of(most: int) -> Page:
        regular = common[:: -(-len(common) // most)]
        k = int(np.argmax(motions[0].evolution.thresholds))
        start = common[int(np.argmax(total_area(motions)[common, k]))]
        return _page(title, pairs, motions, np.union1d(regular, [start]), int(start))

    return Thinned(of, FRAMES)


def _page(
    title: str, pairs: TouchingBodies, motions: Sequence[MotionResult], frames: Int[np.ndarray, " k"], start: int
) -> Page:
    course, e = pairs.pairs[0].motion.course, motions[0].evolution
    k = int(np.argmax(e.thresholds))
    total = total_area(motions)[:, k] * MM2
    most = int(np.argmax(total))
    parts = ", ".join(f"{one.name} {rounded(one.evolution.fixed.area[most, k] * MM2)}" for one in motions)
    said = f"Up to {rounded(total[most])} mm² lie within {in_mm(e, k)} in all pairs together, at {course.at(most)}"
    said += f" ({parts} mm²)."
    sections: list[Section] = [
        _scene(pairs, motions, frames),
        Readout(_rows(motions, frames, k), title=f"This frame, threshold {in_mm(e, k)}"),
        *pair_curves(pairs, motions).at(frames),
        _table(pairs.pairs, motions, k),
        *_loads(pairs, motions),
        INPUTS,
        OPTIONS,
        *_words(pairs.pairs),
    ]
    return Page(
        title=title,
        subtitle=f"Contact of {counted(len(pairs.pairs), 'pair')} over {counted(len(total), 'frame')}",
        time=course.values[frames],
        time_label=course.label,
        headline=(said,),
        facts=[
            (one.name, f"{area.min():.0f} … {area.max():.0f} mm²")
            for one in motions
            for area in [one.evolution.fixed.area[:, k] * MM2]
        ],
        start_frame=int(np.flatnonzero(frames == start)[0]),
        sections=tuple(sections),
        numbers=frames + 1,
        total=len(total),
    )


def _scene(pairs: TouchingBodies, motions: Sequence[MotionResult], frames: Int[np.ndarray, " k"]) -> Scene:
    """All bodies in the common frame; a body of several pairs has the distance to the nearest of the others."""
    spans = [colour_span(one.evolution) for one in motions]
    surfaces: dict[str, Surface] = {}
    distances: dict[str, Float[np.ndarray, "t n"]] = {}
    unsigned: set[str] = set()
    for pair, one in zip(pairs.pairs, motions, strict=True):
        at = np.searchsorted(one.maps.frames, frames)
        settings, e = pair.bodies.settings, one.evolution
        for role, name, surface, kept, faces in (
            ("moving", pair.moving, pair.bodies.moving, one.maps.moving, settings.moving_faces),
            ("fixed", pair.fixed, pair.bodies.fixed, one.maps.fixed, settings.fixed_faces),
        ):
            seen = seen_distances(kept[at], surface, faces)
            distances[name] = np.fmin(distances[name], seen) if name in distances else seen
            surfaces[name] = surface
            if e.signed not in ("both", role):
                unsigned.add(name)
    return Scene(
        bodies=tuple(
            SceneBody(
                name,
                surface.vertices,
                surface.faces,
                None if (motion := pairs.motions[name]) is None else motion.poses[frames],
                distance=distances[name],
                signed=name not in unsigned,
            )
            for name, surface in surfaces.items()
        ),
        thresholds=motions[0].evolution.thresholds,
        span=(min(low for low, _ in spans), max(high for _, high in spans)),
        value_name="distance to the nearest other body of its pairs",
        directions=camera_directions(np.zeros(3)),
    )


def _rows(motions: Sequence[MotionResult], frames: Int[np.ndarray, " k"], k: int) -> list[Row]:
    rows = [Row("contact area, all pairs", "mm²", _texts(total_area(motions)[frames, k] * MM2, 2))]
    for one in motions:
        rows.append(Row(f"contact area, {one.name}", "mm²", _texts(one.evolution.fixed.area[frames, k] * MM2, 2)))
        rows.append(Row(f"smallest distance, {one.name}", "mm", _texts(one.evolution.min_distance[frames] * MM, 3)))
        if one.pressure is not None:
            rows.append(Row(f"force, {one.name}", "N", _texts(one.pressure.pressing[frames], 1)))
    return rows


def _texts(values: Float[np.ndarray, " k"], digits: int) -> list[str]:
    return [f"{value:.{digits}f}" for value in values]


def _table(pairs: Sequence[TouchingPair], motions: Sequence[MotionResult], k: int) -> Table:
    rows = []
    for pair, one in zip(pairs, motions, strict=True):
        e, course = one.evolution, one.motion.course
        area = e.fixed.area[:, k] * MM2
        most = int(np.argmax(area))
        largest = f"{area[most]:.1f} mm² ({e.fixed.lower[most, k] * MM2:.1f} … {e.fixed.upper[most, k] * MM2:.1f})"
        least = f"{e.min_distance.min() * MM:.3f} mm"
        rows.append((one.name, pair.moving, pair.fixed, f"{largest} at {course.at(most)}", least, e.signed))
    header = ("pair", "moving", "fixed", "largest area on the fixed body (bounds)", "smallest distance", "signed")
    return Table("The pairs, each with its own page", header, rows, links=[f"{one.name}/{REPORT}" for one in motions])


def _loads(pairs: TouchingBodies, motions: Sequence[MotionResult]) -> list[Table]:
    """Loads by pair and on each body where all pairs together press most; none without layers."""
    by_pair = pair_loads(pairs, motions)
    if not by_pair:
        return []
    most = int(np.argmax(np.sum([one.pressure.pressing for one in motions if one.pressure is not None], axis=0)))
    of_pairs = pairs.of_pairs
    rows = [(name, of_pairs[name][0], *wrench_texts(load[most])) for name, load in by_pair.items()]
    rows += [("all pairs", body, *wrench_texts(load[most])) for body, load in body_loads(by_pair, of_pairs).items()]
    return [Table(LOADS.format(pairs.pairs[0].motion.course.at(most)), WRENCH_HEADER, rows)]


def wrench_texts(wrench: Float[np.ndarray, " 6"]) -> tuple[str, str]:
    """Force [N] and moment [N m]."""
    return ", ".join(f"{value:.1f}" for value in wrench[:3]), ", ".join(f"{value:.2f}" for value in wrench[3:])


def _words(pairs: Sequence[TouchingPair]) -> list[Words]:
    context = (
        "Each pair is evaluated by itself, as two rigid surfaces in given poses: no body knows what another one "
        "presses on, and nothing comes to rest. The total is the sum of the areas on the fixed bodies of the pairs."
    )
    layered = [pair.name for pair in pairs if pair.options.pressure]
    pressed = f"Loads are those of an elastic layer ({', '.join(layered)}); pairs without one bear none here."
    return [Words("Context of use", [context, *([pressed] if layered else []), NOT_A_DEVICE])]
