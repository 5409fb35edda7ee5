"""Markers at one place, and places that are held, against comparisons of all pairs and of all steps."""

from __future__ import annotations

import time
from itertools import combinations

import numpy as np
import pytest

from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.trial_checks.marker_checks import STILL_FOR, standing_still
from geocontact.trial_checks.recorded import TrialInputs
from geocontact.trial_checks.twice import (
    EVEN,
    LOOKED_AT,
    SAME,
    STRAIGHT,
    held_steps,
    markers_at_one_place,
    straight_gaps,
)

RATE = 100.0


def walk(frames: int, markers: int, seed: int = 0) -> np.ndarray:
    steps = np.random.default_rng(seed).normal(scale=2e-3, size=(frames, markers, 3))
    return np.asarray(np.cumsum(steps, axis=0) + np.arange(markers)[:, None] * 0.1)


def gaps(places: np.ndarray, share: float, seed: int = 1) -> np.ndarray:
    gapped = places.copy()
    gapped[np.random.default_rng(seed).random(places.shape[:2]) < share] = np.nan
    return gapped


def one_at_a_time(places: np.ndarray) -> np.ndarray:
    """Each marker in a part of the trial of its own, and a copy of the first in the first's part."""
    alone = np.full_like(places, np.nan)
    for k, rows in enumerate(np.array_split(np.arange(len(places)), places.shape[1])):
        alone[rows, k] = places[rows, k]
    return alone


def copied(places: np.ndarray, one: int, other: int, rows: slice = slice(None)) -> np.ndarray:
    changed = places.copy()
    changed[rows, other] = changed[rows, one]
    return changed


def between(places: np.ndarray, one: int, other: int) -> np.ndarray:
    """A copy for some frames that lie between those that are looked at first."""
    step = len(places) // LOOKED_AT
    hidden = places.copy()
    hidden[:, other] = np.nan
    for start in range(1, STILL_FOR + 5):
        hidden[step * start + 1, other] = hidden[step * start + 1, one]
    return hidden


RECORDINGS = {
    "noise": walk(300, 12),
    "one copy": copied(walk(300, 12), 3, 9),
    "three at one place": copied(copied(walk(300, 12), 3, 9), 3, 5),
    "a copy with gaps": gaps(copied(walk(300, 12), 3, 9), 0.4),
    "a copy in half of the trial": copied(walk(300, 12), 3, 9, slice(0, 150)),
    "equal along x only": walk(300, 12) * np.array([0.0, 1.0, 1.0]),
    "all at the origin": np.zeros((300, 6, 3)),
    "1 um beside": walk(300, 2)[:, [0, 0]] + np.array([[0.0, 0.0, 0.0], [0.9e-6, 0.0, 0.0]]),
    "2 um beside": walk(300, 2)[:, [0, 0]] + np.array([[0.0, 0.0, 0.0], [2e-6, 0.0, 0.0]]),
    "never seen together": one_at_a_time(walk(300, 12)),
    "nine frames together": copied(one_at_a_time(walk(300, 12)), 0, 5, slice(0, STILL_FOR - 1)),
    "ten frames together": copied(one_at_a_time(walk(300, 12)), 0, 5, slice(0, STILL_FOR)),
    "a copy between what is looked at": between(walk(6000, 4), 1, 3),
    "two frames": walk(2, 3),
    "one marker": walk(300, 1),
    "never seen": np.full((300, 3, 3), np.nan),
}
HELD = {
    "walk": walk(200, 3),
    "ten steps": copied(walk(200, 3), 0, 0),
    "gaps": gaps(walk(200, 3), 0.3),
    "all held": np.zeros((50, 3, 3)),
}
for run in (9, 10, 11, 37):
    for start in (0, 1, 57, 200 - run - 1):
        HELD[f"{run} steps from {start}"] = walk(200, 3)
        HELD[f"{run} steps from {start}"][start : start + run + 1, 1] = HELD[f"{run} steps from {start}"][start, 1]


def pairs_by_hand(places: np.ndarray) -> list[tuple[int, int]]:
    found = []
    for one, other in combinations(range(places.shape[1]), 2):
        apart = np.abs(places[:, one] - places[:, other]).max(axis=1)
        apart = apart[np.isfinite(apart)]
        if len(apart) >= STILL_FOR and (apart < SAME).all():
            found.append((one, other))
    return found


@pytest.mark.parametrize("name", RECORDINGS)
def test_markers_at_one_place_are_those_of_all_pairs(name: str) -> None:
    assert markers_at_one_place(RECORDINGS[name], STILL_FOR) == pairs_by_hand(RECORDINGS[name])


def test_some_recordings_have_such_markers() -> None:
    count = {name: len(pairs_by_hand(places)) for name, places in RECORDINGS.items()}
    assert count["all at the origin"] == 15 and count["three at one place"] == 3 and count["a copy with gaps"] == 1
    assert count["a copy between what is looked at"] == count["ten frames together"] == count["1 um beside"] == 1
    assert count["nine frames together"] == count["2 um beside"] == count["never seen together"] == 0


@pytest.mark.parametrize("name", HELD)
def test_held_steps_are_those_of_all_steps(name: str) -> None:
    places = HELD[name]
    expected = {}
    for k in range(places.shape[1]):
        same = [bool(np.abs(b - a).max() < SAME) for a, b in zip(places[:-1, k], places[1:, k], strict=True)]
        longest = max(len(part) for part in "".join("x" if each else " " for each in same).split(" "))
        if longest >= STILL_FOR:
            expected[k] = same
    assert {k: each.tolist() for k, each in held_steps(places, STILL_FOR).items()} == expected


@pytest.mark.parametrize("frames", [10_000, pytest.param(100_000, marks=pytest.mark.slow)])
def test_two_hundred_markers_of_a_long_recording(frames: int) -> None:
    """0.06 s of CPU time for 100 000 frames; all pairs, frame by frame, took 160 s."""
    course = 0.1 * np.sin(np.arange(frames)[:, None] / RATE + np.arange(3))
    places = course[:, None] + walk(1, 200)
    places[4_000:4_100, 7] = places[4_000, 7]
    names = tuple(f"{chr(97 + k // 26)}{chr(97 + k % 26)}q" for k in range(200))
    trial = TrialInputs(markers=MarkerTrajectories(np.arange(len(places)) / RATE, places, names))
    taken = []
    for _ in range(3):
        start = time.process_time()
        (found,) = standing_still(trial)
        taken.append(time.process_time() - start)
    assert "ahq stays at one place from 40.00 to 40.99 s" in str(found)
    assert min(taken) < 0.2


@pytest.mark.parametrize("still", range(3), ids="xyz")
def test_a_straight_gap_is_found_in_a_planar_movement(still: int) -> None:
    """A coordinate that never changes does not make the whole course one of a model."""
    places = np.random.default_rng(0).normal(0.0, 5e-3, (300, 2, 3)).cumsum(axis=0)
    places[:, :, still] = 0.5
    places[100:131, 0] = np.linspace(places[100, 0], places[130, 0], 31)
    seen = MarkerTrajectories(np.arange(300) / RATE, places, ("a", "b"))
    (said,) = straight_gaps(TrialInputs(markers=seen))
    assert "a goes straight on at one speed from 1.00 to 1.30 s" in str(said)


def test_straight_lines_are_found_wherever_they_begin() -> None:
    """By hand, sample by sample, of lines of 5 to 29 frames in noise of a camera."""
    rng = np.random.default_rng(0)
    found = 0
    for _ in range(60):
        places = rng.normal(0.0, 2e-3, (300, 5, 3)).cumsum(axis=0)
        for k in range(3):
            first = int(rng.integers(1, 260))
            last = first + int(rng.integers(5, 30))
            places[first : last + 1, k] = np.linspace(places[first, k], places[last, k], last - first + 1)
        bent = np.linalg.norm(places[:-2] - 2.0 * places[1:-1] + places[2:], axis=2)
        runs = ["".join("1" if each < EVEN else "0" for each in column).split("0") for column in bent.T]
        expected = {f"m{k}" for k, each in enumerate(runs) if max(map(len, each)) >= STRAIGHT}
        seen = MarkerTrajectories(np.arange(300) / RATE, places, tuple(f"m{k}" for k in range(5)))
        said = {
            str(each).partition(" goes straight")[0].rpartition(" ")[2]
            for each in straight_gaps(TrialInputs(markers=seen))
        }
        assert said <= expected
        found += len(said)
        assert len(expected) - len(said) <= 1  # a kink of less than 1.5 mm by chance
    assert found > 60
