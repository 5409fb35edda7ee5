"""Recordings that do not fit into one part: the same results to the last digit, and files that stay small."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import RigidTransform, Rotation

import geocontact as gc
from geocontact.analyses.cop.result import CopResult
from geocontact.data import frame_blocks
from geocontact.data.errors import InputError
from geocontact.loads import resultant
from geocontact.loads.resultant import pose_rate
from tests.analyses.loadcells.synthetic_walk import recorded
from tests.cli.calls import written

COUNT = 400
TIME = 0.01 * np.arange(COUNT)
STEP = np.maximum(np.sin(2.0 * np.pi * TIME), -0.2)
SPHERES = "px [m], py [m], pz [m], radius [m], zone\n0,0,0,0.02,heel\n0.2,0,0.03,0.02,toe\n0.2,0,-0.03,0.02,toe\n"
LAW = {
    "stiffness": 5e5,
    "exponent": 1.5,
    "damping": 100.0,
    "friction": (0.8, 0.6),
    "full_depth": gc.mm(2),
    "threshold_speed": 0.25,
}


def long_one(folder: Path, turned: str = "euler", **options: object) -> CopResult:
    """A foot that steps four times, slides and tilts, with damping and friction, without contact between steps."""
    folder.mkdir()
    written(folder / "spheres.csv", SPHERES)
    tilt = 0.5 * np.cos(2.0 * np.pi * TIME)
    columns = {"time [s]": TIME, "tx [mm]": 30.0 * TIME, "ty [mm]": 20.0 - 3.0 * STEP, "tz [mm]": 0.0 * TIME}
    if turned == "euler":
        columns |= {"rx [deg]": 0.0 * TIME, "ry [deg]": 2.0 * TIME, "rz [deg]": tilt}
        options["order"] = "XYZ"
    else:
        quaternion = Rotation.from_euler("z", tilt[:, None], degrees=True).as_quat(scalar_first=True)
        columns |= dict(zip(("qw", "qx", "qy", "qz"), quaternion.T, strict=True))
    pd.DataFrame(columns).to_csv(folder / "foot.csv", index=False)
    return gc.centre_of_pressure(folder / "spheres.csv", motion=folder / "foot.csv", **LAW, **options)


@pytest.mark.drawn
@pytest.mark.parametrize("turned", ["euler", "quaternion"])
@pytest.mark.parametrize("filtered", [False, True])
def test_parts_of_any_size_give_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, turned: str, filtered: bool
) -> None:
    """Parts of a few frames, in temporary files, beside the whole in memory: tables, page and drawing, bit by bit."""
    options: dict[str, object] = {"toe": "x", "stances": True, "gate": 20.0}
    if filtered:
        options |= {"force_cutoff": 20.0, "motion_cutoff": 20.0}
    found, drawn, mapped = [], [], len(frame_blocks._MAPPED)
    for at_once in (frame_blocks.AT_ONCE, 701):
        monkeypatch.setattr(frame_blocks, "AT_ONCE", at_once)
        made = long_one(tmp_path / f"in{at_once}", turned, **options)
        assert (len(frame_blocks._MAPPED) > mapped) == (at_once == 701)
        out = made.write(tmp_path / f"out{at_once}", parquet=True)
        drawn.append({file.name: file.read_bytes() for file in out.iterdir() if file.suffix in (".csv", ".png")})
        found.append((made.tables(), made.sentences))
    (whole, said), (parted, said_in_parts) = found
    assert set(whole) == {"cop", "zones", "along_foot", "stances"} == set(parted)
    for name, wanted in whole.items():
        pd.testing.assert_frame_equal(parted[name], wanted, check_exact=True)
    assert drawn[0] == drawn[1] and len(drawn[0]["cop.png"]) > 10_000
    assert said == said_in_parts


@pytest.mark.filterwarnings("ignore:ground.obj is open")
def test_parts_on_a_mesh_are_the_same_to_rounding(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A level sheet as the ground: spheres are grouped by what comes at once, so that the last digits differ."""
    corners = "\n".join(f"v {x} 0 {z}" for x, z in ((-1, -1), (1, -1), (1, 1), (-1, 1)))
    written(tmp_path / "ground.obj", f"{corners}\nf 1 3 2\nf 1 4 3\n")
    tables = []
    for at_once in (frame_blocks.AT_ONCE, 701):
        monkeypatch.setattr(frame_blocks, "AT_ONCE", at_once)
        tables.append(long_one(tmp_path / f"in{at_once}", ground=tmp_path / "ground.obj", unit="m").tables())
    plane = long_one(tmp_path / "plane").tables()["cop"]
    for name, wanted in tables[0].items():
        size = wanted.select_dtypes("number").abs().max()
        for column, most in size.items():
            np.testing.assert_allclose(tables[1][name][column], wanted[column], rtol=0, atol=1e-12 * most)
    np.testing.assert_allclose(tables[0]["cop"]["force_y [N]"], plane["force_y [N]"], rtol=1e-9, atol=1e-9)


def test_a_full_disk_is_said_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """InputError with the folder, wherever the last byte does not fit, and nothing more when the numbers are let go."""

    class Full:
        def write(self, _: object) -> int:
            return 0

        def flush(self) -> None:
            raise OSError(28, "No space left on device")

        close = flush

    class Near(list[float]):
        def tofile(self, _: object) -> None: ...

    growing = frame_blocks.Growing()
    growing._file = Full()  # type: ignore[assignment]
    growing._near = Near([1.0])  # type: ignore[assignment]
    with pytest.raises(InputError, match="TMPDIR"):
        growing._put_away()
    frame_blocks._close(growing._file)  # type: ignore[arg-type]


def test_loads_in_parts_are_those_of_numpy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Second derivation: level ground, k d^n (without damping and friction) and the weighted mean of the contacts."""
    monkeypatch.setattr(frame_blocks, "AT_ONCE", 701)
    monkeypatch.setitem(LAW, "damping", 0.0)
    monkeypatch.setitem(LAW, "friction", (0.0, 0.0))
    found = long_one(tmp_path / "in", "quaternion")
    turn = np.radians(0.5 * np.cos(2.0 * np.pi * TIME))
    centre = np.array([[0.0, 0.0], [0.2, 0.03], [0.2, -0.03]])
    x = 30e-3 * TIME[:, None] + centre[:, 0] * np.cos(turn)[:, None]
    height = (20.0 - 3.0 * STEP)[:, None] * 1e-3 + centre[:, 0] * np.sin(turn)[:, None]
    force = 5e5 * np.maximum(0.02 - height, 0.0) ** 1.5
    np.testing.assert_allclose(found.force[:, 1], force.sum(axis=1), rtol=1e-8, atol=1e-9)
    there = np.isfinite(found.centre_of_pressure[:, 0])
    assert 100 < there.sum() < COUNT
    mean = (force * x).sum(axis=1)[there] / force.sum(axis=1)[there]
    np.testing.assert_allclose(found.centre_of_pressure[there, 0], mean, rtol=1e-8)


def test_a_rate_in_windows_is_that_of_one_spline(monkeypatch: pytest.MonkeyPatch) -> None:
    """Uneven times, noise from frame to frame; the spline through all by scipy's other solver."""
    rng = np.random.default_rng(58)
    time = np.cumsum(rng.uniform(0.2, 3.0, 1000))
    poses = RigidTransform.from_components(rng.normal(size=(1000, 3)), Rotation.random(1000, rng=rng))
    monkeypatch.setattr(resultant, "WINDOW", 90)
    wanted = CubicSpline(time, poses.as_matrix()).derivative()(time)
    np.testing.assert_allclose(pose_rate(time, poses), wanted, rtol=1e-11, atol=1e-11)


def test_a_long_path_is_a_small_drawing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """More frames than dots: the outermost places of the path are drawn, and no more dots than wanted."""
    monkeypatch.setattr("geocontact.analyses.cop.figure.DOTS", 60)
    found = long_one(tmp_path / "in")
    axes = next(each for each in found.figures()["cop"].axes if "Centre of pressure seen" in each.get_title(loc="left"))
    dots = np.asarray(axes.collections[0].get_offsets())
    path = found.centre_of_pressure[np.isfinite(found.centre_of_pressure[:, 0])]
    assert 20 < len(dots) <= 60 < len(path)
    for column in dots.T:
        ends = np.array([column.min(), column.max()])
        assert any(np.allclose(ends, [each.min() * 1e3, each.max() * 1e3]) for each in path.T)


def test_load_cells_in_parts_are_the_same(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tables, mapped = [], len(frame_blocks._MAPPED)
    for at_once in (frame_blocks.AT_ONCE, 701):
        monkeypatch.setattr(frame_blocks, "AT_ONCE", at_once)
        result = gc.load_cells(recorded(tmp_path), unit="N", cycles="stride")
        assert (len(frame_blocks._MAPPED) > mapped) == (at_once == 701)
        out = result.write(tmp_path / f"out{at_once}")
        tables.append({file.name: file.read_bytes() for file in out.iterdir() if file.suffix == ".csv"})
        frames = result.tables()
        del result
    assert tables[0] == tables[1] and len(frames["forces"]) == 500
