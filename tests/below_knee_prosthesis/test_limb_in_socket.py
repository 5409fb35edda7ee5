"""The limb's motion from exact markers on a socket that gives: force beside the stance that made the markers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.from_markers import BODIES, Walked, walked
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY, LegMotion
from geocontact.below_knee_prosthesis.limb_in_socket import LimbInSocket, limb_in_socket, without_socket
from geocontact.below_knee_prosthesis.simulate import Stance, simulate_stance
from geocontact.data.multibody.markers import MarkerTrajectories
from tests.below_knee_prosthesis.socket_markers import body_places, markers_of, planted_stance

MEDIUM, HIGH = 0.1174, 0.151
EXACT = {"cutoff": None, "gap_limit": 0.1}


def along(truth: Stance, motion: LegMotion) -> Stance:
    """The stance on the foot that made the markers, from two frames after their start to two before their end."""
    span = float(motion.time[2]), float(motion.time[-3])
    return simulate_stance(motion, truth.foot, truth.fulcrum, truth.push, span, machine_code=False)


def off(truth: Stance, found: Stance) -> np.ndarray:
    """Root mean square of each component's error while the foot is loaded, over body weight."""
    force = np.column_stack([np.interp(truth.time, found.time, column) for column in found.force.T])
    return np.sqrt(np.mean((force - truth.force)[truth.on] ** 2, axis=0)) / (77.3 * GRAVITY)


@pytest.fixture(scope="module")
def planted() -> tuple[Stance, MarkerTrajectories, Walked]:
    """A stance at medium, its markers, and their fit as if the socket did not give."""
    truth = planted_stance(MEDIUM, 0.72)
    seen = markers_of(truth)
    return truth, seen, walked(seen, truth.motion.leg, **EXACT)


def test_the_planted_socket_is_taken_out_of_its_markers(planted: tuple[Stance, MarkerTrajectories, Walked]) -> None:
    """Then the fit has pelvis, hip and knee that made them; with the socket in it they are up to degrees off."""
    truth, seen, first = planted
    motion = truth.motion
    fit = walked(without_socket(seen, motion.leg, truth), motion.leg, **EXACT)
    assert fit.off.max() < 1e-6
    assert first.off.max() > 5e-3
    wanted = [np.interp(seen.time, motion.time, motion.of(name)) for name in ("hip_flexion", "knee_flexion")]
    for name, angle in zip(("hip_flexion", "knee_flexion"), wanted, strict=True):
        assert np.abs(fit.motion.of(name) - angle).max() < 2e-5
        assert np.abs(first.motion.of(name) - angle).max() > np.radians(1.0)


def test_frames_with_two_markers_of_the_socket_tell_nothing_of_it(
    planted: tuple[Stance, MarkerTrajectories, Walked],
) -> None:
    truth, seen, _ = planted
    places = seen.positions.copy()
    places[7, [seen.names.index(name) for name in BODIES["shank"][:3]]] = np.nan
    found = without_socket(replace(seen, positions=places), truth.motion.leg, truth)
    assert np.isnan(found.of(BODIES["shank"])[7]).all()
    whole = without_socket(seen, truth.motion.leg, truth)
    np.testing.assert_allclose(found.positions[8:], whole.positions[8:], atol=1e-12)


def test_markers_by_matrices_have_the_keel_where_the_simulation_has_it(
    planted: tuple[Stance, MarkerTrajectories, Walked],
) -> None:
    """The heel's marker sits on the keel's end: guards the test's own forward kinematics."""
    truth, seen, _ = planted
    heel = seen.positions[:, seen.names.index("RHEE")]
    np.testing.assert_allclose(heel, truth.poses.translation[::5], atol=1e-9)
    still = body_places(truth.motion.leg, np.zeros(10), np.zeros(6))
    assert still["RTH1"][1] < still["RASI"][1]


def test_turns_end_where_the_force_no_longer_changes_and_where_a_turn_fails(
    planted: tuple[Stance, MarkerTrajectories, Walked],
) -> None:
    """With a simulation that gives the planted stance whatever the motion, one turn is enough."""
    truth, seen, first = planted
    found = limb_in_socket(seen, first, lambda motion: truth, **EXACT, turns=6)
    assert (found.turns, found.change, found.settled) == (1, 0.0, True)
    assert found.walked.off.max() < 1e-6
    none = limb_in_socket(seen, first, lambda motion: truth, **EXACT, turns=0)
    assert none.walked is first and np.isnan(none.change) and not none.settled

    def falls(motion: LegMotion) -> Stance:
        if motion is first.motion:
            return truth
        raise ArithmeticError("the motion cannot go on")

    failed = limb_in_socket(seen, first, falls, **EXACT, turns=6)
    assert failed.walked is first and failed.turns == 0 and not failed.settled


@pytest.mark.slow
@pytest.mark.long  # with every change: the parts above, and tests/analyses/prosthesis/test_simulate.py
@pytest.mark.parametrize(("fulcrum", "twice"), [(MEDIUM, 0.035), (HIGH, 0.045)], ids=["medium", "high"])
def test_exact_markers_on_a_socket_leave_half_a_percent_of_body_weight(fulcrum: float, twice: float) -> None:
    """Vertically; counted twice its motion costs 4.2 and 5.1 %, and exact markers on the limb itself leave 0.3 %."""
    truth = planted_stance(fulcrum, 0.72)
    seen = markers_of(truth)
    first = walked(seen, truth.motion.leg, **EXACT)
    started: list[Stance] = []  # what the socket is first taken out with is counted twice

    def simulated(motion: LegMotion) -> Stance:
        stance = along(truth, motion)
        started.extend([stance] if motion is first.motion else [])
        return stance

    found = limb_in_socket(seen, first, simulated, **EXACT, turns=6)
    assert isinstance(found, LimbInSocket)
    assert found.stance.motion is found.walked.motion
    fore_aft, vertical, sideways = off(truth, found.stance)
    assert vertical < 5e-3
    assert sideways < 5e-3
    assert fore_aft < 15e-3
    assert off(truth, started[0])[1] > twice
