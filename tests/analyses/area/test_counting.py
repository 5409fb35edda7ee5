"""What counts, how it is counted and what is kept: every option compared with another way to the same result."""

from __future__ import annotations

import re
from pathlib import Path
from unittest import mock

import igl
import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.area import motion_outputs
from geocontact.analyses.area.result import AreaResult
from geocontact.geometry.contact_area import evolution
from tests.analyses.area.calls import area
from tests.cli.calls import (
    FEMUR,
    INSERT,
    PLATE,
    ROOT,
    SPHERE,
    agree,
    corners,
    gait,
    poses,
    shifted,
    stl,
    unpictured,
    written,
)

FIXED, MOVING = "area_fixed [mm^2]", "area_moving [mm^2]"
LOWER, UPPER = "area_fixed_lower [mm^2]", "area_fixed_upper [mm^2]"
MEDIAL, LATERAL = "area_fixed_medial [mm^2]", "area_fixed_lateral [mm^2]"
CLIP = {"rule": "clip"}  # exact on the triangles as given: parts add up to rounding


@pytest.fixture(scope="module")
def clipped(tmp_path_factory: pytest.TempPathFactory) -> AreaResult:
    """The same by the rule that does not divide triangles."""
    return area(FEMUR, INSERT, gait(tmp_path_factory.mktemp("clipped")), **CLIP)


# --- thresholds -----------------------------------------------------------------------------------------------------


def test_thresholds_keep_their_order_and_do_not_disturb_each_other(tmp_path: Path, knee: AreaResult) -> None:
    table = area(FEMUR, INSERT, gait(tmp_path), threshold=gc.mm(4, 0.1)).table()
    assert list(table["threshold [mm]"]) == pytest.approx([4.0, 0.1] * 2, rel=1e-15)
    agree(table[0::2].reset_index(drop=True), knee.table())
    assert (table[FIXED][1::2].to_numpy() < 0.1 * table[FIXED][0::2].to_numpy()).all()


# --- what counts ----------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def halves(tmp_path_factory: pytest.TempPathFactory) -> AreaResult:
    """Split at z = 0."""
    return area(FEMUR, INSERT, gait(tmp_path_factory.mktemp("halves")), split="z", side="right")


def test_split_leaves_the_rest_of_the_table_alone(knee: AreaResult, halves: AreaResult) -> None:
    agree(halves.table().drop(columns=[MEDIAL, LATERAL]), knee.table(), areas=1e-3, lengths=1e-2)


def test_split_at_the_middle_equals_two_regions_where_triangles_are_not_cut(tmp_path: Path) -> None:
    """No triangle of the plate crosses z = 0, so that the cut and the choice of faces are the same."""
    straddling = np.ptp(np.sign(np.round(corners(PLATE)[:, :, 2], 3)), axis=1) > 1
    assert not straddling.any()
    given = (SPHERE, PLATE, poses(tmp_path, (3, 19.8, 2)))
    cut = area(*given, split="z", side="right").table()
    for name, region in ((MEDIAL, "z<0"), (LATERAL, "z>0")):
        part = area(*given, region=region).table()
        np.testing.assert_allclose(part[FIXED], cut[name], rtol=1e-3)


def test_medial_side_swaps_the_columns(tmp_path: Path, halves: AreaResult) -> None:
    other = area(FEMUR, INSERT, gait(tmp_path), split="z", medial="+").table()
    renamed = halves.table().rename(columns={MEDIAL: LATERAL, LATERAL: MEDIAL})[list(other.columns)]
    agree(other, renamed, areas=1e-9, lengths=1e-9)
    assert not np.allclose(other[MEDIAL], halves.table()[MEDIAL], rtol=1e-3)
    assert halves.sentences[0] == f"medial is -z (right side, z to the right) of {INSERT.name}"


@pytest.mark.parametrize(
    ("given", "same", "said"),
    [
        ({"side": "left"}, {"medial": "+"}, "+z (left side, z to the right)"),
        ({"medial": "-"}, {"side": "right"}, "-z (as given)"),
    ],
)
def test_the_side_of_the_body_says_what_is_medial(tmp_path: Path, given: dict, same: dict, said: str) -> None:
    """Without a knee convention; a sphere off the middle of a plate tells the sides apart."""
    bodies = (SPHERE, PLATE, poses(tmp_path, (3, 19.8, 2)))
    found, other = (area(*bodies, split="z", **how) for how in (given, same))
    pd.testing.assert_frame_equal(found.table(), other.table(), check_exact=True)
    assert f"medial is {said} of {PLATE.name}" in found.sentences
    assert found.table()[MEDIAL][0] != pytest.approx(found.table()[LATERAL][0], rel=0.1)


@pytest.mark.parametrize("plane", ["z=15", "z=1.5cm", "z=-15"])
def test_split_elsewhere(tmp_path: Path, halves: AreaResult, plane: str) -> None:
    """The plane in FIXED's frame and the mesh unit; with both bodies shifted by as much the halves are the old ones."""
    shift = -15.0 if "-" in plane else 15.0
    there = str(shifted(tmp_path, (0, 0, shift)))
    table = pd.read_csv(gait(tmp_path), skipinitialspace=True)
    table["tz [mm]"] += shift
    table.to_csv(tmp_path / "there.csv", index=False)
    given = (FEMUR, INSERT, tmp_path / "there.csv")
    elsewhere = area(*given, split=plane, side="right", place_fixed=there).table()
    elsewhere["centroid_z [mm]"] -= shift
    agree(elsewhere, halves.table(), areas=1e-6)
    at_zero = area(*given, split="z", side="right", place_fixed=there).table()
    assert (np.sign(shift) * (elsewhere[MEDIAL] - at_zero[MEDIAL]) > 10.0).all()


def up(mesh: Path) -> np.ndarray:
    """Which faces look up by more than 0.25."""
    a, b, c = corners(mesh).swapaxes(0, 1)
    normal = np.cross(b - a, c - a)
    return normal[:, 1] > 0.25 * np.linalg.norm(normal, axis=1)


def test_region_of_fixed_by_expression_and_by_file(tmp_path: Path, clipped: AreaResult) -> None:
    numbers = "\n".join(map(str, np.flatnonzero(up(INSERT))))
    file = written(tmp_path / "faces.txt", "# looking up\n" + numbers + "\n")
    given = (FEMUR, INSERT, gait(tmp_path))
    table = area(*given, **CLIP, region="ny>0.25").table()
    same = area(*given, **CLIP, region=str(file)).table()
    pd.testing.assert_frame_equal(same, table, check_exact=True)
    rest, whole = area(*given, **CLIP, region="not ny > 0.25").table(), clipped.table()
    np.testing.assert_allclose(table[FIXED] + rest[FIXED], whole[FIXED], rtol=1e-9)
    assert (rest[FIXED] > 1.0).all(), "the rim within 4 mm looks sideways"
    np.testing.assert_allclose(table[MOVING], whole[MOVING], rtol=1e-9)
    np.testing.assert_allclose(table["min_distance [mm]"], whole["min_distance [mm]"], atol=1e-9)


def test_region_of_moving(tmp_path: Path, clipped: AreaResult) -> None:
    motion = gait(tmp_path)
    parts = [
        area(FEMUR, INSERT, motion, **CLIP, region_moving=f"z {sign} 0 and abs(x) < 40").table() for sign in ("<", ">=")
    ]
    np.testing.assert_allclose(sum(part[MOVING] for part in parts), clipped.table()[MOVING], rtol=1e-9)
    for part in parts:
        assert (part[MOVING] > 500.0).all()
        np.testing.assert_allclose(part[FIXED], clipped.table()[FIXED], rtol=1e-9)


def test_long_regions_are_expressions_not_file_names(tmp_path: Path, knee: AreaResult) -> None:
    region = " and ".join(f"(x < {limit} or z > -{limit})" for limit in range(100, 120))
    assert len(region) > 300
    table = area(FEMUR, INSERT, gait(tmp_path), region=region).table()
    agree(table.drop(columns="coverage_fixed [-]"), knee.table())


def test_rules_order_as_they_must(tmp_path: Path, knee: AreaResult) -> None:
    """Whole faces with all corners within ≤ the cut ≤ with any corner within; the bounds do not depend on the rule."""
    rules = ("all-vertices", "centroid", "clip", "any-vertex", "refined")
    found = {rule: area(FEMUR, INSERT, gait(tmp_path), rule=rule).table()[FIXED] for rule in rules}
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
        table = area(SPHERE, PLATE, motion, rule=rule).table()
        assert table[FIXED][0] == pytest.approx(size[counted].sum(), rel=1e-9), rule


def test_bounds_are_as_narrow_as_asked_for(tmp_path: Path) -> None:
    motion, thresholds = gait(tmp_path, [30]), gc.mm(0.5, 4)
    table = area(FEMUR, INSERT, motion, threshold=thresholds, bounds=gc.percent(2)).table()
    loose = area(FEMUR, INSERT, motion, threshold=thresholds).table()
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
    given, near = (PLATE, poses(tmp_path, (0, 19.5, 0))), {"threshold": gc.mm(0.1)}
    whole = area(SPHERE, *given, **near).table()
    result = area(opened, *given, **near, assume_closed=word)
    assert any("open.stl" in line and "as you requested" in line for line in result.warnings)
    agree(result.table(), whole, areas=1e-3, lengths=1e-3)
    unsigned = area(opened, *given, **near, assume_closed="fixed")
    assert list(unsigned.table()["signed"]) == ["moving"]


# --- comparison -----------------------------------------------------------------------------------------------------


COMPARED = [
    (1.0, None, True),
    (1.01, None, True),
    (1.05, None, False),
    (0.97, None, False),
    (1.05, 0.1, True),
    (1.01, 0.005, False),
]


@pytest.mark.parametrize(("factor", "tolerance", "within"), COMPARED)
def test_comparison_with_measured_areas(
    tmp_path: Path, knee: AreaResult, factor: float, tolerance: float | None, within: bool
) -> None:
    measured = knee.table()[["time [s]", FIXED, MOVING]]
    measured[FIXED] *= factor
    measured.to_csv(tmp_path / "measured.csv", index=False)
    result = area(FEMUR, INSERT, gait(tmp_path), compare=tmp_path / "measured.csv", tolerance=tolerance)
    assert result.accepted == within
    rows = result.table("comparison")
    relative = rows["relative [-]"].to_numpy().reshape(2, 2)
    np.testing.assert_allclose(relative, [[1 / factor - 1] * 2, [0.0] * 2], atol=1e-9)
    assert list(rows["quantity"]) == [FIXED] * 2 + [MOVING] * 2
    np.testing.assert_allclose(rows["difference [mm^2]"], rows["ours [mm^2]"] - rows["reference [mm^2]"], atol=1e-9)
    assert ("within the tolerance" if within else "beyond the tolerance") in result.sentences[-1]


def test_comparison_between_frames_and_per_threshold(tmp_path: Path) -> None:
    """Ours is taken linearly between frames, and at the threshold that a row is for."""
    given, levels = (FEMUR, INSERT, gait(tmp_path)), gc.mm(1, 4)
    table = area(*given, threshold=levels).table()
    mean = table.loc[[1, 3], FIXED].mean()
    text = f"# laboratory\ntime [s], threshold [mm], {FIXED}\n0.15, 4, {mean}\n0.3, 1, {table[FIXED][2]}\n0.3, 4,\n"
    measured = written(tmp_path / "measured.csv", text)
    rows = area(*given, threshold=levels, compare=measured).table("comparison")
    np.testing.assert_allclose(rows["relative [-]"], [0.0, 0.0], atol=1e-9)


# --- what is written ------------------------------------------------------------------------------------------------


def test_saved_maps(tmp_path: Path) -> None:
    """Every vertex of both bodies in every frame; where the distance is known it is libigl's."""
    shifts = [(1.0, 19.7, -2.0), (0.0, 22.0, 3.0)]
    motion = poses(tmp_path, *shifts)
    with unpictured():
        out = area(SPHERE, PLATE, motion, threshold=gc.mm(1, 4), save_map=True).write(tmp_path / "out")
    with np.load(out / "distances.npz", allow_pickle=False) as archive:
        maps = {name: archive[name] for name in archive.files}
    of_bodies = {f"{body}_{what}" for body in ("fixed", "moving") for what in ("vertices", "faces", "distance")}
    assert set(maps) == {"time", "time_unit", "thresholds", "X_FM", "signed"} | of_bodies
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
    with unpictured():
        area(SPHERE, PLATE, poses(tmp_path, *shifts), save_map=True).write(tmp_path / "result")
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
    result = area(SPHERE, PLATE, poses(tmp_path, (0, 20, 0)))
    with unpictured():
        out = result.write(tmp_path / "out", parquet=True)
    pd.testing.assert_frame_equal(pd.read_parquet(out / "area.parquet"), result.table(), check_exact=True)


@pytest.mark.parametrize("workers", [1, 2, 3])
def test_results_do_not_depend_on_the_number_of_workers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, knee: AreaResult, workers: int
) -> None:
    started = mock.Mock(side_effect=evolution.ThreadPoolExecutor)
    monkeypatch.setattr(evolution, "ThreadPoolExecutor", started)
    result = area(FEMUR, INSERT, gait(tmp_path), workers=workers)
    pd.testing.assert_frame_equal(result.table(), knee.table(), check_exact=True)
    started.assert_called_with(workers)


def test_figure_shows_the_frame_of_the_largest_area(tmp_path: Path) -> None:
    motion = poses(tmp_path, (0, 22, 0), (0, 20, 0), (0, 21, 0))
    result = area(SPHERE, PLATE, motion)
    with mock.patch.object(motion_outputs, "area_figure") as drawn:
        result.figure()
    distance, frame = drawn.call_args.args[3:5]
    assert frame == 1
    assert np.min(distance) == pytest.approx(0.0, abs=1e-5)
