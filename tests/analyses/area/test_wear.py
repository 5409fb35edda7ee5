"""Wear by the pressures of a motion: a ball on a plate in closed form, units, what is doubted and refused; coverage."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.area.result import AreaResult
from geocontact.analyses.frame.quantities import wear_factor
from geocontact.contact.elasticity import layer_modulus
from geocontact.data.errors import InputError
from meshes.simple_shapes import block, sphere
from meshes.stl import stl_bytes
from tests.analyses.area.calls import area, page_of
from tests.analyses.area.calls import pressed as pressures
from tests.cli.calls import corners, poses, written

R, H, M, DEPTH = 20e-3, 12e-3, layer_modulus(5e8, 0.46), 0.3e-3
K, MILLION = 1e-7, 1e6
"""mm^3/(N m), and cycles."""
LAYER = {"modulus": gc.MPa(500), "poisson": 0.46, "thickness": gc.mm(12), "rule": "clip", "piece": gc.mm(0.5)}


@pytest.fixture(scope="module")
def bodies(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """Ball of 20 mm, and a plate 12 mm thick with its top at y = 0."""
    folder = tmp_path_factory.mktemp("bodies")
    plate = stl_bytes(*block(60.0, 30.0, 12.0, 30), "plate")
    return written(folder / "ball.stl", stl_bytes(*sphere(20.0, 30), "ball")), written(folder / "plate.stl", plate)


def slid(
    bodies: tuple[Path, Path], folder: Path, *, reach: float = 4.0, frames: int = 17, **options: object
) -> AreaResult:
    """The ball pressed in by 0.3 mm slides to +-`reach` mm along x and back."""
    along = reach * np.sin(np.linspace(0.0, 2.0 * np.pi, frames))
    motion = poses(folder, *((x, 20.0 - 1e3 * DEPTH, 0.0) for x in along))
    given = LAYER | ({} if "cross_shear" in options else {"wear_factor": f"{K} mm^3/(N m)"}) | options
    return pressures(*bodies, motion, **given)


@pytest.fixture(scope="module")
def worn(bodies: tuple[Path, Path], tmp_path_factory: pytest.TempPathFactory) -> AreaResult:
    """There and back with the options above."""
    return slid(bodies, tmp_path_factory.mktemp("worn"))


def profile(z: np.ndarray) -> np.ndarray:
    """Integral of the pressure of the ball along x at a distance z from its track [N/m], by a sum of many strips.

    The depth of a place is its own to the ball, not that along the vertical.
    """
    x = np.linspace(-4e-3, 4e-3, 4001)
    depth = R - np.sqrt(x**2 + z[:, None] ** 2 + (R - DEPTH) ** 2)
    return M / H * np.maximum(depth, 0.0).sum(axis=1) * (x[1] - x[0])


def test_a_ball_that_slides_wears_factor_times_force_times_path(worn: AreaResult) -> None:
    z = np.linspace(-4e-3, 4e-3, 801)
    force = profile(z).sum() * (z[1] - z[0])
    path = 4 * 4.0e-3  # m; there, back, to the other end and back again
    expected = K * force * path * MILLION  # mm^3
    table = worn.table("wear")
    assert table["volume [mm^3]"].sum() == pytest.approx(expected, rel=2e-3)
    noted = worn.record.results["wear"]
    assert noted["volume_mm3"] == pytest.approx(table["volume [mm^3]"].sum(), rel=1e-9)
    assert noted["force_times_path_J_per_cycle"] == pytest.approx(force * path, rel=2e-3)
    assert noted["cross_shear_ratio"] == pytest.approx(0.0, abs=1e-9)
    np.testing.assert_allclose(table["wear_factor [mm^3/(N m)]"], K, rtol=1e-9)
    np.testing.assert_allclose(table["volume [mm^3]"], table["depth [mm]"] * table["area [mm^2]"], rtol=1e-9)


def test_the_track_is_as_deep_as_the_pressures_that_pass(bodies: tuple[Path, Path], tmp_path: Path) -> None:
    """From 12 mm to -12 mm: the whole ball passes over the middle, whose depth is k times its integral of pressure."""
    along = np.linspace(-12.0, 12.0, 97)
    motion = poses(tmp_path, *((x, 20.0 - 1e3 * DEPTH, 0.0) for x in along))
    found = pressures(*bodies, motion, **LAYER, wear_factor=1e-16, wear_cycles=2e5)
    table = found.table("wear")
    middle = table[np.abs(table["x [mm]"]) < 3.0]
    edges = np.array([-5.0, -3.0, -1.0, 1.0, 3.0, 5.0]) * 1e-3  # of the faces, across the track
    for low, high in pairwise(edges):
        rows = middle[(middle["z [mm]"] > 1e3 * low) & (middle["z [mm]"] < 1e3 * high)]
        expected = 2e5 * 1e-16 * profile(np.linspace(low, high, 101)).mean() * 1e3
        mean = rows["volume [mm^3]"].sum() / rows["area [mm^2]"].sum() if len(rows) else 0.0
        assert mean == pytest.approx(expected, rel=0.03, abs=2e-5)
    assert any("the motion does not end where it begins: the way back" in line for line in found.warnings)


@pytest.mark.parametrize("text", ["1e-7mm^3/(N m)", "1e-7 mm3/Nm", "1e-16 m^2/N", "1e-10 mm^2/N"])
def test_units_of_a_wear_factor(text: str) -> None:
    """1 mm^3/(N m) is 1e-9 m^3/(N m) = 1e-9 m^2/N."""
    assert wear_factor(text, "`wear_factor`") == pytest.approx(1e-16, rel=1e-12)


@pytest.mark.parametrize("text", ["1e-7", "1e-7 mm^3", "much", "1e-7 mm^3/N", "-1e-7 m/N"])
def test_a_wear_factor_without_its_unit_is_refused(text: str) -> None:
    with pytest.raises(InputError, match=r"is not a wear factor; write 1e-7mm\^3/\(N m\)"):
        wear_factor(text, "`wear_factor`")


def test_cross_shear_of_a_square_has_the_factor_of_one_half(bodies: tuple[Path, Path], tmp_path: Path) -> None:
    """Along a square whose sides are short beside the patch both directions have as much work where all is pressed."""
    side = np.linspace(0.0, 1.0, 5)[:-1]
    path = [
        *((x, 0.0) for x in side),
        *((1.0, z) for z in side),
        *((1 - x, 1.0) for x in side),
        *((0, 1 - z) for z in side),
    ]
    motion = poses(tmp_path, *((x, 20.0 - 1e3 * DEPTH, z) for x, z in [*path, (0.0, 0.0)]))
    text = "cross_shear [-], wear_factor [mm^3/(N m)]\n0, 1e-8\n0.5, 4e-7\n"
    found = pressures(*bodies, motion, **LAYER, cross_shear=written(tmp_path / "k.csv", text))
    table = found.table("wear")
    inner = table[np.hypot(table["x [mm]"] - 0.5, table["z [mm]"] - 0.5) < 1.5]
    assert (inner["cross_shear [-]"] > 0.45).all()
    np.testing.assert_allclose(
        table["wear_factor [mm^3/(N m)]"], 1e-8 + (4e-7 - 1e-8) / 0.5 * table["cross_shear [-]"], rtol=1e-6
    )
    assert found.record.results["wear"]["cross_shear_ratio"] == pytest.approx(0.47, abs=0.03)


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("ratio [-], wear_factor [mm^3/(N m)]\n0, 1e-7\n0.5, 2e-7\n", "no column cross_shear"),
        ("cross_shear [-], wear_factor [mm^3]\n0, 1e-7\n0.5, 2e-7\n", "no column wear_factor"),
        ("cross_shear [-], wear_factor [mm^3/(N m)]\n0, 1e-7\n", "one row is one factor"),
        ("cross_shear [-], wear_factor [m^2/N]\n0, 1e-16\n0.5, 1e-7\n", r"row 2: 100 mm.* cannot be"),
        ("cross_shear [-], wear_factor [mm^3/(N m)]\n0.4, 1e-7\n0.1, 2e-7\n", "must increase"),
        ("cross_shear [-], wear_factor [mm^3/(N m)]\n0, 1e-7\n0.9, 2e-7\n", "0.5 at most"),
    ],
)
def test_tables_that_are_none_of_factors_are_refused(
    bodies: tuple[Path, Path], tmp_path: Path, text: str, what: str
) -> None:
    with pytest.raises(InputError, match=what):
        slid(bodies, tmp_path, cross_shear=written(tmp_path / "k.csv", text))


@pytest.mark.parametrize(
    ("options", "what"),
    [
        ({"cross_shear": "k.csv", "wear_factor": 1e-16}, "gives the factor twice"),
        ({"wear_factor": None, "wear_cycles": 1e6}, "no effect without `wear_factor`"),
        ({"wear_factor": 1e-7}, "cannot be a wear factor"),
        ({"wear_cycles": 0.0}, "cannot be how often"),
    ],
)
def test_options_that_contradict_are_refused(
    bodies: tuple[Path, Path], tmp_path: Path, options: dict[str, object], what: str
) -> None:
    if "cross_shear" in options:
        options = options | {"cross_shear": written(tmp_path / "k.csv", "cross_shear [-]\n0\n")}
    with pytest.raises(InputError, match=what):
        slid(bodies, tmp_path, **options)


def test_wear_needs_pressures(bodies: tuple[Path, Path], tmp_path: Path) -> None:
    with pytest.raises(InputError, match="`pressure`"):
        area(*bodies, poses(tmp_path, (0, 20, 0)), wear_factor=1e-16)


def test_factors_of_a_table_are_doubted_as_one_factor_is(bodies: tuple[Path, Path], tmp_path: Path) -> None:
    table = written(tmp_path / "k.csv", "cross_shear [-], wear_factor [mm^3/(N m)]\n0, 1e-7\n0.5, 1e-3\n")
    found = slid(bodies, tmp_path, cross_shear=table, frames=5)
    assert any("k.csv: 0.001 mm^3/(N m) is unusual for a wear factor" in line for line in found.warnings)


@pytest.mark.parametrize(
    ("strikes", "what"),
    [
        ((0.0, 2.0, 4.0), "poses holds 2 cycles, and wear repeats all of its frames as one"),
        ((0.0, 3.0), "the cycle of poses is 0 to 3 s, and wear repeats all of its frames, 0 to 4 s"),
    ],
)
def test_wear_of_a_file_that_is_not_one_cycle_by_its_events_is_refused(
    bodies: tuple[Path, Path], tmp_path: Path, strikes: tuple[float, ...], what: str
) -> None:
    with pytest.raises(InputError, match=what):
        slid(bodies, tmp_path, frames=5, events=struck(tmp_path, *strikes))


def test_wear_of_one_cycle_may_have_its_events(bodies: tuple[Path, Path], tmp_path: Path) -> None:
    found = slid(bodies, tmp_path, frames=5, events=struck(tmp_path, 0.0, 4.0))
    assert found.record.results["cycles"] == {"poses": 1}
    assert found.record.results["wear"]["volume_mm3"] > 0.0


def struck(folder: Path, *times: float) -> Path:
    """Events of the right foot at these times [s]."""
    rows = "".join(f"poses, foot strike, right, {time}\n" for time in times)
    return written(folder / "events.csv", f"recording, event, side, time [s]\n{rows}")


def test_what_a_worn_surface_would_change_is_doubted(
    bodies: tuple[Path, Path], tmp_path: Path, worn: AreaResult
) -> None:
    assert worn.warnings == ()
    deep = slid(bodies, tmp_path, wear_cycles=8e6)
    (said,) = deep.warnings
    assert "the surface is not updated" in said and "more than the layer is pressed in" in said
    ratio = deep.record.results["wear"]["deepest_mm"] / worn.record.results["wear"]["deepest_mm"]
    assert ratio == pytest.approx(8.0, rel=1e-9)
    table = written(tmp_path / "k.csv", "cross_shear [-], wear_factor [mm^3/(N m)]\n0.1, 1e-7\n0.5, 2e-7\n")
    (beyond,) = slid(bodies, tmp_path, cross_shear=table).warnings
    assert beyond.startswith("100% of the work is at cross-shear ratios beyond the table's 0.1 to 0.5")
    (few,) = slid(bodies, tmp_path, reach=25.0, frames=9).warnings
    assert few.startswith("every second frame alone changes the depths of wear by") and "give more of them" in few
    rest = pressures(*bodies, poses(tmp_path, (0, 19.7, 0), (0, 19.7, 0)), **LAYER, wear_factor=1e-16)
    assert any("nothing slides under pressure" in line for line in rest.warnings)
    assert len(rest.table("wear")) == 0
    assert rest.record.results["wear"]["deepest_at_mm"] is None
    assert "Deepest wear" not in dict(page_of(rest).facts)


def test_the_page_shows_wear_as_a_second_map(worn: AreaResult) -> None:
    page = page_of(worn)
    facts = dict(page.facts)
    volume = worn.record.results["wear"]["volume_mm3"]
    assert facts["Volume worn after 1e+06 cycles"] == f"{volume:.4g} mm³"
    (scene,) = [section for section in page.sections if hasattr(section, "maps")]
    pressure, wear = scene.maps
    assert (wear.name, wear.unit, wear.body) == ("wear after 1e+06 cycles", "mm", 0)
    shown = np.asarray(wear.values)
    assert shown.shape == np.shape(pressure.values)
    table = worn.table("wear")
    np.testing.assert_allclose(shown[0, table["face"]], table["depth [mm]"], rtol=1e-12)
    assert (shown > 0.0).sum() == len(table) * len(shown)


def test_wear_is_written_for_paraview(bodies: tuple[Path, Path], tmp_path: Path) -> None:
    pyvista = pytest.importorskip("pyvista")
    found = slid(bodies, tmp_path, frames=5, paraview=True)
    found.write(tmp_path / "out")
    written_table = pd.read_csv(tmp_path / "out" / "wear.csv")
    surface = pyvista.read(tmp_path / "out" / "paraview" / "frames" / "fixed_000.vtp")
    np.testing.assert_allclose(
        surface.cell_data["wear [mm]"][written_table["face"]], written_table["depth [mm]"], rtol=1e-5
    )


def test_coverage_is_the_area_over_that_of_the_region(bodies: tuple[Path, Path], tmp_path: Path) -> None:
    """A ball 1 mm above a plate covers within 2 mm the disk of sqrt((R + T)^2 - (R + g)^2)."""
    motion = poses(tmp_path, (0, 21, 0), (0, 30, 0))
    top = area(*bodies, motion, threshold=gc.mm(2, 1.5), region="ny > 0.5 and abs(x) < 15", region_moving="y < 0")
    table = top.table()
    disk = np.pi * np.array([22.0**2 - 21.0**2, 21.5**2 - 21.0**2])
    np.testing.assert_allclose(table["coverage_fixed [-]"][:2], disk / (30.0 * 30.0), rtol=0.01)
    assert (table["coverage_fixed [-]"][2:] == 0.0).all()
    ball = corners(bodies[0])[corners(bodies[0])[:, :, 1].mean(axis=1) < 0.0]
    half = 0.5 * np.linalg.norm(np.cross(ball[:, 1] - ball[:, 0], ball[:, 2] - ball[:, 0]), axis=1).sum()
    np.testing.assert_allclose(table["coverage_moving [-]"], table["area_moving [mm^2]"] / half, rtol=1e-6)
    noted = top.record.results["motion"]
    assert noted["coverage_fixed_at_2_mm"] == pytest.approx([0.0, disk[0] / 900.0], rel=0.01)
    assert any("of the 900.0 mm^2 of `region`" in line for line in top.sentences)
    facts = dict(page_of(top).facts)
    assert facts["Largest coverage of the fixed body's region"].startswith("14.9% of 900 mm² at 0 s")
    assert not [name for name in area(*bodies, motion).table().columns if "coverage" in name]
