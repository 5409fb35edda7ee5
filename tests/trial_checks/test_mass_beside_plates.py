"""Plates that a .c3d file has beside its markers, against the mass that `scale` and `shoulder` are given."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from geocontact.analyses.motion.checked_trial import standing_on
from geocontact.analyses.motion.markers import turn_of
from geocontact.analyses.motion.scale.factors import read as read_scale
from geocontact.analyses.motion.scale.options import ScaleOptions
from geocontact.analyses.shoulder.simulate.arms import read as read_shoulder
from geocontact.analyses.shoulder.simulate.options import ShoulderSimulateOptions
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.io.mocap.trc import read_trc
from tests.analyses.findings.heard import Lines, heard_reading
from tests.trial_checks import test_commands as trials
from tests.trial_checks.as_c3d import LABORATORY, PER_FRAME, rate_of, write_c3d
from tests.trial_checks.test_checks import GRAVITY, STANDING_STILL, marked

SECONDS = 2.0


def plate(
    kilograms: float, samples: int, sway: float = 0.0, at: float = 0.0, push: float = 0.0
) -> tuple[np.ndarray, ...]:
    """Force on the foot of who stands, where it acts, and torque there; `sway` is the share that comes and goes.

    `push` [N] is along the floor, as of who pushes at a wall.
    """
    time = np.arange(samples) / samples
    normal = kilograms * GRAVITY * (1.0 + sway * np.sin(2.0 * np.pi * 3.0 * time))
    still = np.zeros(samples)
    force = np.column_stack([still + push, normal, still])
    point = np.column_stack([at + 0.1 * np.sin(2.0 * np.pi * time), still, 0.1 * np.cos(2.0 * np.pi * time)])
    return force, point, np.zeros((samples, 3))


def recorded(folder: Path, seen: MarkerTrajectories, *plates: tuple[np.ndarray, ...]) -> Path:
    rate = round(rate_of(seen.time))
    return write_c3d(folder / "trial.c3d", seen.names, seen.positions, rate, plates)  # type: ignore[arg-type]


def repeated(seen: MarkerTrajectories) -> MarkerTrajectories:
    """The first frame for `SECONDS`, at 100 Hz."""
    frames = round(100.0 * SECONDS)
    return replace(seen, time=np.arange(frames) / 100.0, positions=np.repeat(seen.positions[:1], frames, axis=0))


def scaled(folder: Path, mass: float, **of_plate: float) -> Lines:
    """Scale of the synthetic leg that stands on a plate of 30 kg."""
    there = trials.leg_files(folder)
    seen = repeated(read_trc(there / "still.trc"))
    file = recorded(folder, seen, plate(30.0, PER_FRAME * len(seen), **of_plate))
    asked = {"model": there / "leg.osim", "mass": mass, "scale": ("femur_r=1.05",), "axes": LABORATORY}
    return heard_reading(read_scale, ScaleOptions, file, **asked)


def reached(folder: Path, mass: float, push: float = 0.0) -> Lines:
    """Shoulder simulate, up to its reading, of somebody of 82 kg who works on a plate."""
    seen = read_trc(trials.OVERHEAD / "markers.trc")
    file = recorded(folder, seen, plate(82.0, PER_FRAME * len(seen), push=push))
    asked = {"side": "right", "mass": mass, "sex": "male", "axes": LABORATORY}
    return heard_reading(read_shoulder, ShoulderSimulateOptions, file, **asked)


WORDS = "times the weight of"


def test_scale_hears_of_another_mass(tmp_path: Path) -> None:
    assert any(WORDS in line and "by the plates it is 30.0 kg" in line for line in scaled(tmp_path, 45.0))


@pytest.mark.parametrize(("mass", "sway"), [(30.0, 0.0), (32.0, 0.0), (45.0, 0.1)])
def test_scale_does_not_doubt_the_mass(mass: float, sway: float, tmp_path: Path) -> None:
    """What is on one foot changes: nobody knows where the rest of the weight is."""
    assert not any(WORDS in line for line in scaled(tmp_path, mass, sway=sway))


def test_shoulder_hears_of_pounds(tmp_path: Path) -> None:
    assert any(WORDS in line and "by the plates it is 82.0 kg" in line for line in reached(tmp_path, 180.0))


def test_shoulder_does_not_doubt_the_mass(tmp_path: Path) -> None:
    assert not any(WORDS in line for line in reached(tmp_path, 80.0))


@pytest.mark.parametrize("push", [100.0, -200.0])
def test_shoulder_does_not_doubt_a_push(push: float, tmp_path: Path) -> None:
    """Hands that push leave a force along the floor to the feet; of 12 % and 25 % of the weight."""
    assert not any("cross-talk" in line for line in reached(tmp_path, 82.0, push))


@pytest.mark.parametrize(("at", "found"), [(0.0, 1), (1.0, 0)])
def test_both_feet_have_to_be_above_the_plate(at: float, found: int, tmp_path: Path) -> None:
    """A plate 1 m ahead of the feet is another person's, or a chair's."""
    seen = repeated(marked(STANDING_STILL, walks=False))
    file = recorded(tmp_path, seen, plate(75.0, PER_FRAME * len(seen), at=at))
    on = standing_on(seen, file, turn_of(LABORATORY), None)
    assert len(on.plates) == found and on.surely == bool(found)
    assert on.stands_at is None or 0.5 <= on.stands_at <= SECONDS - 0.5
