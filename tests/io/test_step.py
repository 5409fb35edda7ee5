"""STEP files, written here by hand: closed forms, units, and what is refused; all synthetic."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from geocontact.data.errors import InputError, InputWarning
from geocontact.io.mesh import step
from geocontact.io.mesh.meshes import read_mesh
from geocontact.io.text.units import LENGTH
from tests.step_files import box, sphere

needed = pytest.mark.skipif(importlib.util.find_spec("cascadio") is None, reason="the extra `step` is not installed")


def written(folder: Path, text: str, name: str = "body.step") -> Path:
    (folder / name).write_text(text)
    return folder / name


def area_and_volume(vertices: np.ndarray, faces: np.ndarray) -> tuple[float, float]:
    a, b, c = vertices[faces].swapaxes(0, 1)
    turned = np.cross(b - a, c - a)
    return float(np.linalg.norm(turned, axis=1).sum() / 2.0), float(np.sum(a * turned) / 6.0)


def is_closed(faces: np.ndarray) -> bool:
    """Whether every edge is passed once either way."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    return {tuple(edge) for edge in edges} == {tuple(edge[::-1]) for edge in edges} and len(
        {tuple(edge) for edge in edges}
    ) == len(edges)


@needed
@pytest.mark.parametrize("unit", sorted({"m", "cm", "mm", "in"}))
def test_a_box_in_any_unit_has_its_area(unit: str, tmp_path: Path) -> None:
    sizes = np.array([0.01, 0.02, 0.03])
    x, y, z = sizes / LENGTH[unit]
    with pytest.warns(InputWarning, match=r"STEP, 12 triangles within 0.01 mm and 0.2 rad of its exact surfaces"):
        mesh = read_mesh(written(tmp_path, box((x, y, z), unit)), unit)
    assert mesh.vertices.shape == (8, 3) and is_closed(mesh.faces)
    np.testing.assert_allclose(mesh.vertices.max(axis=0), sizes, rtol=2e-7)
    area, volume = area_and_volume(mesh.vertices, mesh.faces)
    assert area == pytest.approx(2.0 * (2e-4 + 3e-4 + 6e-4), rel=1e-6) and volume == pytest.approx(6e-6, rel=1e-6)


@needed
@pytest.mark.parametrize("unit", ["mm", "m"])
def test_a_sphere_is_as_near_as_is_said(unit: str, tmp_path: Path) -> None:
    """Whatever its unit: corners on the sphere, triangles within a hundredth of a mm; closed at seam and poles."""
    radius = 0.02
    with pytest.warns(InputWarning, match="triangles within 0.01 mm"):
        mesh = read_mesh(written(tmp_path, sphere(radius / LENGTH[unit], unit), "ball.STP"), unit)
    assert is_closed(mesh.faces)
    assert np.abs(np.linalg.norm(mesh.vertices, axis=1) - radius).max() < 1e-8
    depth = radius - np.linalg.norm(mesh.vertices[mesh.faces].mean(axis=1), axis=1)
    assert 1e-6 < depth.max() < step.CHORD
    area, volume = area_and_volume(mesh.vertices, mesh.faces)
    assert 4.0 * np.pi * radius**2 == pytest.approx(area, rel=1e-3) and area < 4.0 * np.pi * radius**2
    assert 0.0 < 4.0 / 3.0 * np.pi * radius**3 - volume < step.CHORD * 4.0 * np.pi * radius**2
    assert cKDTree(mesh.vertices).query(mesh.vertices, k=2)[0][:, 1].min() > 1e-6


@needed
def test_what_is_damaged_is_refused_in_one_line(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    whole = box((10.0, 20.0, 30.0), "mm")
    for text, line in (
        (whole.replace("PLANE(", "PLAIN(", 1), r"OpenCASCADE reads 5 of its 6 faces: the surface would have holes"),
        (whole.replace("ADVANCED_FACE", "ADVANCED_FICE"), "OpenCASCADE finds no surface in it; is it complete"),
    ):
        with pytest.raises(InputError, match=line):
            read_mesh(written(tmp_path, text), "mm")
    assert capfd.readouterr() == ("", "")


def test_the_unit_is_the_one_that_the_file_states(tmp_path: Path) -> None:
    """The same with and without the extra, whose absence is said where a file could be read."""
    for text, unit, line in (
        (
            box((1.0, 1.0, 1.0), "in"),
            "mm",
            "body.step: states that it is in in, the unit given is mm; give the unit in",
        ),
        (box((1.0, 1.0, 1.0), "um"), "mm", "states its unit of length as .MICRO.METRE; export it in one of m"),
        (re.sub("LENGTH_UNIT", "L_UNIT", box((1.0, 1.0, 1.0), "mm")), "mm", "does not state its unit of length"),
        ("solid ball\n", "mm", "is not a STEP file although its name says so: it looks like an ASCII STL"),
    ):
        with pytest.raises(InputError, match=line):
            read_mesh(written(tmp_path, text), unit)


COMMENT = "/* #9 = it's (a) comment; ADVANCED_FACE(1) */"


def decorated(text: str) -> str:
    """The same file with comments wherever they may stand, and names that look like other things."""
    text = re.sub(r"^(#\d+) ?= ?", rf"\1 {COMMENT} = {COMMENT} ", text, flags=re.MULTILINE)
    text = text.replace("GLOBAL_UNIT_ASSIGNED_CONTEXT(", f"GLOBAL_UNIT_ASSIGNED_CONTEXT {COMMENT} ( {COMMENT} ")
    text = text.replace("CONVERSION_BASED_UNIT(", f"CONVERSION_BASED_UNIT({COMMENT}")
    return text.replace("ADVANCED_FACE(''", "ADVANCED_FACE('/* it''s; #7 = ADVANCED_FACE(LENGTH_UNIT) #8'")


@pytest.mark.parametrize("unit", ["mm", "in"])
def test_comments_and_names_are_no_entities(unit: str, tmp_path: Path) -> None:
    """ISO 10303-21, 6.5: a comment may stand wherever a blank may."""
    plain = box((1.0, 2.0, 3.0), unit)
    text = decorated(plain)
    assert text.count(COMMENT) > 40 and text.count("it''s") == plain.count("ADVANCED_FACE") == 6
    assert step.unit_of_step(text.encode(), "body.step") == unit
    if unit == "mm" and importlib.util.find_spec("cascadio") is not None:
        with pytest.warns(InputWarning, match="12 triangles within"):
            vertices, faces = step.read_step(text.encode(), "body.step")
        assert area_and_volume(vertices, faces) == pytest.approx((22.0, 6.0), rel=1e-6)


def test_without_the_extra_the_remedy_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(step, "find_spec", lambda name: None)
    line = r"body.step: reading .step needs cascadio; pip install 'geocontact\[step\]', or export the surface as .stl"
    with pytest.raises(InputError, match=line):
        read_mesh(written(tmp_path, box((1.0, 1.0, 1.0), "mm")), "mm")
