"""A recording is cut where somebody rises and goes down: closed form of the hip's height, and the chair's force."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from geocontact.standing_up.chain import Subject, leg_chain
from geocontact.standing_up.movements import contacts_beside, contradiction, hip_height, movements_of

RATE = 100.0


def course(*levels: float, still: float = 1.0, moving: float = 1.4) -> tuple[np.ndarray, np.ndarray, list[float]]:
    """Heights by the polynomial of least jerk from level to level, and when each passage begins."""
    parts, starts, at = [np.full(round(still * RATE), levels[0])], [], still
    for low, high in pairwise(levels):
        s = np.arange(round(moving * RATE)) / round(moving * RATE)
        parts.append(low + (high - low) * (10 * s**3 - 15 * s**4 + 6 * s**5))
        parts.append(np.full(round(still * RATE), high))
        starts.append(at)
        at += still + moving
    height = np.concatenate(parts)
    return np.arange(len(height)) / RATE, height, starts


def on_chair(time: np.ndarray, height: np.ndarray, top: float = 0.55) -> np.ndarray:
    """A chair that carries 500 N below a height."""
    return np.where(height < top, 500.0, 0.0) + 0.0 * time


def test_the_height_of_the_hip_is_that_of_the_chain() -> None:
    subject, rng = Subject(60.0, 1.62), np.random.default_rng(3)
    q = np.column_stack([rng.normal(size=(5, 2)), 0.5 * rng.normal(size=(5, 4))])
    poses = leg_chain(subject).poses(q)
    wanted = poses["trunk"].translation[:, 1] - poses["foot"].translation[:, 1]
    np.testing.assert_allclose(hip_height(subject, q), wanted, atol=1e-12)


def test_five_rises_and_four_ways_down_are_found_where_they_were_made() -> None:
    """Start and end within 0.15 s of where the polynomial has 5 % of its largest speed, with noise of 1 mm."""
    time, height, starts = course(*[0.5, 0.9] * 5)
    noisy = height + 1e-3 * np.random.default_rng(1).normal(size=len(time))
    found = movements_of(time, noisy, on_chair(time, height))
    assert [one.kind for one in found] == ["standing up", "sitting down"] * 4 + ["standing up"]
    for one, start in zip(found, starts, strict=True):
        assert one.start == pytest.approx(start, abs=0.15) and one.end == pytest.approx(start + 1.4, abs=0.15)
        assert abs(one.rise) == pytest.approx(0.4, abs=0.01) and one.agrees
        # seat-off where the course passes 0.55 m: 10 s³ − 15 s⁴ + 6 s⁵ = 1/8 or 7/8
        roots = np.roots([6.0, -15.0, 10.0, 0.0, 0.0, -0.125 if one.rise > 0.0 else -0.875])
        s = next(float(r.real) for r in roots if abs(r.imag) < 1e-9 and 0.0 < r.real < 1.0)
        assert one.contact == pytest.approx(start + 1.4 * s, abs=0.02)


def test_a_squat_has_no_chair_and_swaying_is_no_movement() -> None:
    time, height, _ = course(0.9, 0.5, 0.9, still=0.5)
    (one,) = movements_of(time, height + 0.01 * np.sin(2.0 * time), np.zeros(len(time)))
    assert one.kind == "squat" and np.isnan(one.contact) and one.agrees and one.rise == pytest.approx(-0.4, abs=0.02)
    assert [each.kind for each in movements_of(time, height)] == ["going down", "rising"], "no chair was recorded"
    (same,) = movements_of(time, height, squats=True)
    assert (same.kind, same.agrees) == ("squat", True) and same.start == pytest.approx(one.start, abs=0.05)
    apart, still, _ = course(0.9, 0.5, 0.9, still=2.0)
    assert [each.kind for each in movements_of(apart, still, squats=True)] == ["going down", "rising"], "it rests"
    assert movements_of(time, 0.9 + 0.03 * np.sin(3.0 * time)) == ()


def test_a_chair_that_is_not_left_contradicts() -> None:
    """The plate was never set to zero: 20 N to the end."""
    time, height, _ = course(0.5, 0.9)
    (one,) = movements_of(time, height, on_chair(time, height) + 20.0)
    assert one.kind == "standing up" and not one.agrees and one.after == pytest.approx(20.0)


@pytest.mark.parametrize("rate", [100.0, 1000.0])
def test_noise_of_the_empty_plate_moves_no_seat_off(rate: float) -> None:
    """White noise of 2 N, of which 1 % is beyond 5 N: the chair is left by a fall of 400 N in 0.4 s."""
    time = np.arange(0.0, 12.0, 1.0 / rate)
    s = np.clip((time - 2.12) / 1.3, 0.0, 1.0)
    height = 0.5 + 0.4 * (10 * s**3 - 15 * s**4 + 6 * s**5)
    fall = 400.0 * np.clip(1.0 - (time - 2.0) / 0.4, 0.0, 1.0)
    noisy = np.abs(fall + 2.0 * np.random.default_rng(4).normal(size=len(time)))
    assert (noisy[time > 4.0] > 5.0).any()
    (one,) = movements_of(time, height, noisy)
    assert one.kind == "standing up" and one.agrees and not contradiction(one) and one.end < 3.43
    assert one.contact == pytest.approx(2.4 - 0.4 * 5.0 / 400.0, abs=0.025)
    down, low, _ = course(0.9, 0.5, 0.9, still=0.5)
    squat = np.abs(1.5 * np.random.default_rng(5).normal(size=len(down)))
    assert [each.kind for each in movements_of(down, low, squat)] == ["squat"]


def test_movements_beside_a_deeper_one_are_found() -> None:
    """Seat 0.45 m, standing 0.85 m, a squat to 0.20 m; then without the chair's movements it is said."""
    time, height, starts = course(0.45, 0.85, 0.20, 0.85, 0.45, still=0.6)
    seated = on_chair(time, height) * ((time < starts[1]) | (time > starts[3]))
    found = movements_of(time, height, seated)
    assert [one.kind for one in found] == ["standing up", "squat", "sitting down"] and all(one.agrees for one in found)
    assert [one.rise for one in found] == pytest.approx([0.4, -0.65, -0.4], abs=0.02)
    assert contacts_beside(time, seated, found) == ()
    (late,) = contacts_beside(time, seated, found[:2])
    assert late == pytest.approx(found[2].contact, abs=0.011) and len(contacts_beside(time, seated, ())) == 2


def test_a_chair_that_is_left_elsewhere_contradicts() -> None:
    """Its clock is 4 s late: neither start nor end go there."""
    time, height, _ = course(0.5, 0.9, still=6.0)
    (one,) = movements_of(time, height, np.where(time < 11.0, 500.0, 0.0))
    assert not one.agrees and one.contact == pytest.approx(11.0, abs=0.02) and one.end < 7.5
    assert contradiction(one) == "the chair's force passes 5 N at 11.00 s, more than 0.5 s off the movement"
