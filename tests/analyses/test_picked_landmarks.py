"""One file of picked landmarks, as the commands read it: regions, axes, points, mats, registration; and found out."""

from __future__ import annotations

import hashlib
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import trimesh
from scipy.spatial.transform import Rotation

import geocontact as gc
from geocontact.analyses.frame.bodies import chosen_faces, typed_axis, typed_centre
from geocontact.analyses.shape.result import ShapeResult
from geocontact.data.errors import InputWarning
from geocontact.geometry.placement import placed
from geocontact.geometry.surface import Surface
from tests.analyses.area.calls import area
from tests.analyses.area.test_pairs import knee
from tests.analyses.mat.samples import THIGH, on_plane, refusal, shipped, truth, uniform
from tests.analyses.mat.samples import flat as flat_mat
from tests.cli.calls import FEMUR, INSERT, MESHES, PLATE, SPHERE, poses, written

BODY = MESHES / "thigh.stl"
HEAD = "id,x [{unit}],y [{unit}],z [{unit}]"


def saved(file: Path, mesh: Path, points: Sequence[Sequence[float]], unit: str = "mm", names: str = "ABCDEFGH") -> Path:
    """A file as pages write it, of points in the numbers of a mesh."""
    sha = hashlib.sha256(mesh.read_bytes()).hexdigest()
    head = (
        f"# landmarks picked by hand\n# mesh = {mesh.name}\n# mesh_sha256 = {sha}\n# unit = {unit}\n# frame = its own\n"
    )
    rows = [f"{name},{x:.12g},{y:.12g},{z:.12g}" for name, (x, y, z) in zip(names, points, strict=False)]
    return written(file, head + "\n".join([HEAD.format(unit=unit), *rows]) + "\n")


def middles(mesh: Path) -> np.ndarray:
    return np.asarray(trimesh.load(mesh, process=False).triangles_center)


def fit(mesh: Path, **options: Any) -> ShapeResult:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        return gc.fit_shape(mesh, unit="mm", **options)


def on_sphere(count: int = 5, height: float = 15.0) -> np.ndarray:
    """Corners around the pole of the sphere of 20 mm about the origin, on vertices or faces near enough."""
    angle = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    across = np.sqrt(20.0**2 - height**2)
    return np.column_stack([across * np.cos(angle), across * np.sin(angle), np.full(count, height)])


def test_a_fit_of_the_faces_within_picked_landmarks(tmp_path: Path) -> None:
    corners = on_sphere()
    file = saved(tmp_path / "pole.csv", SPHERE, corners)
    result = fit(SPHERE, shape="sphere", region=f"polygon:{file}")
    at = middles(SPHERE)
    inside = at[:, 2] > 0.0
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        inside &= (b - a)[0] * (at - a)[:, 1] - (b - a)[1] * (at - a)[:, 0] > 0.0
    assert result.fitting.patch.faces.sum() == inside.sum() > 20
    assert (result.fitting.patch.faces == inside).all()
    assert result.fit.radius == pytest.approx(20e-3, abs=1e-7)
    listed = {each["role"]: each for each in result.record.inputs}
    assert listed["`region`"]["landmarks"] == 5
    assert listed["`region`"]["mesh"] == "sphere_r20.stl"


def test_a_fit_of_the_faces_near_a_picked_landmark(tmp_path: Path) -> None:
    pole = trimesh.load(SPHERE, process=False).vertices[7]
    file = saved(tmp_path / "one.csv", SPHERE, [pole])
    result = fit(SPHERE, shape="sphere", region=f"sphere:{file}:A:0.9cm")
    assert (result.fitting.patch.faces == (np.linalg.norm(middles(SPHERE) - pole, axis=1) <= 9.0)).all()


def test_an_axis_and_a_centre_of_picked_landmarks_are_those_that_are_typed(tmp_path: Path) -> None:
    points = trimesh.load(SPHERE, process=False).vertices[[3, 40, 111]]
    file = saved(tmp_path / "points.csv", SPHERE, points)
    typed = ",".join(f"{x:.17g}" for x in (*points[1], *(points[2] - points[1])))
    two = saved(tmp_path / "two.csv", SPHERE, points[1:])
    region = {"shape": "sphere", "region": "radial>10"}
    expected = fit(SPHERE, axis=typed, **region).fitting.patch.faces
    assert 0 < expected.sum() < len(expected)
    for text in (f"{file}:B:C", str(two)):
        assert (fit(SPHERE, axis=text, **region).fitting.patch.faces == expected).all()
    centred = {"shape": "sphere", "region": "radial>25"}
    expected = fit(SPHERE, centre=",".join(f"{x:.17g}" for x in points[0]), **centred).fitting.patch.faces
    assert 0 < expected.sum() < len(expected)
    assert (fit(SPHERE, centre=f"{file}:A", **centred).fitting.patch.faces == expected).all()


def test_six_numbers_in_a_csv_are_an_axis_still(tmp_path: Path) -> None:
    ball = gc.read_surface(SPHERE, "mm")
    for text in ("1,2,3,0,0,1e0\n", "\ufeff1 2 3 0 0 1\r\n"):
        axis = typed_axis("`axis`", str(written(tmp_path / "axis.csv", text)), ball, "mm")
        assert (axis.point, axis.direction) == (pytest.approx((1e-3, 2e-3, 3e-3)), (0.0, 0.0, 1.0))


def test_areas_count_the_picked_faces_of_both_bodies(tmp_path: Path) -> None:
    corners = [[-6.0, 0.0, -6.0], [6.0, 0.0, -6.0], [6.0, 0.0, 6.0], [-6.0, 0.0, 6.0]]
    top = middles(PLATE)[:, 1].max()
    for corner in corners:
        corner[1] = top
    file = saved(tmp_path / "plate.csv", PLATE, corners)
    motion = poses(tmp_path, (0, 22, 0), (0, 21, 0))
    plain = {"threshold": 4e-3}
    found = area(SPHERE, PLATE, motion, region=f"polygon:{file}", **plain).table()
    typed = area(SPHERE, PLATE, motion, region="ny>0.5 and abs(x)<6 and abs(z)<6", **plain).table()
    pd.testing.assert_frame_equal(found, typed, check_exact=True)
    whole = area(SPHERE, PLATE, motion, **plain).table()
    assert not found.equals(whole)


TURN, SHIFT = Rotation.from_rotvec([0.3, -0.5, 0.2]).as_matrix(), np.array([0.012, -0.007, 0.031])
PLACED = {"moved": TURN, "mirrored": TURN @ np.diag([1.0, 1.0, -1.0])}
METRES = {"mm": 1e-3, "cm": 1e-2, "in": 25.4e-3}


@pytest.mark.filterwarnings("ignore:sphere_r20.stl. bounding box")  # a ball of a metre
@pytest.mark.parametrize("numbers", [True, False], ids=["by a model's scale", "by a pose"])
@pytest.mark.parametrize("unit", METRES)
@pytest.mark.parametrize("way", PLACED)
def test_landmarks_move_and_mirror_with_their_mesh(tmp_path: Path, way: str, unit: str, numbers: bool) -> None:
    """The file has the numbers of the mesh; the faces chosen are the same, points are where the mesh goes."""
    corners, metres = on_sphere(), METRES[unit]
    file = saved(tmp_path / "pole.csv", SPHERE, corners, unit)
    linear = PLACED[way] * (metres if numbers else 1.0)
    matrix = np.vstack([np.column_stack([linear, SHIFT]), [0, 0, 0, 1]])
    mesh = gc.read_mesh(SPHERE, unit)
    home, away = Surface.of(mesh), Surface.of(placed(mesh, matrix, metres if numbers else 1.0))
    chosen = chosen_faces("`region`", f"polygon:{file}", away, unit)
    assert chosen is not None
    assert (chosen == chosen_faces("`region`", f"polygon:{file}", home, unit)).all()
    assert 0 < chosen.sum() < len(chosen)
    point = typed_centre("`centre`", f"{file}:B", away, unit)
    assert point == pytest.approx(metres * PLACED[way] @ corners[1] + SHIFT, rel=1e-12)


def test_landmarks_follow_a_mesh_that_an_option_places(tmp_path: Path) -> None:
    corners = on_sphere()
    file = saved(tmp_path / "pole.csv", SPHERE, corners)
    matrix = np.vstack([np.column_stack([TURN, 1e3 * SHIFT]), [0, 0, 0, 1]])
    rows = written(tmp_path / "place.txt", "\n".join(" ".join(map(str, row)) for row in matrix.tolist()))
    region = {"shape": "sphere", "region": f"polygon:{file}"}
    found, home = fit(SPHERE, place=str(rows), **region), fit(SPHERE, **region)
    assert (found.fitting.patch.faces == home.fitting.patch.faces).all()
    assert found.fit.point == pytest.approx(SHIFT, abs=1e-8)


def test_a_load_acts_at_a_picked_landmark(tmp_path: Path) -> None:
    point = trimesh.load(SPHERE, process=False).vertices[5]
    file = saved(tmp_path / "pole.csv", SPHERE, [point])
    ball = gc.read_surface(SPHERE, "mm")
    assert typed_centre("`load_point`", f"{file}:A", ball, "mm") == pytest.approx(point * 1e-3, rel=1e-12)


def test_a_description_of_pairs_names_landmarks_beside_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    vertices = trimesh.load(INSERT, process=False).triangles_center
    high = vertices[np.argsort(vertices[:, 1])[-200:]]
    corners = [high[np.argmax(high @ way)] for way in np.array([[1, 0, 1], [1, 0, -1], [-1, 0, -1], [-1, 0, 1.0]])]
    saved(tmp_path / "rim.csv", INSERT, corners)
    text = knee(tmp_path).read_text("utf-8").replace('region = "z > 0"', 'region = "polygon:rim.csv"')
    written(tmp_path / "pairs.toml", text)
    monkeypatch.chdir(tmp_path.parent)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        found = gc.area_pairs(tmp_path / "pairs.toml", threshold=(4e-3,), workers=1, rule="clip")
    given = {"threshold": 4e-3, "workers": 1, "rule": "clip", "region": f"polygon:{tmp_path / 'rim.csv'}"}
    alone = area(FEMUR, INSERT, tmp_path / "gait.csv", **given).table()
    assert alone["area_fixed [mm^2]"].max() > 0.0
    pd.testing.assert_frame_equal(found.table("lateral/area"), alone, check_exact=True)


def test_a_mat_is_placed_by_landmarks_picked_on_its_scan(tmp_path: Path) -> None:
    table = pd.read_csv(THIGH / "landmarks.csv", skipinitialspace=True)
    sha = hashlib.sha256(BODY.read_bytes()).hexdigest()
    text = f"# mesh = thigh.stl\r\n# mesh_sha256 = {sha}\r\n# unit = mm\r\n" + table.to_csv(
        index=False, lineterminator="\r\n"
    )
    (tmp_path / "picked.csv").write_bytes(text.encode())
    found, expected = shipped(landmarks=tmp_path / "picked.csv"), shipped()
    pd.testing.assert_frame_equal(found.table(), expected.table(), check_exact=True)
    other = written(tmp_path / "other.csv", text.replace(sha, "0" * 64).replace("\r\n", "\n"))
    with refusal("was picked on thigh.stl (000000000000…), not on thigh.stl"):
        shipped(landmarks=other)


def test_a_segment_of_the_mat_is_picked(tmp_path: Path) -> None:
    files = on_plane(tmp_path)
    file = saved(tmp_path / "part.csv", files["surface"], [[0, 0, 0], [100, 0, 0], [100, 41, 0], [0, 41, 0]])
    picked = flat_mat(tmp_path, uniform(), segment=(f"low=polygon:{file}", "high=y>40"))
    typed = flat_mat(tmp_path, uniform(), segment=("low=y<40", "high=y>40"))
    pd.testing.assert_frame_equal(picked.table("segments"), typed.table("segments"), check_exact=True)
    assert len(set(typed.table("segments")["segment"])) == 2


def two_scans(folder: Path) -> dict[str, Path]:
    """The thigh scanned in another place, its marks there, and six vertices picked on both meshes."""
    turn, shift = Rotation.from_rotvec([0.3, -0.5, 0.2]), np.array([40.0, -25.0, 60.0])
    body = trimesh.load(BODY)
    scan = trimesh.Trimesh(turn.inv().apply(body.vertices - shift), body.faces, process=False)
    scan.export(folder / "scan.stl")
    table = pd.read_csv(THIGH / "landmarks.csv", skipinitialspace=True)
    axes = [f"{a} [mm]" for a in "xyz"]
    table[axes] = turn.inv().apply(table[axes].to_numpy() - shift)
    table.to_csv(folder / "landmarks.csv", index=False)
    chosen = np.linspace(0, len(body.vertices) - 1, 6).astype(int)
    on_body = saved(folder / "on_body.csv", BODY, body.vertices[chosen[::-1]], names="FEDCBA")
    on_scan = saved(folder / "on_scan.csv", folder / "scan.stl", scan.vertices[chosen])
    return {
        "surface": folder / "scan.stl",
        "landmarks": folder / "landmarks.csv",
        "body_landmarks": on_scan,
        "picked_on_body": on_body,
    }


def test_a_scan_is_registered_by_landmarks_picked_on_both_meshes(tmp_path: Path) -> None:
    result, exactly = shipped(**two_scans(tmp_path)), truth()
    k = int(exactly["normal [N]"].argmax())
    force, centre = [f"f{a} [N]" for a in "xyz"], [f"cop_{a} [mm]" for a in "xyz"]
    ours = result.table()
    assert np.linalg.norm(ours.loc[k, force] - exactly.loc[k, force]) < 0.02 * exactly.loc[k, "normal [N]"]
    assert np.linalg.norm(ours.loc[k, centre] - exactly.loc[k, centre]) < 0.5
    assert result.record.results["registration by landmarks"]["rms_mm"] < 1e-3
    assert len(result.table("registration")) == 6


def test_ids_of_one_file_alone_are_named_or_too_few(tmp_path: Path) -> None:
    given = two_scans(tmp_path)
    lines = given["picked_on_body"].read_text("utf-8").replace("\nF,", "\nG,")
    given["picked_on_body"].write_text(lines, "utf-8")
    result = shipped(**given)
    assert any("only one of on_scan.csv and on_body.csv: F, G" in said for said in result.warnings)
    given["picked_on_body"].write_text(
        lines.replace("\nE,", "\ne,").replace("\nD,", "\nd,").replace("\nC,", "\nc,"), "utf-8"
    )
    with refusal("has 2 ids of on_scan.csv"):
        shipped(**given)


def resolved(text: str, mesh: Path = SPHERE, unit: str = "mm") -> Any:
    return chosen_faces("`region`", text, gc.read_surface(mesh, unit), unit)


def test_a_file_of_another_mesh_or_unit_is_found_out(tmp_path: Path) -> None:
    file = saved(tmp_path / "pole.csv", SPHERE, on_sphere())
    with refusal("was picked on sphere_r20.stl ("):
        resolved(f"polygon:{file}", PLATE)
    with refusal("was picked in mm, and the mesh is read in cm"):
        resolved(f"polygon:{file}", SPHERE, "cm")
    shifted = written(tmp_path / "moved.stl", "")
    shifted.write_bytes(SPHERE.read_bytes()[:-1] + b"\x01")
    with refusal("not on moved.stl ("):
        resolved(f"polygon:{file}", shifted)
    text = "\n".join(line for line in file.read_text("utf-8").splitlines() if "sha256" not in line)
    assert resolved(f"polygon:{written(tmp_path / 'kept.csv', text)}", shifted).any()


def test_a_landmark_off_the_surface_is_a_warning_with_its_distance(tmp_path: Path) -> None:
    points = on_sphere()
    points[2, 2] += 1.0
    file = saved(tmp_path / "off.csv", SPHERE, points)
    away = np.linalg.norm(points[2]) - 20.0
    with pytest.warns(InputWarning, match="landmark C of off.csv is (.*) mm off sphere_r20.stl") as said:
        resolved(f"polygon:{file}")
    assert float(str(said[0].message).split(" is ")[1].split(" mm")[0]) == pytest.approx(
        away, abs=0.06
    )  # facets lie inside the ball


REFUSED = {
    "sphere:{file}": "names no file, landmark and radius",
    "sphere:{file}:A": "names no file, landmark and radius",
    "sphere:{file}:A:-3mm": "the radius -3mm is not positive",
    "sphere:{file}:A:wide": "'wide' is not a finite number",
    "sphere:{file}:Z:3mm": "has no landmark 'Z'",
    "sphere:{file}:A:1e-9mm": "holds no face of sphere_r20.stl",
    "polygon:nowhere.csv": "there is no file 'nowhere.csv'",
    "polygon:{two}": "a polygon needs 3 landmarks at least, not 2",
    "polygon:{twice}": "id A occurs twice",
    "polygon:{line}": "in one line",
    "polygon:{crossed}": "crosses itself",
}


@pytest.mark.parametrize("text", REFUSED)
def test_a_region_that_cannot_be_is_one_line(tmp_path: Path, text: str) -> None:
    around = on_sphere()
    files = {
        "file": saved(tmp_path / "file.csv", SPHERE, around),
        "two": saved(tmp_path / "two.csv", SPHERE, around[:2]),
        "twice": saved(tmp_path / "twice.csv", SPHERE, around, names="ABCAE"),
        "line": saved(tmp_path / "line.csv", SPHERE, [[20, 0, 0], [0, 0, 0], [-20, 0, 0]]),
        "crossed": saved(tmp_path / "crossed.csv", SPHERE, around[[0, 2, 1, 3]]),
    }
    with warnings.catch_warnings(), refusal(REFUSED[text]) as caught:
        warnings.simplefilter("ignore", InputWarning)
        resolved(text.format(**files))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("names", "said"),
    [
        ("", "2 landmarks are needed here, not 5"),
        (":A", "2 landmarks are needed here, not 1"),
        (":A:A", "name two landmarks that lie apart"),
        (":A:Z", "has no landmark 'Z'"),
    ],
)
def test_an_axis_needs_two_landmarks_apart(tmp_path: Path, names: str, said: str) -> None:
    file = saved(tmp_path / "pole.csv", SPHERE, on_sphere())
    with refusal(said):
        fit(SPHERE, shape="sphere", region="radial>10", axis=f"{file}{names}")


def test_a_centre_is_one_landmark(tmp_path: Path) -> None:
    file = saved(tmp_path / "pole.csv", SPHERE, on_sphere())
    with refusal("one landmark is needed here, not 5"):
        fit(SPHERE, shape="sphere", region="radial>10", centre=str(file))


@pytest.mark.parametrize("names", ["", ":A", ":A:B"])
@pytest.mark.parametrize("option", ["axis", "centre"])
def test_a_file_that_is_not_there_is_said(tmp_path: Path, option: str, names: str) -> None:
    with refusal("there is no such file"):
        fit(SPHERE, shape="sphere", region="radial>10", **{option: f"{tmp_path / 'nofile.csv'}{names}"})


def test_a_sheet_of_landmarks_is_read_as_well(tmp_path: Path) -> None:
    points = trimesh.load(SPHERE, process=False).vertices[[3, 40]]
    rows = [[name, *point] for name, point in zip("AB", points, strict=True)]
    file = tmp_path / "points.xlsx"
    pd.DataFrame(rows, columns=["id", "x [mm]", "y [mm]", "z [mm]"]).to_excel(file, index=False)
    ball = gc.read_surface(SPHERE, "mm")
    for text in (str(file), f"{file}:A:B"):
        axis = typed_axis("`axis`", text, ball, "mm")
        np.testing.assert_allclose(axis.point, 1e-3 * points[0], rtol=1e-12)
    np.testing.assert_allclose(typed_centre("`centre`", f"{file}:B", ball, "mm"), 1e-3 * points[1], rtol=1e-12)
