"""Thickness of a layer: shipped balls in closed form, table, page and .vtp, what is doubted and refused."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.thickness.result import ThicknessResult
from geocontact.data.errors import InputError, InputWarning
from meshes.simple_shapes import block, sphere
from meshes.stl import stl_bytes
from tests.cli.calls import MESHES, shifted, written

BALLS = MESHES / "sphere_r20.stl", MESHES / "sphere_r18.stl"


def layer(outer: Path, inner: Path, **options: object) -> ThicknessResult:
    """Thickness; reservations are those of the result."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        return gc.thickness(outer, inner, **{"unit": "mm", **options})


def test_two_balls_are_two_millimetres_apart(tmp_path: Path) -> None:
    found = layer(*BALLS, paraview=True)
    table = found.table()
    for column in ("along_normal [mm]", "nearest [mm]"):
        np.testing.assert_allclose(table[column], 2.0, atol=0.01)
    assert found.warnings == ()
    noted = found.record.results["thickness"]
    assert noted["covered"] == 1.0 and noted["along"]["mean_mm"] == pytest.approx(2.0, abs=0.01)
    assert noted["thickness_times_area_mm3"] == pytest.approx(2.0 * 4.0 * np.pi * 20.0**2, rel=0.01)
    pyvista = pytest.importorskip("pyvista")
    found.write(tmp_path / "out")
    written_table = pd.read_csv(tmp_path / "out" / "thickness.csv")
    surface = pyvista.read(tmp_path / "out" / "thickness.vtp")
    for field, column in (("along the normal", "along_normal [mm]"), ("nearest distance", "nearest [mm]")):
        seen = surface.cell_data[f"thickness {field} [mm]"][written_table["face"]]
        np.testing.assert_allclose(seen, written_table[column], rtol=1e-6)


def test_the_page_has_a_map_of_each_measure() -> None:
    found = layer(*BALLS, region="y>0")
    (page,) = found.pages({}).values()
    scene = page.sections[0]
    names = [each.name for each in scene.maps]
    assert names == ["thickness, along the normal", "thickness, nearest distance"]
    shown = np.asarray(scene.maps[0].values)
    counted = np.zeros(shown.shape[1], bool)
    counted[found.table()["face"]] = True
    assert (shown[0, counted] > 1.9).all() and (shown[0, ~counted] == 0.0).all() and not counted.all()
    assert dict(page.facts)["Area with a thickness"].startswith("100.0% of 2465 mm²")


def test_a_layer_that_is_not_parallel_is_doubted(tmp_path: Path) -> None:
    aside = layer(*BALLS, place_inner=str(shifted(tmp_path, (1.5, 0.0, 0.0))))
    assert aside.along.max() > 3.4e-3 and aside.nearest.min() < 0.6e-3
    slab = written(tmp_path / "slab.stl", stl_bytes(*block(60.0, 60.0, 10.0, 6), "slab"))
    apart = layer(
        slab, BALLS[1], place_inner=str(shifted(tmp_path, (0.0, -30.0, 0.0))), region="ny<-0.5", most=gc.mm(40)
    )
    assert any("1.25 times as thick along the normal" in line for line in apart.warnings)
    assert any("of the area of slab.stl meets sphere_r18.stl nowhere within 40 mm" in line for line in apart.warnings)


def test_surfaces_that_cross_touch_or_are_exchanged_are_doubted(tmp_path: Path) -> None:
    cross = layer(*BALLS, place_inner=str(shifted(tmp_path, (6.0, 0.0, 0.0))))
    assert any("lies inside sphere_r18.stl: the surfaces cross" in line for line in cross.warnings)
    with pytest.raises(InputError, match=r"sphere_r18\.stl: lies inside sphere_r20\.stl everywhere; exchange OUTER"):
        layer(BALLS[1], BALLS[0])
    same = layer(BALLS[0], BALLS[0])
    assert any("is it the whole boundary of the layer?" in line for line in same.warnings)


def patch(file: Path, radius: float, least: float, x: float = 0.0) -> Path:
    """An open cap of a ball whose centre is moved by x [mm]."""
    vertices, faces = sphere(radius, 40)
    return written(
        file, stl_bytes(np.add(vertices, (x, 0.0, 0.0)), faces[vertices[faces].mean(axis=1)[:, 1] > least], "cap")
    )


def test_open_surfaces_that_cross_are_doubted_as_such(tmp_path: Path) -> None:
    """A quarter has no thickness; a larger `most` would give it none, and it does not enter the mean."""
    outer, inner = patch(tmp_path / "outer.stl", 20.0, 12.0), patch(tmp_path / "inner.stl", 18.0, 2.0, 6.0)
    found = layer(outer, inner, paraview=True)
    (said,) = [line for line in found.warnings if "cross" in line]
    assert "of the area of outer.stl lies beyond inner.stl: the surfaces cross, there is no thickness" in said
    assert not any("nowhere within" in line for line in found.warnings)
    assert np.isnan(found.nearest).mean() > 0.1
    pyvista = pytest.importorskip("pyvista")
    found.write(tmp_path / "out")
    table, surface = pd.read_csv(tmp_path / "out" / "thickness.csv"), pyvista.read(tmp_path / "out" / "thickness.vtp")
    seen = surface.cell_data["thickness nearest distance [mm]"][table["face"]]
    np.testing.assert_array_equal(np.isnan(seen), np.isnan(table["nearest [mm]"]))


def test_an_open_patch_that_is_wound_inwards_is_used_with_a_warning(tmp_path: Path) -> None:
    vertices, faces = sphere(20.0, 20)
    upper = faces[vertices[faces].mean(axis=1)[:, 1] > 5.0][:, ::-1]
    patch = written(tmp_path / "patch.stl", stl_bytes(vertices, upper, "patch"))
    found = layer(patch, BALLS[1])
    (said,) = found.warnings
    assert said.endswith("its faces are wound inwards")
    np.testing.assert_allclose(1e3 * found.along, 2.0, atol=0.1)


def test_bodies_far_apart_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"is nowhere within 20 mm of sphere_r20\.stl; check unit and frames"):
        layer(*BALLS, place_inner=str(shifted(tmp_path, (100.0, 0.0, 0.0))))
    with pytest.raises(InputError, match="cannot be the largest thickness"):
        layer(*BALLS, most=4.0)


def test_the_inner_mesh_may_have_its_own_unit(tmp_path: Path) -> None:
    small = written(tmp_path / "cm.stl", stl_bytes(*sphere(1.8, 30), "ball"))
    found = layer(BALLS[0], small, unit_inner="cm")
    np.testing.assert_allclose(1e3 * found.nearest, 2.0, atol=0.05)
