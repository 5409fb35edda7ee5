"""`geocontact area --pressure`: closed form, the area within zero, sides, maps, and what it refuses."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from geocontact.analyses.stale_results import NAMES
from geocontact.contact.elasticity import layer_modulus
from meshes.simple_shapes import block, sphere
from meshes.stl import stl_bytes
from tests.cli.calls import Call, area, done, inventory, poses, written
from tests.cli.spoilt import Given, refuse
from tests.contact.sphere_on_layer import linear_force, logarithmic_force
from tests.contract import FILES

MATERIAL = ("--pressure", "--modulus", "500MPa", "--poisson", "0.46")
PRESSURE = {"pressure.csv", "pressure.png", "pressure.svg"}
R, H, M = 20e-3, 12e-3, layer_modulus(5e8, 0.46)
FLAT = ("--facets", "flat")
DEPTHS = (0.3, 0.1, -0.5)
"""mm; the last frame is in the air."""


def bodies(folder: Path, n: int = 30) -> dict[str, Path]:
    """Ball of 20 mm and floor 12 mm thick with its top at y = 0."""
    return {
        "moving": written(folder / "ball.stl", stl_bytes(*sphere(20.0, n), "ball")),
        "fixed": written(folder / "floor.stl", stl_bytes(*block(80.0, 80.0, 12.0, 8), "floor")),
    }


def pressed(
    folder: Path, *options: object, at: tuple[float, float] = (0.0, 0.0), n: int = 30, picture: bool = False
) -> Call:
    motion = poses(folder, *((at[0], 20.0 - depth, at[1]) for depth in DEPTHS))
    arguments = (folder / "out", *MATERIAL, *options)
    return area(*arguments, motion=motion, picture=picture, **bodies(folder, n))


@pytest.mark.parametrize(("law", "closed"), [("linear", linear_force), ("logarithmic", logarithmic_force)])
def test_ball_on_a_floor_is_the_closed_form(tmp_path: Path, law: str, closed: Callable[..., float]) -> None:
    result = done(pressed(tmp_path, "--foundation", law, n=100))
    table = result.table("pressure.csv")
    expected = [closed(R, depth * 1e-3, H, M) for depth in DEPTHS[:2]]
    np.testing.assert_allclose(table["force [N]"][:2], expected, rtol=0.02)
    np.testing.assert_allclose(table["force_y [N]"], -table["force [N]"], atol=1e-6)
    np.testing.assert_allclose(table["peak [MPa]"][0], M * 0.3e-3 / H * 1e-6, rtol=0.02)
    assert table["force [N]"][2] == 0.0 and np.isnan(table["cop_x [mm]"][2])
    assert result.warnings == []


def test_what_is_pressed_is_the_area_within_zero(tmp_path: Path) -> None:
    result = done(pressed(tmp_path, "--threshold", "0,4", "--facets", "flat", at=(3.3, -7.1)))
    areas = result.table()
    overlapping = areas[areas["threshold [mm]"] == 0.0]
    table = result.table("pressure.csv")
    np.testing.assert_allclose(table["pressed_area [mm^2]"], overlapping["area_fixed [mm^2]"], rtol=0.03)
    np.testing.assert_allclose(table[["cop_x [mm]", "cop_z [mm]"]][:2], [[3.3, -7.1]] * 2, atol=0.05)
    force, moment = (
        table[[f"{v}_{a} [{u}]" for a in "xyz"]].to_numpy() for v, u in (("force", "N"), ("moment", "N m"))
    )
    centre = table[[f"cop_{a} [mm]" for a in "xyz"]].to_numpy() * 1e-3
    np.testing.assert_allclose(moment[:2], np.cross(centre, force)[:2], atol=1e-6)


def test_sides_add_up(tmp_path: Path) -> None:
    table = done(pressed(tmp_path, "--split", "z", at=(0.0, -0.8))).table("pressure.csv")
    medial, lateral = table["force_medial [N]"], table["force_lateral [N]"]
    np.testing.assert_allclose(medial + lateral, table["force [N]"], rtol=1e-9)
    assert (medial[:2] > lateral[:2]).all() and (lateral[:2] > 0.0).all()
    assert (table["cop_medial_z [mm]"][:2] < 0.0).all() and (table["cop_lateral_z [mm]"][:2] > 0.0).all()
    turned = done(pressed(tmp_path, "--split", "z", "--medial", "+", at=(0.0, -0.8))).table("pressure.csv")
    np.testing.assert_allclose(turned["force_lateral [N]"], medial, rtol=1e-12)


def test_rays_find_the_thickness_that_may_be_given(tmp_path: Path) -> None:
    rays, given = (done(pressed(tmp_path, *o)).table("pressure.csv") for o in ((), ("--thickness", "12mm")))
    thick = done(pressed(tmp_path, "--thickness", "24"))
    assert rays["force [N]"][0] > 100.0
    np.testing.assert_allclose(given["force [N]"], rays["force [N]"], rtol=1e-9)
    np.testing.assert_allclose(thick.table("pressure.csv")["force [N]"], 0.5 * rays["force [N]"], rtol=1e-9)
    assert thick.record()["results"]["pressure"]["thickness_mm"] == [24.0, 24.0]


def test_pieces_that_are_too_large_are_told(tmp_path: Path) -> None:
    coarse = done(pressed(tmp_path, "--piece", "4mm"))
    assert any("pieces of half the size change the largest force by" in line for line in coarse.warnings)
    fine = done(pressed(tmp_path)).record()["results"]["pressure"]
    assert fine["largest_force_N"] == pytest.approx(fine["with_pieces_of_half_the_size_N"], rel=0.01)


def test_large_strain_and_no_contact_are_told(tmp_path: Path) -> None:
    assert any("strained by up to 30%" in line for line in done(pressed(tmp_path, "--thickness", "1mm")).warnings)
    motion = poses(tmp_path, (0, 20.5, 0))
    air = done(area(tmp_path / "out", *MATERIAL, motion=motion, **bodies(tmp_path)))
    assert any("the bodies never overlap" in line for line in air.warnings)


def test_facets_of_a_coarse_ball_stand_for_the_ball(tmp_path: Path) -> None:
    smooth, flat = (done(pressed(tmp_path, *o, n=16)).table("pressure.csv")["force [N]"] for o in ((), FLAT))
    expected = np.array([linear_force(R, depth * 1e-3, H, M) for depth in DEPTHS[:2]])
    np.testing.assert_allclose(smooth[:2], expected, rtol=0.01)
    assert (flat[:2] < 0.95 * expected).all()


@pytest.mark.parametrize("law", ["linear", "logarithmic"])
def test_two_layers_share_the_depth(tmp_path: Path, law: str) -> None:
    """Two of one kind, each half as far in: half the depth of one, so half the force where the law is linear."""
    second = ("--modulus-moving", "500MPa", "--poisson-moving", "0.46", "--thickness-moving", "12mm")
    found = []
    for options in (second, ("--thickness", "24mm")):
        result = done(pressed(tmp_path, "--foundation", law, *options, picture=True))
        page = result.bytes("report.html").decode()
        found.append((result.table("pressure.csv")["force [N]"], result.record()["results"]["pressure"], page))
    (force, told, page), (once, alone, other) = found
    np.testing.assert_allclose(force, once, rtol=1e-9)
    assert told["largest_strain"] == pytest.approx(alone["largest_strain"], rel=1e-6)
    assert told["layer_modulus_moving_Pa"] == pytest.approx(M) and alone["layer_modulus_moving_Pa"] is None
    assert "another one of 2312 MPa" in page and "MOVING is rigid" in other


def test_rays_through_the_ball_find_its_thickness_too(tmp_path: Path) -> None:
    second = ("--modulus-moving", "500MPa", "--poisson-moving", "0.46")
    one, two = (done(pressed(tmp_path, *o)).table("pressure.csv")["force [N]"] for o in ((), second))
    np.testing.assert_allclose(two[:2] / one[:2], 12.0 / (12.0 + 40.0), rtol=0.01)


def test_region_limits_what_is_pressed(tmp_path: Path) -> None:
    half = done(pressed(tmp_path, "--region", "x>0")).table("pressure.csv")
    whole = done(pressed(tmp_path)).table("pressure.csv")
    np.testing.assert_allclose(half["force [N]"], 0.5 * whole["force [N]"], rtol=0.02)


def test_files_page_and_maps(tmp_path: Path) -> None:
    result = done(pressed(tmp_path, "--save-map", "--parquet", "--split", "z", picture=True))
    more = {"area.parquet", "distances.npz", "pressure.parquet", "pressure.npz"}
    assert set(inventory(result.folder)) == FILES | PRESSURE | more <= NAMES
    page = result.bytes("report.html").decode()
    assert "Contact force, elastic foundation" in page and "Largest contact pressure" in page
    with np.load(result.folder / "pressure.npz", allow_pickle=False) as maps:
        corners = maps["vertices"][maps["faces"]]
        each = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        np.testing.assert_allclose(maps["pressure"] @ each, result.table("pressure.csv")["force [N]"], rtol=1e-9)
        assert maps["frames"].tolist() == [0, 1, 2]
    again = done(area(result.folder, motion=poses(tmp_path, (0, 20, 0)), picture=True, **bodies(tmp_path)))
    assert set(inventory(again.folder)) == FILES


@pytest.mark.slow
def test_pressures_for_paraview(tmp_path: Path) -> None:
    pyvista = pytest.importorskip("pyvista")
    result = done(pressed(tmp_path, "--paraview"))
    force = result.table("pressure.csv")["force [N]"]
    for k in range(3):
        mesh = pyvista.read(result.folder / f"paraview/frames/fixed_{k:03d}.vtp")
        sizes = mesh.compute_cell_sizes(length=False, volume=False)["Area"]
        assert float(mesh.cell_data["pressure [MPa]"] @ sizes) == pytest.approx(force[k], rel=1e-5)
        assert "pressure [MPa]" not in pyvista.read(result.folder / f"paraview/frames/moving_{k:03d}.vtp").cell_data


def test_the_number_of_threads_does_not_matter(tmp_path: Path) -> None:
    one = done(pressed(tmp_path, "--workers", "1")).bytes("pressure.csv")
    assert done(pressed(tmp_path, "--workers", "3")).bytes("pressure.csv") == one


SECOND = "--modulus-moving"
LAYER: Given = {"--pressure": "true", "--modulus": "500MPa", "--poisson": "0.46"}
OPEN = stl_bytes(sphere(20.0, 4)[0], sphere(20.0, 4)[1][1:], "ball")
LID = stl_bytes(block(80.0, 80.0, 12.0, 8)[0], block(80.0, 80.0, 12.0, 8)[1][4:], "floor")


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"--modulus": "500MPa"}, ("--modulus", "does nothing without --pressure")),
        ({"--facets": "flat"}, ("--facets", "does nothing without --pressure")),
        ({SECOND: "500MPa"}, (SECOND, "does nothing without --pressure")),
        ({**LAYER, "--thickness-moving": "3mm"}, ("--thickness-moving", f"does nothing without {SECOND}")),
        ({**LAYER, SECOND: "500MPa"}, ("--poisson-moving", f"is missing beside {SECOND}")),
        (
            {**LAYER, SECOND: "500MPa", "--poisson-moving": "0.5"},
            ("--poisson-moving", "0.5 is not from 0 to below 0.5"),
        ),
        ({"--piece": "1mm"}, ("--piece", "does nothing without --pressure")),
        ({**LAYER, "--modulus": None}, ("--modulus", "is missing beside --pressure")),
        ({**LAYER, "--poisson": None}, ("--poisson", "is missing beside --pressure")),
        ({**LAYER, "--poisson": "0.5"}, ("--poisson", "0.5 is not from 0 to below 0.5")),
        ({**LAYER, "--poisson": "nan"}, ("--poisson", "nan is not from 0")),
        ({**LAYER, "--modulus": "500"}, ("--modulus", "'500' is not a pressure", "500MPa")),
        ({**LAYER, "--modulus": "500N"}, ("--modulus", "'500N' is not a pressure")),
        ({**LAYER, "--modulus": "-5MPa"}, ("--modulus", "is not positive")),
        ({**LAYER, "--thickness": "0mm"}, ("--thickness", "is not a positive length")),
        ({**LAYER, "--thickness": "thick"}, ("--thickness", "'thick'")),
        ({**LAYER, "--piece": "0"}, ("--piece", "is not a positive length")),
        ({**LAYER, "--piece": "1um"}, ("--piece", "pieces, more than", "give a longer edge")),
        ({**LAYER, "--foundation": "stiff"}, ("--foundation", "stiff")),
        ({**LAYER, "MOVING": lambda f: written(f / "ball.stl", OPEN)}, ("ball", "is open", "no depth")),
        ({**LAYER, "FIXED": lambda f: written(f / "floor.stl", LID)}, ("floor", "is open", "give a length")),
    ],
)
def test_refused(tmp_path: Path, changes: Given, said: tuple[str, ...]) -> None:
    refuse(tmp_path, changes, *said)
