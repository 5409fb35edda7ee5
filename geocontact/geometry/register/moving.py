"""A registration that travels with its segment."""

from __future__ import annotations

from scipy.spatial.transform import RigidTransform


def carried(X_BA: RigidTransform, X_GB: RigidTransform) -> RigidTransform:
    """X_GA, the poses in the lab G of what is registered (X_BA, one pose) to segment B, from the segment's poses X_GB.

    The bond is rigid: X_GA = X_GB X_BA, one for each of the segment's poses.
    """
    if not X_BA.single:
        raise ValueError(f"a registration is one pose, not {len(X_BA)}; it is carried along by those of the segment")
    return X_GB * X_BA
