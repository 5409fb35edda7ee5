"""Pressures on a real insert: what fluoroscopic poses give, and that area and pressure agree where bodies overlap."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchmarks.area import pressure
from benchmarks.pairs import PAIRS
from tests.cli.calls import Call, area, done

MAP = "rx=knee_flex_r,ry=knee_add_r,rz=knee_rot_r,tx=knee_ant_r,ty=knee_sup_r,tz=knee_lat_r"


@pytest.fixture(scope="module")
def dm(data_dir: Path, tmp_path_factory: pytest.TempPathFactory) -> Call:
    """Subject DM of the 6th Grand Challenge, both bodies closed."""
    folder = data_dir / "gc6_dm_knee"
    femur, insert = (folder / "stl" / f"{b} decimated.stl" for b in ("Femoral Component", "Tibial Insert"))
    motion = folder / "fluoroscopy" / "Fluoroscopic Gait Data.sto"
    options = (
        "--map",
        MAP,
        "--angles",
        "rad",
        "--region",
        "ny>0.25",
        "--split",
        "z",
        "--medial",
        "-",
        "--threshold",
        "0",
    )
    layer = ("--pressure", "--modulus", "500MPa", "--poisson", "0.46", "--facets", "flat")
    out = tmp_path_factory.mktemp("dm") / "out"
    return done(area(out, *options, *layer, moving=femur, fixed=insert, motion=motion, unit="m"))


@pytest.mark.slow
def test_what_is_pressed_is_what_overlaps(dm: Call) -> None:
    pressure, areas = dm.table("pressure.csv"), dm.table()
    for ours, theirs in (("", ""), ("_medial", "_medial"), ("_lateral", "_lateral")):
        pressed, overlapping = pressure[f"pressed_area{ours} [mm^2]"], areas[f"area_fixed{theirs} [mm^2]"]
        assert (pressed - overlapping).abs().max() < 0.02 * overlapping.max(), ours
    air = areas["min_distance [mm]"] > 0.0
    assert air.any() and (pressure["force [N]"][air] == 0.0).all()


def test_force_of_recorded_poses_is_absurd_and_stable(dm: Call) -> None:
    """1.3 mm of overlap is 159 kN: a hundred times what the knee bears; the pose decides, not the pieces."""
    result = dm.record()["results"]["pressure"]
    assert result["largest_force_N"] == pytest.approx(159e3, rel=0.02)
    assert result["largest_force_N"] == pytest.approx(result["with_pieces_of_half_the_size_N"], rel=0.01)
    assert result["largest_strain"] > 0.2 and any("--foundation logarithmic" in line for line in dm.warnings)


def test_sides_add_up_and_their_centres_are_apart(dm: Call) -> None:
    table = dm.table("pressure.csv")
    np.testing.assert_allclose(table["force_medial [N]"] + table["force_lateral [N]"], table["force [N]"], rtol=1e-9)
    both = (table["force_medial [N]"] > 0.0) & (table["force_lateral [N]"] > 0.0)
    gap = (table["cop_lateral_z [mm]"] - table["cop_medial_z [mm]"])[both]
    assert both.sum() > 40 and gap.between(25.0, 70.0).all()


def test_smooth_facets_give_the_force_of_a_refined_mesh(data_dir: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every face of both real bodies cut into four, new corners on the smooth surface, then taken flat."""
    monkeypatch.setenv("GEOCONTACT_DATA", str(data_dir))
    pair = PAIRS["dm"](0, 5)
    bodies = (pair.moving, pair.fixed)
    finer = [pressure.refined(body, 1) for body in bodies]
    assert all(body.closed and len(body.faces) == 4 * len(was.faces) for body, was in zip(finer, bodies, strict=True))
    pose = slice(1, 2)
    forces = {
        name: pressure.forces_of(*given, pair.rotation[pose], pair.translation[pose], smooth, (0.0,)).force[0, 0]
        for name, given, smooth in (("finer", finer, False), ("smooth", bodies, True), ("flat", bodies, False))
    }
    assert forces["finer"] > 1e3
    limit = forces["finer"] + (forces["finer"] - forces["flat"]) / 3.0  # flat triangles err with the square of the edge
    assert abs(forces["flat"] / limit - 1.0) > 0.005
    assert forces["smooth"] == pytest.approx(limit, rel=1e-3)
