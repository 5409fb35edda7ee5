"""Arms of synthetic trials as the choice of a support profile needs them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from geocontact.shoulder_exoskeleton.from_markers.arm_motions import MarkerSettings, arm_motions
from geocontact.shoulder_exoskeleton.human_arm.arm_track import arm_track
from geocontact.shoulder_exoskeleton.human_arm.elevation_torque import elevation_torque
from geocontact.shoulder_exoskeleton.human_arm.hand_load import ToolWork, hand_load
from geocontact.shoulder_exoskeleton.support.arm_trial import ArmTrial
from geocontact.shoulder_exoskeleton.support.phases import SCREW
from geocontact.shoulder_exoskeleton.support.support_case import Hand
from geocontact.shoulder_exoskeleton.synthetic.design import CONDITIONS, PARTICIPANTS, TASKS, Condition
from geocontact.shoulder_exoskeleton.synthetic.trial import OverheadTrial, synthetic_trial

UPRIGHT = (0.0, 0.25)
"""Span in which a synthetic wearer stands still [s]."""


def arms_of(trial: OverheadTrial, dominant_share: float = 1.0) -> list[ArmTrial]:
    """Both arms of one trial, the right one first, from its markers.

    Parameters
    ----------
    dominant_share
        Of the push force; see `hand_load.ToolWork`.
    """
    person, task = trial.participant, trial.task
    settings = MarkerSettings(upright=UPRIGHT)
    motions = arm_motions(trial.markers, settings)
    work = ToolWork(task.tool, task.push * person.push, dominant_share=dominant_share)
    found = []
    for motion in motions.arms:
        track = arm_track(trial.markers, motions.frame, motion.side)
        load = hand_load(work, motion.side, person.dominant, trial.phase == SCREW)
        gravity = np.array(settings.gravity)
        needed = elevation_torque(track, load, mass=person.mass, sex=person.sex, gravity=gravity)
        lever = float(np.linalg.norm(motion.interface - motion.shoulder, axis=1).mean())
        hand: Hand = "dominant" if motion.side == person.dominant else "other"
        name = f"{trial.name} {motion.side}"
        found.append(ArmTrial(name, person.name, task.name, hand, needed, motion.elevation, trial.current, lever))
    return found


def all_arms(conditions: Sequence[Condition] = CONDITIONS[:1], dominant_share: float = 1.0) -> list[ArmTrial]:
    """Both arms of every participant and task; without the device unless told otherwise."""
    trials = [synthetic_trial(person, task, each) for person in PARTICIPANTS for task in TASKS for each in conditions]
    return [arm for trial in trials for arm in arms_of(trial, dominant_share)]
