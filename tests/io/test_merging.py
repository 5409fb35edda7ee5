"""Vertices merged within a tolerance: against all distances by brute force; what would lose faces is refused."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.cop.foot import ground_of
from geocontact.analyses.cop.options import CopOptions
from geocontact.data.errors import InputError, InputWarning
from geocontact.geometry.surface import Surface
from geocontact.io.mesh.meshes import read_mesh
from meshes.simple_shapes import sphere
from tests.analyses.mat.samples import shipped

RADIUS, JITTER, TOLERANCE = 20.0, 2e-5, 3e-4
"""mm: each corner of each face is off by a normal error of its own."""


def soup(folder: Path, corners: np.ndarray, name: str) -> Path:
    """An ASCII STL of triangles [mm] with all digits; nothing is shared but what is equal."""
    facets = (
        "facet normal 0 0 0\nouter loop\n" + "".join("vertex {!r} {!r} {!r}\n".format(*row) for row in face) + "endloop"
        for face in corners.tolist()
    )
    path = folder / name
    path.write_text("solid\n" + "\nendfacet\n".join(facets) + "\nendfacet\nendsolid\n", "utf-8")
    return path


def ball(divisions: int = 6) -> tuple[np.ndarray, np.ndarray]:
    """Vertices [mm] and faces; no two vertices nearer than a tenth of a millimetre."""
    vertices, faces = sphere(RADIUS, divisions)
    return np.asarray(vertices, float), np.asarray(faces)


def jittered(seed: int = 7) -> np.ndarray:
    vertices, faces = ball()
    return vertices[faces] + np.random.default_rng(seed).normal(0.0, JITTER, (len(faces), 3, 3))


def test_a_jittered_ball_is_the_clean_one(tmp_path: Path) -> None:
    """As many vertices, the same faces, closed; each vertex the mean of its copies, which numpy finds by itself."""
    vertices, faces = ball()
    corners = jittered()
    path = soup(tmp_path, corners, "jittered.stl")
    with pytest.warns(InputWarning, match=r"^jittered\.stl: ") as caught:
        mesh = read_mesh(path, "mm", merge_tolerance=gc.mm(TOLERANCE))
    surface = Surface.of(mesh)
    assert surface.closed
    assert surface.topology.open_edges == 0
    assert not Surface.of(read_mesh(path, "mm")).closed, "without a tolerance every edge is open"
    copies = corners.reshape(-1, 3)
    means = np.stack([copies[faces.ravel() == k].mean(axis=0) for k in range(len(vertices))])
    np.testing.assert_allclose(mesh.vertices[mesh.faces], 1e-3 * means[faces], rtol=0, atol=1e-16)
    assert len(mesh.vertices) == len(vertices)
    shift = np.linalg.norm(copies - means[faces.ravel()], axis=1).max()
    (said,) = [str(one.message) for one in caught]
    assert f"{len(copies)} vertices within 0.0003 mm of each other merged into {len(vertices)}, " in said
    assert float(re.search(r"moved by (\S+) mm at most", said)[1]) == pytest.approx(shift, rel=5e-3)  # type: ignore[index]


def test_means_do_not_depend_on_the_order_of_the_faces(tmp_path: Path) -> None:
    corners = jittered()
    order = np.random.default_rng(3).permutation(len(corners))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        one, other = (
            read_mesh(soup(tmp_path, each, name), "mm", merge_tolerance=gc.mm(TOLERANCE))
            for each, name in ((corners, "a.stl"), (corners[order], "b.stl"))
        )
    np.testing.assert_array_equal(one.vertices[one.faces][order], other.vertices[other.faces])


def test_what_is_not_merged_keeps_all_its_bits(tmp_path: Path) -> None:
    vertices, faces = ball()
    corners = vertices[faces]
    corners[4, 1] += [0.0, 3e-5, 4e-5]  # 5e-5 from the others, and each goes half of it
    said = r"2 vertices within 0\.0003 mm of each other merged into 1, moved by 2\.5e-05 mm at most"
    with pytest.warns(InputWarning, match=said):
        mesh = read_mesh(soup(tmp_path, corners, "one.stl"), "mm", merge_tolerance=gc.mm(TOLERANCE))
    clean = read_mesh(soup(tmp_path, vertices[faces], "clean.stl"), "mm")
    moved = (mesh.vertices[mesh.faces] != clean.vertices[clean.faces]).any(axis=2)
    np.testing.assert_array_equal(moved, faces == faces[4, 1])


@pytest.mark.parametrize("unit", ["m", "cm", "in"])
def test_the_tolerance_does_not_depend_on_the_unit_of_the_file(tmp_path: Path, unit: str) -> None:
    per = {"m": 1e-3, "cm": 0.1, "in": 1 / 25.4}[unit]
    with pytest.warns(InputWarning, match=r"within 0\.0003 mm"):
        mesh = read_mesh(soup(tmp_path, jittered() * per, "a.stl"), unit, merge_tolerance=gc.mm(TOLERANCE))
    assert Surface.of(mesh).closed
    apart = jittered()
    apart[4, 1, 0] += 2e-3  # mm: within a tolerance that is read in another unit, beyond this one
    with pytest.warns(InputWarning, match="within"):
        other = read_mesh(soup(tmp_path, apart * per, "b.stl"), unit, merge_tolerance=gc.mm(TOLERANCE))
    assert len(other.vertices) == len(mesh.vertices) + 1
    radii = np.linalg.norm(mesh.vertices, axis=1)
    np.testing.assert_allclose(radii, 1e-3 * RADIUS, rtol=0, atol=1e-3 * 4 * JITTER)


def test_a_tolerance_that_collapses_faces_is_refused(tmp_path: Path) -> None:
    """The remedy is one that works: below the shortest edge, which numpy finds by itself."""
    vertices, faces = ball()
    corners = vertices[faces]
    shortest = min(float(np.linalg.norm(corners[:, k] - corners[:, k - 1], axis=1).min()) for k in range(3))
    path = soup(tmp_path, corners, "ball.stl")
    with pytest.raises(InputError, match=r"^ball\.stl face \d+: `merge_tolerance` of .* mm would collapse") as caught:
        read_mesh(path, "mm", merge_tolerance=gc.mm(1.001 * shortest))
    assert f"the shortest edge, {shortest:.3g} mm" in caught.value.what
    with pytest.warns(InputWarning, match="no two vertices lie within .* `merge_tolerance` has no effect"):
        read_mesh(path, "mm", merge_tolerance=gc.mm(0.999 * shortest))


def test_vertices_that_hang_together_in_a_chain_are_refused(tmp_path: Path) -> None:
    """0, 0.8 and 1.6 tolerances: the first and the last are not within it."""
    vertices, faces = ball()
    corners = vertices[faces]
    of = faces[0, 0]
    for step, face in enumerate(np.flatnonzero((faces == of).any(axis=1))[:3]):
        corners[face, np.argmax(faces[face] == of)] += [0.8 * TOLERANCE * step, 0.0, 0.0]
    with pytest.raises(InputError, match=r"3 vertices, each within 0\.0003 mm of a next one, are 0\.00048 mm across"):
        read_mesh(soup(tmp_path, corners, "chain.stl"), "mm", merge_tolerance=gc.mm(TOLERANCE))


@pytest.mark.parametrize("tolerance", [0.0, -1e-6, np.nan, 0.1])
def test_a_tolerance_that_cannot_be_is_refused(tmp_path: Path, tolerance: float) -> None:
    with pytest.raises(InputError, match="merge_tolerance"):
        gc.read_surface(soup(tmp_path, jittered(), "a.stl"), "mm", merge_tolerance=tolerance)


def test_the_ground_of_a_foot_is_merged_too(tmp_path: Path) -> None:
    """Two triangles that share an edge but for 2e-5 mm are one sheet."""
    corners = np.array([[[-1, 0, -1], [1, 0, 1], [1, 0, -1]], [[-1, 0, -1], [-1, 0, 1], [1, 0, 1]]], float)
    corners[1, 0, 0] += 2e-8
    asked = {"motion": tmp_path / "m.csv", "ground": soup(tmp_path, corners, "ground.stl").as_posix()}
    with pytest.warns(InputWarning) as caught:
        ground_of(CopOptions(tmp_path / "s.csv", unit="m", merge_tolerance=gc.mm(1e-4), **asked))
    said = [str(one.message) for one in caught]
    assert any(
        "2 vertices within 0.0001 mm of each other merged into 1, moved by 1e-05 mm at most" in one for one in said
    )
    assert any("(4 open edges)" in one for one in said)
    with pytest.raises(InputError, match="`merge_tolerance`: has no effect without `unit`"):
        CopOptions(tmp_path / "s.csv", merge_tolerance=gc.mm(1e-4), motion=tmp_path / "m.csv")


def test_the_scan_under_a_mat_is_merged_too() -> None:
    found = shipped(merge_tolerance=gc.mm(1e-4)).warnings
    assert any("thigh.stl: no two vertices lie within 0.0001 mm" in one for one in found)
