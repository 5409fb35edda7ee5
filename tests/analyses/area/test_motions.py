"""Every way of saying how MOVING moves gives the poses it says: compared with the same poses written out."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

import geocontact as gc
from geocontact.analyses.area.result import AreaResult
from tests.analyses.area.calls import area
from tests.cli.calls import (
    FEMUR,
    INSERT,
    KNEE,
    MESHES,
    PLATE,
    SPHERE,
    agree,
    corners,
    gait,
    inventory,
    placement,
    poses,
    shifted,
    storage,
    unpictured,
    written,
)

FIXED, MOVING = "area_fixed [mm^2]", "area_moving [mm^2]"
SHIFTS = "tx=knee_tx,ty=knee_ty,tz=knee_tz"
JOINT = {"osim": KNEE, "joint": "knee_r"}
MAP = f"rz=-knee_flexion,rx=-knee_adduction,ry=-knee_rotation,{SHIFTS}"


@pytest.fixture(scope="module")
def other_way(tmp_path_factory: pytest.TempPathFactory) -> AreaResult:
    """The insert moving on the femoral component, by the joint of the shipped model."""
    return area(INSERT, FEMUR, storage(tmp_path_factory.mktemp("other_way")), **JOINT)


# --- motion ---------------------------------------------------------------------------------------------------------


def test_joint_of_a_model_gives_the_poses_of_the_csv(tmp_path: Path, knee: AreaResult) -> None:
    result = area(FEMUR, INSERT, storage(tmp_path), **JOINT, moving_body="parent")
    agree(result.table(), knee.table(), lengths=2e-4)  # gait.csv is rounded to 1e-4 mm
    assert [i["role"] for i in result.record.inputs] == ["moving", "fixed", "motion", "model"]


def test_swapping_the_bodies_swaps_the_areas(knee: AreaResult, other_way: AreaResult) -> None:
    """FIXED is the parent and MOVING the child: with the meshes exchanged both areas change places."""
    ours, theirs = other_way.table(), knee.table()
    np.testing.assert_allclose(ours[[FIXED, MOVING]], theirs[[MOVING, FIXED]], rtol=2e-4)
    np.testing.assert_allclose(ours["min_distance [mm]"], theirs["min_distance [mm]"], atol=2e-4)


def test_map_spells_out_the_joint(tmp_path: Path, other_way: AreaResult) -> None:
    agree(area(INSERT, FEMUR, storage(tmp_path), map=MAP).table(), other_way.table())


def test_order_of_the_map_matters_and_order_overrules_it(tmp_path: Path, other_way: AreaResult) -> None:
    scrambled = f"{SHIFTS},rx=-knee_adduction,ry=-knee_rotation,rz=-knee_flexion"
    given = (INSERT, FEMUR, storage(tmp_path))
    agree(area(*given, map=scrambled, order="ZXY").table(), other_way.table())
    as_written = area(*given, map=scrambled).table()
    assert not np.allclose(as_written[FIXED], other_way.table()[FIXED], rtol=1e-5)


def test_sign_in_the_map_matters(tmp_path: Path, other_way: AreaResult) -> None:
    wrong = MAP.replace("-knee_rotation", "knee_rotation")
    table = area(INSERT, FEMUR, storage(tmp_path), map=wrong).table()
    assert not np.allclose(table[FIXED], other_way.table()[FIXED], rtol=1e-3)


@pytest.mark.parametrize("unit", ["deg", "rad"])
def test_angles_say_what_the_file_does_not(tmp_path: Path, other_way: AreaResult, unit: str) -> None:
    file = storage(tmp_path)
    head, _, rest = file.read_text(encoding="utf-8").partition("inDegrees=yes\n")
    labels, *rows = rest.removeprefix("endheader\n").splitlines()
    table = np.array([row.split() for row in rows], float)
    table[:, 1:4] = table[:, 1:4] if unit == "deg" else np.radians(table[:, 1:4])
    rows = ["\t".join(map(repr, row)) for row in table.tolist()]
    written(file, "\n".join([head + "endheader", labels, *rows]) + "\n")
    agree(area(INSERT, FEMUR, file, **JOINT, angles=unit).table(), other_way.table())


def test_coordinates_may_be_named_by_their_path(tmp_path: Path, other_way: AreaResult) -> None:
    file = storage(tmp_path)
    text = file.read_text(encoding="utf-8")
    for name in ("flexion", "adduction", "rotation", "tx", "ty", "tz"):
        text = text.replace(f"\tknee_{name}", f"\t/jointset/knee_r/knee_{name}/value")
    written(file, text)
    agree(area(INSERT, FEMUR, file, **JOINT).table(), other_way.table())


def clinical(folder: Path, tz: int = 1) -> Path:
    """The cycle in clinical words: flexion, adduction, internal rotation (the model turns the other way round)."""
    lines = storage(folder).read_text(encoding="utf-8").splitlines()
    table = np.array([line.split() for line in lines[lines.index("endheader") + 2 :]], float)
    table[:, 2:4] *= -1.0
    table[:, 4:] *= [1e3, 1e3, tz * 1e3]
    head = "time [s],flexion [deg],adduction [deg],rotation [deg],tx [mm],ty [mm],tz [mm]"
    rows = [",".join(map(repr, row)) for row in table.tolist()]
    return written(folder / "clinical.csv", "\n".join([head, *rows]) + "\n")


def test_grood_suntay_angles_of_a_right_knee(tmp_path: Path, other_way: AreaResult) -> None:
    result = area(INSERT, FEMUR, clinical(tmp_path), convention="grood-suntay", side="right")
    agree(result.table(), other_way.table())


def test_the_same_clinical_angles_move_a_left_knee_as_its_mirror_image(tmp_path: Path, other_way: AreaResult) -> None:
    left = [MESHES / f"{name}_left_coarse.stl" for name in ("tibial_insert", "femoral_component")]
    result = area(*left, clinical(tmp_path, tz=-1), convention="grood-suntay", side="left")
    ours, right = result.table(), other_way.table()
    np.testing.assert_allclose(ours[[FIXED, MOVING]], right[[FIXED, MOVING]], rtol=1e-6)
    np.testing.assert_allclose(ours["centroid_z [mm]"], -right["centroid_z [mm]"], atol=1e-6)


@pytest.mark.parametrize("order", ["XYZ", "zxy"])
def test_euler_columns_with_their_order(tmp_path: Path, knee: AreaResult, order: str) -> None:
    """`order` XYZ is R = Rx Ry Rz: intrinsic rotations, capital letters for scipy."""
    table = pd.read_csv(gait(tmp_path), skipinitialspace=True)
    turned = Rotation.from_quat(table[["qw", "qx", "qy", "qz"]], scalar_first=True)
    angles = turned.as_euler(order.upper(), degrees=True)
    head = "time [s],tx [mm],ty [mm],tz [mm]," + ",".join(f"r{axis.lower()} [deg]" for axis in order)
    values = np.column_stack([table[["time [s]", "tx [mm]", "ty [mm]", "tz [mm]"]], angles])
    rows = [",".join(map(repr, row)) for row in values.tolist()]
    file = written(tmp_path / "euler.csv", "\n".join([head, *rows]) + "\n")
    agree(area(FEMUR, INSERT, file, order=order).table(), knee.table(), areas=1e-7)


def test_lengths_of_a_csv_are_in_the_unit_of_their_header(tmp_path: Path, knee: AreaResult) -> None:
    table = pd.read_csv(gait(tmp_path), skipinitialspace=True)
    table = table.rename(
        columns={"tx [mm]": "tx [m]", "ty [mm]": "ty [cm]", "tz [mm]": "tz [in]", "time [s]": "time [ms]"}
    )
    table[["tx [m]", "ty [cm]", "tz [in]", "time [ms]"]] *= [1e-3, 0.1, 1 / 25.4, 1e3]
    table.to_csv(tmp_path / "other.csv", index=False)
    agree(area(FEMUR, INSERT, tmp_path / "other.csv").table(), knee.table(), areas=1e-7)


@pytest.mark.parametrize("style", ["several", "pattern"])
def test_several_motions_have_tables_and_a_folder_each(tmp_path: Path, style: str) -> None:
    first, second = gait(tmp_path, [0], "slow walk.csv"), gait(tmp_path, [30], "slow run.csv")
    given = {"several": (second, first), "pattern": (tmp_path / "slow*.csv",)}
    result = area(FEMUR, INSERT, *given[style])
    motions = {"slow walk": first, "slow run": second}
    assert set(result.tables()) == {f"{name}/area" for name in motions}
    assert [one.name for one in result.motions] == sorted(motions)
    assert {sentence.partition(":")[0] for sentence in result.sentences} == set(motions)
    for name, file in motions.items():
        alone = area(FEMUR, INSERT, file)
        pd.testing.assert_frame_equal(result.table(f"{name}/area"), alone.table(), check_exact=True)


def test_each_folder_of_a_motion_has_the_record_of_the_whole_run(tmp_path: Path) -> None:
    """Which motion, by its hash, went into which folder; the records differ in the files beside them only."""
    motions = {"walk": poses(tmp_path, (0, 20, 0), name="walk.csv"), "run": poses(tmp_path, (0, 21, 0), name="run.csv")}
    with unpictured():
        out = area(SPHERE, PLATE, *motions.values()).write(tmp_path / "out")
    assert set(inventory(out)) == {
        "run.json",
        *motions,
        *(f"{name}/{file}" for name in motions for file in ("area.csv", "run.json")),
    }
    record = json.loads((out / "run.json").read_bytes())
    told = {i["folder"]: (i["file"], i["sha256"]) for i in record["inputs"] if i["role"] == "motion"}
    assert told == {n: (str(f), hashlib.sha256(f.read_bytes()).hexdigest()) for n, f in motions.items()}
    assert set(record["results"]) == set(motions)
    assert (record.pop("files"), record.pop("sha256")) == (["run.json"], {})
    for name in motions:
        beside = json.loads((out / name / "run.json").read_bytes())
        assert (beside.pop("files"), list(beside.pop("sha256")), beside) == (
            ["area.csv", "run.json"],
            ["area.csv"],
            record,
        )
    alone = area(SPHERE, PLATE, motions["walk"])
    assert [i["folder"] for i in alone.record.inputs if i["role"] == "motion"] == ["."]


def test_a_name_with_brackets_is_a_file_before_it_is_a_pattern(tmp_path: Path, knee: AreaResult) -> None:
    result = area(FEMUR, INSERT, gait(tmp_path, name="gait[1].csv"))
    pd.testing.assert_frame_equal(result.table(), knee.table(), check_exact=True)


# --- sweep ----------------------------------------------------------------------------------------------------------

POINT, DIRECTION = np.array([2.0, 1.0, -3.0]), np.array([0.2, -0.1, 2.0])
SWEEP = ("flexion", 0.0, gc.deg(-10), gc.deg(-10))


def lifted(folder: Path, height: float = 30.3) -> dict[str, str]:
    """The femoral component placed above the insert."""
    return {"place_moving": str(shifted(folder, (0, height, 0), "lifted.txt"))}


@pytest.fixture(scope="module")
def turned(tmp_path_factory: pytest.TempPathFactory) -> AreaResult:
    """The same as a sweep by poses of our own: p + R (x - p)."""
    folder = tmp_path_factory.mktemp("turned")
    unit = DIRECTION / np.linalg.norm(DIRECTION)
    rotation = Rotation.from_rotvec(np.radians([0.0, -10.0])[:, None] * unit)
    rows = np.column_stack([POINT - rotation.apply(POINT), rotation.as_quat(scalar_first=True)])
    return area(FEMUR, INSERT, poses(folder, *rows), **lifted(folder))


@pytest.mark.parametrize("given", ["numbers", "negative first number", "file", "fit.json"])
def test_sweep_turns_moving_about_the_axis(tmp_path: Path, turned: AreaResult, given: str) -> None:
    numbers = [*POINT, *DIRECTION]
    fit = {"axis": DIRECTION.tolist(), "point_mm": POINT.tolist(), "radius_mm": 20.0}
    behind = [*(POINT - 3 * DIRECTION), *DIRECTION]
    axis = {
        "numbers": ",".join(map(str, numbers)),
        "negative first number": ",".join(map(str, [*(POINT - 20 * DIRECTION), *DIRECTION])),
        "file": str(written(tmp_path / "axis.txt", " ".join(map(str, behind)) + "\n")),
        "fit.json": str(written(tmp_path / "fit.json", json.dumps(fit))),
    }
    table = area(sweep=SWEEP, axis=axis[given], **lifted(tmp_path)).table()
    assert list(table.pop("flexion [deg]")) == pytest.approx([0.0, -10.0], rel=1e-15)
    agree(table, turned.table(), areas=1e-7)


def test_sweep_without_an_axis_takes_the_cylinder_fitted_to_moving(tmp_path: Path) -> None:
    """A cylinder lying on a plate and turned about itself keeps its area; the fit is reported."""
    cylinder = MESHES / "cylinder_r15_l40.stl"
    place = lifted(tmp_path, 15.3)
    turn = ("turn", 0.0, gc.deg(40), gc.deg(40))
    result = area(cylinder, PLATE, sweep=turn, **place)
    (warning,) = result.warnings
    radius = float(warning.partition("radius ")[2].split()[0])
    assert radius == pytest.approx(15.0, abs=0.05) and cylinder.name in warning
    table = result.table()
    assert list(table["time [s]"]) == [0.0, 1.0]
    along = next(row for row in np.eye(3) if np.ptp(corners(cylinder) @ row) > 35)
    explicit = ",".join(map(str, [0, 15.3, 0, *along]))
    same = area(cylinder, PLATE, sweep=turn, axis=explicit, **place)
    np.testing.assert_allclose(table[FIXED], same.table()[FIXED], rtol=2e-3)
    assert np.ptp(table[FIXED]) < 0.01 * table[FIXED].mean()


# --- placement ------------------------------------------------------------------------------------------------------


def test_placing_both_bodies_alike_moves_only_the_centroid(tmp_path: Path, knee: AreaResult) -> None:
    """FIXED placed by X and MOVING by X_FM⁻¹ X X_FM at a frame: the contact is the same, seen from elsewhere."""
    row = pd.read_csv(gait(tmp_path, [30]), skipinitialspace=True).loc[0]
    pose = Rotation.from_quat(np.array(row[["qw", "qx", "qy", "qz"]], float), scalar_first=True)
    at = np.array(row[["tx [mm]", "ty [mm]", "tz [mm]"]], float)
    turn, shift = Rotation.from_rotvec([0.3, -0.2, 0.5]), np.array([12.0, -7.0, 4.0])
    # x -> pose⁻¹ (turn (pose x + at) + shift - at)
    inner = pose.inv() * turn * pose
    moved = pose.inv().apply(turn.apply(at) + shift - at)
    places = {
        "place_fixed": str(placement(tmp_path, turn, shift, "fixed.txt")),
        "place_moving": str(placement(tmp_path, inner, moved, "moving.txt")),
    }
    table = area(FEMUR, INSERT, tmp_path / "gait.csv", **places).table()
    known = knee.table().loc[[1]].reset_index(drop=True)
    centroid = [f"centroid_{axis} [mm]" for axis in "xyz"]
    expected = turn.apply(known[centroid].to_numpy(copy=True)) + shift
    np.testing.assert_allclose(table[centroid], expected, atol=1e-6)
    agree(table.drop(columns=centroid), known.drop(columns=centroid), areas=1e-7)


def test_mesh_placed_as_in_a_model(tmp_path: Path, knee: AreaResult) -> None:
    """The model scales the mm of the mesh files to m and leaves them where they are."""
    places = {"place_moving": f"{KNEE}:femoral_component", "place_fixed": f"{KNEE}:tibial_insert"}
    agree(area(FEMUR, INSERT, gait(tmp_path), **places).table(), knee.table(), areas=1e-7)
