"""Torques of hip and knee above a foot: beside Newton and Euler on three places, loops, and the whole body in 3-D."""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.prosthesis.design.options import ProsthesisDesignOptions
from geocontact.analyses.prosthesis.design.trial import read
from geocontact.below_knee_prosthesis.design.foot_map import CarriedLoad, with_angles_kept
from geocontact.below_knee_prosthesis.design.foot_task import Terrain, needed_of
from geocontact.below_knee_prosthesis.design.joint_torques_kept import recorded_motion
from geocontact.below_knee_prosthesis.design.knob import Knob
from geocontact.below_knee_prosthesis.design.outcomes import outcomes
from tests.below_knee_prosthesis.design.tasks import a_task
from tests.below_knee_prosthesis.design.test_costs_by_hand import a_stance

G = 9.80665
ROOT = Path(__file__).resolve().parents[3]


def moved(t: np.ndarray) -> np.ndarray:
    """Hip, thigh and shank of an invented swing over time."""
    wave = [1.2 * t, 0.9 + 0.02 * np.sin(9.0 * t), 0.3 * np.cos(5.0 * t), -0.1 + 0.4 * np.sin(4.0 * t)]
    return np.stack(wave, axis=-1)


def places(q: np.ndarray) -> dict[str, np.ndarray]:
    """Knee and both mass centres in the ground's frame, by sines and cosines."""
    leg = a_task().leg
    down = np.stack([np.sin(q[:, 2]), -np.cos(q[:, 2])], axis=-1)
    c, s = np.cos(q[:, 3]), np.sin(q[:, 3])
    x, y = leg.centre - leg.knee
    knee = q[:, :2] + leg.length * down
    shank = knee + np.stack([c * x - s * y, s * x + c * y], axis=-1)
    return {"hip": q[:, :2], "knee": knee, "thigh": q[:, :2] + leg.thigh[1] * down, "shank": shank}


def newton_and_euler(course: Callable[[np.ndarray], np.ndarray], time: np.ndarray) -> np.ndarray:
    """Moments about hip and knee."""
    leg, step = a_task().leg, 1e-4
    (m1, _, i1), (m2, i2) = leg.thigh, leg.shank
    ahead, now, back = (places(course(time + by)) for by in (step, 0.0, -step))
    pull = {name: (ahead[name] - 2.0 * now[name] + back[name]) / step**2 + [0.0, G] for name in ("thigh", "shank")}
    spin = (course(time + step) - 2.0 * course(time) + course(time - step))[:, 2:] / step**2

    def cross(point: str, body: str, mass: float) -> np.ndarray:
        (x, y), (fx, fy) = (now[body] - now[point]).T, mass * pull[body].T
        return x * fy - y * fx

    knee = cross("knee", "shank", m2) + i2 * spin[:, 1]
    hip = cross("hip", "thigh", m1) + cross("hip", "shank", m2) + i1 * spin[:, 0] + i2 * spin[:, 1]
    return np.column_stack([hip, knee])


def test_what_weight_and_inertia_need_by_newton_and_euler() -> None:
    """Accelerations by differences of places, moments about hip and knee by crosses."""
    time = np.linspace(0.0, 0.6, 601)
    own, found = newton_and_euler(moved, time), needed_of(a_task().leg, time, moved(time))
    inside = slice(10, -10)
    np.testing.assert_allclose(found[inside], own[inside], atol=2e-4 * np.abs(own).max())


def by_hand(found: CarriedLoad) -> np.ndarray:
    """Torques of hip and knee, with the ankle as the origin of the ground's frame, frame by frame."""
    task, rows = found.task, []
    for t in range(len(task.time)):
        pitch = task.pitch[t] + found.tilt[t]
        turn = np.array([[np.cos(pitch), -np.sin(pitch)], [np.sin(pitch), np.cos(pitch)]])
        centre, knee = (turn @ (each[:2] - task.ankle[:2]) for each in (found.centre[t], task.knee))
        hip = knee + 0.44 * np.array([-np.sin(task.thigh[t]), np.cos(task.thigh[t])])
        levers = [(centre - joint)[0] * task.load[t] - (centre - joint)[1] * task.forward[t] for joint in (hip, knee)]
        rows.append(task.needed[t] - levers)
    return np.array(rows)


def test_moments_means_and_proxy_by_hand() -> None:
    found = a_stance()
    task, own, of = found.task, by_hand(found), outcomes(found)
    np.testing.assert_allclose(found.leg_torques, own, rtol=1e-10, atol=1e-10)
    step, last = task.time[1] - task.time[0], 14

    def mean(column: np.ndarray) -> float:
        return sum(0.5 * (abs(column[t]) + abs(column[t + 1])) for t in range(last)) / last

    for k, joint in enumerate(("hip", "knee")):
        assert of[f"{joint}_moment"] == pytest.approx(max(abs(own[:, k])), rel=1e-12)
        assert of[f"{joint}_mean"] == pytest.approx(mean(own[:, k]), rel=1e-12)
    assert of["ankle_mean"] == pytest.approx(mean(found.ankle_moment), rel=1e-12)
    assert of["socket_mean"] == pytest.approx(mean(found.moment(task.bushing)), rel=1e-12)
    shank, cost = task.pitch + found.tilt, 0.0
    for angle, torque in ((task.thigh - task.pelvis, own[:, 0]), (shank - task.thigh, own[:, 1])):
        rate = [(angle[min(t + 1, last)] - angle[max(t - 1, 0)]) for t in range(15)]
        power = [r * m / (step * (2 if 0 < t < last else 1)) for t, (r, m) in enumerate(zip(rate, torque, strict=True))]
        for t in range(last):
            cost += 0.5 * step * (max(power[t], 0.0) + max(power[t + 1], 0.0)) / 0.25
            cost += 0.5 * step * (max(-power[t], 0.0) + max(-power[t + 1], 0.0)) / 1.2
    assert of["metabolic"] == pytest.approx(cost, rel=1e-10)


def test_a_slope_does_not_move_the_leg() -> None:
    """Levers of hip and knee are those in the laboratory, in whichever frame the stance is read."""
    found, slope = a_stance(), 0.12
    met = copy(found)
    object.__setattr__(met, "task", Terrain(slope).met(found.task))
    np.testing.assert_allclose(met.leg_torques, found.leg_torques, rtol=1e-10, atol=1e-10)


def test_torques_kept_are_those_of_the_present_foot_and_the_springs() -> None:
    from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot

    task, knob = a_task(), Knob("fulcrum", np.array([0.08, 0.117, 0.14]), 0.117)
    maps = knob.maps(vsf_foot(), task)
    kept, moved_by = with_angles_kept(maps[-1], task).leg_torques, knob.other_feet(maps, task).moved()
    size = 2.0 * (62.0 + 11.0 + 4.3)
    for k, found in enumerate(knob.carried(maps, task)["joint torques kept"]):
        off = moved_by.joints[:, k]
        spring = -size * (off + 0.05 * np.gradient(off, moved_by.time, axis=0))
        at = np.column_stack([np.interp(task.time, moved_by.time, each) for each in spring.T])
        np.testing.assert_allclose(found.leg_torques - kept, at, atol=0.02 * np.abs(kept).max())


def rolled(t: np.ndarray) -> np.ndarray:
    """Leg of `a_task` over time, hip and turns, before and after it as well."""
    share = t / 0.6
    hip = [1.1 * t + 0.02 * np.sin(9.0 * t), 0.9 + 0.02 * np.cos(8.0 * t)]
    return np.stack([*hip, np.radians(24.0 - 22.0 * share), np.radians(8.0 - 26.0 * share)], axis=-1)


def test_what_drives_the_leg_is_what_the_present_foot_needs_from_the_first_frame_on() -> None:
    """Accelerations of the whole motion, which goes on beyond the loaded stance; torques by hand at every frame."""
    from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot

    task, step = a_task(61), 1e-4
    bent = (rolled(task.time + step) - 2.0 * rolled(task.time) + rolled(task.time - step)) / step**2
    task = replace(task, needed=newton_and_euler(rolled, task.time), acceleration=bent)
    maps = Knob("fulcrum", np.array([0.117]), 0.117).maps(vsf_foot(), task)
    own, recorded = by_hand(with_angles_kept(maps[-1], task)), recorded_motion(maps[-1], task)
    torques = np.column_stack([recorded.driven[:, 2] + recorded.driven[:, 3], recorded.driven[:, 3]])
    found = np.column_stack([np.interp(task.time, recorded.time, each) for each in torques.T])
    np.testing.assert_allclose(found, own, atol=0.02 * np.abs(own).max())


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::geocontact.InputWarning")
def test_near_the_whole_body_in_three_dimensions() -> None:
    """Two bars under the recorded plate beside 28 coordinates under the simulated foot, whose force differs."""
    stood = ROOT / "meshes" / "amputee_P1"
    own = {"static": stood / "standing.trc", "mass": 77.3, "plates": stood / "plates.mot", "plate": "own_force"}
    given = read(ProsthesisDesignOptions(stood / "walking.trc", cutoff=6.0, **own))
    task, fulcrum = given.trial.task(), given.trial.fulcrum
    (present, last) = Knob("fulcrum", np.array([fulcrum]), fulcrum).maps(given.foot, task)
    flat = outcomes(with_angles_kept(present, task))
    driven, kept = recorded_motion(last, task), with_angles_kept(last, task).leg_torques[:, 0]
    hip, begun = driven.driven[:, 2] + driven.driven[:, 3], task.time[0] + 0.1
    during = (driven.time >= task.time[0]) & (driven.time <= begun)
    off = (hip - np.interp(driven.time, task.time, kept))[during]
    assert np.sqrt(np.mean(off**2)) < 5.0  # 4.1 N m, between the frames; 0.03 N m at them
    off = (np.interp(task.time, driven.time, hip) - kept)[task.time > begun]
    assert np.sqrt(np.mean(off**2)) < 2.0  # 1.3 N m
    functional = {"functional": stood / "functional.trc", "height": 1.81, "other_plate": "other_force"}
    whole = gc.prosthesis.walk(stood / "walking.trc", **own, **functional).peaks
    for joint in ("hip", "knee"):
        solid = whole[f"{joint}_flexion_r"]
        assert flat[f"{joint}_mean"] == pytest.approx(solid.mean, rel=0.15), joint
        assert flat[f"{joint}_moment"] == pytest.approx(solid.peak, rel=0.2), joint
