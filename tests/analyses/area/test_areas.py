"""Areas, bounds, separation and centroids: against the shipped pair's reference, closed forms, and each other."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.area.result import AreaResult
from tests.analyses.area.calls import area
from tests.cli.calls import (
    FEMUR,
    FRAMES,
    INSERT,
    MESHES,
    PLATE,
    SPHERE,
    call,
    corners,
    gait,
    inventory,
    poses,
    shifted,
    stl,
    unpictured,
    written,
)
from tests.contract import COLUMNS, SPLIT

THRESHOLDS = [0.1, 1.0, 4.0]
FIXED, MOVING = "area_fixed [mm^2]", "area_moving [mm^2]"


@pytest.fixture(scope="module")
def split(tmp_path_factory: pytest.TempPathFactory) -> AreaResult:
    """The coarse knee at two frames and three thresholds, split."""
    return area(
        FEMUR, INSERT, gait(tmp_path_factory.mktemp("knee")), threshold=gc.mm(0.1, 1, 4), split="z", side="right"
    )


def test_columns_are_those_of_the_contract_in_their_order(split: AreaResult, knee: AreaResult) -> None:
    assert list(split.table().columns)[: len(COLUMNS) + 2] == COLUMNS + SPLIT
    plain = list(knee.table().columns)
    assert plain[: len(COLUMNS)] == COLUMNS and not {*SPLIT} & {*plain}


def test_frames_are_outer_and_thresholds_inner(split: AreaResult) -> None:
    table = split.table()
    assert list(table["threshold [mm]"]) == pytest.approx(THRESHOLDS * len(FRAMES), rel=1e-15)
    assert list(table["time [s]"]) == [k / 100 for k in FRAMES for _ in THRESHOLDS]


def test_areas_equal_the_reference_of_the_shipped_pair(tmp_path: Path) -> None:
    """meshes/manifest.toml: areas of these very triangles, converged with libigl distances."""
    manifest = tomllib.loads((MESHES / "manifest.toml").read_text(encoding="utf-8"))
    pair = next(p for p in manifest["pair"] if (p["fixed"], p["moving"]) == (INSERT.name, FEMUR.name))
    pose = next(p for p in pair["pose"] if "frame" in p)
    known = [a for a in pose["area"] if a["surface"] == "triangulated"]
    levels = tuple(gc.mm(a["threshold_mm"]) for a in known)
    table = area(FEMUR, INSERT, gait(tmp_path, [pose["frame"]]), threshold=levels).table()
    for side in ("fixed", "moving"):
        np.testing.assert_allclose(table[f"area_{side} [mm^2]"], [a[f"area_{side}_mm2"] for a in known], rtol=1e-3)
    lowest, highest = pose["min_distance_mm"]
    assert lowest - 1e-3 <= table["min_distance [mm]"][0] <= highest + 1e-6


def test_medial_and_lateral_add_up(split: AreaResult) -> None:
    table = split.table()
    np.testing.assert_allclose(table[SPLIT].sum(axis=1), table[FIXED], rtol=1e-9)
    assert (table[SPLIT].to_numpy()[2::3] > 500.0).all(), "both condyles carry at 4 mm"


def test_bounds_enclose_the_area_and_areas_grow_with_the_threshold(split: AreaResult) -> None:
    table = split.table()
    assert (table["area_fixed_lower [mm^2]"] <= table[FIXED]).all()
    assert (table[FIXED] <= table["area_fixed_upper [mm^2]"]).all()
    assert (np.diff(table[FIXED].to_numpy().reshape(-1, 3), axis=1) > 0).all()


def test_penetration_and_distance_belong_together(split: AreaResult) -> None:
    """Both bodies closed: FIXED's depth is at most the overlap, and separation is the same at every threshold."""
    table = split.table()
    separation = table.groupby("time [s]")[["min_distance [mm]", "max_penetration_fixed [mm]"]]
    assert (separation.nunique() == 1).all(axis=None)
    assert (table["max_penetration_fixed [mm]"] >= 0.0).all()
    assert (table["max_penetration_fixed [mm]"] <= np.maximum(0.0, -table["min_distance [mm]"]) + 1e-9).all()


def test_sentences_tell_the_range_of_the_area(split: AreaResult) -> None:
    """And repr shows them."""
    areas = split.table()[FIXED].to_numpy().reshape(-1, 3)
    told = [
        f"area of FIXED within {t:g} mm: {a.min():.1f} … {a.max():.1f} mm^2"
        for t, a in zip((0.1, 1, 4), areas.T, strict=True)
    ]
    least = split.table()["min_distance [mm]"]
    frame = int(least.argmin()) // 3 + 1
    told.append(f"least distance {least.min():.3f}".rstrip("0") + f" mm in frame {frame} of ")
    assert list(split.sentences[1:-1]) == told[:-1] and split.sentences[-1].startswith(told[-1])
    assert split.sentences[-1].endswith("(signed: negative is overlap)") and str(split) == "\n".join(split.sentences)
    assert split.accepted and split.warnings == ()


def test_centroid_is_missing_where_the_area_is_zero(tmp_path: Path) -> None:
    """A sphere 1 mm above a plate: nothing within 0.5 mm, at 4 mm a disc under the centre."""
    table = area(SPHERE, PLATE, poses(tmp_path, (3, 21, -2)), threshold=gc.mm(0.5, 4)).table()
    centroid = table[["centroid_x [mm]", "centroid_y [mm]", "centroid_z [mm]"]]
    assert table[FIXED][0] == table[MOVING][0] == 0.0 and centroid.loc[0].isna().all()
    np.testing.assert_allclose(centroid.loc[1], [3, 0, -2], atol=0.02)


def test_nothing_in_contact_is_a_result(tmp_path: Path) -> None:
    """10 mm apart in the only frame: zero areas, a distance, and a figure all the same."""
    result = area(SPHERE, PLATE, poses(tmp_path, (0, 30, 0)))
    table = result.table()
    assert table[FIXED][0] == table[MOVING][0] == table["area_fixed_upper [mm^2]"][0] == 0.0
    assert table["min_distance [mm]"][0] == pytest.approx(10.0, abs=0.02)
    (said,) = result.warnings
    assert (
        "nothing of FIXED is within 4 mm in any frame: the least distance of the bodies is 10 mm, in frame 1 of 1, 0 s"
        in said
    )
    assert "check unit, where each mesh sits in its body (`place_moving`, `place_fixed`)" in said
    result.figure().draw_without_rendering()


def test_the_least_distance_is_told_with_its_frame(tmp_path: Path) -> None:
    """Also where the bodies touch and the faces that count do not."""
    motion = poses(tmp_path, (0, 32, 0), (0, 29, 0), (0, 31, 0))
    (said,) = area(SPHERE, PLATE, motion).warnings
    assert "is 9 mm, in frame 2 of 3, 1 s; check unit" in said
    (said,) = area(SPHERE, PLATE, poses(tmp_path, (0, 20.5, 0)), region="y<-5").warnings
    assert "is 0.5 mm, in frame 1 of 1, 0 s; the faces that count are elsewhere, check `region`" in said


def opened(folder: Path, mesh: Path, direction: int) -> Path:
    """The mesh without the face that lies farthest out along z, in `direction`: away from any contact here."""
    points = corners(mesh)
    away = np.argmax(direction * points[:, :, 2].mean(axis=1))
    return written(folder / f"open_{mesh.name}", stl(np.delete(points, away, axis=0)))


@pytest.mark.parametrize(
    ("moving_open", "fixed_open", "word"),
    [(False, False, "both"), (False, True, "fixed"), (True, False, "moving"), (True, True, "none")],
)
def test_signed_says_which_areas_are_signed(tmp_path: Path, moving_open: bool, fixed_open: bool, word: str) -> None:
    """area_fixed is signed when MOVING is closed; an unsigned area misses what lies deeper than the threshold."""
    moving = opened(tmp_path, SPHERE, 1) if moving_open else SPHERE
    fixed = opened(tmp_path, PLATE, 1) if fixed_open else PLATE
    result = area(moving, fixed, poses(tmp_path, (0, 19.5, 0)), threshold=gc.mm(0.1))
    table = result.table()
    assert list(table["signed"]) == [word]
    disc, ring = (np.pi * ((20 + t) ** 2 - 19.5**2) for t in (0.1, -0.1))
    expected = disc - ring if moving_open else disc
    facets = 0.06  # facets of the sphere cost a few per cent
    assert table[FIXED][0] == pytest.approx(expected, rel=facets)
    assert np.isnan(table["max_penetration_fixed [mm]"][0]) == moving_open
    assert table["min_distance [mm]"][0] == pytest.approx(0.0 if word == "none" else -0.5, abs=0.02)
    assert len(result.warnings) == moving_open + fixed_open


def test_python_writes_the_bytes_that_the_command_writes(tmp_path: Path) -> None:
    """Typed in mm and per cent, given in SI: the same tables, and the same options in run.json."""
    motion, faces = gait(tmp_path, [30]), written(tmp_path / "faces.txt", " ".join(map(str, range(300))))
    place = shifted(tmp_path, (0, 0.1, 0))
    measured = written(tmp_path / "measured.csv", f"time [s],threshold [mm],{MOVING}\n0.3,1,700\n")
    typed = [
        "--threshold",
        "0.5,1",
        "--split",
        "z=1",
        "--side",
        "left",
        "--bounds",
        "5%",
        "--adduction",
        "x=-1",
        "--tolerance",
        "900%",
    ]
    named = ["--region-moving", faces, "--place-moving", place, "--compare", measured, "--save-map", "--motion", motion]
    layer = ["--pressure", "--modulus", "500MPa", "--poisson", "0.46", "--piece", "1", "--thickness", "8"]
    with unpictured():
        folder = tmp_path / "typed"
        code = call("area", FEMUR, INSERT, "--unit", "mm", "--out", folder, *typed, *named, *layer).code
        result = area(
            FEMUR,
            INSERT,
            motion,
            threshold=(5e-4, 1e-3),
            split="z=1",
            side="left",
            bounds=gc.percent(5),
            adduction=("x", gc.deg(-1)),
            tolerance=9.0,
            region_moving=str(faces),
            place_moving=str(place),
            compare=measured,
            save_map=True,
            pressure=True,
            modulus=gc.MPa(500),
            poisson=0.46,
            piece=gc.mm(1),
            thickness=gc.mm(8),
        )
        python = result.write(tmp_path / "python")
    ours, theirs = inventory(python), inventory(folder)
    assert (code, set(ours)) == (0, set(theirs)) and len(ours) == 6
    same = [name for name in ours if name != "run.json"]
    assert {name: ours[name] for name in same} == {name: theirs[name] for name in same}
