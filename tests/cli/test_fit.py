"""`geocontact fit`: what it writes, that it is what Python writes, and what it refuses."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from tests.cli.calls import FEMUR, INSERT, MESHES, PLATE, SPHERE, Call, area, call, done, inventory, shifted, written

CYLINDER, CUP = MESHES / "cylinder_r15_l40.stl", MESHES / "cup_r24.stl"
FILES = {"fit.json", "fit.png", "fit.svg", "report.html", "run.json"}
PROFILE = {"profile.csv", "profile.png", "profile.svg"}
PROMISED = {
    "radius_mm",
    "axis",
    "point_mm",
    "rms_mm",
    "mean_abs_mm",
    "max_abs_mm",
    "points",
    "inliers",
    "radius_ci95_mm",
}
KNEE = ("--axis", "0,0,0,0,0,1", "--sagittal=-y,-x", "--region", "outward>0.5 and -40<flexion<150")


def fit(folder: Path, mesh: Path, shape: str, *options: object, unit: str = "mm") -> Call:
    """`geocontact fit` into `folder`."""
    return call("fit", mesh, "--shape", shape, "--unit", unit, "--out", folder, *options, folder=folder)


def found(result: Call) -> dict:
    """`fit.json`."""
    return json.loads(result.bytes("fit.json"))


def axis_of(mesh: Path) -> int:
    """The coordinate along which the sample rod lies."""
    return int(np.argmax(np.ptp(gc.read_mesh(mesh, "mm").vertices, axis=0)))


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
    assert len(result.bytes("report.html")) < 5_000_000 and "15.000\u00a0mm".encode() in result.bytes("report.html")


@pytest.mark.slow
def test_writes_what_python_writes(tmp_path: Path) -> None:
    """Files by name, tables byte for byte, options as typed and in SI."""
    typed = ("--split", "z", "--side", "right", "--profile=0:80:40", "--window", "40", "--no-robust", "--parquet")
    result = done(fit(tmp_path / "o", FEMUR, "cylinder", *KNEE, *typed))
    assert set(inventory(result.folder)) == FILES | PROFILE | {"fit.parquet", "profile.parquet"}
    python = gc.fit_shape(
        FEMUR,
        shape="cylinder",
        unit="mm",
        axis=KNEE[1],
        sagittal="-y,-x",
        region=KNEE[-1],
        split="z",
        side="right",
        profile=gc.deg(0, 80, 40),
        window=gc.deg(40),
        robust=False,
    )
    python.write(tmp_path / "python", parquet=True)
    for name in ("fit.json", "profile.csv", "profile.parquet"):
        assert (tmp_path / "python" / name).read_bytes() == result.bytes(name), name
    assert result.out.splitlines()[:-1] == list(python.sentences)
    options = result.record()["options"]
    assert (options["profile"], options["window"], options["robust"]) == ("0:80:40", 40.0, False)
    assert options["mesh"] == str(FEMUR) and options["out"] == str(result.folder)
    told = result.record()["options_si"]
    assert told["profile [rad]"] == list(gc.deg(0, 80, 40)) and told["window [rad]"] == gc.deg(40)


@pytest.mark.slow
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


def test_a_file_of_faces(tmp_path: Path) -> None:
    every = written(tmp_path / "faces.txt", "\n".join(map(str, range(0, 900, 3))))
    result = done(fit(tmp_path / "o", SPHERE, "sphere", "--region", every))
    assert found(result)["faces"] == 300 and found(result)["radius_mm"] == pytest.approx(20.0, abs=1e-4)
    assert [entry["role"] for entry in result.record()["inputs"]] == ["mesh", "--region"]


@pytest.mark.slow
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


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--region", "flexion>3"), "--region: flexion needs --axis and --sagittal"),
        (("--region", "outward>0.5"), "--region: outward needs --axis or --centre"),
        (("--region", "distance<1"), "--region: distance needs --other"),
        (("--region", "flexion>3", "--axis", "0,0,0,0,0,1"), "flexion needs --axis and --sagittal"),
        (("--region", "size>3"), "only x, y, z, nx, ny, nz, radial, outward, flexion, distance, numbers"),
        (("--region", "x>1e6"), "holds for no face"),
        (("--region", "x>0", "--axis", "0,0,0,0,0,1"), "--axis: has no effect here"),
        (("--region", "x>0", "--centre", "0,0,0"), "--centre: has no effect here"),
        (("--region", "x>0", "--other", "x.stl"), "--other: has no effect here"),
        (("--hold-axis",), "--hold-axis: needs a cylinder and an --axis"),
        (("--sagittal=-y,x",), "--sagittal: has no effect here"),
        (("--axis", "0,0,0,0,0,1", "--centre", "0,0,0"), "--centre: with --axis"),
        (("--profile", "0:90:5"), "--sagittal: is missing: which way the mesh's axes point is not known"),
        (("--profile", "0:90:7", "--sagittal=-y,x"), "--profile: steps of 7 from 0 do not end at 90"),
        (("--profile", "0-90", "--sagittal=-y,x"), "--profile: '0-90' is not a range"),
        (("--profile", "0:90:5", "--sagittal=-y,q"), "--sagittal: '-y,q' is not two directions"),
        (("--profile", "0:90:5", "--sagittal=y,-y", "--axis", "0,0,0,0,0,1"), "are the same"),
        (("--profile", "0:90:5", "--sagittal=z,y", "--axis", "0,0,0,0,0,1"), "lies along the axis"),
        (("--window", "20"), "--window: has no effect without --profile"),
        (("--profile", "0:90:5", "--sagittal=-y,x", "--window", "0"), "--window: 0 deg cannot be a window"),
        (("--medial", "+"), "--medial: has no effect without --split"),
        (("--place-other", "x"), "--place-other: has no effect without --other"),
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


@pytest.mark.slow
def test_a_failing_run_leaves_the_old_results_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    done(fit(tmp_path / "o", SPHERE, "sphere"))
    before = inventory(tmp_path)

    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device", "report.html")

    monkeypatch.setattr("geocontact.analyses.frame.pages.write_page", full)
    assert fit(tmp_path / "o", CUP, "sphere").code == 1
    assert inventory(tmp_path) == before
