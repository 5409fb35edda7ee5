"""Whether a plate is under a foot, carries a person and runs on the markers' clock."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.evaluation import PlateStance
from geocontact.below_knee_prosthesis.plate_checks import (
    clock_offset,
    covered_stances,
    part_of,
    require_covering,
    require_near_heel,
    require_one_clock,
    require_under_foot,
    require_weight,
    whole_stances,
)
from geocontact.data.errors import InputError

TIME = np.arange(0.0, 1.0, 0.01)


def plate(most: float = 800.0, begins: float = 0.2, centre: float = 0.1) -> PlateStance:
    """Loaded for half a second, at a place along x."""
    force = np.zeros((len(TIME), 3))
    force[(begins - 1e-9 < TIME) & (begins + 0.5 + 1e-9 > TIME), 1] = most
    place = np.where(force[:, 1:2] > 0.0, np.array([centre, 0.0, 0.0]), np.nan)
    return PlateStance(TIME, force, place, "left_plate", "walk.mot")


@pytest.mark.parametrize("shift", [-0.15, -0.02, 0.0, 0.08])
def test_offset_of_clocks_is_the_smaller_of_both_ends(shift: float) -> None:
    """A foot that lands 20 ms late by its height and leaves on time."""
    time = np.arange(-0.3, 1.3, 0.01)
    height = np.where((time > 0.02) & (time < 0.7), -0.01, 0.02)
    plates = np.arange(-0.3, 1.3, 0.002)
    load = np.where((plates > shift) & (plates < 0.7 + shift), 700.0, 0.0)
    ends = shift - 0.02, shift
    wanted = 0.0 if ends[0] * ends[1] <= 0.0 else np.sign(shift) * min(map(abs, ends))
    assert clock_offset(time, height, plates, load) == pytest.approx(wanted, abs=0.015)


@pytest.mark.parametrize("share", [0.29, 5.1])
def test_a_force_that_no_step_makes_is_refused(share: float) -> None:
    weight = 77.3 * 9.81
    for usual in (0.31, 1.2, 4.9):
        require_weight(plate(usual * weight), weight)
    with pytest.raises(InputError, match=f"walk.mot `other`: .* left_plate is {share:.3g} times body weight"):
        require_weight(plate(share * weight), weight, "`other`")


def test_a_plate_that_is_late_is_refused() -> None:
    """The sole is on the floor from 0.2 to 0.7 s."""
    height = np.where((TIME > 0.195) & (TIME < 0.705), -0.005, 0.03)
    require_one_clock(plate(begins=0.25), TIME, height)
    with pytest.raises(InputError, match=r"loaded 0.0[789] s after the markers touch the floor"):
        require_one_clock(plate(begins=0.28), TIME, height)
    with pytest.raises(InputError, match=r"loaded 0.(09|1[01]) s before the markers"):
        require_one_clock(plate(begins=0.1), TIME, height)


def test_a_centre_of_pressure_belongs_to_the_foot_above_it() -> None:
    require_under_foot(plate(), np.array([np.nan, 0.0, 0.4, 1.0]))
    for elsewhere in (np.full(5, np.nan), np.array([1.6, 1.7, np.nan])):
        with pytest.raises(InputError, match="no plate under the foot"):
            require_under_foot(plate(), elsewhere)
    heel = RigidTransform.from_translation(np.tile([0.0, 0.5, 0.3], (len(TIME), 1)))  # whatever its height
    require_near_heel(plate(centre=0.25), heel, TIME)  # 0.39 m
    with pytest.raises(InputError, match=r"is 0.42 m from its heel"):
        require_near_heel(plate(centre=0.3), heel, TIME)


def test_a_plate_is_recorded_as_long_as_the_markers() -> None:
    require_covering(plate(), np.array([-0.02, 1.01]))
    for time in ([-0.03, 0.9], [0.1, 1.02]):
        with pytest.raises(InputError, match="both need one clock"):
            require_covering(plate(), np.array(time))


def test_a_stance_has_its_part_of_the_plate() -> None:
    """Markers see the three in the middle of five stances: each is alone in its part, though others are longer."""
    time, stances = np.arange(0.0, 6.0, 0.001), [(0.1, 0.9), (1.3, 1.95), (2.5, 3.35), (3.8, 4.45), (4.9, 5.7)]
    loads = [800.0 * np.sin(np.pi * np.clip((time - down) / (off - down), 0.0, 1.0)) for down, off in stances]
    force = np.column_stack([0.0 * time, np.sum(loads, axis=0), 0.0 * time])
    seen = PlateStance(time, force, 0.0 * force)
    covered = covered_stances(seen, 1.1, 4.7)
    assert np.array(covered) == pytest.approx(np.array(stances[1:4]), abs=0.01)
    for stance in covered:
        part = part_of(seen, *stance)
        assert whole_stances(part) == [pytest.approx(stance, abs=1e-9)]
