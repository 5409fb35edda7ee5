"""A foot that carries a load: the table against the keel itself, torque kept, alignment, roll-over arcs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.design.foot_map import (
    PLACES,
    REACH,
    FootMap,
    foot_map,
    needed,
    solved_with_drag,
    with_angles_kept,
    with_torque_kept,
)
from geocontact.below_knee_prosthesis.design.foot_task import FLAT, LEVEL
from geocontact.below_knee_prosthesis.design.outcomes import arc_through, loading_rate, returned, roll_over_radius
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from tests.below_knee_prosthesis.design.tasks import a_task


@pytest.fixture(scope="module")
def maps() -> dict[float, FootMap]:
    task = a_task()
    rows = needed(task.pitch, task.load, REACH)
    return {fulcrum: foot_map(vsf_foot().at(fulcrum), *rows) for fulcrum in (0.08, 0.117)}


def test_at_the_tables_height_the_keel_carries_the_load(maps: dict[float, FootMap]) -> None:
    """Solved afresh at the heights that the table tells: forces, centres and angles are those of the table."""
    task, foot = a_task(), maps[0.117]
    task = replace(task, forward=0.0 * task.forward)
    found = with_angles_kept(foot, task)
    turn = Rotation.from_euler("z", task.pitch[:, None])
    place = np.stack([0.0 * found.height, found.height, 0.0 * found.height], axis=1)
    poses = RigidTransform.from_components(place, turn)
    motion = foot.keel.solve(poses, FLAT)
    np.testing.assert_allclose(motion.force[:, 1], task.load, rtol=0.06)
    pressing, point = motion.loads.pressing, np.nan_to_num(motion.loads.point)
    centre = np.einsum("tn,tni->ti", pressing, point) / pressing.sum(axis=1)[:, None]
    np.testing.assert_allclose(poses.inv().apply(centre)[:, 0], found.centre[:, 0], atol=6e-3)


def test_a_force_along_the_ground_bends_the_keel_by_statics(maps: dict[float, FootMap]) -> None:
    """Each sphere presses k × depth and is held by a fifth of it: its moments about the hinges, summed here by hand."""
    task, foot = a_task(), maps[0.117]
    task = replace(task, forward=0.2 * task.load)
    found, keel = with_angles_kept(foot, task), foot.keel.keel
    place = np.column_stack([0.0 * found.height, found.height, 0.0 * found.height])
    poses = RigidTransform.from_components(place, Rotation.from_euler("z", task.pitch[:, None]))
    motion = solved_with_drag(foot.keel, poses, LEVEL, 0.2)
    np.testing.assert_allclose(motion.force[:, 0], 0.2 * motion.force[:, 1], rtol=1e-6)
    np.testing.assert_allclose(motion.force[:, 1], task.load, rtol=0.06)
    np.testing.assert_allclose(motion.angles, found.angles, atol=0.05 * np.abs(found.angles).max())
    law, spheres, segment = foot.keel.law, foot.keel.sole.spheres, np.array(foot.keel.sole.segment)
    for pitch, height, angles in zip(task.pitch, found.height, motion.angles, strict=True):
        hinges, turn = [], pitch
        at = np.array([0.0, height]) + keel.posterior * np.array([np.cos(pitch), np.sin(pitch)])
        frames = [(np.array([0.0, height]), pitch, 0.0)]
        for angle in angles:
            hinges.append(at)
            turn = turn + angle
            frames.append((at, turn, keel.posterior + len(hinges) * keel.pitch - keel.pitch))
            at = at + keel.pitch * np.array([np.cos(turn), np.sin(turn)])
        torque = np.zeros(8)
        for centre, radius, of, k in zip(spheres.centre, spheres.radius, segment, law.stiffness, strict=True):
            origin, turned, start = frames[of]
            c, s = np.cos(turned), np.sin(turned)
            x, y = origin + np.array([[c, -s], [s, c]]) @ (centre[:2] - [start, 0.0])
            pressing = k * max(radius - y, 0.0) ** law.exponent
            for j in range(of):
                torque[j] += (x - hinges[j][0]) * pressing - (0.0 - hinges[j][1]) * 0.2 * pressing
        for of in range(1, 9):
            origin, turned, _ = frames[of]
            middle = origin[0] + 0.5 * keel.pitch * np.cos(turned)
            for j in range(of):
                torque[j] -= 9.80665 * keel.segment_mass * (middle - hinges[j][0])
        np.testing.assert_allclose(keel.stiffness(0.117) * angles, torque, atol=1e-3)


def test_on_the_recorded_foot_the_kept_torque_turns_nothing(maps: dict[float, FootMap]) -> None:
    task = a_task()
    moment = with_angles_kept(maps[0.117], task).ankle_moment
    same = with_torque_kept(maps[0.117], task, moment)
    assert same.kept == 1.0
    np.testing.assert_allclose(same.tilt, 0.0, atol=np.radians(0.11))
    softer, kept = with_angles_kept(maps[0.08], task), with_torque_kept(maps[0.08], task, moment)
    reached = np.abs(kept.tilt) < REACH - 1e-6
    assert reached.sum() > 5
    assert np.abs(softer.ankle_moment - moment).max() > 1.0
    np.testing.assert_allclose(kept.ankle_moment[reached], moment[reached], atol=1.0)  # in steps of 0.1 degrees


def test_alignment_turns_the_foot_about_the_ankle(maps: dict[float, FootMap]) -> None:
    """Turned back in the ground by as much, the ankle's moment is what it was; the knee keeps its distance."""
    task, angle = a_task(), np.radians(3.0)
    turned = task.aligned(angle)
    back = with_angles_kept(maps[0.117], replace(turned, pitch=turned.pitch - angle))
    plain = with_angles_kept(maps[0.117], task)
    np.testing.assert_allclose(back.ankle_moment, plain.ankle_moment, rtol=1e-12)
    assert np.linalg.norm(turned.knee - turned.ankle) == pytest.approx(np.linalg.norm(task.knee - task.ankle))
    lever = (turned.knee - turned.ankle)[:2]
    assert np.arctan2(*lever) == pytest.approx(np.arctan2(*(task.knee - task.ankle)[:2]) + angle)


def test_a_stiffer_foot_stores_less_and_rolls_on_a_larger_arc(maps: dict[float, FootMap]) -> None:
    soft, stiff = (with_angles_kept(maps[fulcrum], a_task()) for fulcrum in (0.08, 0.117))
    assert soft.stored.max() > 1.25 * stiff.stored.max()
    assert 0.0 < returned(stiff) <= stiff.stored.max()
    assert roll_over_radius(stiff) > roll_over_radius(soft)
    assert loading_rate(stiff) == pytest.approx(loading_rate(soft), rel=0.05)  # the heel is behind both fulcrums


def test_energy_is_half_of_moment_times_turn() -> None:
    """Clapeyron: joints in equilibrium store half of what the moments at them do along the whole turn."""
    keel = vsf_foot().at(0.1)
    foot = FootMap(keel, np.array([0.0, 1.0]), np.array([0.0, 1.0]), *np.zeros((2, 2, 2, PLACES + 8)))
    angles = np.linspace(0.01, 0.05, 8)
    channels = np.concatenate([np.zeros(PLACES), angles])
    assert foot.stored(channels) == pytest.approx(0.5 * float((keel.keel.stiffness(0.1) * angles) @ angles))


def test_arc_is_found_wherever_it_lies() -> None:
    angle = np.linspace(-0.5, 0.3, 30)
    points = np.column_stack([0.3 * np.sin(angle), 0.3 - 0.3 * np.cos(angle)])
    turned = points @ Rotation.from_euler("z", 0.2).as_matrix()[:2, :2].T + [0.4, -0.1]
    for path in (points, turned):
        found = arc_through(path)
        assert found.radius == pytest.approx(0.3, rel=1e-9)
        assert found.off < 1e-12
    assert arc_through(points * [1.0, -1.0]).radius == pytest.approx(-0.3, rel=1e-9)
