"""Two bodies at the first frame of a motion and their areas within any threshold there, for a picture of a form.

Distances are measured once; the areas are those of `area.csv` in that frame.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, UInt8
from scipy.spatial.transform import RigidTransform

from geocontact.analyses.area.bodies import Bodies, read, refinement_of, refuse_zero_without_inside
from geocontact.analyses.area.options import AreaOptions
from geocontact.analyses.area.page_sections import seen_distances
from geocontact.data.evolution import MM2
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.evolution import ContactPair
from geocontact.geometry.contact_area.maps import at_vertices
from geocontact.geometry.contact_area.sampled import Distances
from geocontact.geometry.surface import Surface
from geocontact.io.text.units import LENGTH
from geocontact.view.page.content import Page, Scene, SceneBody
from geocontact.view.surfaces.camera import camera_directions

UNUSED = 1e-3
"""m; a threshold, which a scene has even where no distance is shown."""
MIDDLE, STEPS = 127, 127
"""Level of a vertex whose distance is the threshold, the highest one that counts; levels to either side of it."""


@dataclass(frozen=True, eq=False)
class FramePair:
    """Two bodies in contact at one pose.

    Parameters
    ----------
    name
        What the analysis calls them; "" where there are no others.
    moving, fixed
        Names of the bodies.
    contact, distances
        The surfaces, and what was measured between them.
    pose
        `X_FM` of that frame.
    bounds
        Those asked for.
    """

    name: str
    moving: str
    fixed: str
    contact: ContactPair
    distances: tuple[Distances, Distances]
    pose: RigidTransform
    bounds: float | None

    @classmethod
    def of(
        cls, bodies: Bodies, motion: Motion, bounds: float | None, names: tuple[str, str, str] = ("", "moving", "fixed")
    ) -> FramePair:
        """Measure distances in the first frame, as far as the largest threshold of `bodies`."""
        contact = ContactPair(bodies.moving, bodies.fixed, replace(bodies.settings, sensitivity=()))
        pose = motion.poses[0]
        distances = contact.distances(pose.rotation.as_matrix(), pose.translation)
        return cls(*names, contact, distances, pose, bounds)

    def areas(self, thresholds: Sequence[float]) -> list[dict[str, float]]:
        """Areas [mm^2] within each threshold [m], by their names in `area.csv`.

        Raises
        ------
        InputError
            For a threshold of 0 where no body has an inside.
        """
        contact, side = self.contact, self.contact.settings.medial_side
        refuse_zero_without_inside(tuple(thresholds), contact.moving, contact.fixed)
        refinement = refinement_of(tuple(thresholds), self.bounds)
        turn, shift = self.pose.rotation.as_matrix(), self.pose.translation
        found = []
        for threshold in thresholds:
            fixed, moving = contact.within(threshold, self.distances, turn, shift, refinement)
            areas = {"area_fixed": fixed.area, "area_moving": moving.area}
            if side:
                medial = fixed.negative if side < 0 else fixed.area - fixed.negative
                areas |= {"area_fixed_medial": medial, "area_fixed_lateral": fixed.area - medial}
            found.append({name: area * MM2 for name, area in areas.items()})
        return found

    def maps(self) -> dict[str, Float[np.ndarray, " n"]]:
        """Signed distance of each vertex to the other body [m] by body; infinite where no face of it counts."""
        contact, settings = self.contact, self.contact.settings
        sides = (
            (self.fixed, contact.fixed, settings.fixed_faces, self.distances[0]),
            (self.moving, contact.moving, settings.moving_faces, self.distances[1]),
        )
        return {
            name: seen_distances(at_vertices(body, measured.signed)[None], body, faces)[0]
            for name, body, faces, measured in sides
        }


@dataclass(frozen=True, eq=False)
class FirstFrame:
    """All bodies in the first frame.

    Parameters
    ----------
    surfaces, poses
        By the name of the body; one pose in the frame of the scene, None for a body at rest there.
    pairs
        Those that are in contact.
    when
        The frame in words.
    """

    surfaces: Mapping[str, Surface]
    poses: Mapping[str, RigidTransform | None]
    pairs: tuple[FramePair, ...]
    when: str

    @property
    def who(self) -> str:
        """The bodies in words."""
        files = ((pair.name, pair.contact.moving.name, pair.contact.fixed.name) for pair in self.pairs)
        return "; ".join(f"{name} {moving} (moving) on {fixed} (fixed)".lstrip() for name, moving, fixed in files)

    def words(self, thresholds: Sequence[float], unit: str) -> list[str]:
        """Areas within each threshold, one line each; InputError as `FramePair.areas` has it."""
        lines = []
        for pair in self.pairs:
            for threshold, areas in zip(thresholds, pair.areas(thresholds), strict=True):
                sums = ", ".join(f"{name} {area:.2f} mm^2" for name, area in areas.items())
                lines.append(f"{pair.name} within {threshold / LENGTH[unit]:.6g} {unit}: {sums}".lstrip())
        return lines

    def levels(self, threshold: float) -> list[UInt8[np.ndarray, " n"]]:
        """Level of each vertex of each body: at most `MIDDLE` where its distance to another body is within [m].

        Levels are linear in the distance, over the longest edge of the body to either side: a picture that
        interpolates them cuts triangles where the distance, taken as linear between corners, is the threshold.
        """
        near = {name: np.full(len(body.vertices), np.inf) for name, body in self.surfaces.items()}
        for pair in self.pairs:
            for name, distance in pair.maps().items():
                near[name] = np.minimum(near[name], distance)
        found = []
        for name, body in self.surfaces.items():
            share = np.clip((near[name] - threshold) / body.edge_length.max(), -1.0, 1.0)
            found.append((MIDDLE + np.ceil(STEPS * share)).astype(np.uint8))
        return found

    def page(self) -> Page:
        """The bodies in 3-D, in the order of `levels`."""
        settings = self.pairs[0].contact.settings
        normal = np.zeros(3) if settings.split is None else np.asarray(settings.split.normal) * settings.medial_side
        bodies = [
            SceneBody(body.name, body.vertices, body.faces, self.poses[name]) for name, body in self.surfaces.items()
        ]
        scene = Scene(bodies, (UNUSED,), (0.0, UNUSED), directions=camera_directions(normal))
        return Page(
            "Within the threshold", "coloured, on each body", np.zeros(1), "time [s]", sections=(scene,), plays=False
        )


def frame_words(motion: Motion, name: str = "") -> str:
    """The first frame of a motion, which has a name where there are several."""
    return f"{name} frame 1 of {len(motion)}, {motion.course.at(0)}".lstrip()


def first_frame(o: AreaOptions) -> FirstFrame:
    """The bodies of `area` in the first frame of its first motion; InputError as the analysis has it."""
    bodies = read(o)
    name, motion = bodies.motions[0]
    pair = FramePair.of(bodies, motion, o.bounds)
    surfaces = {"fixed": bodies.fixed, "moving": bodies.moving}
    return FirstFrame(surfaces, {"fixed": None, "moving": motion.poses[:1]}, (pair,), frame_words(motion, name))
