"""`geocontact cop`: tables, units, laws, grounds and force plates, as users and outside checks meet them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

from tests.cli.calls import PLATE, Call, call, done, poses, written

COLUMNS = ["time [s]", *(f"force_{a} [N]" for a in "xyz"), *(f"cop_{a} [m]" for a in "xyz"), "free_moment [N m]"]
"""The contract; more may follow."""

FILES = {"cop.csv", "cop.png", "cop.svg", "report.html", "run.json", "zones.csv"}
HEAD = "px [m], py [m], pz [m], radius [m], zone"
RADIUS = 0.02
STATIC = ("--damping", "0", "--friction", "0,0")
LAW = ("--stiffness", "5e5", "--exponent", "1.5", *STATIC)


def sole(folder: Path, *rows: str, head: str = HEAD, name: str = "spheres.csv") -> Path:
    """A heel and a toe sphere unless rows are given."""
    return written(folder / name, "\n".join([head, *(rows or ("0,0,0,0.02,heel", "0.2,0,0,0.02,toe"))]) + "\n")


def cop(folder: Path, *options: object, spheres: Path | None = None, motion: Path | None = None) -> Call:
    """`geocontact cop` into `folder`/out; by default a foot that sinks 1, 2, 3 mm into y = 0."""
    spheres = spheres or sole(folder)
    motion = motion or poses(folder, (0, 19, 0), (0, 18, 0), (0, 17, 0))
    return call("cop", spheres, "--motion", motion, "--out", folder / "out", *options, folder=folder / "out")


def table(result: Call, name: str = "cop.csv") -> pd.DataFrame:
    """A result table, as pandas reads it by default."""
    return pd.read_csv(result.folder / name)


def test_contract(tmp_path: Path) -> None:
    result = done(cop(tmp_path, *LAW))
    assert {file.name for file in result.folder.iterdir()} == FILES
    assert set(result.record()["tables"]) == {"cop.csv", "zones.csv"}
    assert result.record()["tables"]["cop.csv"]["frame"] == "ground"
    ours = table(result)
    assert list(ours.columns[: len(COLUMNS)]) == COLUMNS
    force = 2 * 5e5 * (np.array([1, 2, 3]) * 1e-3) ** 1.5
    np.testing.assert_allclose(ours["force_y [N]"], force, rtol=1e-11)
    np.testing.assert_allclose(ours[["cop_x [m]", "cop_y [m]", "cop_z [m]"]], [[0.1, 0.0, 0.0]] * 3, atol=1e-12)
    np.testing.assert_allclose(table(result, "zones.csv")["heel [N]"], ours["force_y [N]"] / 2, rtol=1e-11)
    record = result.record()
    assert (record["command"], set(record["files"])) == ("cop", FILES)
    assert record["results"]["cop"]["frames_with_cop"] == 3 == record["inputs"][1]["frames"]
    assert all(len(entry["sha256"]) == 64 for entry in record["inputs"])


def test_below_the_gate_cells_are_empty(tmp_path: Path) -> None:
    result = done(cop(tmp_path, *LAW, "--gate", "50"))
    assert result.bytes("cop.csv").decode().splitlines()[1].split(",")[4:8] == ["", "", "", ""]
    assert table(result)["cop_x [m]"].notna().tolist() == [False, True, True]
    assert table(result)["force_y [N]"].gt(0.0).all()


def test_sphere_point_lies_above_the_ground(tmp_path: Path) -> None:
    result = done(cop(tmp_path, *LAW, "--gate", "0", "--point", "sphere"))
    np.testing.assert_allclose(table(result)["cop_y [m]"], [0.019, 0.018, 0.017], atol=1e-12)
    assert "sphere centres" in result.record()["tables"]["cop.csv"]["cop"]
    assert result.record()["options"]["point"] == "sphere"


def test_lengths_of_spheres_may_be_in_other_units(tmp_path: Path) -> None:
    head = "px [mm], py [cm], pz [m], radius [mm], zone"
    other = sole(tmp_path, "0,0,0,20,heel", "200,0,0,20,toe", head=head, name="mm.csv")
    ours, theirs = (table(done(cop(tmp_path, *LAW, spheres=s))) for s in (other, sole(tmp_path)))
    pd.testing.assert_frame_equal(ours, theirs, rtol=1e-12)


def test_friction_and_damping_come_from_the_motion(tmp_path: Path) -> None:
    """A foot that slides at 0.4 m/s, beyond the threshold, and sinks at 0.1 m/s, below the depth of full damping."""
    time = np.linspace(0.0, 0.02, 5)
    rows = "\n".join(f"{t},{400 * t},{17 - 100 * t},0,1,0,0,0" for t in time)
    motion = written(tmp_path / "slide.csv", f"time [s], tx [mm], ty [mm], tz [mm], qw, qx, qy, qz\n{rows}\n")
    result = done(cop(tmp_path, "--stiffness", "5e4", "--exponent", "1.5", "--damping", "300", "--friction", "0.9,0.7",
                      "--full-depth", "2mm", "--threshold-speed", "0.2", motion=motion))  # fmt: skip
    depth = 3e-3 + 0.1 * time
    normal = 2 * (5e4 * depth**1.5 + 300 * 0.1)
    np.testing.assert_allclose(table(result)["force_y [N]"], normal, rtol=1e-9)
    np.testing.assert_allclose(table(result)["force_x [N]"], -0.7 * normal, rtol=1e-9)


def test_zones_have_their_own_friction(tmp_path: Path) -> None:
    """Of a foot that slides at 0.4 m/s the toe is braked by 0.2 of its load, the heel by 0.7."""
    time = np.linspace(0.0, 0.02, 5)
    rows = "\n".join(f"{t},{400 * t},17,0,1,0,0,0" for t in time)
    motion = written(tmp_path / "slide.csv", f"time [s], tx [mm], ty [mm], tz [mm], qw, qx, qy, qz\n{rows}\n")
    text = "k = 5e4\nn = 1.5\nb = 0.0\ndelta_full = 0.002\nv_th = 0.2\nmu_s = 0.9\nmu_k = 0.7\n"
    law = written(tmp_path / "law.toml", text + "[zone.toe]\nmu_s = 0.3\nmu_k = 0.2\n")
    result = done(cop(tmp_path, "--law", law, motion=motion))
    one = 5e4 * 3e-3**1.5
    np.testing.assert_allclose(table(result)["force_x [N]"], -(0.7 + 0.2) * one, rtol=1e-9)
    numbers = result.record()["results"]["cop"]["law"]
    assert (numbers["mu_s"], numbers["mu_k"]) == ([0.3, 0.9], [0.2, 0.7])


@pytest.mark.slow
def test_numbers_of_the_law_by_column_file_and_option_agree(tmp_path: Path) -> None:
    rows = ("0,0,0,0.02,heel,3e5,100", "0.2,0,0,0.02,toe,9e5,200")
    column = sole(tmp_path, *rows, head=f"{HEAD}, k [N/m^1.5], b [N s/m]", name="columns.csv")
    numbers = "n = 1.5\nmu_s = 0\nmu_k = 0\ndelta_full = 0.002\nv_th = 0.25\n"
    zones = "[zone.heel]\nk = 3e5\nb = 100.0\n[zone.toe]\nk = 9e5\nb = 200.0\n"
    by_file = written(tmp_path / "law.toml", numbers + zones)
    rest = written(tmp_path / "rest.toml", "k = 9e5\nb = 200.0\n" + numbers + "[zone.heel]\nk = 3e5\nb = 100.0\n")
    results = [
        done(cop(tmp_path, "--exponent", "1.5", "--friction", "0,0", "--full-depth", "2mm", spheres=column)),
        done(cop(tmp_path, "--law", by_file)),
        done(cop(tmp_path, "--law", rest)),
    ]
    assert not any(result.warnings for result in results)
    first, *others = (table(result) for result in results)
    for other in others:
        pd.testing.assert_frame_equal(other, first, rtol=1e-12)
    np.testing.assert_allclose(first["cop_x [m]"].dropna(), 0.15, atol=0.03)


def test_numbers_that_nobody_gave_are_told(tmp_path: Path) -> None:
    warnings = done(cop(tmp_path)).warnings
    assert any("no stiffness given for every sphere" in line for line in warnings)
    assumed = "n = 1.2, b = 200 N s/m, delta_full = 0.002 m, mu_s = 0.9, mu_k = 0.7, v_th = 0.25 m/s"
    assert f"numbers of the force law that were not given are assumed: {assumed}" in warnings


def test_numbers_without_effect_are_not_told(tmp_path: Path) -> None:
    """Without damping no depth of full damping, without friction no threshold speed."""
    assert done(cop(tmp_path, *LAW)).warnings == []


@pytest.mark.slow
def test_tilted_plane_equals_the_level_one_after_turning_the_foot(tmp_path: Path) -> None:
    turn = Rotation.from_euler("XZ", [0.3, -0.5])
    qx, qy, qz, qw = turn.as_quat()
    shift = np.array([0.1, -0.2, 0.3])
    rows = [(*(1e3 * (turn.apply([0.0, y, 0.0]) + shift)), qw, qx, qy, qz) for y in (0.019, 0.018, 0.017)]
    normal = turn.apply([0.0, 1.0, 0.0])
    ground = "plane:" + ",".join(map(repr, [*(2.0 * normal).tolist(), float(normal @ shift)]))
    motion = poses(tmp_path, *rows, name="tilted.csv")
    tilted = table(done(cop(tmp_path, *LAW, "--gate", "0", "--ground", ground, motion=motion)))
    level = table(done(cop(tmp_path, *LAW, "--gate", "0")))
    places = ["cop_x [m]", "cop_y [m]", "cop_z [m]"]
    np.testing.assert_allclose(tilted[places], turn.apply(level[places].to_numpy()) + shift, atol=1e-9)
    np.testing.assert_allclose(tilted["normal [N]"], level["normal [N]"], rtol=1e-9)


def test_stairs_and_mesh_as_ground(tmp_path: Path) -> None:
    """The toe on a step 10 mm up; the sample plate, whose top is a plane too."""
    spheres = sole(tmp_path, "0,0,0,0.02,heel", "0.2,0.01,0,0.02,toe")
    stairs = table(done(cop(tmp_path, *LAW, "--gate", "0", "--ground", "stairs:0,0.1:0.01", spheres=spheres)))
    level = table(done(cop(tmp_path, *LAW, "--gate", "0")))
    np.testing.assert_allclose(stairs["force_y [N]"], level["force_y [N]"], rtol=1e-10)
    np.testing.assert_allclose(stairs["cop_y [m]"], 0.005, atol=1e-12)
    corners = np.frombuffer(
        PLATE.read_bytes(), np.dtype([("n", "<f4", 3), ("c", "<f4", (3, 3)), ("a", "<u2")]), offset=84
    )
    top = corners["c"].reshape(-1, 3).max(axis=0)
    small = sole(tmp_path, "0,0,0,0.02,heel", "0.02,0,0,0.02,toe", name="small.csv")
    motion = poses(tmp_path, *((-10, 0, float(top[2]) + 20 - d) for d in (1, 2, 3)), name="plate.csv")
    mesh = done(cop(tmp_path, *LAW, "--gate", "0", "--ground", PLATE, "--unit", "mm", spheres=small, motion=motion))
    assert not mesh.warnings
    np.testing.assert_allclose(table(mesh)["force_z [N]"], level["force_y [N]"], rtol=1e-6)
    np.testing.assert_allclose(table(mesh)["cop_z [m]"], top[2] * 1e-3, atol=1e-9)


def test_coordinates_by_name_as_motion(tmp_path: Path) -> None:
    motion = written(tmp_path / "foot.csv", "time [s], x [m], y [m], pitch [rad]\n0,1,0.018,0\n1,1,0.018,0.005\n")
    result = cop(tmp_path, *LAW, "--map", "rz=pitch,tx=x,ty=y", motion=motion)
    ours = table(done(result))
    assert result.warnings == [f"{motion}: nothing is mapped to rx, ry, tz; taken as 0"]
    np.testing.assert_allclose(ours["cop_x [m]"][0], 1.1, atol=1e-12)
    assert ours["cop_x [m]"][1] < 1.1, "the toe is lifted"


def plate_file(folder: Path, shift: float = 0.0, turn: str = "") -> Path:
    """A force plate that shows what the standing foot of `cop` should: 2 k d^1.5 at x = 0.1 + shift, plus a spin."""
    names = [f"ground_force_{c}{a}" for c in "vp" for a in "xyz"] + [f"ground_torque_{a}" for a in "xyz"]
    rows = [["time", *names]]
    for t, depth in enumerate((1e-3, 2e-3, 3e-3)):
        force = 2 * 5e5 * depth**1.5
        vertical = [0.0, force, 0.0] if not turn else [0.0, 0.0, force]
        about = [0.0, 1.5, 0.0] if not turn else [0.0, 0.0, 1.5]
        rows.append([t, *vertical, 0.1 + shift, 0.0, 0.0, *about])
    text = "\n".join("\t".join(map(str, row)) for row in rows)
    return written(folder / "grf.mot", f"grf\nversion=1\nnRows=3\nnColumns=10\ninDegrees=no\nendheader\n{text}\n")


def test_a_force_plate_beside_the_spheres(tmp_path: Path) -> None:
    result = done(cop(tmp_path, *LAW, "--gate", "50", "--compare", plate_file(tmp_path, 0.004)))
    rows = table(result, "comparison.csv")
    assert {file.name for file in result.folder.iterdir()} == FILES | {"comparison.csv"}
    np.testing.assert_allclose(rows["difference_force_y [N]"], 0.0, atol=1e-9)
    np.testing.assert_allclose(rows["difference_cop_x [m]"][1:], -0.004, atol=1e-12)
    np.testing.assert_allclose(rows["difference_free_moment [N m]"][1:], -1.5, atol=1e-9)
    assert rows["plate_cop_x [m]"].isna().tolist() == [True, False, False], "gated by load"
    assert result.record()["results"]["comparison"]["rms_cop_x [m]"] == pytest.approx(0.004)


def test_a_plate_with_another_frame_is_refused_until_its_pose_is_given(tmp_path: Path) -> None:
    file = plate_file(tmp_path)
    upright = ("--ground", "plane:0,0,1,0")
    motion = poses(tmp_path, (0, 0, 19), (0, 0, 18), (0, 0, 17), name="z.csv")
    refused = cop(tmp_path, *LAW, *upright, "--compare", file, motion=motion)
    assert (refused.code, refused.folder.exists()) == (2, False)
    assert "its normal is (0.00, 1.00, 0.00), that of our ground (0.00, 0.00, 1.00)" in refused.err
    pose = written(tmp_path / "pose.txt", "1 0 0 0\n0 0 -1 0\n0 1 0 0\n0 0 0 1\n")
    result = done(cop(tmp_path, *LAW, *upright, "--compare", file, "--plate-pose", pose, motion=motion))
    rows = table(result, "comparison.csv")
    np.testing.assert_allclose(rows["difference_force_z [N]"], 0.0, atol=1e-9)
    np.testing.assert_allclose(rows.filter(like="difference_cop").dropna(), 0.0, atol=1e-12)


def test_parquet_and_pictures(tmp_path: Path) -> None:
    result = done(cop(tmp_path, *LAW, "--parquet"))
    pd.testing.assert_frame_equal(
        pd.read_parquet(result.folder / "cop.parquet"), table(result), rtol=1e-11, check_dtype=False
    )
    assert result.bytes("cop.png").startswith(b"\x89PNG") and b"<svg" in result.bytes("cop.svg")


@pytest.mark.slow
def test_same_call_gives_the_same_bytes(tmp_path: Path) -> None:
    first = {name: done(cop(tmp_path)).bytes(name) for name in FILES - {"run.json"}}
    again = {name: done(cop(tmp_path)).bytes(name) for name in FILES - {"run.json"}}
    assert first == again


def test_record_holds_the_law_in_force(tmp_path: Path) -> None:
    numbers = json.loads(done(cop(tmp_path, *LAW)).bytes("run.json"))["results"]["cop"]["law"]
    assert numbers == {"k": [5e5], "b": [0.0], "n": 1.5, "delta_full_m": 2e-3, "mu_s": 0.0, "mu_k": 0.0,
                       "v_th_m_per_s": 0.25}  # fmt: skip
