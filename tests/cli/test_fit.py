"""`geocontact fit`: numbers, files, patches, sides, profile, as users and outside checks meet them; refusals."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.stats import t as student

from tests.cli.calls import FEMUR, INSERT, MESHES, PLATE, SPHERE, Call, area, call, done, inventory, shifted, written

CYLINDER, CUP, FINER = (
    MESHES / "cylinder_r15_l40.stl",
    MESHES / "cup_r24.stl",
    MESHES / "femoral_component_right_medium.stl",
)
FILES = {"fit.json", "fit.png", "fit.svg", "report.html", "run.json"}
PROFILE = {"profile.csv", "profile.png", "profile.svg"}
PROMISED = {
    "radius_mm", "axis", "point_mm", "rms_mm", "mean_abs_mm", "max_abs_mm", "points", "inliers", "radius_ci95_mm",
}  # fmt: skip
KNEE = ("--axis", "0,0,0,0,0,1", "--sagittal=-y,-x", "--region", "outward>0.5 and -40<flexion<150")


def fit(folder: Path, mesh: Path, shape: str, *options: object, unit: str = "mm") -> Call:
    """`geocontact fit` into `folder`."""
    return call("fit", mesh, "--shape", shape, "--unit", unit, "--out", folder, *options, folder=folder)


def found(result: Call) -> dict:
    """`fit.json`."""
    return json.loads(result.bytes("fit.json"))


def axis_of(mesh: Path) -> int:
    """The coordinate along which the sample rod lies."""
    from geocontact.io.mesh.meshes import read_mesh

    return int(np.argmax(np.ptp(read_mesh(mesh, "mm").vertices, axis=0)))


def test_contract_and_a_rod(tmp_path: Path) -> None:
    along = axis_of(CYLINDER)
    name = "xyz"[along]
    result = done(fit(tmp_path / "rod", CYLINDER, "cylinder", "--region", f"abs(n{name})<0.5"))
    assert set(inventory(result.folder)) == FILES
    told = found(result)
    assert set(told) >= PROMISED
    assert told["radius_mm"] == pytest.approx(15.0, abs=1e-4)  # corners of the facets lie on the rod
    assert np.abs(told["axis"]) == pytest.approx(np.eye(3)[along], abs=1e-7)
    assert told["facing"] == "convex" and told["inliers"] == told["points"] and told["arc_deg"] > 340
    record = result.record()
    assert record["command"] == "fit" and set(record["files"]) == FILES
    assert record["results"]["fit"]["radius_mm"] == told["radius_mm"]
    assert len(result.bytes("report.html")) < 5_000_000 and b"15.000 mm" in result.bytes("report.html")


def test_the_ends_of_a_rod_are_outliers_of_its_wall(tmp_path: Path) -> None:
    """Without a region: caps and all."""
    robust = found(done(fit(tmp_path / "a", CYLINDER, "cylinder")))
    plain = found(done(fit(tmp_path / "b", CYLINDER, "cylinder", "--no-robust")))
    assert robust["radius_mm"] == pytest.approx(15.0, abs=1e-3) and robust["inliers"] < robust["points"]
    assert abs(plain["radius_mm"] - 15.0) > 0.1 and plain["robust"] is False


def test_units_and_placement(tmp_path: Path) -> None:
    here = found(done(fit(tmp_path / "a", SPHERE, "sphere")))
    there = found(done(fit(tmp_path / "b", SPHERE, "sphere", "--place", shifted(tmp_path, (1, -2, 3)))))
    larger = found(done(fit(tmp_path / "c", SPHERE, "sphere", unit="cm")))
    assert here["radius_mm"] == pytest.approx(20.0, abs=1e-4) and here["axis"] is None
    assert np.subtract(there["point_mm"], here["point_mm"]) == pytest.approx([1, -2, 3], abs=1e-4)
    assert larger["radius_mm"] == pytest.approx(10.0 * here["radius_mm"], rel=1e-9)
    centroids = found(done(fit(tmp_path / "d", SPHERE, "sphere", "--points", "faces")))
    assert 19.5 < centroids["radius_mm"] < here["radius_mm"] - 1e-3, "centroids of facets lie below the sphere"


def test_inside_and_outside_of_a_cup_by_centre_and_by_the_ball_in_it(tmp_path: Path) -> None:
    ball = done(fit(tmp_path / "ball", SPHERE, "sphere")).folder / "fit.json"
    cavity = found(done(fit(tmp_path / "a", CUP, "sphere", "--centre", ball, "--region", "outward<-0.9")))
    back = found(done(fit(tmp_path / "b", CUP, "sphere", "--centre", "0,0,0", "--region", "outward>0.9")))
    near = found(done(fit(tmp_path / "c", CUP, "sphere", "--other", SPHERE, "--region", "distance<4.5")))
    assert (cavity["facing"], back["facing"]) == ("concave", "convex")
    assert [each["radius_mm"] for each in (cavity, back, near)] == pytest.approx([24.0, 29.0, 24.0], abs=1e-3)


def test_a_plate(tmp_path: Path) -> None:
    """The upper face of the plate, and the two together, which are none."""
    top = found(done(fit(tmp_path / "a", PLATE, "plane", "--region", "ny>0.9")))
    assert top["radius_mm"] is None and top["radius_ci95_mm"] is None and top["facing"] is None
    assert np.abs(top["axis"]) == pytest.approx([0, 1, 0], abs=1e-9) and top["rms_mm"] < 1e-4


def test_radius_by_side_and_by_flexion(tmp_path: Path) -> None:
    """The synthetic femoral component: distal radius 34, posterior 22, about the axis through its origin."""
    result = done(fit(tmp_path / "o", FINER, "cylinder", *KNEE, "--split", "z", "--profile=-20:100:20", "--parquet"))
    assert set(inventory(result.folder)) == FILES | PROFILE | {"profile.parquet"}
    told, table = found(result), result.table("profile.csv")
    assert set(told["sides"]) == {"medial", "lateral"}
    counted = sum(side["points"] for side in told["sides"].values())
    assert told["points"] <= counted <= told["points"] + 200, "points on the plane are on both sides"
    low, high = told["radius_ci95_mm"]
    radius = told["parameters"].index("radius [m]")
    variance = told["covariance"][radius][radius]
    assert 0.5e-3 * (high - low) == pytest.approx(student.ppf(0.975, 15) * np.sqrt(variance), rel=1e-3)
    assert low < told["radius_mm"] < high and 22 < told["radius_mm"] < 34
    assert list(table["flexion [deg]"]) == pytest.approx([*range(-20, 101, 20)] * 2)
    medial = table[table["side"] == "medial"].set_index(table["flexion [deg]"].round()[table["side"] == "medial"])
    assert medial.loc[0, "radius [mm]"] == pytest.approx(34, rel=0.01)
    assert medial.loc[80, "radius [mm]"] == pytest.approx(22, rel=0.01)
    assert (medial["crest_z [mm]"] < 0).all() and (table[table["side"] == "lateral"]["crest_z [mm]"] > 0).all()
    pd.testing.assert_frame_equal(
        pd.read_parquet(result.folder / "profile.parquet"), table, rtol=1e-9, check_dtype=False
    )
    assert math.isclose(table["radius_upper [mm]"][0] + table["radius_lower [mm]"][0], 2 * table["radius [mm]"][0])
    right = found(done(fit(tmp_path / "p", FINER, "cylinder", *KNEE, "--split", "z", "--medial", "+")))
    assert right["sides"]["lateral"] == told["sides"]["medial"]


def test_fit_json_is_the_axis_of_a_sweep_and_of_a_patch(tmp_path: Path) -> None:
    axis = done(fit(tmp_path / "axis", FEMUR, "cylinder", *KNEE)).folder / "fit.json"
    again = found(done(fit(tmp_path / "o", FEMUR, "cylinder", "--axis", axis, "--region", "outward>0.5")))
    assert 20 < again["radius_mm"] < 40
    swept = area(
        tmp_path / "s",
        "--sweep",
        "flexion=0:1:1",
        "--axis",
        axis,
        "--place-moving",
        shifted(tmp_path, (0, 25, 0)),
        moving=FEMUR,
        fixed=INSERT,
    )
    assert done(swept).record()["inputs"][-1]["role"] == "--axis"
    sphere = done(fit(tmp_path / "ball", SPHERE, "sphere")).folder / "fit.json"
    plane = done(fit(tmp_path / "plate", PLATE, "plane", "--region", "ny>0.9")).folder / "fit.json"
    for wrong in (sphere, plane):
        refused = fit(tmp_path / "r", FEMUR, "cylinder", "--axis", wrong, "--region", "outward>0.5")
        assert refused.code == 2 and "give the fit.json of a cylinder fit" in refused.err


def test_an_axis_that_is_held(tmp_path: Path) -> None:
    """The wall of a rod seen a little askew: the radius of its section grows, and the axis is the one given."""
    along = axis_of(CYLINDER)
    way = np.roll([1.0, 0.1, 0.0], along)
    region = f"abs(n{'xyz'[along]})<0.5"
    given = ",".join(map(str, [0, 0, 0, *way]))
    held = found(done(fit(tmp_path / "o", CYLINDER, "cylinder", "--axis", given, "--hold-axis", "--region", region)))
    assert held["axis"] == pytest.approx((way / np.linalg.norm(way)).tolist(), abs=1e-12)
    assert held["rms_mm"] > 0.3 and held["parameters"] == ["shift_u [m]", "shift_v [m]", "radius [m]"]


def test_a_file_of_faces(tmp_path: Path) -> None:
    every = written(tmp_path / "faces.txt", "\n".join(map(str, range(0, 900, 3))))
    result = done(fit(tmp_path / "o", SPHERE, "sphere", "--region", every))
    assert found(result)["faces"] == 300 and found(result)["radius_mm"] == pytest.approx(20.0, abs=1e-4)
    assert [entry["role"] for entry in result.record()["inputs"]] == ["mesh", "--region"]


def test_residuals_for_paraview(tmp_path: Path) -> None:
    pyvista = pytest.importorskip("pyvista")
    result = done(fit(tmp_path / "o", CUP, "sphere", "--centre", "0,0,0", "--region", "outward>0.9", "--paraview"))
    body = pyvista.read(result.folder / "fit.vtp")
    told = found(result)
    assert int(body.cell_data["patch"].sum()) == told["faces"] < body.n_cells
    residual = body.point_data["residual [mm]"]
    counted = np.isfinite(residual)
    off = np.linalg.norm(body.points - told["point_mm"], axis=1) - told["radius_mm"]
    np.testing.assert_allclose(residual[counted], off[counted], atol=2e-5)
    assert counted.sum() == told["points"]
    assert "fit.vtp" not in inventory(done(fit(tmp_path / "o", CUP, "sphere")).folder), "of an earlier run"


def test_doubts_are_said_and_kept(tmp_path: Path) -> None:
    flat = done(fit(tmp_path / "a", SPHERE, "cylinder", "--region", "abs(z)<4 and y>18"))
    assert any("degrees about the axis" in line for line in flat.warnings)
    wrong = done(fit(tmp_path / "b", PLATE, "sphere"))
    assert flat.record()["warnings"] == flat.warnings and wrong.record()["warnings"] == wrong.warnings


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--region", "flexion>3"), "--region: flexion needs --axis and --sagittal"),
        (("--region", "outward>0.5"), "--region: outward needs --axis or --centre"),
        (("--region", "distance<1"), "--region: distance needs --other"),
        (("--region", "flexion>3", "--axis", "0,0,0,0,0,1"), "flexion needs --axis and --sagittal"),
        (("--region", "size>3"), "only x, y, z, nx, ny, nz, radial, outward, flexion, distance, numbers"),
        (("--region", "x>1e6"), "holds for no face"),
        (("--region", "x>0", "--axis", "0,0,0,0,0,1"), "--axis: does nothing here"),
        (("--region", "x>0", "--centre", "0,0,0"), "--centre: does nothing here"),
        (("--region", "x>0", "--other", "x.stl"), "--other: does nothing here"),
        (("--hold-axis",), "--hold-axis: needs a cylinder and an --axis"),
        (("--sagittal=-y,x",), "--sagittal: does nothing here"),
        (("--axis", "0,0,0,0,0,1", "--centre", "0,0,0"), "--centre: beside --axis"),
        (("--profile", "0:90:5"), "--sagittal: is missing: which way the mesh's axes point is not known"),
        (("--profile", "0:90:7", "--sagittal=-y,x"), "--profile: steps of 7 from 0 do not end at 90"),
        (("--profile", "0-90", "--sagittal=-y,x"), "--profile: '0-90' is not a range"),
        (("--profile", "0:90:5", "--sagittal=-y,q"), "--sagittal: '-y,q' is not two directions"),
        (("--profile", "0:90:5", "--sagittal=y,-y", "--axis", "0,0,0,0,0,1"), "are the same"),
        (("--profile", "0:90:5", "--sagittal=z,y", "--axis", "0,0,0,0,0,1"), "lies along the axis"),
        (("--window", "20"), "--window: does nothing without --profile"),
        (("--profile", "0:90:5", "--sagittal=-y,x", "--window", "0"), "--window: 0.0 is not between"),
        (("--parquet",), "--parquet: does nothing without --profile"),
        (("--medial", "+"), "--medial: does nothing without --split"),
        (("--place-other", "x"), "--place-other: does nothing without --other"),
        (("--region", "outward>0", "--centre", "1,2"), "--centre: '1,2' is neither"),
        (("--shape", "cone"), "cone"),
    ],
)
def test_options_refused(tmp_path: Path, options: tuple[str, ...], words: str) -> None:
    shape = () if "--shape" in options else ("--shape", "cylinder")
    out = tmp_path / "o"
    result = call("fit", CYLINDER, *shape, "--unit", "mm", "--out", out, *options, folder=out)
    assert (result.code, len(result.complaints), out.exists()) == (2, 1, False), result.err
    assert words in result.complaints[0]


def test_meshes_refused(tmp_path: Path) -> None:
    without = call("fit", CYLINDER, "--shape", "cylinder", "--out", tmp_path / "o")
    assert without.code == 2 and "--unit" in without.err and "pass --unit mm" in without.err
    metres = fit(tmp_path / "o", CYLINDER, "cylinder", unit="m")
    assert metres.code == 2 and len(metres.complaints) == 1
    one = written(tmp_path / "one.txt", "0\n")
    few = fit(tmp_path / "o", CYLINDER, "cylinder", "--region", one)
    assert few.code == 2 and "a cylinder needs at least 6 points, not 3; choose more faces with --region" in few.err
    assert not (tmp_path / "o").exists()


def test_a_side_without_points_is_refused(tmp_path: Path) -> None:
    result = fit(tmp_path / "o", SPHERE, "sphere", "--split", "z=100")
    assert result.code == 2 and "lateral: a sphere needs at least 5 points, not 0" in result.err


def test_a_failing_run_leaves_the_old_results_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    done(fit(tmp_path / "o", SPHERE, "sphere"))
    before = inventory(tmp_path)

    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device", "report.html")

    monkeypatch.setattr("geocontact.analyses.shape.write.write_fit_report", full)
    assert fit(tmp_path / "o", CUP, "sphere").code == 1
    assert inventory(tmp_path) == before
