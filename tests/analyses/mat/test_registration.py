"""A scan brought to a body model, by landmarks and by shape. Synthetic recordings."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from tests.analyses.mat.samples import CENTRE, FORCE, THIGH, flat, marks, refusal, shipped, truth, uniform
from tests.cli.calls import MESHES, written

AXES = [f"{a} [mm]" for a in "xyz"]
BODY = MESHES / "thigh.stl"


def pairs(folder: Path, off: np.ndarray) -> Path:
    """The landmarks of the thigh on a body that is the scan itself, seen `off` there [mm]."""
    table = pd.read_csv(THIGH / "landmarks.csv", skipinitialspace=True)[["id", *AXES]]
    table[[f"body_{a}" for a in AXES]] = table[AXES].to_numpy() + off
    table.to_csv(folder / "pairs.csv", index=False)
    return folder / "pairs.csv"


def elsewhere(folder: Path, noise: float) -> dict[str, Path]:
    """The thigh as it was scanned in another place, its marks there, and pairs whose places are noisy [mm]."""
    turn, shift = Rotation.from_rotvec([0.3, -0.5, 0.2]), np.array([40.0, -25.0, 60.0])
    body = trimesh.load(BODY)
    scan = trimesh.Trimesh(turn.inv().apply(body.vertices - shift), body.faces, process=False)
    scan.export(folder / "scan.stl")
    table = pd.read_csv(THIGH / "landmarks.csv", skipinitialspace=True)
    on_body = table[AXES].to_numpy()
    table[AXES] = turn.inv().apply(on_body - shift)
    table.to_csv(folder / "landmarks.csv", index=False)
    seen = table[AXES].to_numpy() + np.random.default_rng(0).normal(0.0, noise, on_body.shape)
    both = pd.DataFrame(np.column_stack([seen, on_body]), columns=[*AXES, *(f"body_{a}" for a in AXES)])
    both.insert(0, "id", table["id"])
    both.to_csv(folder / "pairs.csv", index=False)
    names = {"surface": "scan.stl", "landmarks": "landmarks.csv", "body_landmarks": "pairs.csv"}
    return {option: folder / name for option, name in names.items()}


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")  # open3d's own imports warn
@pytest.mark.parametrize("way", ["landmarks", "shape"])
def test_results_are_in_the_frame_of_the_body_that_the_scan_is_registered_to(tmp_path: Path, way: str) -> None:
    shape = way == "shape"
    by_shape = {"body": BODY, "icp": True} if shape else {}
    result, exactly = shipped(**elsewhere(tmp_path, 2.0 if shape else 0.0), **by_shape), truth()
    ours, k = result.table(), int(exactly["normal [N]"].argmax())
    assert np.linalg.norm(ours.loc[k, FORCE] - exactly.loc[k, FORCE]) < 0.02 * exactly.loc[k, "normal [N]"]
    assert np.linalg.norm(ours.loc[k, CENTRE] - exactly.loc[k, CENTRE]) < (2.0 if shape else 0.5)
    told = result.record.results[f"registration by {way}"]
    assert told["rms_mm"] < 0.5 and told.get("engine", "own") in ("open3d", "own")
    residual = result.table("registration")["residual [mm]"]
    assert np.sqrt((residual**2).mean()) == pytest.approx(told["rms_mm"], rel=1e-3)
    place = result.record.results["uncertainty"]
    assert place["place"] == f"residual of the registration by {way}"
    if shape:
        assert 0.0 < max(place["sd_shift_mm"]) < 2.0, "less than the landmarks' own noise"
    assert (result.table("uncertainty").iloc[k, 1:4] > 0.0).all()


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")  # open3d's own imports warn
@pytest.mark.parametrize("engine", ["own", pytest.param("open3d", marks=pytest.mark.slow)])
def test_the_residual_of_a_registration_makes_the_wrench_uncertain_unless_it_is_stated(
    tmp_path: Path, engine: str
) -> None:
    """Landmarks that are off by 2 mm; 9 of them leave 21 degrees of freedom. Shape leaves less, with either engine."""
    if engine == "open3d":
        pytest.importorskip("open3d", reason="open3d is not installed", exc_type=ImportError)
    seen = pairs(tmp_path, np.random.default_rng(1).normal(0.0, 2.0, (9, 3)))
    ways = {
        "landmarks": {},
        "stated": {"registration": (0.0, 0.0)},
        "shape": {"body": BODY, "icp": True, "icp_engine": engine},
    }
    found = {name: shipped(body_landmarks=seen, **options) for name, options in ways.items()}
    told = {name: result.record.results["uncertainty"] for name, result in found.items()}
    turning = {name: result.table("uncertainty")["sd_mz [N m]"].max() for name, result in found.items()}
    assert told["landmarks"]["degrees_of_freedom"] == 21.0
    # each axis: 2 mm / sqrt(9) and the turn's share at the mat's middle, which is that of the landmarks
    assert told["landmarks"]["sd_shift_mm"] == pytest.approx([2.0 / 3.0] * 3, rel=0.5)
    assert told["stated"]["place"] == "`registration`" and turning["stated"] < turning["landmarks"]
    assert max(told["shape"]["sd_shift_mm"]) < 0.1, "the same mesh on both sides"


@pytest.mark.parametrize("engine", [None, "auto", "open3d"])
def test_where_open3d_does_not_import_our_own_search_is_taken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, engine: str | None
) -> None:
    """The record says which; who asked for open3d is told."""
    monkeypatch.setitem(sys.modules, "open3d", None)
    by_shape = {"body_landmarks": pairs(tmp_path, np.array([1.0, -1.0, 0.5])), "body": BODY, "icp": True}
    if engine == "open3d":
        with refusal("`icp_engine`: open3d does not import"):
            shipped(**by_shape, icp_engine=engine)
    else:
        told = shipped(**by_shape, icp_engine=engine).record.results["registration by shape"]
        assert told["engine"] == "own"


def test_both_residuals_count(tmp_path: Path) -> None:
    """Registration by landmarks and marks of the mat: variances add up at the middle of the mat."""
    apart = marks(tmp_path, "a,0,0,19,30,0", "b,4,0,61,30,0", "c,0,3,19,60,0", "d,4,3,61,60,0", name="apart.csv")
    corners = [(20, 30), (60, 30), (20, 60), (60, 60)]
    rows = [f"{k},{x},{y},0,{x + (3 if k % 2 else -3)},{y},0" for k, (x, y) in enumerate(corners)]
    head = "id, x [mm], y [mm], z [mm], body_x [mm], body_y [mm], body_z [mm]"
    on_body = written(tmp_path / "pairs.csv", "\n".join([head, *rows]) + "\n")
    result = flat(tmp_path, uniform(), landmarks=apart, point="40,45,0", accuracy=1e-5, body_landmarks=on_body)
    told = result.record.results["uncertainty"]
    assert told["place"] == "residual of the registration by landmarks"
    own, more = (np.array(each["sd_shift_mm"]) for each in (told, told["mat_on_scan"]))
    assert more[:2] == pytest.approx([np.sqrt(0.8 / 4)] * 2, rel=1e-6) and own.min() > more.max()
    sd = result.table("uncertainty").iloc[0]
    assert sd["sd_my [N m]"] == pytest.approx(12e-3 * np.hypot(own[0], more[0]), rel=0.02)
