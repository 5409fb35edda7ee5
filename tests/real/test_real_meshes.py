"""Every surface of the real data is read, and equals what trimesh reads."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import trimesh

from geocontact.data.errors import InputWarning
from geocontact.io.mesh.meshes import read_mesh


def surfaces(folder: Path) -> list[Path]:
    return sorted(p for p in folder.rglob("*") if p.suffix.lower() in {".stl", ".obj"})


IN_MILLIMETRES = {"jma_ankles"}
"""Folders whose surfaces are in mm, as their SOURCE.md says; the others are in m."""


def test_every_real_surface_is_read_in_metres(data_dir):
    paths = surfaces(data_dir)
    assert any(p.suffix.lower() == ".stl" for p in paths), f"no STL under {data_dir}"
    for path in paths:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", InputWarning)
            unit = "mm" if path.relative_to(data_dir).parts[0] in IN_MILLIMETRES else "m"
            mesh = read_mesh(path, unit)
        oracle = trimesh.load_mesh(path, process=False, maintain_order=True, skip_materials=True)
        scale = 1e-3 if unit == "mm" else 1.0
        np.testing.assert_array_equal(mesh.vertices[mesh.faces], oracle.triangles * scale, err_msg=path.name)
        assert len(np.unique(mesh.vertices, axis=0)) == len(mesh.vertices), f"{path.name}: coincident vertices left"
