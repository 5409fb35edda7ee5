"""The foot in its plane, its rows, and the numbers with which a rigid one is nearest."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.foot_in_plane import FootInPlane, in_plane, plane_trial, row_numbers, rows_of
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from tests.below_knee_prosthesis.stances import a_stance
from tests.below_knee_prosthesis.test_stance_errors import plate_of, walked

TIME = np.linspace(0.0, 0.7, 141)


def rolled() -> FootInPlane:
    """A foot that lands on its heel and leaves over its toes."""
    share = TIME / TIME[-1]
    pitch = 0.3 - 0.6 * share
    lowest = np.where(pitch > 0.0, 0.0, 0.2 * -np.sin(pitch))
    return FootInPlane(TIME, 0.1 * share, 0.03 - 0.008 * np.sin(np.pi * share) + lowest, pitch, np.eye(3)[0])


def test_a_plane_holds_the_foot_and_what_presses_on_it() -> None:
    """A foot that walks 30 degrees beside x: advance along it, and a point of the ground has its place on the foot."""
    out, pitch = np.radians(30.0), np.array([0.2, 0.0, -0.3])
    turn = Rotation.from_euler("y", out) * Rotation.from_euler("z", pitch[:, None])
    along = np.array([np.cos(out), 0.0, -np.sin(out)])
    place = np.array([0.0, 0.1, 0.2])[:, None] * along + np.array([0.0, 0.02, 0.0])
    foot = in_plane(np.arange(3.0), RigidTransform.from_components(place, turn))
    np.testing.assert_allclose(foot.forward, along, atol=1e-12)
    np.testing.assert_allclose(foot.x, [0.0, 0.1, 0.2], atol=1e-12)
    np.testing.assert_allclose(foot.pitch, pitch, atol=1e-12)
    ground = foot.x + 0.12 / np.cos(pitch) + foot.y * np.tan(pitch)  # 0.12 along the foot, in the ground
    force = np.array([10.0, 50.0, 5.0])[:, None] * along + np.array([0.0, 500.0, 0.0])
    force[2, 1] = 19.0
    ahead, up, centre = foot.reaction(force, ground[:, None] * along)
    np.testing.assert_allclose(ahead, [10.0, 50.0, 5.0])
    np.testing.assert_allclose(up, [500.0, 500.0, 19.0])
    np.testing.assert_allclose(centre[:2], 0.12, atol=1e-12)
    assert np.isnan(centre[2])


def test_rows_are_numbered_within_their_zone() -> None:
    rows = rows_of(vsf_foot().sole.spheres)
    heel, mid, fore = ("heel_back", "heel_middle", "heel_front"), "midfoot", "forefoot"
    assert list(dict.fromkeys(rows)) == [
        *heel,
        *(f"{mid}_{k}" for k in range(1, 5)),
        *(f"{fore}_{k}" for k in range(1, 6)),
    ]
    assert all(rows.count(row) == 2 for row in rows)


def test_numbers_of_a_rigid_foot_are_found_again() -> None:
    """Forces of the law itself at other numbers for each row: nothing is off but the rate by differences."""
    foot, whole = rolled(), vsf_foot()
    spheres, law, rows = whole.sole.spheres, whole.law, rows_of(whole.sole.spheres)
    names = list(dict.fromkeys(rows))
    wanted = dict(zip(names, np.linspace(8e3, 30e3, len(names)), strict=True))
    s, c = np.sin(foot.pitch)[:, None], np.cos(foot.pitch)[:, None]
    depth = spheres.radius - foot.y[:, None] - spheres.centre[:, 0] * s - spheres.centre[:, 1] * c
    pressing = np.array([wanted[row] for row in rows]) * np.maximum(depth, 0.0)
    up = pressing.sum(axis=1)
    with np.errstate(invalid="ignore"):
        centre = (pressing * (spheres.centre[:, 0] - s * spheres.radius)).sum(axis=1) / up
    found = row_numbers(foot, spheres, law, up, centre)
    assert found.stiffness == pytest.approx(wanted, rel=1e-6)
    assert max(found.damping.values()) < 1e-3 and found.off < 1e-6


def test_rows_are_those_of_the_least_squares_by_hand() -> None:
    """Force, and moment about the heel over 5 cm: no step of one row's numbers makes their sum of squares less."""
    foot, whole = rolled(), vsf_foot()
    spheres, law, rows = whole.sole.spheres, whole.law, rows_of(whole.sole.spheres)
    rng = np.random.default_rng(3)
    force = 700.0 * np.sin(np.pi * TIME / TIME[-1]) + 20.0 * rng.normal(size=len(TIME))
    centre = 0.2 * TIME / TIME[-1]
    found = row_numbers(foot, spheres, law, force, centre)

    def squares(stiffness: dict[str, float], damping: dict[str, float]) -> float:
        total = 0.0
        depths = np.zeros((len(TIME), len(rows)))
        for t, (y, pitch) in enumerate(zip(foot.y, foot.pitch, strict=True)):
            for s, ((px, py, _), radius) in enumerate(zip(spheres.centre, spheres.radius, strict=True)):
                depths[t, s] = max(radius - (y + px * np.sin(pitch) + py * np.cos(pitch)), 0.0)
        rates = np.maximum(np.gradient(depths, TIME, axis=0), 0.0)
        for t, pitch in enumerate(foot.pitch):
            up, moment = 0.0, 0.0
            for s, row in enumerate(rows):
                share = min(depths[t, s] / law.full_depth, 1.0)
                pressed = stiffness[row] * depths[t, s] ** law.exponent
                pressed += damping[row] * rates[t, s] * share**2 * (3.0 - 2.0 * share)
                up += pressed
                moment += pressed * (spheres.centre[s, 0] - np.sin(pitch) * spheres.radius[s])
            total += (up - force[t]) ** 2 + ((moment - force[t] * centre[t]) / 0.05) ** 2
        return total

    least = squares(found.stiffness, found.damping)
    for row in list(dict.fromkeys(rows))[::4]:
        for by in (0.98, 1.02):
            moved = {**found.stiffness, row: by * found.stiffness[row] + 1e-3}
            assert squares(moved, found.damping) >= least * (1.0 - 1e-12)


def test_a_trial_is_the_loaded_foot_and_a_twentieth_of_a_second_around_it() -> None:
    """A plate that is loaded from 0.1 to 0.8 s, beside markers on a foot that stands at x = 0."""
    own, time = np.arange(0.0, 0.95, 0.002), np.arange(-0.1, 1.0, 0.01)
    still = RigidTransform.from_components(np.tile([0.0, 0.03, 0.0], (len(time), 1)), Rotation.identity(len(time)))
    stance, plate = a_stance(own, walked(own)), plate_of(own)
    found = plane_trial(time, still, plate, stance)
    assert found is not None and found.reaction is not None
    assert found.foot.time[[0, -1]] == pytest.approx([0.05, 0.85], abs=0.011)
    ahead, up, centre = found.reaction
    np.testing.assert_allclose(ahead, np.interp(found.foot.time, own, walked(own)[:, 0]), atol=1e-9)
    np.testing.assert_allclose(up, np.interp(found.foot.time, own, walked(own)[:, 1]), atol=1e-9)
    inside = (found.foot.time > 0.15) & (found.foot.time < 0.75)
    np.testing.assert_allclose(centre[inside], 0.05 + 0.2 * (found.foot.time[inside] - 0.1), atol=1e-9)
    alone = plane_trial(time, still, None, stance)
    assert alone is not None and alone.reaction is None
    assert plane_trial(time, still, None, a_stance(own)) is None
