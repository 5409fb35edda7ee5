"""Loads of a person's joints, an arm that keeps its torque, and sway, beside pendulums by hand."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

from geocontact.data.body_segments import body_segments
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion, Side
from geocontact.shoulder_exoskeleton.device import Wearer, lucy
from geocontact.shoulder_exoskeleton.device_frame import DeviceFrame
from geocontact.shoulder_exoskeleton.human_arm import ArmTrack, HandLoad
from geocontact.shoulder_exoskeleton.joint_loads import Load, arm_needs, bending_torque, raising_torque
from geocontact.shoulder_exoskeleton.simulate import ArmSimulation, simulate_arm
from geocontact.shoulder_exoskeleton.sway import GRAVITY, InvertedPendulum
from geocontact.shoulder_exoskeleton.torque_kept import LeavesAtOnceError, TorqueKept, torque_kept

MASS, SEX = 80.0, "male"
DOWN = np.array([0.0, 0.0, -9.81])
SHARES = {"upper_arm": (0.0271, 0.5772, 0.285, 0.269), "forearm": (0.0162, 0.4574, 0.276, 0.265)}
SHARES |= {"hand": (0.0061, 0.7900, 0.628, 0.513)}
"""De Leva's man, copied: mass, centre, radii about the sagittal and the transverse axis."""
LENGTHS = {"upper_arm": 0.29, "forearm": 0.26, "hand": 0.08}
SHOULDER = np.array([-0.2, -0.12, -0.02])


def straight(time: np.ndarray, angle: np.ndarray, side: Side = "right") -> ArmTrack:
    """A straight arm in the sagittal plane of a trunk that stands still: forwards is -y."""
    along = np.column_stack([0.0 * angle, -np.sin(angle), -np.cos(angle)])
    place = SHOULDER * ([1.0, 1.0, 1.0] if side == "right" else [-1.0, 1.0, 1.0])
    ends = np.cumsum([0.0, *LENGTHS.values()])
    joints = [place + end * along for end in ends]
    return ArmTrack(side, time, *joints, np.tile([0.0, 0.0, -1.0], (len(time), 1)))


def pendulum(tool: float = 0.0) -> tuple[float, float]:
    """First moment [kg m] and moment of inertia about the shoulder [kg m²] of that arm."""
    start, first, second = 0.0, 0.0, 0.0
    for name, (share, centre, sagittal, transverse) in SHARES.items():
        m, own = share * MASS, LENGTHS[name]
        at = start + centre * own
        first += m * at
        second += m * (at**2 + 0.5 * (sagittal**2 + transverse**2) * own**2)
        start += own
    return first + tool * start, second + tool * start**2


def test_a_swinging_arm_needs_what_a_pendulum_needs() -> None:
    """I θ'' + S g sin θ, with a tool, and the moment of a push; the elbow has forearm, hand and tool."""
    time = np.arange(201) * 0.01
    angle = 0.9 + 0.5 * np.sin(2.0 * time)
    bend = -4.0 * 0.5 * np.sin(2.0 * time)
    track = straight(time, angle)
    first, second = pendulum(1.3)
    hand = HandLoad(1.3, np.tile([0.0, 0.0, 20.0], (len(time), 1)))
    found = raising_torque(track, arm_needs(track, hand, mass=MASS, segments=body_segments(SEX), gravity=DOWN))
    reach = sum(LENGTHS.values())
    np.testing.assert_allclose(found, second * bend + (first * 9.81 + 20.0 * reach) * np.sin(angle), atol=2e-3)


def test_a_cuff_takes_its_moment_from_the_shoulder_and_nothing_from_the_elbow() -> None:
    time = np.arange(51) * 0.01
    still = np.full(51, 1.0)
    track = straight(time, still)
    up = np.array([0.0, 0.0, 1.0])
    bent = replace(track, wrist=track.elbow + 0.26 * up, hand=track.elbow + 0.34 * up)
    needs = arm_needs(bent, HandLoad(0.0, np.zeros((51, 3))), mass=MASS, segments=body_segments(SEX), gravity=DOWN)
    assert bending_torque(bent, needs) == pytest.approx(np.zeros(51), abs=1e-9)  # straight above the elbow
    across = np.tile([0.0, -np.cos(1.0), np.sin(1.0)], (51, 1))
    cuff = Load(30.0 * across, track.shoulder + 0.2 * (track.elbow - track.shoulder) / 0.29, np.zeros((51, 3)))
    less = raising_torque(bent, needs) - raising_torque(bent, needs, cuff)
    np.testing.assert_allclose(less, 6.0, atol=1e-9)


def test_a_level_forearm_bends_its_elbow_with_its_weight() -> None:
    time = np.arange(51) * 0.01
    track = straight(time, np.zeros(51) + 0.3)
    level = np.array([0.0, -1.0, 0.0])
    wrist = track.elbow + 0.26 * level
    bent = replace(track, wrist=wrist, hand=wrist + 0.08 * level)
    needs = arm_needs(bent, HandLoad(2.0, np.zeros((51, 3))), mass=MASS, segments=body_segments(SEX), gravity=DOWN)
    weight = MASS * (0.0162 * 0.4574 * 0.26 + 0.0061 * (0.26 + 0.79 * 0.08)) + 2.0 * 0.34
    np.testing.assert_allclose(bending_torque(bent, needs), 9.81 * weight, atol=1e-9)


@cache
def kept(side: Side = "right", level: float = 0.3) -> tuple[ArmSimulation, ArmTrack, TorqueKept]:
    """A straight arm that is raised slowly to 50 degrees, in the device."""
    time = np.arange(151) * 0.01
    x = np.clip(time / 1.5, 0.0, 1.0)
    angle = 0.15 + 0.7 * x**3 * (10.0 - 15.0 * x + 6.0 * x**2)
    track = straight(time, angle, side)
    along = (track.elbow - track.shoulder) / LENGTHS["upper_arm"]
    motion = ArmMotion(side, time, track.shoulder + 0.19 * along, track.shoulder, angle, DOWN)
    s = simulate_arm(motion, lucy(), Wearer(upper_arm=0.27), level)
    frame = DeviceFrame(np.zeros((151, 3)), np.tile(np.eye(3), (151, 1, 1)))
    hand = HandLoad(0.8, np.tile([0.0, 0.0, 5.0], (151, 1)))
    found = torque_kept(track, hand, s, frame, mass=MASS, segments=body_segments(SEX), gravity=DOWN)
    return s, track, found


def test_an_arm_that_keeps_its_torque_is_a_pendulum_under_torque_and_cuff() -> None:
    """I θ'' = τ - S g sin θ - F l sin θ + M, by hand: the course of M is that of the result, its effect is not."""
    s, _, found = kept()
    time = s.motion.time[: len(found.departure)]
    first, second = pendulum(0.8)
    reach = sum(LENGTHS.values())
    course = CubicSpline(s.motion.time, s.motion.elevation)
    arm = found.simulation.motion.interface - found.simulation.motion.shoulder
    moment = CubicSpline(time, -np.cross(arm, found.simulation.outputs["force"])[:, 0])

    def down(angle: float) -> float:
        return (first * 9.81 + 5.0 * reach) * np.sin(angle)

    def rates(t: float, x: np.ndarray) -> list[float]:
        torque = second * float(course(t, 2)) + down(float(course(t)))
        return [x[1], (torque - down(x[0]) + float(moment(t))) / second]

    start = [float(course(0.0)), float(course(0.0, 1))]
    swung = solve_ivp(rates, time[[0, -1]], start, "LSODA", time, rtol=1e-8, atol=1e-10).y[0]
    assert np.degrees(found.departure).max() > 4.0
    np.testing.assert_allclose(np.degrees(found.departure), np.degrees(swung - course(time)), atol=0.1)
    assert found.unexplained < 0.05


def test_a_left_arm_that_keeps_its_torque_is_the_mirror_image() -> None:
    right, left = kept()[2], kept("left")[2]
    count = min(len(right.departure), len(left.departure))
    np.testing.assert_allclose(left.departure[:count], right.departure[:count], atol=1e-4)
    mirrored = left.simulation.outputs["force"][:count] * [-1.0, 1.0, 1.0]
    np.testing.assert_allclose(mirrored, right.simulation.outputs["force"][:count], atol=0.02)


def test_more_support_takes_the_arm_farther() -> None:
    most = [np.degrees(kept("right", level)[2].departure).max() for level in (0.0, 0.3, 0.6)]
    assert most[0] < most[1] < most[2]


def test_only_a_point_keeps_the_torque() -> None:
    s, track, _ = kept()
    frame = DeviceFrame(np.zeros((151, 3)), np.tile(np.eye(3), (151, 1, 1)))
    other = replace(s, cuff="surface")
    with pytest.raises(ValueError, match="a cuff that holds at a point"):
        torque_kept(
            track, HandLoad(0.0, np.zeros((151, 3))), other, frame, mass=MASS, segments=body_segments(SEX), gravity=DOWN
        )


def test_an_arm_that_leaves_its_range_at_once_keeps_no_torque(monkeypatch: pytest.MonkeyPatch) -> None:
    """A range that ends where the recorded arm is in the fourth frame, which the device raises it to at once."""
    s, track, _ = kept()
    monkeypatch.setattr("geocontact.shoulder_exoskeleton.torque_kept.HIGHEST", float(s.motion.elevation[3]))
    frame = DeviceFrame(np.zeros((151, 3)), np.tile(np.eye(3), (151, 1, 1)))
    with pytest.raises(LeavesAtOnceError, match=r"leaves its range after [1-5] frames"):
        torque_kept(
            track, HandLoad(0.0, np.zeros((151, 3))), s, frame, mass=MASS, segments=body_segments(SEX), gravity=DOWN
        )


def test_sway_after_a_step_is_that_of_a_damped_oscillator() -> None:
    """Closed form: θ = M/K' (1 - exp(-ζωt) (cos ω'_t + ζω/ω' sin ω't)) about the equilibrium before, which may be
    that of a moment that is never in the course.
    """
    person = InvertedPendulum(80.0, 1.8, 1.6, 0.4)
    length = 1.8 * (1.0 - 0.039)
    left = 0.6 * 80.0 * GRAVITY * 0.5 * length
    inertia = 80.0 * length**2 / 3.0
    time = np.arange(4001) * 1e-3
    moment = np.where(time > 0.0005, 12.0, 2.0)
    omega = np.sqrt(left / inertia)
    damped = omega * np.sqrt(1.0 - 0.4**2)
    decay = np.exp(-0.4 * omega * time) * (np.cos(damped * time) + 0.4 * omega / damped * np.sin(damped * time))
    expected = (2.0 + 10.0 * (1.0 - decay)) / left
    np.testing.assert_allclose(person.sway(time, moment, 2.0), expected, atol=2e-3 * 10.0 / left)
    np.testing.assert_allclose(person.sway(time, np.full(len(time), 12.0), 2.0), expected, atol=1e-9)
    assert person.sway(time, np.full(len(time), 7.0), 7.0) == pytest.approx(np.full(len(time), 7.0 / left))


def test_ankles_without_reflexes_hold_nobody() -> None:
    with pytest.raises(ValueError, match=r"a stiffness of 0\.91 m g h holds nobody up"):
        InvertedPendulum(80.0, 1.8, 0.91)


def test_sway_is_that_of_the_linear_system_and_refuses_uneven_times() -> None:
    from scipy.signal import lsim

    person, time = InvertedPendulum(70.0, 1.75), 0.01 * np.arange(400)
    moment = np.random.default_rng(2).standard_normal(400).cumsum()
    damping = 2.0 * person.damping * np.sqrt(person.inertia * person.left)
    matrix = np.array([[0.0, 1.0], [-person.left / person.inertia, -damping / person.inertia]])
    system = matrix, np.array([[0.0], [1.0 / person.inertia]]), np.array([[1.0, 0.0]]), np.zeros((1, 1))
    _, expected, _ = lsim(system, moment, time, X0=np.array([0.3 / person.left, 0.0]))
    np.testing.assert_allclose(person.sway(time, moment, 0.3), expected, rtol=0.0, atol=1e-12 * np.abs(expected).max())
    with pytest.raises(ValueError, match="even times"):
        person.sway(time**1.1, moment, 0.3)
