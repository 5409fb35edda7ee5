"""A recorded walk of both legs: coordinates of exact markers, loads on the floor, errors and differences by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.both_sides.amputee import Amputee
from geocontact.below_knee_prosthesis.both_sides.amputee_tree import amputee_tree
from geocontact.below_knee_prosthesis.both_sides.joint_work import joint_moments, joint_work, metabolic_proxy
from geocontact.below_knee_prosthesis.both_sides.recorded_steps import (
    centre_on_floor,
    force_errors,
    load_errors,
    played_back,
    recorded_steps,
    single_support,
)
from geocontact.below_knee_prosthesis.both_sides.walk import WholeMotion
from geocontact.below_knee_prosthesis.evaluation import PlateStance
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_foot
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY
from geocontact.data.multibody.markers import MarkerTrajectories
from meshes.amputee import true_amputee
from meshes.amputee_walk import amputee_walk
from meshes.gait_persons import PARTICIPANTS

MASS = 77.3
WEIGHT = MASS * GRAVITY
TIME = np.arange(0.0, 1.0, 0.002)


@pytest.fixture(scope="module")
def truth() -> Amputee:
    return true_amputee(PARTICIPANTS[0], vsf_foot(), fulcrum_of("medium"))


def plate(begins: float, ends: float) -> PlateStance:
    inside = ((begins <= TIME) & (ends >= TIME))[:, None]
    force = np.where(inside, [30.0, 700.0, -20.0], 0.0)
    return PlateStance(TIME, force, np.where(inside, [0.4, 0.0, 0.1], np.nan))


def test_exact_markers_give_the_coordinates_and_the_plate_the_load(truth: Amputee) -> None:
    given, _ = amputee_walk(truth, 0.72)
    few = slice(20, 40)
    model = amputee_tree(truth)
    values = np.zeros((20, len(model.coordinates)))
    for k, coordinate in enumerate(model.coordinates):
        if coordinate.name in given.names:
            values[:, k] = given.values[few, given.names.index(coordinate.name)]
    places, names = model.marker_places(values), tuple(m.name for m in model.markers)
    seen = MarkerTrajectories(given.time[few], places, names, "walk")
    other = replace(plate(0.2, 0.3), time=TIME - 0.2)
    found = recorded_steps(truth, seen, other, cutoff=None, gap_limit=0.1)
    np.testing.assert_allclose(found.given.values, given.values[few], atol=1e-6)
    inside = (found.given.time > 0.005) & (found.given.time < 0.095)
    by_hand = [30.0, 700.0, -20.0, *np.cross([0.4, 0.0, 0.1], [30.0, 700.0, -20.0])]
    np.testing.assert_allclose(found.given.ground[inside], np.broadcast_to(by_hand, (inside.sum(), 6)))
    assert inside.any() and not found.given.ground[found.given.time < -0.005].any()


def test_a_load_crosses_the_floor_where_it_acts() -> None:
    force, place = np.array([[50.0, 600.0, -30.0], [0.0, 10.0, 0.0]]), np.array([0.7, 0.0, -0.2])
    found = centre_on_floor(np.hstack([force, np.cross(place, force)]))
    np.testing.assert_allclose(found[0], place, atol=1e-12)
    assert np.isnan(found[1]).all()


def test_single_support_is_between_the_other_foots_stances() -> None:
    other = plate(0.0, 0.3)
    again = replace(other, force=other.force + plate(0.7, 0.9).force)
    found = single_support(plate(0.2, 0.8), again)
    assert found == pytest.approx((0.3, 0.7), abs=0.003)
    assert single_support(plate(0.2, 0.4), plate(0.1, 0.5)) is None


def test_errors_are_over_the_plates_stance_and_what_was_simulated() -> None:
    """A force that is a tenth too large from 0.5 s on, simulated up to 0.65 s."""
    seen = PlateStance(TIME, np.outer(np.sin(np.pi * TIME), [0.0, 700.0, 0.0]), np.zeros((len(TIME), 3)))
    own = seen.force * np.where(TIME < 0.5, 1.0, 1.1)[:, None]
    until = TIME <= 0.65
    found = force_errors(TIME[until], own[until], seen, MASS)
    at = np.linspace(np.arcsin(20.0 / 700.0) / np.pi, 1.0 - np.arcsin(20.0 / 700.0) / np.pi, 101)
    off = np.where(at < 0.5, 0.0, 0.1) * 700.0 * np.sin(np.pi * at) / WEIGHT
    assert found["vertical"].rmsd == pytest.approx(np.sqrt(np.mean(off[at <= 0.648] ** 2)), rel=0.05)
    assert found["resultant"].rmsd == pytest.approx(found["vertical"].rmsd) and found["fore_aft"].rmsd == 0.0
    assert force_errors(TIME, own, plate(2.0, 3.0), MASS) == {}


def motion(q: np.ndarray, up: float) -> WholeMotion:
    names = ("pelvis_tilt", "pelvis_ty", "knee_flexion_r")
    own = np.zeros((len(TIME), 6))
    own[:, 1] = up
    return WholeMotion(TIME, names, q, 0.0 * q, own, 0.0 * own, 1)


def test_differences_that_grow_are_held_until_half_a_degree() -> None:
    """An angle that is 0.01 degrees exp(9 t) off: 0.5 degrees after ln(50)/9 = 0.435 s."""
    off = np.column_stack([0.0 * TIME, 2e-3 + 0.0 * TIME, np.radians(0.01) * np.exp(9.0 * TIME)])
    found = played_back(motion(0.0 * off, 700.0), motion(off, 700.0), MASS)
    assert found.held == pytest.approx(np.log(50.0) / 9.0, abs=0.003)
    assert found.growth == pytest.approx(9.0, rel=1e-6)
    assert found.shift[-1] == pytest.approx(2.0) and found.force[-1] == 0.0
    lost = played_back(motion(0.0 * off, 700.0), motion(0.0 * off, 700.0 + 0.03 * WEIGHT), MASS)
    assert lost.held == 0.0 and np.isnan(lost.growth)


def test_work_of_a_joint_by_hand() -> None:
    """A moment of 10 N m sin against a rate of 2 rad/s sin over a whole turn, then the other way round."""
    time = np.linspace(0.0, 1.0, 20001)
    wave = np.sin(2.0 * np.pi * time)
    rates = np.column_stack([wave, 2.0 * wave, 2.0 * wave, wave])
    forces = np.column_stack([wave, 10.0 * wave, -10.0 * wave, wave])
    names = ("pelvis_tilt", "hip_flexion_r", "knee_flexion_l", "keel_1_r")
    moments, found = joint_moments(time, names, forces), joint_work(time, names, rates, forces)
    assert list(moments) == ["hip_flexion_r", "knee_flexion_l"] and list(found) == ["hip_r", "knee_l"]
    hip, knee = found.values()
    flexion = moments["hip_flexion_r"]
    assert (flexion.peak, flexion.mean) == pytest.approx((10.0, 20.0 / np.pi), rel=1e-6)
    assert (hip.positive, hip.negative) == pytest.approx((10.0, 0.0), abs=1e-6)
    assert (knee.positive, knee.negative) == pytest.approx((0.0, 10.0), abs=1e-6)
    assert metabolic_proxy(found) == pytest.approx(10.0 / 0.25 + 10.0 / 1.2, rel=1e-6)


def test_work_of_a_joint_is_that_of_its_coordinates_together() -> None:
    """One hip gains 50 W in flexion and loses 40 W in adduction for 0.1 s: 1 J, which costs 4 J; apart 23.3 J."""
    time = np.linspace(0.0, 0.1, 11)
    names = ("hip_flexion_r", "hip_adduction_r", "hip_flexion_l")
    rates, forces = np.ones((11, 3)), np.ones((11, 1)) * np.array([50.0, -40.0, 0.0])
    found = joint_work(time, names, rates, forces)
    assert found["hip_r"].positive == pytest.approx(1.0) and found["hip_r"].negative == 0.0
    assert metabolic_proxy(found) == pytest.approx(4.0)


def test_a_centre_of_pressure_is_compared_where_both_are_known() -> None:
    """A load at x = 0.1 + 0.3 t beside a plate that has it 5 mm further and 2 mm aside: the differences, in metres."""
    up = 700.0 * np.sin(np.pi * np.clip((TIME - TIME[0]) / np.ptp(TIME), 0.0, 1.0))
    force = up[:, None] * np.array([0.0, 1.0, 0.0])
    centre = np.column_stack([0.1 + 0.3 * TIME, 0.0 * TIME, 0.05 + 0.0 * TIME])
    seen = np.where(up[:, None] > 100.0, centre + np.array([0.005, 0.0, -0.002]), np.nan)
    plate = PlateStance(TIME, force, seen)
    found = load_errors(TIME, np.hstack([force, np.cross(centre, force)]), plate, MASS)
    assert found["cop_x"].rmsd == pytest.approx(0.005, rel=1e-6)
    assert found["cop_z"].rmsd == pytest.approx(0.002, rel=1e-6)
    assert found["vertical"].rmsd == pytest.approx(0.0, abs=1e-9) and found["cop_x"].samples < 101
