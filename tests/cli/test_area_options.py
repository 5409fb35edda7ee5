"""What counts, how it is counted and what is written: every option compared with another way to the same result."""

from __future__ import annotations

import re
from pathlib import Path
from unittest import mock

import igl
import numpy as np
import pandas as pd
import pytest

from geocontact.geometry.contact_area import evolution
from tests.cli.calls import (
    INSERT,
    PLATE,
    ROOT,
    SPHERE,
    Call,
    agree,
    area,
    call,
    corners,
    done,
    gait,
    poses,
    shifted,
    stl,
    written,
)

FIXED, MOVING = "area_fixed [mm^2]", "area_moving [mm^2]"
LOWER, UPPER = "area_fixed_lower [mm^2]", "area_fixed_upper [mm^2]"
MEDIAL, LATERAL = "area_fixed_medial [mm^2]", "area_fixed_lateral [mm^2]"
CLIP = ("--rule", "clip")  # exact on the triangles as given: parts add up to rounding


@pytest.fixture(scope="module")
def clipped(tmp_path_factory: pytest.TempPathFactory) -> Call:
    """The same by the rule that does not divide triangles."""
    folder = tmp_path_factory.mktemp("clipped")
    return done(area(folder / "out", *CLIP, motion=gait(folder)))


# --- thresholds -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("text", ["4mm", "0.4cm", "0.004 m", " 4 "])
def test_thresholds_may_carry_a_unit(tmp_path: Path, knee: Call, text: str) -> None:
    assert done(area(tmp_path / "out", "--threshold", text, motion=gait(tmp_path))).bytes() == knee.bytes()


def test_thresholds_keep_their_order_and_do_not_disturb_each_other(tmp_path: Path, knee: Call) -> None:
    table = done(area(tmp_path / "out", "--threshold", "4,0.1", motion=gait(tmp_path))).table()
    assert list(table["threshold [mm]"]) == [4.0, 0.1] * 2
    agree(table[0::2].reset_index(drop=True), knee.table())
    assert (table[FIXED][1::2].to_numpy() < 0.1 * table[FIXED][0::2].to_numpy()).all()


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
    there = shifted(tmp_path, (0, 0, shift))
    table = pd.read_csv(gait(tmp_path), skipinitialspace=True)
    table["tz [mm]"] += shift
    table.to_csv(tmp_path / "there.csv", index=False)
    result = area(tmp_path / "out", "--split", plane, "--place-fixed", there, motion=tmp_path / "there.csv")
    elsewhere = done(result).table()
    elsewhere["centroid_z [mm]"] -= shift
    agree(elsewhere, halves.table(), areas=1e-6)
    at_zero = done(area(tmp_path / "b", "--split", "z", "--place-fixed", there, motion=tmp_path / "there.csv")).table()
    assert (np.sign(shift) * (elsewhere[MEDIAL] - at_zero[MEDIAL]) > 10.0).all()


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


COMPARED = [
    (1.0, [], 0),
    (1.01, [], 0),
    (1.05, [], 1),
    (0.97, [], 1),
    (1.05, ["--tolerance", "10%"], 0),
    (1.01, ["--tolerance", "0.005"], 1),
]


@pytest.mark.parametrize(("factor", "options", "code"), COMPARED)
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
        "time", "time_unit", "thresholds", "X_FM", "signed", "fixed_vertices", "fixed_faces", "fixed_distance",
        "moving_vertices", "moving_faces", "moving_distance",
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


def test_saved_maps_are_read_as_the_reference_shows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The lines of docs/reference, run where the result is, against libigl: plate corners within 4 mm of the ball."""
    shifts = np.array([(1.0, 19.7, -2.0), (0.0, 22.0, 3.0)])
    done(area(tmp_path / "result", "--save-map", moving=SPHERE, fixed=PLATE, motion=poses(tmp_path, *shifts)))
    page = (ROOT / "docs/reference/area_csv.md").read_text(encoding="utf-8")
    (lines,) = [block for block in re.findall(r"```python\n(.*?)```", page, re.DOTALL) if "distances.npz" in block]
    assert len([line for line in lines.splitlines() if line]) == 4
    monkeypatch.chdir(tmp_path)
    names: dict[str, np.ndarray] = {}
    exec(lines, names)  # the reader's own lines
    names["maps"].close()
    ball, plate = corners(SPHERE), np.unique(corners(PLATE).reshape(-1, 3), axis=0)
    faces = np.arange(3 * len(ball)).reshape(-1, 3)
    squared = [igl.point_mesh_squared_distance(plate - shift, ball.reshape(-1, 3), faces)[0] for shift in shifts]
    assert list(names["within"]) == [np.count_nonzero(distance <= 16.0) for distance in squared]


def test_parquet_holds_the_same_table(tmp_path: Path) -> None:
    result = done(area(tmp_path / "out", "--parquet", motion=gait(tmp_path, [0, 30])))
    agree(pd.read_parquet(result.folder / "area.parquet"), result.table(), areas=1e-11, lengths=1e-11)
    assert not list(done(area(tmp_path / "b", motion=gait(tmp_path, [0]))).folder.glob("*.parquet"))


@pytest.mark.parametrize("workers", [1, 2, 3])
def test_results_do_not_depend_on_the_number_of_workers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, knee: Call, workers: int
) -> None:
    started = mock.Mock(side_effect=evolution.ThreadPoolExecutor)
    monkeypatch.setattr(evolution, "ThreadPoolExecutor", started)
    assert done(area(tmp_path / "out", "--workers", workers, motion=gait(tmp_path))).bytes() == knee.bytes()
    started.assert_called_with(workers)


def test_picture_shows_the_frame_of_the_largest_area(tmp_path: Path) -> None:
    motion = poses(tmp_path, (0, 22, 0), (0, 20, 0), (0, 21, 0))
    with mock.patch("geocontact.analyses.area.write.draw_areas") as drawn:
        area(tmp_path / "out", moving=SPHERE, fixed=PLATE, motion=motion, picture=True)
    distance, frame = drawn.call_args.args[3:5]
    assert frame == 1
    assert np.min(distance) == pytest.approx(0.0, abs=1e-5)


def test_every_option_is_tried_here() -> None:
    """A new option is named in this folder's tests, or this fails."""
    told = call("area", "--help").out
    options = {word.strip("│*.,:;") for word in told.split() if word.startswith("--")}
    here = "".join(p.read_text(encoding="utf-8") for p in Path(__file__).parent.glob("*.py"))
    assert {"--unit", "--out", "--threshold", "--save-map"} <= options
    assert not {option for option in options if f'"{option}"' not in here}
