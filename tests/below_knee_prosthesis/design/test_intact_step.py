"""What is refused of a step of the intact foot."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.both_sides.intact_leg import IntactLeg
from geocontact.below_knee_prosthesis.both_sides.standing import standing_intact_leg
from geocontact.below_knee_prosthesis.design.intact_step import IntactStep, require_intact
from geocontact.below_knee_prosthesis.evaluation import PlateStance
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_foot
from geocontact.below_knee_prosthesis.leg import Person
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from meshes.amputee import standing_trials
from meshes.gait_persons import PARTICIPANTS

TIME, PLATE = np.arange(0.0, 1.0, 0.01), np.arange(0.0, 1.0, 0.002)
EXACT = {"cutoff": None, "gap_limit": 0.1}


@pytest.fixture(scope="module")
def leg() -> IntactLeg:
    trials = standing_trials(PARTICIPANTS[0], vsf_foot(), fulcrum_of("medium", "pinned"))
    return standing_intact_leg(trials.standing, Person(77.3))


def seen(leg: IntactLeg) -> MarkerTrajectories:
    """The foot level, 5 mm into the floor from 0.2 to 0.7 s, 30 mm higher before and after."""
    markers = [marker for marker in leg.markers if marker.body == "intact_foot"]
    up = leg.sole + np.where((TIME > 0.195) & (TIME < 0.705), -0.005, 0.03)
    places = np.array([marker.location for marker in markers]) + up[:, None, None] * np.array([0.0, 1.0, 0.0])
    return MarkerTrajectories(TIME, places, tuple(marker.name for marker in markers), "step.trc")


def plate(begins: float, most: float = 800.0) -> PlateStance:
    force = np.zeros((len(PLATE), 3))
    force[(begins < PLATE) & (begins + 0.5 > PLATE), 1] = most
    return PlateStance(PLATE, force, np.zeros((len(PLATE), 3)), "right_plate", "step.mot")


def step(frames: int = 40, beside: float = 0.2) -> IntactStep:
    """An ankle that rolls over a wheel of 0.3 m."""
    turn = np.linspace(-0.3, 0.4, frames)
    centre = np.column_stack([0.3 * np.sin(turn), 0.3 * (1.0 - np.cos(turn)) - 0.3])
    shank, force = np.tile([0.0, 0.4], (frames, 1)), np.tile([0.0, 800.0], (frames, 1))
    return IntactStep(np.linspace(0.2, 0.7, frames), centre, shank, force, 758.0, 5e3, beside)


def test_a_step_on_its_own_plate_is_taken(leg: IntactLeg) -> None:
    require_intact(step(), seen(leg), leg, plate(0.2), plate(0.0, 700.0), **EXACT)


@pytest.mark.parametrize(
    ("what", "found", "under", "own"),
    [
        ("step.mot `intact_plate`: right_plate is under the prosthetic foot", step(), plate(0.2), plate(0.2)),
        ("no plate under the intact foot: .* is 0.8 lengths", step(beside=0.8), plate(0.2), plate(0.0)),
        ("loaded 0.1[01] s after the markers", step(), plate(0.31), plate(0.0)),
        ("step.trc: the step of the intact foot is too short", step(2), plate(0.2), plate(0.0)),
        (
            "would have a rate of loading at touch-down of -1 N/s",
            replace(step(), rise=-1.0),
            plate(0.2),
            plate(0.0),
        ),
    ],
)
def test_refused(leg: IntactLeg, what: str, found: IntactStep, under: PlateStance, own: PlateStance) -> None:
    with pytest.raises(InputError, match=what):
        require_intact(found, seen(leg), leg, under, own, **EXACT)
