"""The picture of a scene by matplotlib, far faces first: what is drawn where pyvista cannot render.

Faces are painted whole in the order of their depth, so bodies that run through each other are wrong along the crossing,
and colours are one per face. Threshold lines are drawn over everything, on the faces that are turned to the eye.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.view.surfaces.camera import Shot
from geocontact.view.surfaces.legend import MOVING, coloured, known_up_to, level_lines, threshold_colour
from geocontact.view.surfaces.scene import ContactScene

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MM = 1e3
VEIL = 0.13  # opacity of MOVING


def paint(axes: Axes, scene: ContactScene, shot: Shot) -> None:
    """Draw both bodies and the threshold lines into `axes`, in mm about the middle of the shot."""
    from matplotlib.collections import LineCollection, PolyCollection

    body, body_colours = _body(scene, shot)
    veil, veil_colours = _veil(scene, shot)
    corners = np.concatenate([body, veil])
    colours = np.concatenate([body_colours, veil_colours])
    order = np.argsort(corners[:, :, 2].mean(axis=1), kind="stable")
    axes.add_collection(
        PolyCollection(
            list(corners[order, :, :2]),
            facecolors=colours[order],
            edgecolors="none",
            # no seams: opaque faces show none when their edges are hard, translucent ones when they are soft
            antialiaseds=(colours[order, 3] < 1.0).tolist(),
            rasterized=True,
        )
    )
    facing = _normal(shot.project(scene.fixed_vertices)[scene.fixed_faces])[:, 2] > 0.0
    for k, threshold in enumerate(scene.thresholds):
        ends, face = level_lines(scene.fixed_vertices, scene.fixed_faces, scene.distance, threshold)
        segments = list(shot.project(ends[facing[face]])[:, :, :2] * MM)
        for colour, width in (("white", 2.6), (threshold_colour(k), 1.3)):
            axes.add_collection(LineCollection(segments, colors=colour, linewidths=width, capstyle="round"))


def _body(scene: ContactScene, shot: Shot) -> tuple[Float[np.ndarray, "m 3 3"], Float[np.ndarray, "m 4"]]:
    """Corners [mm] and colours of FIXED's faces, divided where the known distance ends."""
    known = known_up_to(scene.distance, scene.fixed_faces)
    values, colours, (lower, top) = coloured(scene.distance, scene.thresholds, known)
    given = np.column_stack([shot.project(scene.fixed_vertices) * MM, values])[scene.fixed_faces]
    below = given[:, :, 3] < known
    cut = below.any(axis=1) & ~below.all(axis=1)
    pieces = np.concatenate([given[~cut], _quartered(_quartered(_quartered(given[cut])))])
    share = (pieces[:, :, 3].mean(axis=1) - lower) / (top - lower)
    shaded = colours[np.rint(share * (len(colours) - 1)).astype(np.int64)] * _shade(pieces[:, :, :3])[:, None]
    return pieces[:, :, :3], np.column_stack([shaded, np.ones(len(shaded))])


def _veil(scene: ContactScene, shot: Shot) -> tuple[Float[np.ndarray, "m 3 3"], Float[np.ndarray, "m 4"]]:
    """Corners [mm] and colours of those of MOVING's faces that are turned to the eye."""
    from matplotlib.colors import to_rgb

    corners = shot.project(scene.moving_vertices)[scene.moving_faces] * MM
    corners = corners[_normal(corners)[:, 2] > 0.0]
    shaded = np.asarray(to_rgb(MOVING)) * _shade(corners)[:, None]
    return corners, np.column_stack([shaded, np.full(len(shaded), VEIL)])


def _quartered(corners: Float[np.ndarray, "m 3 c"]) -> Float[np.ndarray, "4*m 3 c"]:
    """Triangles cut in four at the middles of their edges."""
    a, b, c = corners.swapaxes(0, 1)
    ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
    return np.concatenate([np.stack(t, axis=1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])


def _normal(corners: Float[np.ndarray, "m 3 3"]) -> Float[np.ndarray, "m 3"]:
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    return np.asarray(normal / np.where(size > 0.0, size, 1.0))


def _shade(corners: Float[np.ndarray, "m 3 3"]) -> Float[np.ndarray, " m"]:
    """Brightness by one lamp beside the eye, the same for both sides of a face."""
    lamp = np.array([0.25, 0.35, 0.9])
    normal = _normal(corners)
    facing = normal * np.where(normal[:, 2:] < 0.0, -1.0, 1.0)
    return np.asarray(0.55 + 0.45 * np.clip(facing @ lamp, 0.0, 1.0))
