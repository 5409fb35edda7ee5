"""Torques of hip and knee kept on another foot: what the equations are, and what comes of it beside angles kept."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.design.foot_map import PLACES, FootMap, feet_on_ground
from geocontact.below_knee_prosthesis.design.foot_task import (
    bias,
    force_along,
    mass_matrix,
    point_of_shank,
    thigh_direction,
    turned,
)
from geocontact.below_knee_prosthesis.design.knob import Knob
from geocontact.below_knee_prosthesis.design.outcomes import outcomes
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY
from tests.below_knee_prosthesis.design.tasks import a_task

PRESENT = 0.117


@pytest.fixture(scope="module")
def knob() -> Knob:
    return Knob("fulcrum", np.array([0.08, PRESENT, 0.14]), PRESENT)


@pytest.fixture(scope="module")
def maps(knob: Knob) -> tuple[FootMap, ...]:
    return knob.maps(vsf_foot(), a_task())


def energy(q: np.ndarray, u: np.ndarray) -> tuple[float, float]:
    """Of motion and of height, from the places of the three masses and nothing else [J]."""
    leg = a_task().leg
    (m1, a, i1), (m2, i2) = leg.thigh, leg.shank

    def places(at: np.ndarray) -> np.ndarray:
        up = thigh_direction(np.asarray(at[2]))
        return np.stack(
            [at[:2], at[:2] - a * up, at[:2] - leg.length * up - turned(np.asarray(at[3]), leg.knee - leg.centre)]
        )

    masses, step = np.array([leg.body, m1, m2]), 1e-6
    speeds = (places(q + step * u) - places(q - step * u)) / (2.0 * step)
    moving = 0.5 * float(masses @ (speeds**2).sum(axis=1)) + 0.5 * (i1 * u[2] ** 2 + i2 * u[3] ** 2)
    return moving, GRAVITY * float(masses @ places(q)[:, 1])


def test_power_of_all_forces_is_what_energy_gains() -> None:
    """Mass matrix, weight and centrifugal forces against energies that are written down from the places."""
    leg, rng = a_task().leg, np.random.default_rng(1)
    q, u, a = rng.normal(0.0, 0.5, (3, 4))
    assert 0.5 * u @ mass_matrix(leg, q) @ u == pytest.approx(energy(q, u)[0], rel=1e-8)
    step = 1e-5
    after, before = (sum(energy(q + s * u + 0.5 * s**2 * a, u + s * a)) for s in (step, -step))
    needed = mass_matrix(leg, q) @ a + bias(leg, q, u)
    assert u @ needed == pytest.approx((after - before) / (2.0 * step), rel=1e-6)


def test_force_along_has_the_power_of_the_force() -> None:
    leg, rng = a_task().leg, np.random.default_rng(2)
    q, u = rng.normal(0.0, 0.5, (2, 4))
    point, force = np.array([0.15, -0.03]), np.array([40.0, 700.0])
    _, speed = point_of_shank(leg, q, u, point)
    assert u @ force_along(leg, q, point, force) == pytest.approx(force @ speed, rel=1e-12)


def test_a_foot_bears_at_a_height_the_load_that_the_map_has_there(maps: tuple[FootMap, ...]) -> None:
    feet, task = feet_on_ground(maps[:-1]), a_task()
    for pitch, load in zip(task.pitch, task.load, strict=True):
        both = np.full(3, pitch), np.full(3, load)
        told = np.stack([each.at(*(of[:1] for of in both))[0] for each in maps[:-1]])
        found, centre = feet.borne(both[0], told[:, 0])
        np.testing.assert_allclose(found, load, rtol=1e-9)
        np.testing.assert_allclose(centre, told[:, 1:PLACES], atol=1e-9)
        np.testing.assert_allclose(feet.height(*both), told[:, 0], atol=1e-12)


def test_on_the_present_foot_its_own_torques_alone_make_the_recorded_stance(
    knob: Knob, maps: tuple[FootMap, ...]
) -> None:
    """On others they fold the leg within the stance."""
    task = a_task()
    alone = knob.other_feet(maps, task, tracking=0.0).moved()
    assert np.abs(alone.off[:, 1]).max() < 1e-7
    np.testing.assert_allclose(np.interp(task.time, alone.time, alone.load[:, 1]), task.load, rtol=1e-3)
    assert alone.held[1] == pytest.approx(task.time[-1])
    assert (alone.held[[0, 2]] < 0.8 * task.time[-1]).all()


def test_both_ends_of_what_a_person_does(knob: Knob, maps: tuple[FootMap, ...]) -> None:
    """On the present foot they are one; on others the leg gives way to its torques, by some degrees."""
    carried = knob.carried(maps, a_task())
    angles, torques = ([outcomes(each) for each in carried[of]] for of in ("angles kept", "joint torques kept"))
    for aim in angles[1]:
        assert torques[1][aim] == pytest.approx(angles[1][aim], rel=2e-3), aim  # on the present foot
    for aim in ("energy", "radius"):
        assert np.sign(np.diff([each[aim] for each in torques])) == pytest.approx(
            np.sign(np.diff([each[aim] for each in angles]))
        )
    turned_by = np.degrees([np.abs(each.tilt).max() for each in carried["joint torques kept"]])
    assert turned_by[1] < 0.01 and (turned_by[[0, 2]] > 0.2).all() and (turned_by < 8.0).all()


def test_maps_of_other_rows_are_refused(maps: tuple[FootMap, ...]) -> None:
    other = FootMap(maps[0].keel, maps[0].pitch + 0.1, maps[0].load, maps[0].table, maps[0].dragged)
    with pytest.raises(ValueError, match="other rows"):
        feet_on_ground((maps[0], other))
