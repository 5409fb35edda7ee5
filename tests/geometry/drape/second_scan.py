"""A synthetic second scan of the sample thigh: another tessellation, with a mat on it, noisy, standing elsewhere."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import griddata
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.geometry.surface import Surface
from geocontact.io.mesh.meshes import read_mesh
from meshes.mat_placement import THIGH_MAT, Mat
from meshes.segment_meshes import segment_mesh
from tests.cli.calls import MESHES

ELSEWHERE = RigidTransform.from_components([0.4, -0.2, 0.9], Rotation.from_rotvec([0.7, 0.5, -0.4]))
"""Pose of the bare scan's frame in that of the second one."""


def bare() -> Surface:
    return Surface.of(read_mesh(MESHES / "thigh.stl", "mm"))


def cells_at(mat: Mat, at: np.ndarray) -> np.ndarray:
    """Row and column [cells] of skin points (theta, y); NaN far from the mat."""
    u, v = np.linspace(-1.0, mat.rows + 1.0, 73), np.linspace(-1.0, mat.columns + 1.0, 41)
    known = mat.parameters(u, v, 2.0).reshape(-1, 2)
    cells = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
    scale = np.array([76.0, 1.0])  # rad to mm, about
    return griddata(known * scale, cells, at * scale)


def with_mat(thickness: float, noise: float, mat: Mat = THIGH_MAT, n: int = 30, seed: int = 0) -> Surface:
    """The thigh with a slab [mm] on the skin under the mat, every vertex off by `noise` [mm]."""
    segment = mat.segment
    vertices, faces = segment_mesh(segment, n)
    at = np.column_stack([np.arctan2(vertices[:, 2], vertices[:, 0]), vertices[:, 1]])
    cells = cells_at(mat, at)
    with np.errstate(invalid="ignore"):
        on = ((cells >= 0.0) & (cells <= [mat.rows, mat.columns])).all(axis=1)
    on &= np.abs(segment.off_surface(vertices)) < 0.1
    moved = vertices + np.where(on, thickness, 0.0)[:, None] * segment.normals(at)
    moved += np.random.default_rng(seed).normal(0.0, 1.0, moved.shape) * noise
    return Surface(ELSEWHERE.apply(1e-3 * moved), faces, "thigh with mat")


def corners(mat: Mat = THIGH_MAT) -> np.ndarray:
    """On the smooth skin [m]: first, end of column 1, last, end of row 1; counter-clockwise seen from outside."""
    u, v = np.array([0.0, mat.rows]), np.array([0.0, mat.columns])
    found = 1e-3 * mat.segment.points(mat.parameters(u, v, 2.0))
    return np.array([found[0, 0], found[1, 0], found[1, 1], found[0, 1]])
