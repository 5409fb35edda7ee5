"""Contact area of two rigid surfaces over a motion: the main job."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.evolution import AreaEvolution, SideAreas
from geocontact.data.motion import Motion
from geocontact.data.plausible import THRESHOLD
from geocontact.geometry.contact_area.area import (
    AS_GIVEN,
    CLIP,
    REFINED,
    RULES,
    AreaWithin,
    Refinement,
    area_within,
    areas_cut_once,
    counted_area,
)
from geocontact.geometry.contact_area.gap import Edges, Facing, Rise, least_distance
from geocontact.geometry.contact_area.sampled import Distances, Sampled, measure
from geocontact.geometry.inside_outside import resolve_inside_outside
from geocontact.geometry.kernels.floor import deepest
from geocontact.geometry.plane import Plane
from geocontact.geometry.surface import Surface
from geocontact.geometry.union import UnitedSurface

TOLERANCE = 1e-9  # m; depths closer together than this count as equal
DIVISIONS = 30  # a guard; edges halve each time
CANDIDATES = 20_000  # at most this many triangles are divided at a time, the most promising first


def lowest_signed_distance(
    sampled: Sampled, other: Surface, distances: Distances, rise: Rise, known: float = 0.0
) -> float:
    """Smallest signed distance [m] of the counted faces to `other`, within 1e-9 m, or `known` <= 0 if that is lower.

    Branch and bound over triangles. Bounds from the distances of the corners: no point of a triangle is deeper than its
    corner's depth plus the longest edge there, nor deeper than the largest distance of its corners to one face of
    `other`, nor farther below the plane of such a face than its corners are, plus what `other` rises over that plane.
    What cannot beat the deepest point found so far is dropped, the rest is divided into four.

    Parameters
    ----------
    sampled, other, distances
        Faces that count, the closed surface they may be inside of, and the distances of their corners to it.
    rise
        Of `other`.
    known
        A signed distance that is attained elsewhere; only what lies deeper is looked for.
    """
    d = _unlimited(other, distances)
    faces, edges, points, signed, slot = sampled.faces, sampled.edges, d.points, d.signed, d.slot
    best, above, effort = known, rise.above, np.array([DIVISIONS, 0])
    while len(faces):
        best, faces, edges, points, signed, slot, side = deepest(
            other.tree,
            rise.place,
            above,
            rise.reach,
            rise.signed,
            faces,
            edges,
            points,
            signed,
            slot,
            best,
            TOLERANCE,
            CANDIDATES,
            effort,
        )
        above = rise.above[:0]
        if len(faces):  # sides of new points, three behind the corners of each divided face, are asked for
            new = np.arange(len(points)).reshape(-1, 6)[:, 3:].ravel()
            distance = np.abs(signed[new])
            signed[new] = distance * resolve_inside_outside(other, points[new], side[new], distance)[0]
    return best


def _unlimited(other: Surface, d: Distances) -> Distances:
    """The same distances with deep points, which lie beyond their limit, measured in full."""
    deep = (d.slot < 0) & (d.side < 0)
    if not deep.any():
        return d
    full = measure(other, np.ascontiguousarray(d.points[deep]), np.full(int(deep.sum()), np.inf), d.across[deep])
    distance, slot, closest = d.distance.copy(), d.slot.copy(), d.closest.copy()
    distance[deep], slot[deep], closest[deep] = full.distance, full.slot, full.closest
    return dataclasses.replace(d, distance=distance, slot=slot, closest=closest)


@dataclass(frozen=True)
class Settings:
    """What counts as contact and how it is counted.

    Parameters
    ----------
    thresholds
        Largest signed distances that count as contact [m].
    rule
        One of `rules.RULES`.
    refinement
        When the refined rule stops dividing triangles.
    fixed_faces, moving_faces
        Marks the faces that count; None for all.
    split
        Plane in FIXED's frame between medial and lateral.
    medial_side
        +1 or -1, the side of the plane that is medial; 0 without a plane.
    sensitivity
        Further thresholds [m] at which FIXED's area is wanted to see how much the choice matters: triangles cut once as
        given, no bounds. Distances reach as far as the largest of all thresholds.

    Examples
    --------
    >>> import geocontact as gc
    >>> settings = gc.Settings(thresholds=gc.mm(1, 4), rule="clip")
    >>> settings.thresholds
    (0.001, 0.004)
    """

    thresholds: tuple[float, ...] = (4e-3,)
    rule: str = REFINED
    refinement: Refinement = Refinement()
    fixed_faces: Bool[np.ndarray, " f"] | None = None
    moving_faces: Bool[np.ndarray, " g"] | None = None
    split: Plane | None = None
    medial_side: int = 0
    sensitivity: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        every = (*self.thresholds, *self.sensitivity)
        if not self.thresholds or min(every) < 0.0 or not np.isfinite(every).all():
            raise ValueError("thresholds must be finite and not negative")
        for threshold in self.thresholds:
            THRESHOLD.require(threshold, "`thresholds`")
        if self.rule not in RULES:
            raise ValueError(f"rule must be one of {', '.join(RULES)}, not {self.rule!r}")
        if self.medial_side not in ((0,) if self.split is None else (-1, 1)):
            raise ValueError("split and medial_side belong together: -1 or +1 is the side of the plane that is medial")


@dataclass(frozen=True)
class FrameContact:
    """One frame: areas per threshold, separation, and the distances they come from.

    sensitivity (s,) is FIXED's area [m^2] at the thresholds of `Settings.sensitivity`.
    """

    fixed: list[AreaWithin]
    moving: list[AreaWithin]
    sensitivity: Float[np.ndarray, " s"]
    min_distance: float
    max_penetration_fixed: float
    fixed_distances: Distances
    moving_distances: Distances


class ContactPair:
    """Two surfaces prepared once and evaluated at as many poses as wanted.

    Parameters
    ----------
    moving, fixed
        The two bodies, each in its own frame.
    settings
        What counts as contact.

    Examples
    --------
    >>> import geocontact as gc, numpy as np
    >>> ball, plate = (gc.read_surface(f"meshes/{name}.stl", "mm") for name in ("sphere_r20", "plate_80x80x12"))
    >>> pair = gc.ContactPair(ball, plate, gc.Settings(rule="clip"))
    >>> pair.signed, float(pair.at(np.eye(3), np.array([0.0, 1.0, 0.0])).fixed[0].area)
    ('both', 0.0)
    """

    def __init__(self, moving: Surface, fixed: Surface, settings: Settings = Settings()) -> None:
        self.moving = moving
        self.fixed = fixed
        self.settings = settings
        largest = max((*settings.thresholds, *settings.sensitivity))
        self._fixed = Sampled.of(fixed, largest, settings.fixed_faces, settings.split)
        self._moving = Sampled.of(moving, largest, settings.moving_faces)
        self._whole_fixed = self._fixed if settings.fixed_faces is None else Sampled.of(fixed, largest)
        self._whole_moving = self._moving if settings.moving_faces is None else Sampled.of(moving, largest)
        # trees and what is known of normals are built here, before threads share them
        self._rise_of_moving, self._rise_of_fixed = Rise.of(moving, fixed), Rise.of(fixed, moving)
        self._edges_of_moving, self._edges_of_fixed = Edges.of(moving), Edges.of(fixed)

    @property
    def signed(self) -> str:
        """Which areas are signed; area_fixed is when MOVING is closed."""
        return {(1, 1): "both", (1, 0): "fixed", (0, 1): "moving", (0, 0): "none"}[
            int(self.moving.closed), int(self.fixed.closed)
        ]

    def at(self, rotation: Float[np.ndarray, "3 3"], translation: Float[np.ndarray, " 3"]) -> FrameContact:
        """Contact with MOVING at x_fixed = rotation x_moving + translation [m]."""
        on_fixed, on_moving = self.distances(rotation, translation)
        lowest, penetration = self._overlap(on_fixed, on_moving)
        within = [self.within(t, (on_fixed, on_moving), rotation, translation) for t in self.settings.thresholds]
        return FrameContact(
            fixed=[on for on, _ in within],
            moving=[on for _, on in within],
            sensitivity=areas_cut_once(self._fixed, on_fixed, self.settings.sensitivity),
            min_distance=lowest,
            max_penetration_fixed=penetration,
            fixed_distances=on_fixed,
            moving_distances=on_moving,
        )

    def distances(
        self, rotation: Float[np.ndarray, "3 3"], translation: Float[np.ndarray, " 3"]
    ) -> tuple[Distances, Distances]:
        """Distances of FIXED's points to MOVING and of MOVING's to FIXED, in the order of `Surface.walk`, at a pose."""
        if not (np.isfinite(rotation).all() and np.isfinite(translation).all()):
            raise ValueError("the pose is not finite")
        on_fixed = self._fixed.distances(self.moving, np.ascontiguousarray(rotation.T), -rotation.T @ translation)
        return on_fixed, self._moving.distances(self.fixed, np.ascontiguousarray(rotation), translation)

    def within(
        self,
        threshold: float,
        distances: tuple[Distances, Distances],
        rotation: Float[np.ndarray, "3 3"],
        translation: Float[np.ndarray, " 3"],
        refinement: Refinement | None = None,
    ) -> tuple[AreaWithin, AreaWithin]:
        """Areas of FIXED and of MOVING within a threshold [m] at the pose that `distances` were measured at.

        The threshold need not be one of the settings, but none above their largest: distances reach no farther.
        `refinement` in place of that of the settings.
        """
        back, origin = np.ascontiguousarray(rotation.T), -rotation.T @ translation
        on_fixed, on_moving = distances
        fine = refinement or self.settings.refinement
        fixed = self._area(self._fixed, self.moving, on_fixed, threshold, back, origin, fine)
        moving = self._area(self._moving, self.fixed, on_moving, threshold, rotation, translation, fine)
        return fixed, _in_frame(moving, rotation, translation)

    def _area(
        self,
        sampled: Sampled,
        other: Surface,
        distances: Distances,
        threshold: float,
        rotation: Float[np.ndarray, "3 3"],
        translation: Float[np.ndarray, " 3"],
        refinement: Refinement,
    ) -> AreaWithin:
        rule = self.settings.rule
        refinement = refinement if rule == REFINED else AS_GIVEN
        found = area_within(sampled, other, distances, threshold, rotation, translation, refinement)
        if rule in (REFINED, CLIP):
            return found
        area, moment, negative = counted_area(sampled, other, distances, threshold, rule)
        moment = moment + area * sampled.surface.centre
        return AreaWithin(area, found.lower, found.upper, found.upper - found.lower, moment, negative, found.undecided)

    def _overlap(self, on_fixed: Distances, on_moving: Distances) -> tuple[float, float]:
        """Smallest distance between the surfaces and depth of FIXED's counted faces in MOVING [m]."""
        inside = bool((on_fixed.side < 0).any() or (on_moving.side < 0).any())
        depth = 0.0 if self.moving.closed else np.nan
        if not inside:
            gap = least_distance(
                Facing(self._edges_of_fixed, on_fixed, self.moving, self._rise_of_moving),
                Facing(self._edges_of_moving, on_moving, self.fixed, self._rise_of_fixed),
            )
            if gap > 0.0:
                return gap, depth
        lowest = 0.0
        if self.moving.closed:
            lowest = lowest_signed_distance(self._whole_fixed, self.moving, on_fixed, self._rise_of_moving)
            counted = lowest
            if self._fixed is not self._whole_fixed:
                counted = lowest_signed_distance(self._fixed, self.moving, on_fixed, self._rise_of_moving)
            depth = -counted
        if self.fixed.closed:
            lowest = lowest_signed_distance(self._whole_moving, self.fixed, on_moving, self._rise_of_fixed, lowest)
        return lowest, depth


def _in_frame(
    found: AreaWithin, rotation: Float[np.ndarray, "3 3"], translation: Float[np.ndarray, " 3"]
) -> AreaWithin:
    """The same with the first moment taken in FIXED's frame."""
    moment = rotation @ found.moment + found.area * translation
    return AreaWithin(found.area, found.lower, found.upper, found.error, moment, found.negative, found.undecided)


def area_evolution(
    moving: Surface,
    fixed: Surface,
    motion: Motion,
    settings: Settings = Settings(),
    workers: int | None = None,
    each: Callable[[int, FrameContact], None] | None = None,
) -> AreaEvolution:
    """Contact area of both surfaces for every frame of a motion.

    Parameters
    ----------
    moving, fixed
        The two bodies, each in its own frame [m].
    motion
        Poses of MOVING in FIXED's frame.
    settings
        Thresholds and what counts; 4 mm as in the knee-implant paper by default.
    workers
        Threads over frames; all cores by default. Results do not depend on it.
    each
        Called with every finished frame, in order: for progress and for keeping distance maps.

    Examples
    --------
    >>> import geocontact as gc
    >>> femoral = gc.read_surface("meshes/femoral_component_right_coarse.stl", "mm")
    >>> insert = gc.read_surface("meshes/tibial_insert_right_coarse.stl", "mm")
    >>> settings = gc.Settings(thresholds=gc.mm(1, 4), rule="clip")
    >>> found = gc.area_evolution(femoral, insert, gc.read_motion("meshes/gait.csv"), settings)
    >>> found.fixed.area.shape, (1e6 * found.fixed.area.max(axis=0)).round(0).tolist()
    ((101, 2), [1084.0, 2484.0])
    """
    pair = ContactPair(moving, fixed, settings)
    rotation = np.ascontiguousarray(motion.poses.rotation.as_matrix().reshape(-1, 3, 3))
    translation = np.asarray(motion.poses.translation).reshape(-1, 3)
    on_fixed: list[list[AreaWithin]] = []
    on_moving: list[list[AreaWithin]] = []
    sensitivity: list[np.ndarray] = []
    lowest: list[float] = []
    deepest: list[float] = []
    with ThreadPoolExecutor(workers or os.cpu_count() or 1) as pool:
        for k, frame in enumerate(pool.map(pair.at, rotation, translation)):
            if each is not None:
                each(k, frame)
            on_fixed.append(frame.fixed)
            on_moving.append(frame.moving)
            sensitivity.append(frame.sensitivity)
            lowest.append(frame.min_distance)
            deepest.append(frame.max_penetration_fixed)
    return AreaEvolution(
        time=motion.time,
        thresholds=settings.thresholds,
        fixed=_gathered(on_fixed, _region(fixed, settings.fixed_faces)),
        moving=_gathered(on_moving, _region(moving, settings.moving_faces)),
        min_distance=np.array(lowest),
        max_penetration_fixed=np.array(deepest),
        signed=pair.signed,
        medial_side=settings.medial_side,
        split_normal=settings.split.normal if settings.split is not None else (0.0, 0.0, 0.0),
        sensitivity_thresholds=settings.sensitivity,
        sensitivity=np.array(sensitivity),
        undecided=np.array([a[0].undecided + b[0].undecided for a, b in zip(on_fixed, on_moving, strict=True)]),
    )


def area_of_outer(
    moving: Surface,
    fixed: Surface,
    motion: Motion,
    settings: Settings,
    body: Literal["moving", "fixed"],
    outer: UnitedSurface,
    workers: int | None = None,
) -> Float[np.ndarray, " t"]:
    """Contact area of the outer surface alone of one body over a motion, at the largest threshold [m^2].

    Parameters
    ----------
    moving, fixed, motion, settings, workers
        As in `area_evolution`; the faces of `body` that count are marked on the whole surface.
    body, outer
        Body whose file holds closed surfaces inside or across others, and its outer surface.
    """
    sides = {"moving": moving, "fixed": fixed, body: outer.surface}
    faces = {"moving": settings.moving_faces, "fixed": settings.fixed_faces}
    marked = faces[body]
    faces[body] = None if marked is None else marked[outer.face]
    alone = dataclasses.replace(
        settings,
        thresholds=(max(settings.thresholds),),
        sensitivity=(),
        moving_faces=faces["moving"],
        fixed_faces=faces["fixed"],
    )
    found = area_evolution(sides["moving"], sides["fixed"], motion, alone, workers)
    return np.asarray(getattr(found, body).area[:, 0])


def _region(body: Surface, faces: Bool[np.ndarray, " f"] | None) -> float | None:
    """Area of the faces that were chosen [m^2], each once."""
    return None if faces is None else float(body.face_area[faces & ~body.repeated].sum()) or None


def _gathered(rows: Sequence[Sequence[AreaWithin]], region: float | None) -> SideAreas:
    def collect(name: str) -> np.ndarray:
        return np.array([[getattr(cell, name) for cell in row] for row in rows])

    return SideAreas(
        area=collect("area"),
        lower=collect("lower"),
        upper=collect("upper"),
        error=collect("error"),
        centroid=collect("centroid"),
        negative=collect("negative"),
        region=region,
    )
