"""Feet, laws and motions that the tests of the loads share."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from hypothesis import strategies as st
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.loads.ground import Ground
from geocontact.loads.sphere_set import SoleLaw, SphereLoads, SphereSet, sphere_loads

RADIUS = 0.02
ROOT = Path(__file__).resolve().parents[2]


def law(count: int, *, b: float = 0.0, mu: float = 0.0, k: float | np.ndarray = 5e4, v_th: float = 0.1) -> SoleLaw:
    """k depth^1.5; frictionless and undamped unless asked for."""
    stiffness = np.broadcast_to(np.asarray(k, float), count).copy()
    return SoleLaw(stiffness, np.full(count, b), 1.5, 2e-3, np.full(count, mu), np.full(count, 0.8 * mu), v_th)


def sole(points: np.ndarray, radius: float | np.ndarray = RADIUS, zone: tuple[str, ...] | None = None) -> SphereSet:
    """Spheres at these centres."""
    radii = np.broadcast_to(np.asarray(radius, float), len(points)).copy()
    return SphereSet(np.asarray(points, float), radii, zone or ("foot",) * len(points))


def scattered(seed: int, count: int = 12, height: float = RADIUS - 2e-3) -> SphereSet:
    """A sole of spheres of various heights and sizes, most of which touch the ground y = 0."""
    rng = np.random.default_rng(seed)
    points = np.column_stack(
        [rng.uniform(0.0, 0.25, count), height + rng.uniform(-2e-3, 3e-3, count), rng.uniform(-0.04, 0.04, count)]
    )
    return sole(points, RADIUS + rng.uniform(-1e-3, 1e-3, count))


def still(*poses: RigidTransform) -> tuple[RigidTransform, np.ndarray]:
    """Poses (the identity without any) of a foot that does not move, and their rate."""
    stack = RigidTransform.from_matrix(np.array([pose.as_matrix() for pose in poses or [RigidTransform.identity()]]))
    return stack, np.zeros((len(stack), 4, 4))


def standing(spheres: SphereSet, numbers: SoleLaw, ground: Ground) -> SphereLoads:
    """Loads on a foot that stands still where it is."""
    return sphere_loads(spheres, numbers, *still(), ground)


def twist(pose: RigidTransform, velocity: np.ndarray, turning: np.ndarray) -> tuple[RigidTransform, np.ndarray]:
    """One pose and its rate when the foot's origin moves with `velocity` and the foot turns with `turning` [rad/s]."""
    rate = np.zeros((1, 4, 4))
    x, y, z = turning
    rate[0, :3, :3] = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) @ pose.rotation.as_matrix()
    rate[0, :3, 3] = velocity
    return RigidTransform.from_matrix(pose.as_matrix()[None]), rate


coordinate = st.floats(-2.0, 2.0)
vectors = st.tuples(coordinate, coordinate, coordinate).map(np.array)
rotations = (
    st.tuples(*(st.floats(-1.0, 1.0),) * 4).filter(lambda q: sum(x * x for x in q) > 0.01).map(Rotation.from_quat)
)
rigid = st.builds(RigidTransform.from_components, vectors, rotations)
