"""Foam under the keel: closed forms of flat and tilted compression, and a heel strike integrated by hand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from math import cos, radians, sin, tan

import numpy as np
import pytest
from scipy.optimize import brentq, newton
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.design.drawn import finer_feet
from geocontact.below_knee_prosthesis.keel.compression import pressed_sole
from geocontact.below_knee_prosthesis.keel.foam import FoamNumbers, areas, cut_finer, foam_law, foam_numbers, foam_sole
from geocontact.below_knee_prosthesis.keel.foot import FootRecord, VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.keel.quasi_static import loads_at
from geocontact.below_knee_prosthesis.keel.sole import Foam
from geocontact.below_knee_prosthesis.keel.vsf import vsf_keel, vsf_on_foam
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.ground import Stairs
from geocontact.loads.resultant import pose_rate
from geocontact.loads.sphere_set import SphereSet

FLOOR = HalfSpace()
BREADTH, BELOW, LONG = 0.055, 0.032, 0.229
HEEL = FoamNumbers(thickness=0.024, modulus=0.31e6, retardation=0.013, static=0.5, kinetic=0.5)
FORE = FoamNumbers(thickness=0.017, modulus=0.83e6, retardation=0.006, static=0.5, kinetic=0.5)
CUT = 0.093
"""m; where the heel ends."""
FULL, CREEP = 1.5e-3, 0.02


def foot(column: float, across: int = 2, *, exponent: float = 1.0, keel: Keel | None = None) -> VariableStiffnessFoot:
    keel = replace(vsf_keel(), bending=1e9, torsional=1e9) if keel is None else keel
    foam = Foam(BREADTH, column, across, (("heel", CUT), ("fore", LONG)))
    sole = foam_sole(keel, foam, BELOW, {"heel": HEEL.thickness, "fore": FORE.thickness})
    law = foam_law(sole, {"heel": HEEL, "fore": FORE}, exponent, FULL, CREEP)
    return VariableStiffnessFoot(keel, sole, law, FootRecord("foam", BELOW))


def placed(height: float, pitch: float = 0.0, roll: float = 0.0) -> RigidTransform:
    turn = Rotation.from_euler("zx", [[pitch, roll]])
    return RigidTransform.from_components(np.array([[0.0, height, 0.0]]), turn)


def test_columns_fill_the_sole() -> None:
    for column in (7e-3, 3e-3):
        sole = foot(column, 3).sole
        assert areas(sole).sum() == pytest.approx(LONG * BREADTH, rel=1e-12)
        heel = np.array(sole.spheres.zone) == "heel"
        assert areas(sole)[heel].sum() == pytest.approx(CUT * BREADTH, rel=1e-12)
        steps = np.diff(np.unique(sole.spheres.centre[:, 0]))
        assert steps.max() < 1.2 * column and steps.min() > 0.8 * column


@pytest.mark.parametrize("exponent", [1.0, 1.7])
def test_flat_compression_is_the_closed_form(exponent: float) -> None:
    """F = b (E1 (d/h1)^n l1 + E2 (d/h2)^n l2), and its centre, at any cut."""
    deep = 4e-3
    own = [(HEEL, 0.0, CUT), (FORE, CUT, LONG)]
    forces = [each.modulus * (deep / each.thickness) ** exponent * BREADTH * (b - a) for each, a, b in own]
    centre = sum(f * 0.5 * (a + b) for f, (_, a, b) in zip(forces, own, strict=True)) / sum(forces)
    for column, across in ((20e-3, 1), (4e-3, 3)):
        moved = (
            foot(column, across, exponent=exponent).at(0.1).solve(placed(BELOW - deep), FLOOR, gravity=(0.0, 0.0, 0.0))
        )
        assert moved.force[0, 1] == pytest.approx(sum(forces), rel=1e-4)  # the keel bends a little
        pressing = moved.loads.pressing[0]
        assert pressing @ moved.loads.point[0, :, 0] / pressing.sum() == pytest.approx(centre, rel=1e-3)


def wedge(tilt: float, travel: float) -> float:
    """Force along y [N] of a plate tilted by `tilt`, that moved so far along y from the tip, n = 1, rigid keel.

    Depth along the normal at s behind the tip: travel cos(tilt) - s sin(tilt).
    """
    deep, long = travel * cos(tilt), min(travel / tan(tilt), LONG - CUT)
    area = deep * long - 0.5 * sin(tilt) * long**2
    return FORE.modulus / FORE.thickness * BREADTH * area * cos(tilt)


def test_a_tilted_plate_is_the_integral_and_columns_converge_to_it() -> None:
    """Errors come from the column that the wedge ends in: they fall with the square of its breadth."""
    tilt, travel, off = radians(20.0), 5e-3, []
    for column in (8e-3, 2e-3, 0.5e-3):
        one = foot(column, 1)
        lowest = 0.5 * float(np.diff(np.unique(one.sole.spheres.centre[:, 0]))[-1]) * tan(tilt)
        force = pressed_sole(one.keel, 0.1, one.sole, one.law, np.array([travel - lowest]), tilt=tilt)[0]
        off.append(abs(force / wedge(tilt, travel) - 1.0))
    assert 0.01 < off[0] < 0.2 and off[1] < off[0] / 4.0 and off[2] < 1e-3


def test_a_rolled_foot_has_the_moment_of_the_whole_breadth_at_many_columns() -> None:
    """M = roll b³/12 times E l / h of both zones; two columns have three quarters of it."""
    roll, deep = 0.02, 4e-3
    stiff = sum(each.modulus / each.thickness * long for each, long in ((HEEL, CUT), (FORE, LONG - CUT)))
    whole = roll * BREADTH**3 / 12.0 * stiff
    for across, share in ((2, 0.75), (12, 1.0)):
        moved = foot(30e-3, across).at(0.1).solve(placed(BELOW - deep, roll=roll), FLOOR)
        pressing = moved.loads.pressing[0]
        side = moved.loads.point[0, :, 2]
        assert abs(pressing @ (side - side.mean())) == pytest.approx(share * whole, rel=0.02)


def heel_strike(time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pitch, and height of the keel's posterior end: lands on its heel, rolls flat and on to the toes."""
    share = time / time[-1]
    pitch = radians(17.0) - radians(37.0) * share**1.3
    deep = 6e-3 * np.sin(np.pi * share) ** 2 - 0.5e-3
    along = np.where(pitch > 0.0, 0.0, LONG)
    return pitch, BELOW * np.cos(pitch) - along * np.sin(pitch) - deep


def by_hand(
    one: VariableStiffnessFoot, motion: Callable[[float], tuple[np.ndarray, np.ndarray]], time: np.ndarray
) -> np.ndarray:
    """Forward and upward force [N] of a keel of one joint, by backward Euler steps from the second time on."""
    keel, x, z = one.keel, one.sole.spheres.centre[:, 0], one.sole.foam
    assert z is not None
    heel = x < CUT
    strip = np.where(heel, CUT / heel.sum(), (LONG - CUT) / (~heel).sum()) * BREADTH
    modulus, thick = np.where(heel, HEEL.modulus, FORE.modulus), np.where(heel, HEEL.thickness, FORE.thickness)
    tau = np.where(heel, HEEL.retardation, FORE.retardation)
    joint, stiff = keel.posterior, float(keel.stiffness(0.1)[0])
    mass, arm = keel.segment_mass, 0.5 * (keel.length - keel.posterior)
    front = x > joint

    def forces(t: float, angle: float, speed: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
        (px, py, pitch), (vx, vy, spin) = motion(t)
        jx, jy = px + joint * cos(pitch), py + joint * sin(pitch)
        ux, uy = vx - spin * (jy - py), vy + spin * (jx - px)
        turn = np.where(front, pitch + angle, pitch)
        rx = np.where(front, x - joint, x) * np.cos(turn) + BELOW * np.sin(turn)
        ry = np.where(front, x - joint, x) * np.sin(turn) - BELOW * np.cos(turn)
        fast = np.where(front, spin + speed, spin)
        cx, cy = np.where(front, jx, px) + rx, np.where(front, jy, py) + ry
        slide, rise = np.where(front, ux, vx) - fast * ry, np.where(front, uy, vy) + fast * rx
        deep = np.maximum(-cy, 0.0)
        gate = np.minimum(deep / FULL, 1.0)
        up = strip * modulus / thick * (deep + tau * np.maximum(-rise, 0.0) * gate**2 * (3.0 - 2.0 * gate))
        up = np.where(deep > 0.0, up, 0.0)
        along = -up * HEEL.kinetic * np.clip(slide / CREEP, -1.0, 1.0)
        about = ((cx - jx) * up + cy * 0.0 * along - (0.0 - jy) * along)[front].sum()
        about -= mass * 9.80665 * arm * cos(pitch + angle)
        return along, up, cx, float(about)

    rows, angle = [], brentq(lambda a: forces(time[0], a, 0.0)[3] - stiff * a, -0.5, 0.5, xtol=1e-12)
    for before, now in pairwise(time):
        step, last = now - before, angle

        def left(a: float, t: float = now, last: float = last, step: float = step) -> float:
            speed = (a - last) / step
            return forces(t, a, speed)[3] - stiff * a - keel.retardation * stiff * speed

        angle = newton(left, last, tol=1e-10)
        along, up, *_ = forces(now, angle, (angle - last) / step)
        rows.append((along.sum(), up.sum()))
    return np.array(rows)


def test_a_heel_strike_that_rolls_on_is_the_one_integrated_by_hand() -> None:
    """A keel of one joint with damping, foam with damping and friction; only the keel's numbers are shared."""
    keel = replace(vsf_keel(joints=1), retardation=0.02)
    one = foot(6e-3, 1, keel=keel)
    time = np.linspace(0.0, 0.35, 1401)
    pitch, height = heel_strike(time)
    ahead = 0.03 * np.sin(9.0 * time)
    turn = Rotation.from_euler("z", pitch[:, None])
    poses = RigidTransform.from_components(np.column_stack([ahead, height, 0.0 * time]), turn)
    rates = np.stack([np.gradient(each, time, edge_order=2) for each in (ahead, height, pitch)])
    places = np.stack([ahead, height, pitch])

    def motion(t: float) -> tuple[np.ndarray, np.ndarray]:
        return tuple(np.array([np.interp(t, time, row) for row in rows]) for rows in (places, rates))  # type: ignore[return-value]

    moved = one.at(0.1).solve(poses, FLOOR, rate=pose_rate(time, poses), time=time)
    expected = by_hand(one, motion, time)
    assert expected[:, 1].max() > 300.0 and np.ptp(expected[:, 0]) > 100.0
    off = moved.force[1:, :2] - expected
    assert np.sqrt(np.mean(off**2, axis=0)).max() < 0.003 * expected[:, 1].max()


def test_a_law_becomes_its_numbers_again() -> None:
    one = foot(5e-3, 2, exponent=1.4)
    found = foam_numbers(one.sole, one.law)
    for zone, own in (("heel", HEEL), ("fore", FORE)):
        for name, value in vars(own).items():
            assert getattr(found[zone], name) == pytest.approx(value, rel=1e-12)


def test_finer_columns_are_the_same_foam() -> None:
    one = foot(8e-3, 2)
    finer = cut_finer(one, 4)
    assert foam_numbers(finer.sole, finer.law)["heel"].modulus == pytest.approx(HEEL.modulus, rel=1e-12)
    assert areas(finer.sole).sum() == pytest.approx(areas(one.sole).sum(), rel=1e-12)
    assert [len(each.sole.spheres) for each in finer_feet(one, 2)] == [
        len(one.sole.spheres),
        len(cut_finer(one, 2).sole.spheres),
    ]
    flat = [each.at(0.1).solve(placed(BELOW - 3e-3), FLOOR).force[0, 1] for each in (one, finer)]
    assert flat[1] == pytest.approx(flat[0], rel=1e-3)


def test_uneven_ground_presses_foam_as_a_plane_does() -> None:
    """A tread of stairs at 0 in place of the floor; a sphere's depth was limited by its radius there."""
    one = foot(9e-3).at(0.1)
    poses, rate = placed(BELOW - 5e-3), np.zeros((1, 4, 4))
    angles = np.zeros((1, one.keel.joints))
    floor = loads_at(one, angles, angles, poses, rate, FLOOR)
    tread = loads_at(one, angles, angles, poses, rate, Stairs((3.0,), (0.0, 0.2)))
    np.testing.assert_allclose(tread.force, floor.force, atol=1e-9)
    assert floor.force[..., 1].sum() > 100.0
    with pytest.raises(ValueError, match="column of foam 1 is deeper under the ground than any thickness"):
        loads_at(one, angles, angles, placed(BELOW - 0.03), rate, Stairs((3.0,), (0.0, 0.2)))


def test_the_shipped_foot_on_foam_meets_its_compressions_and_stands_up_to_spheres() -> None:
    one = vsf_on_foam(8e-3, 1)
    for name, stiffness in (("low", 10e3), ("medium", 19e3), ("high", 32e3)):
        force = pressed_sole(one.keel, one.record.settings[name], one.sole, one.law, np.array([5e-3]))[0]
        assert force / 5e-3 == pytest.approx(stiffness, rel=0.02)
    assert one.record.origin["sole forefoot_modulus"].source == "derived"


def test_refused() -> None:
    with pytest.raises(ValueError, match="foam needs a positive thickness"):
        SphereSet(np.zeros((1, 3)), np.ones(1), ("a",), np.zeros(1))
