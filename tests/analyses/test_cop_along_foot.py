"""The centre of pressure along the foot, filters, and stances: closed forms of a foot with two spheres."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

import geocontact as gc
from geocontact.analyses.cop.foot import smoothed_motion
from geocontact.analyses.cop.page import cop_page
from geocontact.analyses.cop.result import CopResult
from geocontact.data.errors import InputError
from geocontact.data.motion import Motion
from geocontact.identify.signals.filters import zero_lag
from geocontact.view.page.content import Curves, Picture
from tests.cli.calls import written

LAW = {"stiffness": 5e5, "exponent": 1.0, "damping": 0.0, "friction": (0.0, 0.0)}
HEAD = "px [m], py [m], pz [m], radius [m], zone"
RATE = 200.0


def walked(folder: Path, motion: np.ndarray, time: np.ndarray | None = None, **options: object) -> CopResult:
    """Heel and toe spheres of 20 mm at 0 and 200 mm; `motion` has columns x, y [m] and pitch [rad]."""
    sole = written(folder / "spheres.csv", f"{HEAD}\n0,0,0,0.02,heel\n0.2,0,0.03,0.02,toe\n")
    time = np.arange(len(motion)) / RATE if time is None else time
    rows = "\n".join(f"{t:.9g},{x:.12g},{y:.12g},{p:.12g},0,0,0" for t, (x, y, p) in zip(time, motion, strict=True))
    names = "time [s],tx [m],ty [m],rz [rad],tz [m],rx [rad],ry [rad]"
    moved = written(folder / "motion.csv", f"{names}\n{rows}\n")
    return gc.centre_of_pressure(sole, motion=moved, order="XYZ", **{**LAW, **options})


def test_both_points_by_name_and_as_a_share_of_the_foot(tmp_path: Path) -> None:
    """Pitch a: heel at depth d, toe at d - 0.2 sin a; the ground point of a centre is r sin a behind it."""
    pitch, deep = np.linspace(-0.004, 0.004, 9), 2e-3
    motion = np.column_stack([np.linspace(0.0, 3.0, 9), np.full(9, 0.02 - deep), pitch])
    found = walked(tmp_path, motion, toe="x").table("along_foot")
    depth = np.column_stack([np.full(9, deep), deep - 0.2 * np.sin(pitch)])
    centre = depth @ [0.0, 0.2] / depth.sum(axis=1) + 0.02
    share = depth / depth.sum(axis=1, keepdims=True)
    height = (share * (0.02 - depth)).sum(axis=1)
    np.testing.assert_allclose(found["sphere_centre [mm]"], 1e3 * centre, atol=1e-8)
    np.testing.assert_allclose(found["ground_point [mm]"], 1e3 * (centre - height * np.sin(pitch)), atol=1e-8)
    np.testing.assert_allclose(found["sphere_centre_share [-]"], centre / 0.24, atol=1e-11)
    longer = walked(tmp_path, motion, toe="x", foot_length=0.3).table("along_foot")
    np.testing.assert_allclose(longer["sphere_centre_share [-]"], centre / 0.3, atol=1e-11)
    back = walked(tmp_path, motion, toe="-x").table("along_foot")
    np.testing.assert_allclose(back["sphere_centre_share [-]"], 1.0 - centre / 0.24, atol=1e-11)


def bounced(time: np.ndarray) -> np.ndarray:
    """Two stances of a foot that goes up and down at 1 Hz, level."""
    up = 0.021 - 3e-3 * np.sin(2.0 * np.pi * time)
    return np.column_stack([0.0 * time, up, 0.0 * time])


def test_stances_run_from_gate_to_gate(tmp_path: Path) -> None:
    """2 k d with d = 3 mm sin - 1 mm: above 100 N where d > 0.1 mm."""
    time = np.arange(0.0, 2.0, 1.0 / RATE)
    found = walked(tmp_path, bounced(time), gate=100.0, stances=True, toe="x")
    table = found.table("stances")
    assert len(table) == 2 * 101 and table["stance [-]"].unique().tolist() == [1, 2]
    rise = np.arcsin(1.1 / 3.0) / (2.0 * np.pi)
    for number, one in table.groupby("stance [-]"):
        times = one["time [s]"].to_numpy()
        np.testing.assert_allclose(times, number - 1 + np.linspace(rise, 0.5 - rise, 101), atol=2e-4)
        load = 1e6 * (3e-3 * np.sin(2.0 * np.pi * times) - 1e-3)
        np.testing.assert_allclose(one["normal [N]"], load, atol=2.0)
        assert one["cycle [%]"].tolist() == list(range(101))
    inside = table["ground_point_share [-]"].to_numpy()[2:99]
    np.testing.assert_allclose(inside, 0.5, atol=1e-9)
    sections = cop_page(found).sections
    over = [s for s in sections if isinstance(s, Curves) and s.over is not None]
    assert [s.title for s in over] == ["Normal force over the stance", "Centre from the heel over the stance"]
    assert not any(isinstance(s, Picture) for s in sections)
    (curve,) = [s for s in sections if isinstance(s, Curves) and "along the foot" in s.title]
    assert curve.unit == "% of foot length" and np.nanmax(curve.curves[0].values) == pytest.approx(50.0)


def test_a_recording_without_a_stance_is_told_of(tmp_path: Path) -> None:
    with pytest.warns(gc.InputWarning, match="no complete stance"):
        found = walked(tmp_path, np.tile([0.0, 0.018, 0.0], (9, 1)), stances=True)
    assert len(found.table("stances")) == 0


def test_filters_take_the_noise_and_leave_the_motion(tmp_path: Path) -> None:
    """Forces are those of the filtered height; a filter of forces acts on force and moment, the centre follows."""
    time = np.arange(0.0, 2.0, 1.0 / RATE)
    noisy = np.column_stack([0.0 * time, 0.017 + 3e-4 * np.sin(2.0 * np.pi * 60.0 * time), 2e-3 * np.sin(7.0 * time)])
    calm = noisy.copy()
    calm[:, 1:2] = zero_lag(noisy[:, 1:2], 1.0 / RATE, 6.0)
    plain, filtered = walked(tmp_path, noisy), walked(tmp_path, noisy, motion_cutoff=6.0)
    wanted = walked(tmp_path, calm)
    rough, smooth = (np.abs(np.diff(each.centre.pressing[50:-50])).max() for each in (plain, filtered))
    assert rough > 20.0 * smooth
    np.testing.assert_allclose(filtered.centre.pressing, wanted.centre.pressing, rtol=2e-3)
    forces = walked(tmp_path, noisy, force_cutoff=40.0)
    raw = plain.centre
    load = zero_lag(raw.pressing, 1.0 / RATE, 40.0)
    np.testing.assert_allclose(forces.centre.pressing, load, rtol=1e-12)
    moment = zero_lag(raw.pressing[:, None] * raw.centre, 1.0 / RATE, 40.0)
    np.testing.assert_allclose(forces.centre.centre, moment / load[:, None], atol=1e-12)
    np.testing.assert_allclose(sum(forces.zones.values()), load, rtol=1e-12)


def test_a_filtered_motion_does_not_depend_on_the_frame(tmp_path: Path) -> None:
    """Poses in another frame of the ground are filtered to the same poses."""
    rng, time = np.random.default_rng(2), np.arange(0.0, 1.0, 0.01)
    turns = Rotation.from_rotvec(0.1 * rng.normal(size=(100, 3)))
    poses = RigidTransform.from_components(rng.normal(size=(100, 3)), turns)
    other = RigidTransform.from_components([1.0, -2.0, 0.5], Rotation.from_rotvec([0.3, 2.0, -1.0]))
    here = smoothed_motion(Motion(time, poses), 6.0, tmp_path).poses
    there = smoothed_motion(Motion(time, other * poses), 6.0, tmp_path).poses
    np.testing.assert_allclose((other * here).as_matrix(), there.as_matrix(), atol=1e-12)


def test_uneven_times_are_refused(tmp_path: Path) -> None:
    time = np.array([0.0, 0.005, 0.010, 0.030, *np.arange(0.035, 0.2, 0.005)])
    with pytest.raises(InputError, match="not evenly spaced"):
        walked(tmp_path, np.tile([0.0, 0.018, 0.0], (len(time), 1)), time, motion_cutoff=6.0)
