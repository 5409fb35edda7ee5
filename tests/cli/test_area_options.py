"""Every option of `geocontact area` does what it says: compared with another way to the same result."""

from __future__ import annotations

import json
from pathlib import Path

import igl
import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

from tests.cli.calls import (
    FEMUR,
    INSERT,
    KNEE,
    MESHES,
    PLATE,
    SPHERE,
    Call,
    agree,
    area,
    call,
    corners,
    done,
    gait,
    inventory,
    poses,
    stl,
    storage,
    written,
)

FIXED, MOVING = "area_fixed [mm^2]", "area_moving [mm^2]"
LOWER, UPPER = "area_fixed_lower [mm^2]", "area_fixed_upper [mm^2]"
MEDIAL, LATERAL = "area_fixed_medial [mm^2]", "area_fixed_lateral [mm^2]"
SHIFTS = "tx=knee_tx,ty=knee_ty,tz=knee_tz"
CLIP = ("--rule", "clip")  # exact on the triangles as given: parts add up to rounding
MAP = f"rz=-knee_flexion,rx=-knee_adduction,ry=-knee_rotation,{SHIFTS}"


@pytest.fixture(scope="module")
def knee(tmp_path_factory: pytest.TempPathFactory) -> Call:
    """Two frames of the coarse knee with the default options."""
    folder = tmp_path_factory.mktemp("knee")
    return done(area(folder / "out", motion=gait(folder)))


@pytest.fixture(scope="module")
def clipped(tmp_path_factory: pytest.TempPathFactory) -> Call:
    """The same by the rule that does not divide triangles."""
    folder = tmp_path_factory.mktemp("clipped")
    return done(area(folder / "out", *CLIP, motion=gait(folder)))


@pytest.fixture(scope="module")
def other_way(tmp_path_factory: pytest.TempPathFactory) -> Call:
    """The insert moving on the femoral component, by the joint of the shipped model."""
    folder = tmp_path_factory.mktemp("other_way")
    options = ("--osim", KNEE, "--joint", "knee_r")
    return done(area(folder / "out", *options, moving=INSERT, fixed=FEMUR, motion=storage(folder)))


# --- thresholds -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("text", ["4mm", "0.4cm", "0.004 m", " 4 "])
def test_thresholds_may_carry_a_unit(tmp_path: Path, knee: Call, text: str) -> None:
    assert done(area(tmp_path / "out", "--threshold", text, motion=gait(tmp_path))).bytes() == knee.bytes()


def test_thresholds_keep_their_order_and_do_not_disturb_each_other(tmp_path: Path, knee: Call) -> None:
    table = done(area(tmp_path / "out", "--threshold", "4,0.1", motion=gait(tmp_path))).table()
    assert list(table["threshold [mm]"]) == [4.0, 0.1] * 2
    agree(table[0::2].reset_index(drop=True), knee.table())
    assert (table[FIXED][1::2].to_numpy() < 0.1 * table[FIXED][0::2].to_numpy()).all()


# --- motion ---------------------------------------------------------------------------------------------------------


def test_joint_of_a_model_gives_the_poses_of_the_csv(tmp_path: Path, knee: Call) -> None:
    options = ("--osim", KNEE, "--joint", "knee_r", "--moving", "parent")
    result = done(area(tmp_path / "out", *options, motion=storage(tmp_path)))
    agree(result.table(), knee.table(), lengths=2e-4)  # gait.csv is rounded to 1e-4 mm
    assert [i["role"] for i in result.record()["inputs"]] == ["moving", "fixed", "motion", "model"]


def test_swapping_the_bodies_swaps_the_areas(knee: Call, other_way: Call) -> None:
    """FIXED is the parent and MOVING the child: with the meshes exchanged both areas change places."""
    ours, theirs = other_way.table(), knee.table()
    np.testing.assert_allclose(ours[[FIXED, MOVING]], theirs[[MOVING, FIXED]], rtol=2e-4)
    np.testing.assert_allclose(ours["min_distance [mm]"], theirs["min_distance [mm]"], atol=2e-4)


def test_map_spells_out_the_joint(tmp_path: Path, other_way: Call) -> None:
    result = area(tmp_path / "out", "--map", MAP, moving=INSERT, fixed=FEMUR, motion=storage(tmp_path))
    agree(done(result).table(), other_way.table())


def test_order_of_the_map_matters_and_order_overrules_it(tmp_path: Path, other_way: Call) -> None:
    scrambled = f"{SHIFTS},rx=-knee_adduction,ry=-knee_rotation,rz=-knee_flexion"
    bodies = {"moving": INSERT, "fixed": FEMUR, "motion": storage(tmp_path)}
    agree(done(area(tmp_path / "a", "--map", scrambled, "--order", "ZXY", **bodies)).table(), other_way.table())
    as_written = done(area(tmp_path / "b", "--map", scrambled, **bodies)).table()
    assert not np.allclose(as_written[FIXED], other_way.table()[FIXED], rtol=1e-5)


def test_sign_in_the_map_matters(tmp_path: Path, other_way: Call) -> None:
    wrong = MAP.replace("-knee_rotation", "knee_rotation")
    table = done(area(tmp_path / "out", "--map", wrong, moving=INSERT, fixed=FEMUR, motion=storage(tmp_path))).table()
    assert not np.allclose(table[FIXED], other_way.table()[FIXED], rtol=1e-3)


@pytest.mark.parametrize("unit", ["deg", "rad"])
def test_angles_say_what_the_file_does_not(tmp_path: Path, other_way: Call, unit: str) -> None:
    file = storage(tmp_path)
    head, _, rest = file.read_text(encoding="utf-8").partition("inDegrees=yes\n")
    labels, *rows = rest.removeprefix("endheader\n").splitlines()
    table = np.array([row.split() for row in rows], float)
    table[:, 1:4] = table[:, 1:4] if unit == "deg" else np.radians(table[:, 1:4])
    rows = ["\t".join(map(repr, row)) for row in table.tolist()]
    written(file, "\n".join([head + "endheader", labels, *rows]) + "\n")
    options = ("--osim", KNEE, "--joint", "knee_r", "--angles", unit)
    agree(done(area(tmp_path / "out", *options, moving=INSERT, fixed=FEMUR, motion=file)).table(), other_way.table())


def test_coordinates_may_be_named_by_their_path(tmp_path: Path, other_way: Call) -> None:
    file = storage(tmp_path)
    text = file.read_text(encoding="utf-8")
    for name in ("flexion", "adduction", "rotation", "tx", "ty", "tz"):
        text = text.replace(f"\tknee_{name}", f"\t/jointset/knee_r/knee_{name}/value")
    written(file, text)
    options = ("--osim", KNEE, "--joint", "knee_r")
    agree(done(area(tmp_path / "out", *options, moving=INSERT, fixed=FEMUR, motion=file)).table(), other_way.table())


def clinical(folder: Path, tz: int = 1) -> Path:
    """The cycle in clinical words: flexion, adduction, internal rotation (the model turns the other way round)."""
    lines = storage(folder).read_text(encoding="utf-8").splitlines()
    table = np.array([line.split() for line in lines[lines.index("endheader") + 2 :]], float)
    table[:, 2:4] *= -1.0
    table[:, 4:] *= [1e3, 1e3, tz * 1e3]
    head = "time [s],flexion [deg],adduction [deg],rotation [deg],tx [mm],ty [mm],tz [mm]"
    rows = [",".join(map(repr, row)) for row in table.tolist()]
    return written(folder / "clinical.csv", "\n".join([head, *rows]) + "\n")


def test_grood_suntay_angles_of_a_right_knee(tmp_path: Path, other_way: Call) -> None:
    options = ("--convention", "grood-suntay", "--side", "right")
    result = area(tmp_path / "out", *options, moving=INSERT, fixed=FEMUR, motion=clinical(tmp_path))
    agree(done(result).table(), other_way.table())


def test_the_same_clinical_angles_move_a_left_knee_as_its_mirror_image(tmp_path: Path, other_way: Call) -> None:
    left = {name: MESHES / f"{name}_left_coarse.stl" for name in ("tibial_insert", "femoral_component")}
    result = area(
        tmp_path / "out", "--convention", "grood-suntay", "--side", "left",
        moving=left["tibial_insert"], fixed=left["femoral_component"], motion=clinical(tmp_path, tz=-1),
    )  # fmt: skip
    ours, right = done(result).table(), other_way.table()
    np.testing.assert_allclose(ours[[FIXED, MOVING]], right[[FIXED, MOVING]], rtol=1e-6)
    np.testing.assert_allclose(ours["centroid_z [mm]"], -right["centroid_z [mm]"], atol=1e-6)


@pytest.mark.parametrize("order", ["XYZ", "zxy"])
def test_euler_columns_with_their_order(tmp_path: Path, knee: Call, order: str) -> None:
    """--order XYZ is R = Rx Ry Rz: intrinsic rotations, capital letters for scipy."""
    table = pd.read_csv(gait(tmp_path), skipinitialspace=True)
    turned = Rotation.from_quat(table[["qw", "qx", "qy", "qz"]], scalar_first=True)
    angles = turned.as_euler(order.upper(), degrees=True)
    head = "time [s],tx [mm],ty [mm],tz [mm]," + ",".join(f"r{axis.lower()} [deg]" for axis in order)
    values = np.column_stack([table[["time [s]", "tx [mm]", "ty [mm]", "tz [mm]"]], angles])
    rows = [",".join(map(repr, row)) for row in values.tolist()]
    file = written(tmp_path / "euler.csv", "\n".join([head, *rows]) + "\n")
    agree(done(area(tmp_path / "out", "--order", order, motion=file)).table(), knee.table(), areas=1e-7)


def test_lengths_of_a_csv_are_in_the_unit_of_their_header(tmp_path: Path, knee: Call) -> None:
    table = pd.read_csv(gait(tmp_path), skipinitialspace=True)
    table = table.rename(
        columns={"tx [mm]": "tx [m]", "ty [mm]": "ty [cm]", "tz [mm]": "tz [in]", "time [s]": "time [ms]"}
    )
    table[["tx [m]", "ty [cm]", "tz [in]", "time [ms]"]] *= [1e-3, 0.1, 1 / 25.4, 1e3]
    table.to_csv(tmp_path / "other.csv", index=False)
    agree(done(area(tmp_path / "out", motion=tmp_path / "other.csv")).table(), knee.table(), areas=1e-7)


@pytest.mark.parametrize("style", ["repeated option", "shell glob", "quoted pattern"])
def test_several_motions_have_a_folder_each(tmp_path: Path, style: str) -> None:
    first, second = gait(tmp_path, [0], "slow walk.csv"), gait(tmp_path, [30], "slow run.csv")
    given = {
        "repeated option": ["--motion", first, "--motion", second],
        "shell glob": ["--motion", second, first],
        "quoted pattern": ["--motion", tmp_path / "slow*.csv"],
    }
    result = done(area(tmp_path / "out", *given[style]))
    assert set(inventory(result.folder)) == {
        "slow walk", "slow walk/area.csv", "slow run", "slow run/area.csv", "run.json"
    }  # fmt: skip
    for name, file in (("slow walk", first), ("slow run", second)):
        assert result.bytes(f"{name}/area.csv") == done(area(tmp_path / name, motion=file)).bytes()
    assert [Path(i["file"]).name for i in result.record()["inputs"]].count("slow walk.csv") == 1


def test_a_name_with_brackets_is_a_file_before_it_is_a_pattern(tmp_path: Path, knee: Call) -> None:
    assert done(area(tmp_path / "out", motion=gait(tmp_path, name="gait[1].csv"))).bytes() == knee.bytes()


# --- sweep ----------------------------------------------------------------------------------------------------------

POINT, DIRECTION = np.array([2.0, 1.0, -3.0]), np.array([0.2, -0.1, 2.0])
SWEEP = ("--sweep", "flexion=0:-10:-10")


def lifted(folder: Path, height: float = 30.3) -> tuple[str, Path]:
    """The femoral component placed above the insert."""
    rows = f"1 0 0 0\n0 1 0 {height}\n0 0 1 0\n0 0 0 1\n"
    return "--place-moving", written(folder / "lifted.txt", rows)


@pytest.fixture(scope="module")
def turned(tmp_path_factory: pytest.TempPathFactory) -> Call:
    """The same as --sweep by poses of our own: p + R (x - p)."""
    folder = tmp_path_factory.mktemp("turned")
    unit = DIRECTION / np.linalg.norm(DIRECTION)
    rotation = Rotation.from_rotvec(np.radians([0.0, -10.0])[:, None] * unit)
    rows = np.column_stack([POINT - rotation.apply(POINT), rotation.as_quat(scalar_first=True)])
    return done(area(folder / "out", *lifted(folder), motion=poses(folder, *rows)))


@pytest.mark.parametrize("given", ["numbers", "negative first number", "file", "fit.json"])
def test_sweep_turns_moving_about_the_axis(tmp_path: Path, turned: Call, given: str) -> None:
    numbers = [*POINT, *DIRECTION]
    fit = {"axis": DIRECTION.tolist(), "point_mm": POINT.tolist(), "radius_mm": 20.0}
    behind = [*(POINT - 3 * DIRECTION), *DIRECTION]
    axis = {
        "numbers": ",".join(map(str, numbers)),
        "negative first number": ",".join(map(str, [*(POINT - 20 * DIRECTION), *DIRECTION])),
        "file": written(tmp_path / "axis.txt", " ".join(map(str, behind)) + "\n"),
        "fit.json": written(tmp_path / "fit.json", json.dumps(fit)),
    }
    result = done(area(tmp_path / "out", *SWEEP, "--axis", axis[given], *lifted(tmp_path)))
    agree(result.table(), turned.table(), areas=1e-7)


def test_sweep_without_an_axis_takes_the_cylinder_fitted_to_moving(tmp_path: Path) -> None:
    """A cylinder lying on a plate and turned about itself keeps its area; the fit is reported."""
    cylinder = MESHES / "cylinder_r15_l40.stl"
    place = lifted(tmp_path, 15.3)
    result = done(area(tmp_path / "out", "--sweep", "turn=0:40:40", *place, moving=cylinder, fixed=PLATE))
    (warning,) = result.warnings
    radius = float(warning.partition("radius ")[2].split()[0])
    assert radius == pytest.approx(15.0, abs=0.05) and cylinder.name in warning
    table = result.table()
    assert list(table["time [s]"]) == [0.0, 1.0]
    along = next(row for row in np.eye(3) if np.ptp(corners(cylinder) @ row) > 35)
    explicit = ",".join(map(str, [0, 15.3, 0, *along]))
    same = done(
        area(tmp_path / "b", "--sweep", "turn=0:40:40", "--axis", explicit, *place, moving=cylinder, fixed=PLATE)
    )
    np.testing.assert_allclose(table[FIXED], same.table()[FIXED], rtol=2e-3)
    assert np.ptp(table[FIXED]) < 0.01 * table[FIXED].mean()


def test_step_of_a_sweep_is_one_degree_when_not_given(tmp_path: Path) -> None:
    result = done(area(tmp_path / "out", "--sweep", "a=0:2", "--axis", "0,0,0,0,0,1", *lifted(tmp_path)))
    assert len(result.table()) == 3


# --- placement ------------------------------------------------------------------------------------------------------


def matrix(folder: Path, turn: Rotation, shift: np.ndarray, name: str) -> Path:
    rows = np.vstack([np.column_stack([turn.as_matrix(), shift]), [0, 0, 0, 1]])
    return written(folder / name, "# pose\n" + "\n".join(" ".join(map(repr, row)) for row in rows.tolist()) + "\n")


def test_placing_both_bodies_alike_moves_only_the_centroid(tmp_path: Path, knee: Call) -> None:
    """FIXED placed by X and MOVING by X_FM⁻¹ X X_FM at a frame: the contact is the same, seen from elsewhere."""
    row = pd.read_csv(gait(tmp_path, [30]), skipinitialspace=True).loc[0]
    pose = Rotation.from_quat(np.array(row[["qw", "qx", "qy", "qz"]], float), scalar_first=True)
    at = np.array(row[["tx [mm]", "ty [mm]", "tz [mm]"]], float)
    turn, shift = Rotation.from_rotvec([0.3, -0.2, 0.5]), np.array([12.0, -7.0, 4.0])
    # x -> pose⁻¹ (turn (pose x + at) + shift - at)
    inner = pose.inv() * turn * pose
    moved = pose.inv().apply(turn.apply(at) + shift - at)
    places = (
        "--place-fixed", matrix(tmp_path, turn, shift, "fixed.txt"),
        "--place-moving", matrix(tmp_path, inner, moved, "moving.txt"),
    )  # fmt: skip
    table = done(area(tmp_path / "out", *places, motion=tmp_path / "gait.csv")).table()
    known = knee.table().loc[[1]].reset_index(drop=True)
    centroid = [f"centroid_{axis} [mm]" for axis in "xyz"]
    expected = turn.apply(known[centroid].to_numpy()) + shift
    np.testing.assert_allclose(table[centroid], expected, atol=1e-6)
    agree(table.drop(columns=centroid), known.drop(columns=centroid), areas=1e-7)


def test_mesh_placed_as_in_a_model(tmp_path: Path, knee: Call) -> None:
    """The model scales the mm of the mesh files to m and leaves them where they are."""
    places = ("--place-moving", f"{KNEE}:femoral_component", "--place-fixed", f"{KNEE}:tibial_insert")
    agree(done(area(tmp_path / "out", *places, motion=gait(tmp_path))).table(), knee.table(), areas=1e-7)


# --- what counts ----------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def halves(tmp_path_factory: pytest.TempPathFactory) -> Call:
    """Split at z = 0."""
    folder = tmp_path_factory.mktemp("halves")
    return done(area(folder / "out", "--split", "z", motion=gait(folder)))


def test_split_leaves_the_rest_of_the_table_alone(knee: Call, halves: Call) -> None:
    agree(halves.table().drop(columns=[MEDIAL, LATERAL]), knee.table(), areas=1e-3, lengths=1e-2)


def test_split_at_the_middle_equals_two_regions_where_triangles_are_not_cut(tmp_path: Path) -> None:
    """No triangle of the plate crosses z = 0, so that the cut and the choice of faces are the same."""
    straddling = np.ptp(np.sign(np.round(corners(PLATE)[:, :, 2], 3)), axis=1) > 1
    assert not straddling.any()
    bodies = {"moving": SPHERE, "fixed": PLATE, "motion": poses(tmp_path, (3, 19.8, 2))}
    cut = done(area(tmp_path / "a", "--split", "z", **bodies)).table()
    for name, region in ((MEDIAL, "z<0"), (LATERAL, "z>0")):
        part = done(area(tmp_path / region, "--region", region, **bodies)).table()
        np.testing.assert_allclose(part[FIXED], cut[name], rtol=1e-3)


def test_medial_side_swaps_the_columns(tmp_path: Path, halves: Call) -> None:
    other = done(area(tmp_path / "out", "--split", "z", "--medial", "+", motion=gait(tmp_path))).table()
    renamed = halves.table().rename(columns={MEDIAL: LATERAL, LATERAL: MEDIAL})[list(other.columns)]
    agree(other, renamed, areas=1e-9, lengths=1e-9)
    assert not np.allclose(other[MEDIAL], halves.table()[MEDIAL], rtol=1e-3)
    default = done(area(tmp_path / "b", "--split", "z", "--medial", "-", motion=gait(tmp_path)))
    assert default.bytes() == halves.bytes()


@pytest.mark.parametrize("plane", ["z=15", "z=1.5cm", "z=-15"])
def test_split_elsewhere(tmp_path: Path, halves: Call, plane: str) -> None:
    """The plane in FIXED's frame and the mesh unit; with both bodies shifted by as much the halves are the old ones."""
    shift = -15.0 if "-" in plane else 15.0
    there = matrix(tmp_path, Rotation.identity(), np.array([0, 0, shift]), "there.txt")
    table = pd.read_csv(gait(tmp_path), skipinitialspace=True)
    table["tz [mm]"] += shift
    table.to_csv(tmp_path / "there.csv", index=False)
    result = area(tmp_path / "out", "--split", plane, "--place-fixed", there, motion=tmp_path / "there.csv")
    shifted = done(result).table()
    shifted["centroid_z [mm]"] -= shift
    agree(shifted, halves.table(), areas=1e-6)
    at_zero = done(area(tmp_path / "b", "--split", "z", "--place-fixed", there, motion=tmp_path / "there.csv")).table()
    assert (np.sign(shift) * (shifted[MEDIAL] - at_zero[MEDIAL]) > 10.0).all()


def up(mesh: Path) -> np.ndarray:
    """Which faces look up by more than 0.25."""
    a, b, c = corners(mesh).swapaxes(0, 1)
    normal = np.cross(b - a, c - a)
    return normal[:, 1] > 0.25 * np.linalg.norm(normal, axis=1)


def test_region_of_fixed_by_expression_and_by_file(tmp_path: Path, clipped: Call) -> None:
    numbers = "\n".join(map(str, np.flatnonzero(up(INSERT))))
    file = written(tmp_path / "faces.txt", "# looking up\n" + numbers + "\n")
    motion = gait(tmp_path)
    chosen = done(area(tmp_path / "a", *CLIP, "--region", "ny>0.25", motion=motion))
    assert done(area(tmp_path / "b", *CLIP, "--region", file, motion=motion)).bytes() == chosen.bytes()
    rest = done(area(tmp_path / "c", *CLIP, "--region", "not ny > 0.25", motion=motion)).table()
    table, whole = chosen.table(), clipped.table()
    np.testing.assert_allclose(table[FIXED] + rest[FIXED], whole[FIXED], rtol=1e-9)
    assert (rest[FIXED] > 1.0).all(), "the rim within 4 mm looks sideways"
    np.testing.assert_allclose(table[MOVING], whole[MOVING], rtol=1e-9)
    np.testing.assert_allclose(table["min_distance [mm]"], whole["min_distance [mm]"], atol=1e-9)


def test_region_of_moving(tmp_path: Path, clipped: Call) -> None:
    motion = gait(tmp_path)
    parts = [
        done(area(tmp_path / sign, *CLIP, "--region-moving", f"z {sign} 0 and abs(x) < 40", motion=motion)).table()
        for sign in ("<", ">=")
    ]
    np.testing.assert_allclose(sum(part[MOVING] for part in parts), clipped.table()[MOVING], rtol=1e-9)
    for part in parts:
        assert (part[MOVING] > 500.0).all()
        np.testing.assert_allclose(part[FIXED], clipped.table()[FIXED], rtol=1e-9)


def test_long_regions_are_expressions_not_file_names(tmp_path: Path, knee: Call) -> None:
    region = " and ".join(f"(x < {limit} or z > -{limit})" for limit in range(100, 120))
    assert len(region) > 300
    agree(done(area(tmp_path / "out", "--region", region, motion=gait(tmp_path))).table(), knee.table())


def test_rules_order_as_they_must(tmp_path: Path, knee: Call) -> None:
    """Whole faces with all corners within ≤ the cut ≤ with any corner within; the bounds do not depend on the rule."""
    rules = ("all-vertices", "centroid", "clip", "any-vertex", "refined")
    found = {rule: done(area(tmp_path / rule, "--rule", rule, motion=gait(tmp_path))).table()[FIXED] for rule in rules}
    assert (found["all-vertices"] < found["clip"]).all() and (found["clip"] < found["any-vertex"]).all()
    assert (found["all-vertices"] <= found["centroid"]).all() and (found["centroid"] <= found["any-vertex"]).all()
    np.testing.assert_allclose(found["clip"], found["refined"], rtol=0.02)
    np.testing.assert_array_equal(found["refined"], knee.table()[FIXED])


def test_crude_rules_count_whole_faces(tmp_path: Path) -> None:
    """One frame, by libigl distances of the corners and of the centroids."""
    motion = poses(tmp_path, (1, 21, -2))
    points = corners(PLATE).reshape(-1, 3) - [1, 21, -2]
    ball = corners(SPHERE)
    distance = np.sqrt(
        igl.point_mesh_squared_distance(
            np.vstack([points, points.reshape(-1, 3, 3).mean(axis=1)]),
            ball.reshape(-1, 3),
            np.arange(ball.size // 3).reshape(-1, 3),
        )[0]
    )
    within, middle = (distance[: len(points)] <= 4.0).reshape(-1, 3), distance[len(points) :] <= 4.0
    a, b, c = corners(PLATE).swapaxes(0, 1)
    size = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    rules = {"all-vertices": within.all(axis=1), "any-vertex": within.any(axis=1), "centroid": middle}
    for rule, counted in rules.items():
        table = done(area(tmp_path / rule, "--rule", rule, moving=SPHERE, fixed=PLATE, motion=motion)).table()
        assert table[FIXED][0] == pytest.approx(size[counted].sum(), rel=1e-9), rule


@pytest.mark.parametrize("text", ["0.02", "2%"])
def test_bounds_are_as_narrow_as_asked_for(tmp_path: Path, text: str) -> None:
    motion, thresholds = gait(tmp_path, [30]), ("--threshold", "0.5,4")
    table = done(area(tmp_path / "a", *thresholds, "--bounds", text, motion=motion)).table()
    loose = done(area(tmp_path / "b", *thresholds, motion=motion)).table()
    for side in ("fixed", "moving"):
        lower, upper = table[f"area_{side}_lower [mm^2]"], table[f"area_{side}_upper [mm^2]"]
        assert ((upper - lower) / upper < 0.02).all()
        assert (lower <= table[f"area_{side} [mm^2]"]).all() and (table[f"area_{side} [mm^2]"] <= upper).all()
        # two intervals for the same true area
        assert (
            np.maximum(lower, loose[f"area_{side}_lower [mm^2]"])
            <= np.minimum(upper, loose[f"area_{side}_upper [mm^2]"])
        ).all()


@pytest.mark.parametrize("word", ["moving", "both"])
def test_an_open_body_is_closed_on_the_users_word(tmp_path: Path, word: str) -> None:
    """A face far from the contact is missing: with the word the result is that of the whole body."""
    points = corners(SPHERE)
    opened = written(tmp_path / "open.stl", stl(np.delete(points, np.argmax(points[:, :, 1].mean(axis=1)), axis=0)))
    motion = poses(tmp_path, (0, 19.5, 0))
    bodies = {"fixed": PLATE, "motion": motion}
    whole = done(area(tmp_path / "a", "--threshold", "0.1", moving=SPHERE, **bodies)).table()
    result = done(area(tmp_path / "b", "--threshold", "0.1", "--assume-closed", word, moving=opened, **bodies))
    assert any("open.stl" in line and "your word" in line for line in result.warnings)
    agree(result.table(), whole, areas=1e-3, lengths=1e-3)
    unsigned = area(tmp_path / "c", "--threshold", "0.1", "--assume-closed", "fixed", moving=opened, **bodies)
    assert list(done(unsigned).table()["signed"]) == ["moving"]


# --- comparison -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("factor", "options", "code"),
    [(1.0, [], 0), (1.01, [], 0), (1.05, [], 1), (0.97, [], 1), (1.05, ["--tolerance", "10%"], 0), (1.01, ["--tolerance", "0.005"], 1)],
)  # fmt: skip
def test_comparison_with_measured_areas(
    tmp_path: Path, knee: Call, factor: float, options: list[str], code: int
) -> None:
    measured = knee.table()[["time [s]", FIXED, MOVING]]
    measured[FIXED] *= factor
    measured.to_csv(tmp_path / "measured.csv", index=False)
    result = area(tmp_path / "out", "--compare", tmp_path / "measured.csv", *options, motion=gait(tmp_path))
    assert (result.code, result.complaints) == (code, []), result.err
    rows = result.table("comparison.csv")
    relative = rows["relative [-]"].to_numpy().reshape(2, 2)
    np.testing.assert_allclose(relative, [[1 / factor - 1] * 2, [0.0] * 2], atol=1e-9)
    assert list(rows["quantity"]) == [FIXED] * 2 + [MOVING] * 2
    np.testing.assert_allclose(rows["difference [mm^2]"], rows["ours [mm^2]"] - rows["reference [mm^2]"], atol=1e-9)
    assert (result.folder / "area.csv").is_file(), "results are kept when they differ from the measured ones"
    assert ("beyond" if code else "within") in result.out


def test_comparison_between_frames_and_per_threshold(tmp_path: Path) -> None:
    """Ours is taken linearly between frames, and at the threshold that a row is for."""
    motion, levels = gait(tmp_path), ("--threshold", "1,4")
    table = done(area(tmp_path / "a", *levels, motion=motion)).table()
    mean = table.loc[[1, 3], FIXED].mean()
    text = f"# laboratory\ntime [s], threshold [mm], {FIXED}\n0.15, 4, {mean}\n0.3, 1, {table[FIXED][2]}\n0.3, 4,\n"
    measured = written(tmp_path / "measured.csv", text)
    rows = done(area(tmp_path / "b", *levels, "--compare", measured, motion=motion)).table("comparison.csv")
    np.testing.assert_allclose(rows["relative [-]"], [0.0, 0.0], atol=1e-9)


# --- what is written ------------------------------------------------------------------------------------------------


def test_saved_maps(tmp_path: Path) -> None:
    """Every vertex of both bodies in every frame; where the distance is known it is libigl's."""
    shifts = [(1.0, 19.7, -2.0), (0.0, 22.0, 3.0)]
    motion = poses(tmp_path, *shifts)
    result = done(area(tmp_path / "out", "--threshold", "1,4", "--save-map", moving=SPHERE, fixed=PLATE, motion=motion))
    with np.load(result.folder / "distances.npz", allow_pickle=False) as archive:
        maps = {name: archive[name] for name in archive.files}
    assert set(maps) == {
        "time", "thresholds", "X_FM", "signed", "fixed_vertices", "fixed_faces", "fixed_distance", "moving_vertices",
        "moving_faces", "moving_distance",
    }  # fmt: skip
    np.testing.assert_array_equal(maps["time"], [0.0, 1.0])
    np.testing.assert_allclose(maps["thresholds"], [1e-3, 4e-3])
    assert str(maps["signed"]) == "both"
    np.testing.assert_allclose(maps["X_FM"][:, :3, 3], np.array(shifts) * 1e-3)
    np.testing.assert_array_equal(maps["X_FM"][:, :3, :3], [np.eye(3)] * 2)
    bodies = {"fixed": PLATE, "moving": SPHERE}
    for name, other, sign in (("fixed", "moving", -1), ("moving", "fixed", 1)):
        vertices, faces = maps[f"{name}_vertices"], maps[f"{name}_faces"]
        np.testing.assert_allclose(vertices[faces], corners(bodies[name]) * 1e-3, rtol=1e-12)
        assert maps[f"{name}_distance"].shape == (2, len(vertices))
        for frame, shift in enumerate(shifts):
            distance = maps[f"{name}_distance"][frame]
            squared = igl.point_mesh_squared_distance(
                vertices + sign * np.array(shift) * 1e-3, maps[f"{other}_vertices"], maps[f"{other}_faces"]
            )[0]
            known = np.isfinite(distance)
            assert known[np.sqrt(squared) <= 4e-3].all(), "known at least as far as the largest threshold"
            np.testing.assert_allclose(np.abs(distance[known]), np.sqrt(squared[known]), rtol=1e-6, atol=1e-9)
            assert (distance < 0).any() == (frame == 0)


def test_parquet_holds_the_same_table(tmp_path: Path) -> None:
    result = done(area(tmp_path / "out", "--parquet", motion=gait(tmp_path, [0, 30])))
    agree(pd.read_parquet(result.folder / "area.parquet"), result.table(), areas=1e-11, lengths=1e-11)
    assert not list(done(area(tmp_path / "b", motion=gait(tmp_path, [0]))).folder.glob("*.parquet"))


@pytest.mark.parametrize("workers", [1, 2, 3])
def test_results_do_not_depend_on_the_number_of_workers(tmp_path: Path, knee: Call, workers: int) -> None:
    assert done(area(tmp_path / "out", "--workers", workers, motion=gait(tmp_path))).bytes() == knee.bytes()


def test_every_option_is_tried_here() -> None:
    """A new option is named in this folder's tests, or this fails."""
    told = call("area", "--help").out
    options = {word.strip("│*.,:") for word in told.split() if word.startswith("--")}
    here = "".join(p.read_text(encoding="utf-8") for p in Path(__file__).parent.glob("*.py"))
    assert {"--unit", "--out", "--threshold", "--save-map"} <= options
    assert not {option for option in options if f'"{option}"' not in here}
