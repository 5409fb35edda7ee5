"""Bands over draws, differences and answers of a sweep, by hand."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.design.foot_task import Terrain
from geocontact.below_knee_prosthesis.design.knob import AIMS, Knob
from geocontact.below_knee_prosthesis.design.sweep import Sweep, Together, band, usual_target
from geocontact.below_knee_prosthesis.design.varied import ends_of, known_pitch
from geocontact.below_knee_prosthesis.leg import AS_STOOD, FootOffset
from tests.below_knee_prosthesis.design.tasks import a_task

VALUES = np.array([0.07, 0.1, 0.13, 0.15])
RADIUS = AIMS.index("radius")


def a_sweep(draws: int = 21) -> Sweep:
    """Every outcome is 1000 times the fulcrum, and each draw is off by its own share of -1 to 1, whatever the value."""
    shift = np.linspace(-1.0, 1.0, draws)
    drawn = np.broadcast_to(1e3 * VALUES[:, None], (draws, 3, len(VALUES), len(AIMS))) + shift[:, None, None, None]
    return Sweep(Knob("fulcrum", VALUES, 0.12), drawn, 2.0 * drawn, 0.9)


def test_a_band_is_median_and_ends() -> None:
    np.testing.assert_allclose(band(np.arange(101.0), 0.9), [50.0, 5.0, 95.0])
    bands = a_sweep().bands
    np.testing.assert_allclose(bands[0, 0, :, 0], 2e3 * VALUES)
    np.testing.assert_allclose(bands[2] - bands[1], 2.0 * 2.0 * 0.9)
    np.testing.assert_allclose(a_sweep().ends, 2e3 * np.broadcast_to(VALUES[:, None], (2, len(VALUES), len(AIMS))))


def test_a_difference_is_taken_within_each_draw() -> None:
    """What all values share falls out of it."""
    found = a_sweep().difference(0, 0)
    assert (found.median, found.lower, found.upper) == pytest.approx((160.0, 160.0, 160.0))
    assert not found.small and not found.unsure
    one = a_sweep()
    same = Sweep(one.knob, one.drawn, one.free[:, :, :1].repeat(4, axis=2), one.level).difference(0, 0)
    assert same.small and same.unsure


def test_an_aim_is_what_is_wanted_else_what_the_intact_side_has_else_the_usual() -> None:
    task = a_task()
    found = dict(zip(AIMS, a_sweep().answers(task, {"energy": 110.0}, {"radius": 100.0}), strict=True))
    assert found["energy"].target == 110.0 and not found["energy"].of_intact
    assert found["radius"].target == 100.0 and found["radius"].wanted == "nearest to the intact side's 100 m"
    assert found["radius"].choice.best == pytest.approx(0.1, abs=2e-3)
    assert found["ankle_moment"].target is None and found["ankle_moment"].wanted == "the least"
    assert usual_target("radius", task) == pytest.approx(0.3 * task.leg_length)
    (usual,) = (each for each in a_sweep().answers(task, {}, {}) if each.aim == "radius")
    assert usual.target == pytest.approx(0.3 * task.leg_length)


def test_a_pair_is_judged_as_the_value_alone_is() -> None:
    """An outcome that the turn makes less, the more the better."""
    sweep, turns = a_sweep(), np.radians([-3.0, 0.0, 3.0])
    beside = sweep.drawn[:, None, :2] * np.array([0.5, 1.0, 1.5])[:, None, None, None]
    pair = Together.of(VALUES, turns, beside, sweep.answers(a_task(), {}, {}), 0.9)
    least = pair.choices["ankle_moment"]
    assert (least.value, least.alignment) == (VALUES[0], turns[0])
    np.testing.assert_allclose(pair.bands[0, 0, 0, :, RADIUS], 500.0 * VALUES)


def test_ends_have_the_present_value_between_them() -> None:
    knob = Knob("fulcrum", VALUES, 0.12, Terrain(0.05))
    assert ends_of(knob).settings.tolist() == [0.07, 0.12, 0.15] and ends_of(knob).terrain == knob.terrain
    assert ends_of(Knob("fulcrum", VALUES, 0.07)).settings.tolist() == [0.07, 0.15]


def test_a_pitch_is_known_as_well_as_its_offset_or_better() -> None:
    assert known_pitch(AS_STOOD, 0.01) == 0.01
    assert known_pitch(FootOffset(pitch_sd=0.002), 0.01) == 0.002
    assert known_pitch(FootOffset(pitch_sd=0.02), 0.01) == 0.01
