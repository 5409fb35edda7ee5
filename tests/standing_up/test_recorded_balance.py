"""Torques by the ground beside statics from above, and a strap's force beside its lever, by hand."""

from __future__ import annotations

from pathlib import Path
from unittest import mock

import numpy as np
import pytest

from geocontact.analyses.sit_to_stand import recorded_beside
from geocontact.standing_up.chain import Subject, leg_chain
from geocontact.standing_up.exoskeleton import EXO_JOINTS, two_chains
from geocontact.standing_up.recorded_balance import strap_by_coordinates, torques_by_ground
from geocontact.standing_up.strap_sites import STRAP_SITES, StrapSite
from geocontact.standing_up.trials import StandingTrial

SUBJECT, G = Subject(), 9.81
POSES = np.array([[0.02, 0.095, 0.0, 0.3, -0.9, 0.8], [0.0, 0.095, 0.05, -0.1, 0.2, -0.4]])


def by_hand(q: np.ndarray) -> tuple[np.ndarray, float, float]:
    """Torques that hold what is above each joint [N m], weight [N] and place of the whole centre of mass [m]."""
    part, angle, place = SUBJECT.segments, float(q[2]), float(q[0])
    foot = part["foot"]
    at = [place + foot.centre * np.cos(angle) + 0.05 * np.sin(angle)]
    joints = []
    for name, turn in zip(("shank", "thigh", "trunk"), q[3:], strict=True):
        angle += float(turn)
        joints.append(place)
        at.append(place - part[name].centre * np.sin(angle))
        place -= part[name].length * np.sin(angle)
    mass, at = np.array([part[name].mass for name in ("foot", "shank", "thigh", "trunk")]), np.array(at)
    torques = [G * float(mass[k + 1 :] @ (at[k + 1 :] - joints[k])) for k in range(3)]
    return np.array(torques), G * float(mass.sum()), float(mass @ at / mass.sum())


def test_a_posture_that_is_held_needs_what_its_upper_part_weighs() -> None:
    """From the ground upwards as from the trunk downwards."""
    hand = [by_hand(q) for q in POSES]
    force = np.array([[0.0, weight] for _, weight, _ in hand])
    found = torques_by_ground(leg_chain(SUBJECT), POSES, force, np.array([centre for _, _, centre in hand]))
    np.testing.assert_allclose(found, [torque for torque, _, _ in hand], atol=1e-9 * 700.0)
    pushed = torques_by_ground(leg_chain(SUBJECT), POSES[:1], force[:1] + np.array([10.0, 0.0]), np.array([hand[0][2]]))
    assert pushed[0, 0] - found[0, 0] == pytest.approx(10.0 * 0.095)  # the ankle's height


@pytest.mark.parametrize("site", STRAP_SITES, ids=lambda site: site.name)
def test_a_strap_is_pressed_by_its_lever(site: StrapSite) -> None:
    """Only the exoskeleton's hinge below it turns: stiffness times distance times sine."""
    chain = two_chains(SUBJECT)
    names = [c.name for c in chain.coordinates]
    values = {site.names[0]: 2500.0, site.names[3]: 0.25}
    q = np.zeros((3, len(names)))
    q[:, names.index(EXO_JOINTS[site.hinges - 1])] = turn = np.array([0.0, 0.05, -0.1])
    lever = 0.25 - site.above
    np.testing.assert_allclose(strap_by_coordinates(chain, q, site, values), -2500.0 * lever * np.sin(turn), atol=1e-9)


@pytest.mark.parametrize(("factor", "words"), [(1e3, "is the unit right?"), (-1.0, "is their sign turned?"), (1.0, "")])
def test_torques_in_another_unit_are_named_by_it(factor: float, words: str) -> None:
    """Of a slow squat; samples of the knee that nobody measured silence none of its others."""
    share = np.linspace(0.0, 1.0, 30)[:, None]
    q = np.array([0.0, 0.095, 0.0, 0.0, 0.0, 0.0]) * (1.0 - share) + POSES[0] * share
    hand = [by_hand(each) for each in q]
    force = np.array([[0.0, weight] for _, weight, _ in hand])
    torque = factor * np.array([each for each, _, _ in hand])
    torque[:4, 1] = np.nan
    centre = np.array([each for _, _, each in hand])
    trial = StandingTrial(np.linspace(0.0, 3.0, 30), q, np.zeros_like(q), force, centre, "T1", torque)
    said: list[str] = []
    with mock.patch.object(recorded_beside, "reserve", said.append):
        recorded_beside.doubt_torques("T1", Path("torques.csv"), leg_chain(SUBJECT), trial)
    assert [line for line in said if "knee" in line and line.endswith(words)] if words else not said
