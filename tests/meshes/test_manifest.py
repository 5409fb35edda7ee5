"""Walks `meshes/manifest.toml`: the shipped files are what it says, clean, and made by the scripts beside them."""

import hashlib
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from meshes import solids
from meshes.gait import settled_height
from meshes.make import all_knee_files, differing, leg_files, overhead_files, simple_files
from meshes.mat_files import recording_files
from meshes.mat_recordings import kneeling
from meshes.simple_shapes import SAMPLES
from meshes.stl import read_stl
from meshes.total_knee import RESOLUTIONS, total_knee
from tests import closed_forms

FOLDER = Path(__file__).parents[2] / "meshes"
MANIFEST = tomllib.loads((FOLDER / "manifest.toml").read_text(encoding="utf-8"))
FILES = {f["name"]: f for f in MANIFEST["file"]}
SURFACES = [f for f in MANIFEST["file"] if f["kind"] == "surface"]
AREAS = [
    pytest.param(pair, pose, area, id=f"{pair['name']}-{k}-{area['threshold_mm']}-{area['surface']}")
    for pair in MANIFEST["pair"]
    for k, pose in enumerate(pair["pose"])
    for area in pose["area"]
]

each_file = pytest.mark.parametrize("file", MANIFEST["file"], ids=lambda f: f["name"])
each_surface = pytest.mark.parametrize("file", SURFACES, ids=lambda f: f["name"])
each_area = pytest.mark.parametrize(("pair", "pose", "area"), AREAS)


def test_lists_every_data_file_and_no_other():
    files = (p.relative_to(FOLDER) for p in FOLDER.rglob("*") if p.is_file())
    present = {p for p in files if p.parts[0] not in {"generated", "__pycache__"} and p.suffix not in {".py", ".md"}}
    assert {p.as_posix() for p in present} == {"manifest.toml", *FILES}


@each_file
def test_bytes_and_label(file):
    data = (FOLDER / file["name"]).read_bytes()
    assert hashlib.sha256(data).hexdigest() == file["sha256"]
    assert file["what"].startswith("synthetic")
    assert len(data) < 800_000


@each_surface
def test_surface_is_closed_and_clean(file):
    vertices, faces = read_stl(FOLDER / file["name"])
    assert (len(vertices), len(faces)) == (file["vertices"], file["faces"])
    assert file["unit"] == "mm"
    assert file["closed"] is True
    assert solids.is_closed(faces)
    assert solids.volume(vertices, faces) == pytest.approx(file["volume_mm3"], abs=1e-3)
    assert file["volume_mm3"] > 0
    assert solids.smallest_angle(vertices, faces) > 24
    assert cKDTree(vertices).query(vertices, k=2)[0][:, 1].min() > 0.1, "vertices that nearly coincide"
    assert len({tuple(sorted(f)) for f in faces.tolist()}) == len(faces)


@each_surface
def test_one_piece_without_holes_but_the_torus(file):
    _, faces = read_stl(FOLDER / file["name"])
    euler = file["vertices"] - len(faces) * 3 // 2 + len(faces)
    assert euler == (0 if file["name"].startswith("torus") else 2)
    assert set(np.unique(faces)) == set(range(file["vertices"]))


@each_surface
def test_surface_does_not_cut_itself(file):
    assert not crossings(*read_stl(FOLDER / file["name"]))


def test_crossings_are_found():
    vertices, faces = read_stl(FOLDER / "sphere_r20.stl")
    both = np.vstack([vertices, vertices + np.array([33.0, 1.0, 2.0])])
    assert crossings(both, np.vstack([faces, faces + len(vertices)]))


def crossings(vertices, faces):
    """Whether an edge of a face runs through another face that shares no vertex with it."""
    corners = vertices[faces]
    centre = corners.mean(axis=1)
    reach = np.linalg.norm(corners - centre[:, None], axis=2).max()
    first, second = cKDTree(centre).query_pairs(2 * reach, output_type="ndarray").T
    apart = ~(faces[first][:, :, None] == faces[second][:, None, :]).any(axis=(1, 2))
    first, second = first[apart], second[apart]
    pairs = (
        (corners[i], corners[j][:, k], corners[j][:, k - 1])
        for i, j in ((first, second), (second, first))
        for k in range(3)
    )
    return any(segment_cuts(*p).any() for p in pairs)


def segment_cuts(triangle, start, end):
    """Whether the segments pass through the triangles (Moeller and Trumbore 1997)."""
    a, ab, ac, along = triangle[:, 0], triangle[:, 1] - triangle[:, 0], triangle[:, 2] - triangle[:, 0], end - start
    across, from_a = np.cross(along, ac), start - a
    det = np.einsum("ij,ij->i", ab, across)
    safe = np.where(np.abs(det) > 1e-12, det, np.inf)
    turned = np.cross(from_a, ab)
    u, v = np.einsum("ij,ij->i", from_a, across) / safe, np.einsum("ij,ij->i", along, turned) / safe
    t = np.einsum("ij,ij->i", ac, turned) / safe
    return np.isfinite(safe) & (u >= 0) & (v >= 0) & (u + v <= 1) & (t >= 0) & (t <= 1)


def test_left_insert_and_component_mirror_the_right_ones():
    for body in ("tibial_insert", "femoral_component"):
        left, right = (read_stl(FOLDER / f"{body}_{side}_coarse.stl")[0] for side in ("left", "right"))
        assert cKDTree(right).query(left * [1, 1, -1])[0].max() == 0


@each_area
def test_reference_area_lies_between_its_bounds(pair, pose, area):
    assert pair["fixed"] in FILES
    assert pair["moving"] in FILES
    assert np.linalg.norm(pose["quaternion"]) == pytest.approx(1, abs=1e-9)
    for side in ("fixed", "moving"):
        value = area[f"area_{side}_mm2"]
        assert 0 <= area[f"area_{side}_uncertainty_mm2"] <= 5e-5 * value
        if area["surface"] == "triangulated":
            assert area["source"].startswith("converged by adaptive subdivision with libigl")
            assert area[f"area_{side}_lower_mm2"] <= value <= area[f"area_{side}_upper_mm2"]
        else:
            known = {"gap": area["gap_mm"], "threshold": area["threshold_mm"]}
            assert eval(area[f"formula_{side}"], vars(closed_forms), known) == pytest.approx(value, rel=1e-11)


@pytest.mark.parametrize("pair", [p for p in MANIFEST["pair"] if "motion" in p], ids=lambda p: p["name"])
def test_poses_come_from_the_motion(pair):
    rows = np.loadtxt(FOLDER / pair["motion"], delimiter=",", skiprows=1)
    for pose in pair["pose"]:
        assert pose["position_mm"] + pose["quaternion"] == pytest.approx(rows[pose["frame"], 1:], abs=1e-10)
        lower, upper = pose["min_distance_mm"]
        assert -0.05 < lower <= upper < 0


@pytest.mark.slow
def test_generator_reproduces_what_takes_it_seconds():
    """Everything but the whole gait cycle and three of the four mats."""
    files = all_knee_files() | simple_files() | leg_files() | overhead_files() | recording_files(kneeling())
    assert len(files) == 6 + len(SAMPLES) + 9 + 3 + 7
    assert differing(files, FOLDER) == []


@pytest.mark.slow
def test_frames_of_the_gait_cycle_are_settled_anew():
    rows = np.loadtxt(FOLDER / "gait.csv", delimiter=",", skiprows=1)
    insert, femoral = total_knee(RESOLUTIONS["medium"])
    for k in (14, 73):
        tx, height, tz = rows[k, 1:4]
        turn = Rotation.from_quat(rows[k, 4:], scalar_first=True)
        assert settled_height(insert, femoral, turn, tx, tz, rows[k - 1, 2]) == height


@pytest.mark.slow
@pytest.mark.long  # what takes it long changes with the scripts of the samples only
def test_generator_reproduces_every_byte():
    done = subprocess.run([sys.executable, FOLDER / "make.py", "--check"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    # by make_gait.py, make_standing.py and whole_body.py: digits depend on the compiler
    simulated = [file for file in FILES if str(file).startswith(("gait_P1", "amputee_P1", "standing_up", "whole_body"))]
    assert len(simulated) == 8 + 8 + 11 + 19 + 7 + 18 + 3
    assert f"{len(FILES) - len(simulated)} files" in done.stdout
