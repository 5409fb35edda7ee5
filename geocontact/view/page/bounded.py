"""A page of bounded size: of a long recording it shows the frames with the extremes of its curves, and says so."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Int

from geocontact.view.extremes import FRAMES, with_extremes
from geocontact.view.page.content import Choices, Curve, Curves, Page, Plan, Points, Readout, Scene, Section, Strip

SPARE = 1.2
"""Times `FRAMES` that a page may have before it is thinned out: those that were thinned out have a few added."""


def bounded(page: Page) -> Page:
    """The page itself, or one with about `FRAMES` of its frames: those with the extremes of its curves.

    The first panel counts first. Marks at times of their own are thinned out likewise.
    """
    others = () if page.choices is None else page.choices.others
    every = [*page.sections, *(section for other in others for section in other.instead.values())]
    count = len(page.time)
    dense = any(
        len(points.time) > SPARE * FRAMES for each in every if isinstance(each, Curves) for points in each.points
    )
    if count <= SPARE * FRAMES and not dense:
        return page
    curves = [curve.values for section in page.sections if isinstance(section, Curves) for curve in section.curves]
    kept = np.arange(count) if count <= SPARE * FRAMES else with_extremes(count, curves, always=(page.start_frame,))

    def fewer(section: Section) -> Section:
        return _fewer(section, kept)

    choices = page.choices
    if choices is not None:
        instead = [replace(o, instead={k: fewer(section) for k, section in o.instead.items()}) for o in choices.others]
        choices = Choices(choices.label, choices.own, instead)
    numbers = np.arange(1, count + 1) if page.numbers is None else page.numbers
    said = [] if len(kept) == count else [f"the page shows {len(kept)} of {count} samples; the tables have all"]
    return replace(
        page,
        time=page.time[kept],
        reservations=(*page.reservations, *said),
        start_frame=int(np.searchsorted(kept, page.start_frame)),
        sections=tuple(fewer(section) for section in page.sections),
        numbers=numbers[kept],
        total=count if page.total is None else page.total,
        choices=choices,
    )


def _fewer(section: Section, kept: Int[np.ndarray, " k"]) -> Section:
    """A section at some of its frames; one that does not change over time as it is."""
    match section:
        case Curves(curves=curves, points=points):
            return replace(section, curves=[_curve(c, kept) for c in curves], points=[_points(p) for p in points])
        case Strip(values=values):
            return replace(section, values=values[kept])
        case Plan(tracks=tracks):
            told = [[track.told[k] for k in kept] if track.told else () for track in tracks]
            return replace(
                section,
                tracks=[replace(t, points=t.points[kept], told=said) for t, said in zip(tracks, told, strict=True)],
            )
        case Readout(rows=rows):
            return replace(section, rows=[replace(row, texts=[row.texts[k] for k in kept]) for row in rows])
        case Scene():
            return _scene(section, kept)
    return section


def _curve(curve: Curve, kept: Int[np.ndarray, " k"]) -> Curve:
    lower, upper = (None if each is None else each[kept] for each in (curve.lower, curve.upper))
    return replace(curve, values=curve.values[kept], lower=lower, upper=upper)


def _points(points: Points) -> Points:
    if len(points.time) <= SPARE * FRAMES:
        return points
    kept = with_extremes(len(points.time), [points.values])
    return replace(points, time=points.time[kept], values=points.values[kept])


def _scene(scene: Scene, kept: Int[np.ndarray, " k"]) -> Scene:
    bodies = [
        replace(
            body,
            poses=None if body.poses is None else body.poses[kept],
            distance=None if body.distance is None else body.distance[kept],
        )
        for body in scene.bodies
    ]
    linkages = [replace(one, points=one.points[kept] if len(one.points) > 1 else one.points) for one in scene.linkages]
    return replace(
        scene, bodies=bodies, maps=[replace(m, values=m.values[kept]) for m in scene.maps], linkages=linkages
    )
