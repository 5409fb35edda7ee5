"""Bodies and poses for the geometry tests, in metres; what is measured at a pose, in one call."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.geometry.contact_area.evolution import ContactPair, FrameContact, Settings
from geocontact.geometry.surface import Surface
from meshes import simple_shapes

MM = 1e-3
MM2 = 1e-6
ORIGIN = (0.0, 0.0, 0.0)


def surface(body, name="surface"):
    """Surface of a body (vertices [mm], faces)."""
    return Surface(body[0] * MM, body[1], name)


def cube(centre, half):
    """Twelve triangles about `centre`; `half` is one length or one per axis. Vertices and faces."""
    half = np.broadcast_to(np.asarray(half, float), 3)
    vertices, faces = simple_shapes.block(2.0, 2.0, 2.0, 1)
    return (vertices + np.array([0, 1, 0])) * half + centre, faces


def joined(*bodies):
    """Several bodies as one: vertices and faces concatenated, nothing merged."""
    starts = np.cumsum([0, *(len(v) for v, _ in bodies)])
    return np.vstack([v for v, _ in bodies]), np.vstack(
        [f + start for (_, f), start in zip(bodies, starts[:-1], strict=True)]
    )


def moved(body, rotation, shift):
    """A body turned and shifted."""
    return rotation.apply(body[0]) + shift, body[1]


def turned(x, y, z):
    """Rotation by a vector of degrees."""
    return Rotation.from_rotvec([x, y, z], degrees=True)


def pose_of(rotation=None, shift=ORIGIN):
    """X_FM; shift in m."""
    return RigidTransform.from_components(np.asarray(shift, float), rotation or Rotation.identity())


def contact(moving, fixed, pose, thresholds, **settings) -> FrameContact:
    """One frame; thresholds in m."""
    pair = ContactPair(moving, fixed, Settings(thresholds=tuple(np.atleast_1d(thresholds)), **settings))
    return pair.at(np.ascontiguousarray(pose.rotation.as_matrix()), np.asarray(pose.translation))


def box_distance(points, centre, half):
    """Signed distance to a box in closed form, negative inside."""
    away = np.abs(points - np.asarray(centre)) - half
    return np.linalg.norm(np.maximum(away, 0.0), axis=1) + np.minimum(away.max(axis=1), 0.0)


def order_of(edge, error):
    """Slope of log error over log edge length."""
    return float(np.polyfit(np.log(edge), np.log(np.abs(error)), 1)[0])
