"""Forces on the person from plates by themselves: seat-off, the chair's smooth load, the centre under the feet."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.data.errors import InputError
from geocontact.data.wrench import Wrench
from geocontact.standing_up.trial_forces import SEATED, chair_load, seat_off, steady, under_the_feet
from geocontact.standing_up.trials import StandingTrial, with_chairs

TIME = np.arange(0.0, 10.0, 0.01)
STILL = np.zeros((len(TIME), 3))


def test_the_chair_is_left_where_its_force_falls_for_good() -> None:
    """It touches 4 N at 2 s and is sat on again; from 3 s on it carries 1 N."""
    time = np.arange(6.0)
    assert seat_off(time, np.array([300.0, 300.0, 4.0, 200.0, 1.0, 1.0])) == 4.0
    with pytest.raises(InputError, match="seat-off not found: its force is never 5 N"):
        seat_off(time, np.full(6, 4.9))
    with pytest.raises(InputError, match="its force is 20 N to the end; check that the plate was set to zero"):
        seat_off(time, np.full(6, 20.0))


def test_the_running_median_keeps_falls_where_they_are() -> None:
    """Equal to what falls or rises all along; by sorting eleven samples at a time; single samples are gone."""
    fall = np.r_[300.0 * np.exp(-3.0 * TIME)]
    np.testing.assert_array_equal(steady(TIME, fall)[5:-5], fall[5:-5])
    rng = np.random.default_rng(7)
    noise = np.abs(2.0 * rng.normal(size=len(TIME)))
    wanted = [np.sort(noise[k - 5 : k + 6])[5] for k in range(5, len(TIME) - 5)]
    np.testing.assert_allclose(steady(TIME, noise)[5:-5], wanted)
    assert noise.max() > SEATED > steady(TIME, noise).max()


def test_noise_of_a_chair_is_not_given_to_the_motion() -> None:
    """White noise of 0.5 N at 100 Hz is less than half of it; 300 N let go in 0.3 s are off by 1 N at most."""
    up = 300.0 * np.clip(1.0 - TIME / 0.3, 0.0, 1.0) ** 3
    force = np.column_stack([0.0 * up, up, 0.0 * up])
    noise = 0.5 * np.random.default_rng(3).normal(size=force.shape)
    loads = [chair_load(Wrench(seen, STILL, STILL, "ground"), TIME)[:, 1] for seen in (force, force + noise)]
    assert 0.1 < np.abs(loads[0] - up).max() < 1.0
    assert np.std(loads[1] - loads[0]) < 0.25


def test_a_load_needs_even_times() -> None:
    uneven = np.r_[TIME[:-1], TIME[-1] + 0.5]
    with pytest.raises(InputError, match="times that are not even"):
        chair_load(Wrench(STILL, STILL, STILL, "ground"), uneven)


def test_the_centre_is_where_the_force_acts() -> None:
    """700 N up and 30 N forwards at 0.1 m ahead of the origin on the ground: m_z = x f_y."""
    x = 0.1 + 0.05 * np.sin(2.0 * np.pi * TIME)
    force = np.tile([30.0, 700.0, 0.0], (len(TIME), 1))
    moment = np.cross(np.column_stack([x, STILL[:, :2]]), force)
    wrench = Wrench(force, moment, STILL, "ground")
    found, centre = under_the_feet(wrench, TIME, np.zeros(len(TIME)))
    np.testing.assert_allclose(centre, x, atol=1e-15)
    np.testing.assert_array_equal(found, force[:, :2])
    with pytest.raises(InputError, match=r"is 0\.90 m ahead of the ankle"):
        under_the_feet(wrench, TIME, np.full(len(TIME), -0.8))
    lifted, lost = force.copy(), moment.copy()
    lifted[400, 1], lost[7, 2] = 10.0, np.nan
    with pytest.raises(InputError, match="carries 10 N at 4 s; the feet must stand on it throughout"):
        under_the_feet(replace(wrench, force=lifted), TIME, np.zeros(len(TIME)))
    with pytest.raises(InputError, match="has gaps within the trial"):
        under_the_feet(replace(wrench, moment=lost), TIME, np.zeros(len(TIME)))


def test_where_one_sits_the_others_have_a_chair_without_a_load() -> None:
    time, none = np.arange(3.0), np.zeros((3, 6))

    def trial(chair: np.ndarray | None) -> StandingTrial:
        return StandingTrial(time, none, none, none[:, :2], 0.0 * time, chair=chair)

    bare, sat = trial(None), trial(np.ones((3, 3)))
    assert with_chairs([bare, bare]) == (bare, bare)
    other, same = with_chairs([bare, sat])
    assert other.chair is not None and not other.chair.any() and same is sat
