"""A stance of one leg: the load that the rest of the body has, and where stances are."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.standing_up.chain import Subject
from geocontact.standing_up.stance import chain_of, load_of_the_rest, one_leg, stances

SUBJECT = Subject(72.0, 1.7)
G = 9.81


def moved(t: np.ndarray) -> np.ndarray:
    wave = [0.02 * np.sin(3.0 * t), 0.1 + 0.01 * t**2, 0.1 - 0.3 * t**2, -0.2 + 0.5 * t, 0.4 * np.sin(4.0 * t)]
    return np.stack(wave, axis=-1)


def centres(q: np.ndarray) -> list[tuple[float, float, np.ndarray, np.ndarray]]:
    """Mass and moment of inertia of one side, mass centre, and turn of foot, shank and thigh."""
    parts, rows = SUBJECT.segments, []
    turn = np.cumsum(q[:, 2:], axis=1)
    at = q[:, :2]
    for k, name in enumerate(("foot", "shank", "thigh")):
        own, c, s = parts[name], np.cos(turn[:, k]), np.sin(turn[:, k])
        x, y = (own.centre, -0.05) if name == "foot" else (0.0, own.centre)
        centre = at + np.column_stack([c * x - s * y, s * x + c * y])
        rows.append((0.5 * own.mass, 0.5 * own.mass * own.gyration**2, centre, turn[:, k]))
        if name != "foot":
            at = at + own.length * np.column_stack([-s, c])
    return rows


def test_the_rest_of_the_body_is_what_the_leg_and_the_ground_leave() -> None:
    """Newton and Euler about the ground's origin, by second differences of the mass centres."""
    time, h = np.linspace(0.0, 0.6, 6001), 1e-4
    ground = np.column_stack([30.0 * np.sin(time), 600.0 + 50.0 * time, 20.0 * np.cos(time)])
    total = np.zeros((len(time), 3))
    three = (centres(moved(time + by)) for by in (h, 0.0, -h))
    for ahead, now, back in zip(*three, strict=True):
        mass, inertia, at, turn = now
        a = (ahead[2] - 2.0 * at + back[2]) / h**2 + [0.0, G]
        spin = (ahead[3] - 2.0 * turn + back[3]) / h**2
        total += np.column_stack([mass * a, mass * (at[:, 0] * a[:, 1] - at[:, 1] * a[:, 0]) + inertia * spin])
    found = load_of_the_rest(SUBJECT, time, moved(time), ground)
    inside = slice(5, -5)
    np.testing.assert_allclose(found[inside], (total - ground)[inside], atol=2e-3 * np.abs(total).max())


def test_a_leg_is_half_of_both() -> None:
    leg = one_leg(SUBJECT)
    assert leg.mass == pytest.approx(72.0 * (0.0137 + 0.0433 + 0.1416))
    assert [len(chain_of(SUBJECT, n).coordinates) for n in (5, 6, 9)] == [5, 6, 9]


def test_stances_are_where_a_flat_foot_is_loaded() -> None:
    """Two whole ones; the first has begun before the recording, the third ends as the heel has risen, one is brief."""
    time = np.arange(400) / 100.0
    up, turn = np.zeros(400), np.zeros(400)
    for a, b in ((0, 40), (100, 170), (200, 205), (250, 330)):
        up[a:b] = 700.0
    turn[300:] = -0.7
    assert stances(time, up, turn, 20) == [(1.0, 1.69), (2.5, 2.99)]
