"""A ball over a plate: a scene whose distances are known in closed form."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.view.surfaces.scene import ContactScene, ContactSeries, MappedBody
from meshes import simple_shapes

MM = 1e-3
RADIUS = 18 * MM
HALF = 30 * MM  # of the plate
GAP = -0.1 * MM  # of the ball above the plate's upper side, which is at y = 0
LIMIT = 5 * MM  # beyond it distances are not known
THRESHOLDS = (1 * MM, 4 * MM)


def plate(cells: int = 40):
    """Upper side of a plate in y = 0, open: vertices [m], faces."""
    line = np.linspace(-HALF, HALF, cells + 1)
    x, z = np.meshgrid(line, line, indexing="ij")
    vertices = np.column_stack([x.ravel(), np.zeros(x.size), z.ravel()])
    at = np.arange(x.size).reshape(x.shape)
    a, b, c, d = at[:-1, :-1].ravel(), at[1:, :-1].ravel(), at[1:, 1:].ravel(), at[:-1, 1:].ravel()
    return vertices, np.vstack([np.column_stack([a, c, b]), np.column_stack([a, d, c])])


def ball(n: int = 12):
    """Ball about the origin: vertices [m], faces."""
    vertices, faces = simple_shapes.sphere(RADIUS / MM, n)
    return vertices * MM, faces


def to_ball(points, centre):
    """Signed distance to the ball [m], infinite beyond the limit."""
    distance = np.linalg.norm(points - centre, axis=1) - RADIUS
    return np.where(distance <= LIMIT, distance, np.inf)


def to_plate(points):
    """Signed distance to the half-space below the plate [m], infinite beyond the limit."""
    return np.where(points[:, 1] <= LIMIT, points[:, 1], np.inf)


def scene(centre=(0.0, RADIUS + GAP, 0.0), **changes) -> ContactScene:
    """The ball at `centre` [m]."""
    (fixed, fixed_faces), (moving, moving_faces) = plate(), ball()
    given = {
        "fixed_vertices": fixed,
        "fixed_faces": fixed_faces,
        "distance": to_ball(fixed, np.asarray(centre)),
        "moving_vertices": moving + centre,
        "moving_faces": moving_faces,
        "thresholds": THRESHOLDS,
        "time": 0.25,
    }
    return ContactScene(**{**given, **changes})


def series(frames: int = 4, **changes) -> ContactSeries:
    """The ball rolling along x."""
    (fixed, fixed_faces), (moving, moving_faces) = plate(20), ball(6)
    x = np.linspace(-8 * MM, 8 * MM, frames)
    centres = np.column_stack([x, np.full(frames, RADIUS + GAP), np.zeros(frames)])
    turned = Rotation.from_rotvec(np.column_stack([0.0 * x, 0.0 * x, -x / RADIUS]))
    poses = RigidTransform.from_components(centres, turned)
    given = {
        "time": np.linspace(0.0, 1.0, frames) / 3.0,
        "poses": poses,
        "fixed": MappedBody(fixed, fixed_faces, np.array([to_ball(fixed, c) for c in centres])),
        "moving": MappedBody(moving, moving_faces, np.array([to_plate(p.apply(moving)) for p in poses])),
        "thresholds": THRESHOLDS,
        "signed": "fixed",
    }
    return ContactSeries(**{**given, **changes})
