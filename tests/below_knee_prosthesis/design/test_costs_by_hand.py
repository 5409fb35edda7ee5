"""Every outcome of a design of the foot, and what its choice weighs, beside loops over plain numbers."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.design.choice import choose_pair
from geocontact.below_knee_prosthesis.design.foot_map import CarriedLoad
from geocontact.below_knee_prosthesis.design.joint_torques_kept import RETARDATION, STIFFNESS, OtherFeet
from geocontact.below_knee_prosthesis.design.outcomes import loading_rate, outcomes, returned, roll_over_radius
from tests.below_knee_prosthesis.design.tasks import a_task


def a_stance() -> CarriedLoad:
    """Three joints, each with its own damper; the keel of which nothing but these is asked."""
    task, rng = a_task(15), np.random.default_rng(2)
    dampers = np.array([0.2, 3.0, 40.0])
    keel = SimpleNamespace(fulcrum=0.1, keel=SimpleNamespace(damping=lambda _: dampers))
    foot = SimpleNamespace(keel=keel, at=lambda _pitch, load: np.column_stack([0.03 - 1e-5 * load, load, load]))
    share = np.linspace(0.0, 1.0, 15)
    made = object.__new__(CarriedLoad)
    known = {
        "task": task,
        "foot": foot,
        "tilt": 0.01 * rng.normal(size=15),
        "centre": np.column_stack([0.24 * share - 0.02, 0.02 * (share - 0.4) ** 2]),
        "angles": 0.1 * rng.normal(size=(15, 3)),
        "stored": 9.0 * np.sin(2.4 * share) + share,
    }
    for name, value in known.items():
        object.__setattr__(made, name, value)
    return made


def moment(found: CarriedLoad, point: np.ndarray, t: int) -> float:
    """Of the ground's force, turned into the foot's frame, about a point."""
    pitch = found.task.pitch[t] + found.tilt[t]
    ahead = (np.cos(pitch), -np.sin(pitch))
    up = (np.sin(pitch), np.cos(pitch))
    fx, fy = (found.task.forward[t] * a + found.task.load[t] * b for a, b in zip(ahead, up, strict=True))
    x, y = found.centre[t] - point[:2]
    return float(x * fy - y * fx)


def test_outcomes_by_hand() -> None:
    found = a_stance()
    task, of = found.task, outcomes(found)
    assert of["ankle_moment"] == pytest.approx(max(moment(found, task.ankle, t) for t in range(15)), rel=1e-12)
    assert of["socket_moment"] == pytest.approx(max(abs(moment(found, task.bushing, t)) for t in range(15)), rel=1e-12)
    top, step, lost = max(range(15), key=lambda t: found.stored[t]), task.time[1] - task.time[0], []
    for t in range(15):
        a, b = max(t - 1, 0), min(t + 1, 14)
        rates = (found.angles[b] - found.angles[a]) / ((b - a) * step)
        lost.append(sum(c * rate**2 for c, rate in zip((0.2, 3.0, 40.0), rates, strict=True)))
    away = sum(0.5 * step * (lost[t] + lost[t + 1]) for t in range(top, 14))
    assert returned(found) == of["energy"] == pytest.approx(found.stored[top] - found.stored[14] - away, rel=1e-10)
    first = next(t for t in range(15) if task.load[t] >= 0.3 * task.weight)
    assert first > 0
    assert loading_rate(found) == pytest.approx(1e5 * task.falling, rel=1e-9)
    turned = []
    lean = 0.5 * np.pi - np.arctan2(*(task.knee - task.ankle)[[1, 0]])
    for t in range(15):
        if (task.time[t] - task.time[0]) <= 0.8 * (task.time[-1] - task.time[0]) and task.load[t] >= 0.2 * task.weight:
            x, y = found.centre[t] - task.ankle[:2]
            turned.append((np.cos(lean) * x - np.sin(lean) * y, np.sin(lean) * x + np.cos(lean) * y))
    points = np.array(turned)
    off = [2.0 * points[:, 0], 2.0 * points[:, 1], np.ones(len(points))]
    a, b, c = np.linalg.solve([[u @ v for v in off] for u in off], [u @ (points**2).sum(axis=1) for u in off])
    assert abs(roll_over_radius(found)) == pytest.approx(np.sqrt(c + a**2 + b**2), rel=1e-6)


def test_tracking_by_hand() -> None:
    """Torque on the knee, and the difference on the thigh: of four coordinates, of each foot its own deviation."""
    leg, rng = a_task().leg, np.random.default_rng(3)
    feet = object.__new__(OtherFeet)
    object.__setattr__(feet, "leg", leg)
    object.__setattr__(feet, "tracking", 0.7)
    off, rate = rng.normal(size=(5, 4)), rng.normal(size=(5, 4))
    found, size = feet._tracking(off, rate), 0.7 * STIFFNESS * (62.0 + 11.0 + 4.3)
    for n in range(5):
        hip = -size * (off[n, 2] + RETARDATION * rate[n, 2])
        knee = -size * (off[n, 3] - off[n, 2] + RETARDATION * (rate[n, 3] - rate[n, 2]))
        np.testing.assert_allclose(found[n], [0.0, 0.0, hip - knee, knee], rtol=1e-12)


def test_a_pair_by_hand() -> None:
    """Three alignments, two responses, four values, eleven draws: the least of the worse medians."""
    rng = np.random.default_rng(4)
    drawn = rng.normal(size=(11, 3, 2, 4)) + 10.0 * rng.uniform(size=(1, 3, 2, 4))
    values, turns = np.array([1.0, 2.0, 5.0, 9.0]), np.array([-0.1, 0.0, 0.3])
    found = choose_pair(values, turns, drawn, "most", None, 0.9)
    worse = {
        (m, n): max(sorted(-drawn[d, m, j, n] for d in range(11))[5] for j in range(2))
        for m in range(3)
        for n in range(4)
    }
    m, n = min(worse, key=lambda pair: worse[pair])
    alone = min(range(4), key=lambda k: worse[1, k])
    assert (found.alignment, found.value, found.alone) == (turns[m], values[n], values[alone])
    gains = sorted(drawn[d, m, 1, n] - drawn[d, 1, 1, alone] for d in range(11))
    assert found.gain["torque kept"][0] == pytest.approx(gains[5], rel=1e-12)
