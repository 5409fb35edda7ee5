"""Contact equilibrium of the shipped knee: tables, poses that `area` reads again, external loads, refusals."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

import geocontact as gc
from geocontact.analyses.frame.job import Job
from geocontact.data.errors import InputError, InputWarning
from geocontact.io.motion.motion import read_motion
from tests.cli.calls import FEMUR, INSERT, KNEE, MESHES, PLATE, SPHERE, call, done, gait, in_metres, poses
from tests.elsewhere import Elsewhere
from tests.opensim_oracle import external_wrenches

GAIT = MESHES / "gait.csv"
LAYER = {"modulus": gc.MPa(463), "poisson": 0.46}
BODIES = ("femoral_component", "tibial_insert")


@pytest.fixture(scope="module")
def motion(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three frames of the shipped cycle."""
    return gait(tmp_path_factory.mktemp("motion"), (0, 30, 60))


@pytest.fixture(scope="module")
def written(motion: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Results with external loads and maps."""
    found = gc.knee.settle(
        FEMUR, INSERT, unit="mm", motion=motion, side="right", load=1800.0, bodies=BODIES, paraview=True, **LAYER
    )
    return found.write(tmp_path_factory.mktemp("settled") / "out")


def test_every_frame_is_at_rest_under_the_load(written: Path) -> None:
    table = pd.read_csv(written / "settle.csv")
    assert len(table) == 3 and (table["residual [N]"] < 2e-3 * 1800).all()
    np.testing.assert_allclose(table["force_total [N]"], 1800.0, rtol=2e-3)
    np.testing.assert_allclose(table["force_medial [N]"] + table["force_lateral [N]"], table["force_total [N]"])
    assert (table[["force_medial [N]", "force_lateral [N]"]] > 400.0).all().all()
    for name in ("report.html", "settle.svg", "paraview/both.pvd", "paraview/frames/fixed_002.vtp", "run.json"):
        assert (written / name).stat().st_size > 0


def test_area_reads_the_poses_again(written: Path) -> None:
    """Rows of poses.csv and knee angles of settled.mot are the same poses."""
    rows = read_motion(written / "poses.csv")
    knee = read_motion(written / "settled.mot", grood_suntay_side="right", moving="parent")
    np.testing.assert_allclose(knee.poses.translation, rows.poses.translation, atol=1e-8)
    assert (knee.poses.rotation.inv() * rows.poses.rotation).magnitude().max() < 1e-8


def test_opensim_applies_the_forces_of_the_table(written: Path, opensim: Elsewhere) -> None:
    """Equal and opposite on both bodies, at the centre of pressure, in FIXED's frame."""
    table = pd.read_csv(written / "settle.csv")
    time = float(table["time [s]"][1])
    found = opensim(external_wrenches, KNEE, written / "contact_loads.xml", time)
    for side in ("medial", "lateral"):
        body, frame, numbers = found[f"contact_{side}_force"]
        other, back_frame, back = found[f"contact_back_{side}_force"]
        assert (body, other, frame, back_frame) == (BODIES[1], BODIES[0], BODIES[1], BODIES[1])
        assert numbers[0, 1] == pytest.approx(-table[f"force_{side} [N]"][1], rel=1e-8)
        centre = [table[f"cop_{side}_{axis} [mm]"][1] * 1e-3 for axis in "xyz"]
        np.testing.assert_allclose(numbers[1], centre, atol=1e-9)
        np.testing.assert_allclose(back, numbers * [[-1.0], [1.0], [-1.0]], rtol=1e-9, atol=1e-12)


def refused(job: Job, *meshes: Path, **options: object) -> str:
    with pytest.raises(InputError) as error:
        job(*meshes, unit="mm", side="right", **{**LAYER, **options})
    return str(error.value)


def test_a_unit_for_each_body_gives_the_same_rest(motion: Path, tmp_path: Path) -> None:
    """The point of the load is MOVING's, in its unit; the splitting plane and the region are FIXED's."""
    given = {"motion": motion, "side": "right", "load": 1800.0, "region": "ny>0.25", "piece": gc.mm(1), **LAYER}
    expected = gc.knee.settle(FEMUR, INSERT, unit="mm", split="z=1", load_point="0,5,1", **given).table()
    femur = in_metres(tmp_path, FEMUR)
    ours = gc.knee.settle(
        femur, INSERT, unit="mm", unit_moving="m", split="z=1", load_point="0,0.005,0.001", **given
    ).table()
    pd.testing.assert_frame_equal(ours, expected)
    with pytest.raises(InputError, match=r"femoral.*: bounding box .*, pass `unit_moving` m$"):
        gc.knee.settle(femur, INSERT, unit="mm", unit_moving="cm", **given)


def test_what_nothing_holds_is_refused_by_name(tmp_path: Path) -> None:
    """A ball on a plate rolls and slides; a spring holds what it is for."""
    over = poses(tmp_path, (0, 40, 0))
    given = {"motion": over, "load": 500.0, "region": "ny>0.9"}
    line = refused(gc.knee.settle, SPHERE, PLATE, free=("anterior", "rotation"), **given)
    assert "nothing holds anterior and rotation" in line and "`springs`" in line
    held = gc.knee.settle(
        SPHERE, PLATE, unit="mm", side="right", free=("anterior",), springs={"anterior": 1e4}, **LAYER, **given
    )
    assert abs(held.table()["anterior [mm]"][0]) < 0.1


def test_bodies_that_miss_each_other_are_told(tmp_path: Path) -> None:
    line = refused(gc.knee.settle, SPHERE, PLATE, motion=poses(tmp_path, (400, 40, 0)), load=500.0)
    assert "no contact found" in line and "region" in line
    some = poses(tmp_path, (0, 40, 0), (400, 40, 0), name="some.csv")
    with pytest.warns(InputWarning, match=r"1 of 2 frames: no contact found \(at 1 s\)"):
        found = gc.knee.settle(SPHERE, PLATE, unit="mm", side="right", motion=some, load=500.0, free=(), **LAYER)
    assert found.table()["force_total [N]"].isna().tolist() == [False, True]


def test_a_sweep_needs_no_recorded_poses() -> None:
    """A ball lies on the plate wherever it turns to; the flexion is that asked for, the other turns are 0."""
    found = gc.knee.settle(
        SPHERE, PLATE, unit="mm", side="right", sweep=("flexion", *gc.deg(0, 30, 15)), load=500.0, free=(), **LAYER
    )
    table = found.table()
    np.testing.assert_allclose(table["flexion [deg]"], [0.0, 15.0, 30.0], atol=1e-6)
    np.testing.assert_allclose(table[["adduction [deg]", "rotation [deg]", "anterior [mm]"]], 0.0, atol=1e-6)
    np.testing.assert_allclose(table["force_total [N]"], 500.0, rtol=2e-3)
    assert table["axial [mm]"].between(19.5, 20.0).all()
    np.testing.assert_allclose(found.force["total"], table["force_total [N]"])
    np.testing.assert_allclose(1e6 * found.area, table["contact_area [mm^2]"])
    np.testing.assert_allclose(1e-6 * found.pressure, table["peak [MPa]"])


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({}, "one says the axial load"),
        ({"load": 500.0, "sweep": ("flexion", *gc.deg(0, 30, 15))}, "exactly one says how it flexes"),
        ({"load": 500.0, "motion": None, "sweep": ("turn", *gc.deg(0, 30, 15))}, "'turn' does not sweep"),
        ({"load": 500.0, "free": ("flexion",)}, "'flexion' is none of"),
        ({"load": 500.0, "springs": {"anterior": 1e4}}, "anterior is held"),
        ({"load": 500.0, "split": "x"}, "does not lie across z"),
    ],
)
def test_refused_before_a_file_is_read(options: dict[str, object], words: str) -> None:
    assert words in refused(gc.knee.settle, FEMUR, INSERT, **{"motion": GAIT, **options})


def test_the_command_takes_springs_and_no_free_coordinates(motion: Path, tmp_path: Path) -> None:
    command = ["knee", "settle", str(FEMUR), str(INSERT), "--unit", "mm", "--motion", str(motion), "--side", "right"]
    command += ["--load", "900", "--modulus", "463MPa", "--poisson", "0.46", "--piece", "1mm"]
    springs, out = ["--free", "anterior,rotation", "--springs", "anterior=30,rotation=0.36"], tmp_path / "out"
    result = done(call(*command, *springs, "--out", out, folder=out))
    options = result.record()["options_si"]
    assert options["free"] == ["anterior", "rotation"] and options["springs"]["anterior"] == 30e3


def test_the_area_at_rest_is_in_the_range_of_films(tmp_path: Path) -> None:
    """2000 N on the shipped knee: 80 to 154 mm^2 were measured on seven implants with Fuji film at 0, 15 and 60 deg."""
    layer = {**LAYER, "region": "ny>0.25", "piece": gc.mm(1)}
    first = gait(tmp_path, (0,))
    found = gc.knee.settle(
        FEMUR, INSERT, unit="mm", motion=first, side="right", load=2000.0, compare="literature", **layer
    )
    film = found.table("literature").set_index("published").loc["film 1995, seven implants"]
    assert film["comparable"] == "yes" and 80.0 < film["ours [mm^2]"] < 154.0
    assert film["ours [mm^2]"] == pytest.approx(1e6 * found.area.mean())


@pytest.mark.slow
def test_the_error_of_the_pose_reaches_the_medial_share(tmp_path: Path) -> None:
    """With adduction held 0.02 deg off the share is that of poses that are so by themselves: quantiles of 20 runs."""
    layer = {**LAYER, "piece": gc.mm(2), "unit": "mm", "side": "right", "load": 1500.0}
    balanced = gc.knee.settle(FEMUR, INSERT, motion=gait(tmp_path, (0,)), free=("adduction",), **layer)
    first = tmp_path / "balanced.csv"
    balanced.table("poses").to_csv(first, index=False)
    layer["free"] = ()
    sd = (0.0, 0.0, 0.0, gc.deg(0.02), 0.0, 0.0)
    found = gc.knee.settle(FEMUR, INSERT, motion=first, pose_sd=sd, draws=20, **layer)
    (row,) = found.table("settle_error").to_dict(orient="records")
    pose = read_motion(first).poses[0]
    shares = []
    for turn in np.random.default_rng(1).standard_normal((20, 6))[:3, 3] * sd[3]:
        rotation = Rotation.from_rotvec([turn, 0.0, 0.0]) * pose.rotation
        w = rotation.as_quat(scalar_first=True)
        moved = tmp_path / "moved.csv"
        cells = ",".join(f"{each:.12g}" for each in (0.0, *(1e3 * pose.translation), *w))
        moved.write_text(f"time [s],tx [mm],ty [mm],tz [mm],qw,qx,qy,qz\n{cells}\n")
        alone = gc.knee.settle(FEMUR, INSERT, motion=moved, **layer)
        shares.append(float(alone.force["medial"][0] / alone.force["total"][0]))
    assert found.pose_error is not None and found.pose_error.share is not None
    np.testing.assert_allclose(found.pose_error.share[0, :3], shares, atol=2e-4)
    low, high = np.quantile(found.pose_error.share[0], (0.025, 0.975))
    assert (row["medial_share_lower [-]"], row["medial_share_upper [-]"]) == pytest.approx((low, high))
    assert high - low > 0.02 and "% of the force medial where the load is largest" in str(found)
