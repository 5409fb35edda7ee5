"""Cycles of a walk: heel strikes from loads, and curves that are cut at them."""

from __future__ import annotations

import numpy as np

from geocontact.data.wrench import Wrench
from geocontact.identify.signals.gait_cycles import gait_cycles, strikes_on_plates

TIME = np.arange(501) / 100.0
UP = np.array([0.0, 1.0, 0.0])


def test_each_side_is_cut_at_its_own_strikes() -> None:
    """A cosine of 1.25 s: strikes at its crests for the right, half a period later for the left; the rest as right."""
    wave = np.cos(2.0 * np.pi * TIME / 1.25)
    values = np.column_stack([wave, wave, 3.0 + wave, np.full(len(TIME), 7.0)])
    strikes = {"left": 0.625 + 1.25 * np.arange(4), "right": 1.25 * np.arange(9)}
    names = ("knee_r", "knee_l", "pelvis_tilt", "mtp_r")
    cycles = gait_cycles(TIME, names, ("deg",) * 4, values, strikes)
    assert cycles.counts == {"right": 4, "left": 3}, "strikes beyond the recording do not count"
    shape = np.cos(2.0 * np.pi * np.arange(101) / 100.0)
    for name, expected in (("knee_r", shape), ("knee_l", -shape), ("pelvis_tilt", 3.0 + shape)):
        np.testing.assert_allclose(cycles.curves[name], np.broadcast_to(expected, cycles.curves[name].shape), atol=2e-3)
    assert "mtp_r" not in cycles.curves, "locked"
    assert not gait_cycles(TIME, names, ("deg",) * 4, values, {"right": np.array([1.0])})


def test_plates_tell_strikes_by_the_side_of_their_bodies() -> None:
    """Right feet on from 1 to 1.7 and 2.2 to 2.9 s, left feet once; a body without a side tells nothing."""

    def load(*spans: tuple[float, float]) -> Wrench:
        on = np.any([np.logical_and(a <= TIME, b > TIME) for a, b in spans], axis=0)
        force = np.outer(np.where(on, 700.0, 0.0), UP)
        return Wrench(force, 0.0 * force, 0.0 * force, "ground")

    loads = {"calcn_r": load((1.0, 1.7), (2.2, 2.9)), "calcn_l": load((1.6, 2.3)), "hand": load((0.5, 0.9), (1.5, 2.0))}
    found = strikes_on_plates(TIME, loads, UP, 20.0)
    np.testing.assert_allclose(found["right"], [1.0, 2.2], atol=0.01)
    assert set(found) == {"right", "left"} and len(found["left"]) == 0


def test_strikes_stand_where_the_load_passes_the_onset() -> None:
    """A ramp of 1000 N/s twice: 200 N are reached 0.2 s after it begins, 20 N after 0.02 s."""
    ramp = np.clip(1000.0 * (TIME % 2.0 - 1.0), 0.0, None)
    force = np.outer(ramp, UP)
    loads = {"calcn_l": Wrench(force, 0.0 * force, 0.0 * force, "ground")}
    for onset in (20.0, 200.0):
        found = strikes_on_plates(TIME, loads, UP, onset)["left"]
        np.testing.assert_allclose(found, [1.0 + onset / 1000.0, 3.0 + onset / 1000.0], atol=1e-9)
