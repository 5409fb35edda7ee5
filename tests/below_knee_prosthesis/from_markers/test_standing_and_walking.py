"""The leg and its motion from exact markers: round trip, a left leg as the mirror image, and what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from geocontact.below_knee_prosthesis.from_markers import (
    MIRROR,
    PELVIS,
    STANDING,
    as_right,
    functional_hip,
    hip_by_regression,
    mirrored_name,
    standing_hip,
    standing_leg,
    walked,
)
from geocontact.below_knee_prosthesis.keel.vsf import vsf_keel
from geocontact.below_knee_prosthesis.leg import Leg, Person
from geocontact.below_knee_prosthesis.leg_tree import RECORDED, recorded_tree
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.dynamics.functional_joint import FunctionalCentre
from meshes.gait_persons import PARTICIPANTS, SPINES, marker_places, true_leg

BELOW = 0.03


def seen(leg: Leg, values: np.ndarray, time: np.ndarray) -> MarkerTrajectories:
    """Exact markers of a leg."""
    poses = recorded_tree(leg).poses(values)
    places = {
        name: poses[body].apply(place)
        for body, of in marker_places(leg, vsf_keel().length).items()
        for name, place in of.items()
    }
    return MarkerTrajectories(time, np.stack([places[name] for name in STANDING], axis=1), STANDING, "exact")


@pytest.fixture(scope="module")
def leg() -> Leg:
    """With the hip where the regression puts it."""
    spines = {name: np.array(place) for name, place in SPINES.items()}
    return replace(true_leg(PARTICIPANTS[0], BELOW), hip=hip_by_regression(spines))


@pytest.fixture(scope="module")
def standing(leg: Leg) -> MarkerTrajectories:
    """Upright with the sole on the floor."""
    values = np.zeros((1, len(RECORDED)))
    values[0, RECORDED.index("pelvis_ty")] = BELOW - (leg.keel[1] - leg.thigh + leg.hip[1])
    return seen(leg, values, np.zeros(1))


def test_leg_and_motion_are_those_that_made_the_markers(leg: Leg, standing: MarkerTrajectories) -> None:
    found = standing_leg(standing, leg.person, vsf_keel(), BELOW)
    np.testing.assert_allclose(found.hip, leg.hip, atol=1e-9)
    assert found.thigh == pytest.approx(leg.thigh, abs=1e-9)
    np.testing.assert_allclose(found.ankle, leg.ankle, atol=1e-9)
    np.testing.assert_allclose(found.keel, leg.keel, atol=1e-9)
    assert (found.turn.inv() * leg.turn).magnitude() < 1e-9
    time = np.arange(0.0, 0.3, 0.02)
    values = np.zeros((len(time), len(RECORDED)))
    for k in range(len(RECORDED)):
        values[:, k] = 0.1 * np.sin(4.0 * time + k) + (1.2 * time if k == 3 else 0.0)
    motion = walked(seen(leg, values, time), found, cutoff=None, gap_limit=0.1)
    assert motion.off.max() < 1e-7
    np.testing.assert_allclose(motion.motion.values, values, atol=1e-6)


def test_a_left_leg_is_the_mirror_image(leg: Leg, standing: MarkerTrajectories) -> None:
    names = tuple(mirrored_name(name) for name in standing.names)
    left = MarkerTrajectories(standing.time, standing.positions * MIRROR, names, "left")
    one = standing_leg(as_right(left, "left"), leg.person, vsf_keel(), BELOW)
    other = standing_leg(standing, leg.person, vsf_keel(), BELOW)
    np.testing.assert_allclose(one.keel, other.keel, atol=1e-15)
    with pytest.raises(InputError, match="left and right are exchanged"):
        standing_leg(MarkerTrajectories(left.time, left.positions, standing.names, ""), leg.person, vsf_keel(), BELOW)


def test_functional_trial_finds_the_hip(leg: Leg) -> None:
    rng = np.random.default_rng(5)
    values = np.zeros((60, len(RECORDED)))
    values[:, 6:9] = 0.5 * rng.standard_normal((60, 3))
    spines = np.array([SPINES[name] for name in PELVIS])
    found = functional_hip(seen(leg, values, np.arange(60.0)), spines)
    assert isinstance(found, FunctionalCentre)
    np.testing.assert_allclose(found.first, leg.hip, atol=1e-6)


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda p: p * 1e3, "the keel is 229 mm long"),
        (lambda p: Rotation.from_euler("x", 90.0, degrees=True).apply(p[0])[None], "y must be up"),
    ],
    ids=["unit", "axes"],
)
def test_a_wrong_unit_or_axis_is_refused(standing: MarkerTrajectories, spoil: object, words: str) -> None:
    with pytest.raises(InputError, match=words):
        standing_leg(replace(standing, positions=spoil(standing.positions)), Person(77.0), vsf_keel(), BELOW)  # type: ignore[operator]


def test_markers_on_a_line_are_refused(standing: MarkerTrajectories) -> None:
    places = standing.positions.copy()
    at = [STANDING.index(name) for name in ("RTH1", "RTH2", "RTH3", "RKNE")]
    places[:, at] = (
        places[:, at[:1]] + (places[:, at[3:]] - places[:, at[:1]]) * np.array([0.0, 0.4, 0.7, 1.0])[:, None]
    )
    with pytest.raises(InputError, match="lie on a line"):
        standing_leg(replace(standing, positions=places), Person(77.0), vsf_keel(), BELOW)


def test_both_trials_together_find_the_hip_wherever_the_person_stood(leg: Leg, standing: MarkerTrajectories) -> None:
    """In the standing pelvis' frame, though the person stood elsewhere and turned."""
    values = np.zeros((60, len(RECORDED)))
    values[:, 6:9] = 0.5 * np.random.default_rng(5).standard_normal((60, 3))
    turn = Rotation.from_euler("y", 0.4)
    places = turn.apply(standing.positions.reshape(-1, 3)).reshape(standing.positions.shape)
    places = places + np.array([0.3, 0.0, -1.0])
    elsewhere = replace(standing, positions=places)
    found = standing_hip(elsewhere, seen(leg, values, np.arange(60.0)))
    np.testing.assert_allclose(found.first, leg.hip, atol=1e-6)
