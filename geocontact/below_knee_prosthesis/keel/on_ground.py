"""Loads on the spheres of a keel whose angles are known, on any ground."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.keel.quasi_static import QuasiStaticKeel
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.ground import Ground
from geocontact.loads.sphere_loads import SphereLoads, sphere_loads

FIELDS = ("pressing", "force", "point", "centre", "normal", "depth")


def loads_at(
    keel: QuasiStaticKeel,
    angles: Float[np.ndarray, "t m"],
    speeds: Float[np.ndarray, "t m"],
    poses: RigidTransform,
    rate: Float[np.ndarray, "t 4 4"],
    ground: Ground,
) -> SphereLoads:
    """At angles [rad] and their rates [rad/s] of a keel without torsion, along poses `X_GK` and their derivative.

    Off a plane each segment is a rigid foot of its own, for `loads.sphere_loads`; ValueError where a sphere is deeper
    than its radius there.
    """
    if isinstance(ground, HalfSpace):
        return keel.at(angles, speeds, poses, ground, rate).loads
    frames, segments = len(angles), np.array(keel.sole.segment)
    matrix, moving = poses.as_matrix().reshape(-1, 4, 4), np.asarray(rate)
    found: dict[str, Float[np.ndarray, ...]] = {}
    for segment in range(keel.keel.joints + 1):
        if segment:
            at = keel.keel.places[0] if segment == 1 else keel.keel.pitch
            step, slope = _hinge(angles[:, segment - 1], speeds[:, segment - 1], at)
            matrix, moving = matrix @ step, moving @ step + matrix @ slope
        spheres, chosen = keel.sole.on(segment, keel.keel), segments == segment
        if spheres is None:
            continue
        law = replace(
            keel.law,
            stiffness=keel.law.stiffness[chosen],
            damping=keel.law.damping[chosen],
            static=np.broadcast_to(keel.law.static, len(segments))[chosen],
            kinetic=np.broadcast_to(keel.law.kinetic, len(segments))[chosen],
        )
        own = sphere_loads(spheres, law, RigidTransform.from_matrix(matrix), moving, ground)
        for name in FIELDS:
            values = getattr(own, name)
            if name not in found:
                found[name] = np.empty((frames, len(segments), *values.shape[2:]))
            found[name][:, chosen] = values
    return SphereLoads(**found)


def _hinge(
    angle: Float[np.ndarray, " t"], speed: Float[np.ndarray, " t"], ahead: float
) -> tuple[Float[np.ndarray, "t 4 4"], Float[np.ndarray, "t 4 4"]]:
    """Pose of a segment in the one before, and its derivative."""
    step, slope = np.zeros((2, len(angle), 4, 4))
    step[:, :3, :3] = Rotation.from_euler("z", angle[:, None]).as_matrix()
    step[:, 0, 3], step[:, 3, 3] = ahead, 1.0
    s, c = np.sin(angle) * speed, np.cos(angle) * speed
    slope[:, 0, 0], slope[:, 0, 1], slope[:, 1, 0], slope[:, 1, 1] = -s, -c, c, -s
    return step, slope
