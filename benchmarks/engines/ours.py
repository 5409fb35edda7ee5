"""geocontact itself: map with exact clip, and the refined area with certified bounds."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial

import numpy as np
from jaxtyping import Float

from benchmarks.engines.engine import Engine, Frame, Step
from benchmarks.pairs import THRESHOLD, Pair
from geocontact.analyses.area.bodies import BRIEF
from geocontact.geometry.contact_area.area import AS_GIVEN, Refinement, area_within
from geocontact.geometry.contact_area.evolution import ContactPair, Settings
from geocontact.geometry.contact_area.sampled import Distances, Sampled

OURS = "geocontact, map + clip"
BOTH = "geocontact, map + clip of both bodies"
FRAMES = "geocontact, all that `area` finds, gap and depth included"


def prepare(pair: Pair, refinement: Refinement) -> Step:
    """Bounded map of A's vertices and the area on A; signed where B is closed."""
    sampled = Sampled.of(pair.moving, THRESHOLD)
    _ = pair.fixed.tree, pair.fixed.closed and pair.fixed.normals_trusted

    def step(k: int) -> Frame:
        pose = pair.rotation[k], pair.translation[k]
        start = time.process_time()
        distances = sampled.distances(pair.fixed, *pose)
        seconds = time.process_time() - start
        area = area_within(sampled, pair.fixed, distances, THRESHOLD, *pose, refinement).area
        return Frame((sampled, distances), area, seconds)

    return step


def both(pair: Pair) -> Step:
    """Bounded maps and clipped areas of both bodies: what the command needs at least."""
    steps = [prepare(one, AS_GIVEN) for one in (pair, _turned(pair))]

    def step(k: int) -> Frame:
        frames = [one(k) for one in steps]
        return Frame(frames[0].distance, frames[0].area, sum(frame.map_seconds for frame in frames))

    return step


def whole_frames(pair: Pair) -> Step:
    """All that the command finds of a frame: refined areas of both bodies, the curve of thresholds, gap and depth."""
    sensitivity = tuple(THRESHOLD * np.linspace(0.0, 1.5, 13))
    settings = Settings((THRESHOLD,), refinement=Refinement(pieces=BRIEF), sensitivity=sensitivity)
    bodies = ContactPair(pair.fixed, pair.moving, settings)  # the area that is compared is that of A
    turned, sampled = _turned(pair), Sampled.of(pair.moving, THRESHOLD)

    def step(k: int) -> Frame:
        found = bodies.at(turned.rotation[k], turned.translation[k])
        return Frame((sampled, found.fixed_distances), found.fixed[0].area, 0.0)

    return step


def _turned(pair: Pair) -> Pair:
    """A and B with their parts exchanged."""
    back = np.ascontiguousarray(pair.rotation.transpose(0, 2, 1))
    return Pair(pair.name, pair.fixed, pair.moving, back, -np.einsum("tij,tj->ti", back, pair.translation))


def in_given_order(frame: Frame) -> Float[np.ndarray, " n"]:
    """Unsigned distance of A's vertices as the mesh numbers them; infinite beyond their limit."""
    sampled: Sampled
    found: Distances
    sampled, found = frame.distance  # type: ignore[misc]
    distance = np.full(len(sampled.surface.vertices), np.inf)
    distance[sampled.surface.walk] = np.where(found.slot >= 0, found.distance, np.inf)
    return distance


def unbounded(pair: Pair) -> Step:
    """Signed distance with closest point, normal and face of every vertex, however far."""

    def step(k: int) -> Frame:
        start = time.process_time()
        distance = np.abs(pair.fixed.proximity(pair.moved(k) + pair.fixed.centre).distance)
        return Frame(distance, np.nan, time.process_time() - start)

    return step


def engines() -> list[Engine]:
    """The row that ratios are taken to, the refined area, and the unbounded query."""

    def row(name: str, refinement: Refinement, goal: float | None = None) -> Engine:
        steps: Callable[[Pair], Step] = partial(prepare, refinement=refinement)
        return Engine(name, "geocontact", steps, in_given_order, lambda pair: THRESHOLD, goal=goal)

    return [
        row(OURS, AS_GIVEN),
        row("geocontact, map + refined area with bounds", Refinement()),
        Engine(BOTH, "geocontact", both, in_given_order, lambda pair: THRESHOLD),
        Engine(FRAMES, "geocontact", whole_frames, in_given_order, lambda pair: THRESHOLD),
        Engine("geocontact, unbounded signed proximity", "geocontact", unbounded, every=10, note="no area"),
    ]
