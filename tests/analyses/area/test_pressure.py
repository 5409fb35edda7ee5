"""Pressures of an elastic layer: closed form, the area within zero, sides, thickness, two layers, and what is told."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Callable
from io import StringIO
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.area.pressure_page import facts, pressure_sections, sentence, shown_pressures
from geocontact.analyses.area.result import AreaResult
from geocontact.contact.elasticity import layer_modulus
from geocontact.view.page.content import Plan
from meshes.simple_shapes import block, sphere
from meshes.stl import stl_bytes
from tests.analyses.area.calls import area
from tests.analyses.area.calls import pressed as pressures
from tests.cli.calls import poses, unpictured, written
from tests.contact.sphere_on_layer import linear_force, logarithmic_force

LAYER = {"modulus": gc.MPa(500), "poisson": 0.46}
SECOND = {"modulus_moving": gc.MPa(500), "poisson_moving": 0.46}
R, H, M = 20e-3, 12e-3, layer_modulus(5e8, 0.46)
DEPTHS = (0.3, 0.1, -0.5)
"""mm; the last frame is in the air."""


def bodies(folder: Path, n: int = 30) -> tuple[Path, Path]:
    """Ball of 20 mm and floor 12 mm thick with its top at y = 0."""
    return (
        written(folder / "ball.stl", stl_bytes(*sphere(20.0, n), "ball")),
        written(folder / "floor.stl", stl_bytes(*block(80.0, 80.0, 12.0, 8), "floor")),
    )


def pressed(folder: Path, at: tuple[float, float] = (0.0, 0.0), n: int = 30, **options: object) -> AreaResult:
    """The ball at the depths, `at` x and z [mm]; areas are counted the quick way, as few tests look at them."""
    motion = poses(folder, *((at[0], 20.0 - depth, at[1]) for depth in DEPTHS))
    quick = {"rule": "clip", "threshold": 0.0, "piece": gc.mm(1)}
    return pressures(*bodies(folder, n), motion, **(quick | LAYER | options))


@pytest.mark.slow
@pytest.mark.parametrize(("law", "closed"), [("linear", linear_force), ("logarithmic", logarithmic_force)])
def test_ball_on_a_floor_is_the_closed_form(tmp_path: Path, law: str, closed: Callable[..., float]) -> None:
    result = pressed(tmp_path, foundation=law, n=50)
    table = result.table()
    expected = [closed(R, depth * 1e-3, H, M) for depth in DEPTHS[:2]]
    np.testing.assert_allclose(table["force [N]"][:2], expected, rtol=0.02)
    np.testing.assert_allclose(table["force_y [N]"], -table["force [N]"], atol=1e-6)
    np.testing.assert_allclose(table["peak [MPa]"][0], M * 0.3e-3 / H * 1e-6, rtol=0.02)
    assert table["force [N]"][2] == 0.0 and np.isnan(table["cop_x [mm]"][2])
    (apart,) = result.warnings
    assert apart.startswith("1 of 3 frames have nothing within 0 mm; the bodies are farthest apart, 0.5 mm, in frame 3")


@pytest.mark.slow
def test_what_is_pressed_is_the_area_within_zero(tmp_path: Path) -> None:
    result = pressed(tmp_path, threshold=gc.mm(0, 4), rule="refined", facets="flat", at=(3.3, -7.1))
    areas = result.table("area")
    overlapping = areas[areas["threshold [mm]"] == 0.0]
    table = result.table("pressure")
    np.testing.assert_allclose(table["pressed_area [mm^2]"], overlapping["area_fixed [mm^2]"], rtol=0.03)
    np.testing.assert_allclose(table[["cop_x [mm]", "cop_z [mm]"]][:2], [[3.3, -7.1]] * 2, atol=0.05)
    force, moment = (
        table[[f"{v}_{a} [{u}]" for a in "xyz"]].to_numpy() for v, u in (("force", "N"), ("moment", "N m"))
    )
    centre = table[[f"cop_{a} [mm]" for a in "xyz"]].to_numpy() * 1e-3
    np.testing.assert_allclose(moment[:2], np.cross(centre, force)[:2], atol=1e-6)


@pytest.mark.slow
def test_sides_add_up(tmp_path: Path) -> None:
    table = pressed(tmp_path, split="z", side="right", at=(0.0, -0.8)).table()
    medial, lateral = table["force_medial [N]"], table["force_lateral [N]"]
    np.testing.assert_allclose(medial + lateral, table["force [N]"], rtol=1e-9)
    assert (medial[:2] > lateral[:2]).all() and (lateral[:2] > 0.0).all()
    assert (table["cop_medial_z [mm]"][:2] < 0.0).all() and (table["cop_lateral_z [mm]"][:2] > 0.0).all()
    turned = pressed(tmp_path, split="z", medial="+", at=(0.0, -0.8)).table()
    np.testing.assert_allclose(turned["force_lateral [N]"], medial, rtol=1e-12)


@pytest.mark.slow
def test_rays_find_the_thickness_that_may_be_given(tmp_path: Path) -> None:
    rays, given = (pressed(tmp_path, thickness=thickness).table() for thickness in ("rays", gc.mm(12)))
    thick = pressed(tmp_path, thickness=gc.mm(24))
    assert rays["force [N]"][0] > 100.0
    np.testing.assert_allclose(given["force [N]"], rays["force [N]"], rtol=1e-9)
    np.testing.assert_allclose(thick.table()["force [N]"], 0.5 * rays["force [N]"], rtol=1e-9)
    assert thick.record.results["pressure"]["thickness_mm"] == [24.0, 24.0]


@pytest.mark.slow
def test_pieces_that_are_too_large_are_told(tmp_path: Path) -> None:
    coarse = pressed(tmp_path, piece=gc.mm(4))
    (said,) = [line for line in coarse.warnings if "pieces of half the size change the largest force by" in line]
    assert said.endswith("give a smaller `piece`")
    fine = pressed(tmp_path, piece=None).record.results["pressure"]
    assert fine["largest_force_N"] == pytest.approx(fine["with_pieces_of_half_the_size_N"], rel=0.01)


@pytest.mark.slow
def test_large_strain_and_no_contact_are_told(tmp_path: Path) -> None:
    assert any("strain of the layer is up to 30%" in line for line in pressed(tmp_path, thickness=gc.mm(1)).warnings)
    air = pressures(*bodies(tmp_path), poses(tmp_path, (0, 20.5, 0)), **LAYER)
    assert any("the bodies never overlap" in line for line in air.warnings)


@pytest.mark.slow
def test_facets_of_a_coarse_ball_stand_for_the_ball(tmp_path: Path) -> None:
    smooth, flat = (pressed(tmp_path, facets=facets, n=16).table()["force [N]"] for facets in ("smooth", "flat"))
    expected = np.array([linear_force(R, depth * 1e-3, H, M) for depth in DEPTHS[:2]])
    np.testing.assert_allclose(smooth[:2], expected, rtol=0.01)
    assert (flat[:2] < 0.95 * expected).all()


@pytest.mark.slow
@pytest.mark.parametrize("law", ["linear", "logarithmic"])
def test_two_layers_share_the_depth(tmp_path: Path, law: str) -> None:
    """Two of one kind, each half as far in: half the depth of one, so half the force where the law is linear."""
    found = []
    for options in ({**SECOND, "thickness_moving": gc.mm(12)}, {"thickness": gc.mm(24)}):
        result = pressed(tmp_path, foundation=law, **options)
        page = result.page(tmp_path / "page.html").read_text(encoding="utf-8")
        found.append((result.table()["force [N]"], result.record.results["pressure"], page))
    (force, told, page), (once, alone, other) = found
    np.testing.assert_allclose(force, once, rtol=1e-9)
    assert told["largest_strain"] == pytest.approx(alone["largest_strain"], rel=1e-6)
    assert told["layer_modulus_moving_Pa"] == pytest.approx(M) and alone["layer_modulus_moving_Pa"] is None
    assert "another one of 2312\u00a0MPa" in page and "MOVING is rigid" in other


@pytest.mark.slow
def test_rays_through_the_ball_find_its_thickness_too(tmp_path: Path) -> None:
    one, two = (pressed(tmp_path, **options).table()["force [N]"] for options in ({}, SECOND))
    np.testing.assert_allclose(two[:2] / one[:2], 12.0 / (12.0 + 40.0), rtol=0.01)


@pytest.mark.slow
def test_region_limits_what_is_pressed(tmp_path: Path) -> None:
    half, whole = pressed(tmp_path, region="x>0").table(), pressed(tmp_path).table()
    np.testing.assert_allclose(half["force [N]"], 0.5 * whole["force [N]"], rtol=0.02)


@pytest.mark.slow
def test_pressures_for_paraview(tmp_path: Path) -> None:
    pyvista = pytest.importorskip("pyvista")
    result = pressed(tmp_path, paraview=True)
    with unpictured():
        folder = result.write(tmp_path / "out")
    force = result.table()["force [N]"]
    for k in range(3):
        mesh = pyvista.read(folder / f"paraview/frames/fixed_{k:03d}.vtp")
        sizes = mesh.compute_cell_sizes(length=False, volume=False)["Area"]
        assert float(mesh.cell_data["pressure [MPa]"] @ sizes) == pytest.approx(force[k], rel=1e-5)
        assert "pressure [MPa]" not in pyvista.read(folder / f"paraview/frames/moving_{k:03d}.vtp").cell_data


@pytest.mark.slow
def test_the_number_of_threads_does_not_matter(tmp_path: Path) -> None:
    one, three = (pressed(tmp_path, workers=workers).table() for workers in (1, 3))
    pd.testing.assert_frame_equal(one, three, check_exact=True)


@pytest.mark.slow
def test_pressure_is_the_area_analysis_with_its_pressures_asked_for(tmp_path: Path) -> None:
    """One implementation: the same tables, of which the other one comes first."""
    motion = poses(tmp_path, (0, 19.8, 0), (0, 19.9, 0))
    given = {**LAYER, "rule": "clip", "piece": gc.mm(1)}
    areas = area(*bodies(tmp_path), motion, pressure=True, **given)
    result = pressures(*bodies(tmp_path), motion, **given)
    assert (list(areas.tables()), list(result.tables())) == (["area", "pressure"], ["pressure", "area"])
    for name, table in areas.tables().items():
        pd.testing.assert_frame_equal(result.table(name), table, check_exact=True)
    assert areas.sentences == result.sentences and len(result.sentences) == 3
    assert areas.figure().axes[0].get_legend().get_title().get_text() == "Contact area"
    assert result.figure().axes[0].get_legend().get_title().get_text() == "Contact force"


@pytest.mark.parametrize("missing", ["modulus", "poisson"])
def test_pressure_needs_its_material(tmp_path: Path, missing: str) -> None:
    known = {name: value for name, value in LAYER.items() if name != missing}
    with pytest.raises(TypeError, match=missing):
        pressures(*bodies(tmp_path), poses(tmp_path, (0, 20, 0)), **known)
    assert "pressure" not in gc.pressure.__signature__.parameters


def test_the_page_shows_the_path_of_the_centre_of_pressure(tmp_path: Path) -> None:
    """One row of numbers, and the path on the outline of the floor as seen along the load."""
    result = pressed(tmp_path, at=(3.0, -2.0), split="z", side="right", n=16)
    shown = shown_pressures(result.motions[0].pressure, result.bodies.fixed)
    course = result.motions[0].motion.course
    plan = next(each for each in pressure_sections(shown, np.arange(3)) if isinstance(each, Plan))
    assert (plan.across, plan.up, plan.unit) == ("z", "x", "mm")
    total = next(track for track in plan.tracks if track.name == "total")
    np.testing.assert_allclose(total.points[:2], [[-2.0, 3.0]] * 2, atol=0.1)
    assert np.isnan(total.points[2]).all(), "in the air nothing presses"
    corners = np.concatenate(plan.lines)
    assert np.ptp(corners, axis=0) == pytest.approx([80.0, 80.0])
    assert sentence(shown, course, "ball", "floor").startswith("ball presses on floor with up to ")
    assert len(facts(shown, course)) == 3


def test_forces_are_external_loads_of_both_bodies(tmp_path: Path) -> None:
    """What OpenSim is given is what the table has, and its opposite on the other body."""
    result = pressed(tmp_path, bodies=("femur", "tibia"))
    result.write(tmp_path / "out")
    table, loads = result.table(), ET.parse(tmp_path / "out" / "contact_loads.xml")
    assert [one.findtext("applied_to_body") for one in loads.iter("ExternalForce")] == ["tibia", "femur"]
    _, _, rows = (tmp_path / "out" / "contact_loads.mot").read_text(encoding="utf-8").partition("endheader\n")
    given = pd.read_csv(StringIO(rows), sep="\t")
    for name, sign in (("contact_total", 1.0), ("contact_back_total", -1.0)):
        np.testing.assert_allclose(given[f"{name}_force_vy"], sign * table["force_y [N]"], rtol=1e-6, atol=1e-9)
