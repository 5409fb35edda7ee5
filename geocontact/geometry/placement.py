"""Where a mesh sits in the frame of its body."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.data.mesh import Mesh


def placed(mesh: Mesh, placement: Float[np.ndarray, "4 4"], metres_per_number: float = 1.0) -> Mesh:
    """The mesh in its body's frame.

    Parameters
    ----------
    placement
        4 x 4 matrix from mesh to body, translation in m. A mirroring one turns the faces over, so that they keep
        pointing outwards.
    metres_per_number
        The matrix acts on vertices divided by this: 1 for vertices in m; the mesh unit where the matrix holds the scale
        factors of a model file, which act on the numbers in the mesh file.
    """
    linear, shift = placement[:3, :3], placement[:3, 3]
    volume = float(np.linalg.det(linear)) if np.isfinite(placement).all() else 0.0
    if volume == 0.0:
        raise ValueError("the placement is singular or not finite")
    vertices = mesh.vertices / metres_per_number @ linear.T + shift
    faces = mesh.faces if volume > 0.0 else np.ascontiguousarray(mesh.faces[:, ::-1])
    metric = placement.copy()
    metric[:3, :3] /= metres_per_number
    before = np.eye(4) if mesh.placement is None else mesh.placement
    return Mesh(vertices, faces, mesh.name, mesh.unit, mesh.sha256, placement=metric @ before)
