"""Several closed surfaces in one file: the outer one alone, or how much of the contact area lies inside others."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Literal

import numpy as np
from jaxtyping import Float

from geocontact.analyses.area.options import AreaOptions
from geocontact.analyses.area.read import Bodies
from geocontact.analyses.run_record import Record
from geocontact.data.evolution import MM2, AreaEvolution
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.evolution import area_evolution

Body = Literal["moving", "fixed"]
NONE = 1e-9
"""Share of a contact area below which what lies inside is rounding."""


def say_inner_area(
    record: Record, bodies: Bodies, o: AreaOptions, name: str, motion: Motion, evolution: AreaEvolution
) -> None:
    """For each file with surfaces inside or across others that count: how much of its contact area is on these."""
    for body, whole, alone in _with_and_without(bodies, o, motion, evolution):
        united = bodies.inner[body]
        within = f"within {max(evolution.thresholds) * 1e3:g} mm"
        inside = whole - alone
        frame = int(np.argmax(inside))
        largest = float(inside[frame])
        holds = f"{f'{name}: ' if name else ''}{united.surface.name} holds {united.words}"
        record.results[f"{name} inner_surfaces_{body}".lstrip()] = {
            "closed_surfaces": united.count,
            "largest_inner_area_mm2": round(max(largest, 0.0) * MM2, 3),
            "frame": frame,
        }
        if largest <= NONE * float(whole[frame]):
            record.say(f"{holds}; nothing of area_{body} {within} lies inside")
            continue
        record.warn(
            f"{holds}: {largest * MM2:.1f} of the {whole[frame] * MM2:.1f} mm^2 of area_{body} {within} in frame "
            f"{frame + 1} of {len(motion)}, {motion.course.at(frame)}, lie inside another one; "
            f"`outer` {body} counts the outer surface alone"
        )


def _with_and_without(
    bodies: Bodies, o: AreaOptions, motion: Motion, evolution: AreaEvolution
) -> Iterator[tuple[Body, Float[np.ndarray, " t"], Float[np.ndarray, " t"]]]:
    """Body, and its area over the frames at the largest threshold as counted and of the outer surface alone [m^2]."""
    widest = int(np.argmax(evolution.thresholds))
    settings = replace(bodies.settings, thresholds=(max(evolution.thresholds),), sensitivity=())
    for body in bodies.inner:
        sides = {"moving": bodies.moving, "fixed": bodies.fixed, body: bodies.inner[body].surface}
        faces = {"moving": settings.moving_faces, "fixed": settings.fixed_faces}
        marked = faces[body]
        faces[body] = None if marked is None else marked[bodies.inner[body].face]
        alone = replace(settings, moving_faces=faces["moving"], fixed_faces=faces["fixed"])
        found = area_evolution(sides["moving"], sides["fixed"], motion, alone, o.workers)
        yield body, getattr(evolution, body).area[:, widest], getattr(found, body).area[:, 0]
