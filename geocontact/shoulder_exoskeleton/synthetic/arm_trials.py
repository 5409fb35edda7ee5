"""Arms of synthetic trials as the choice of a support profile needs them."""

from __future__ import annotations

from collections.abc import Sequence

from geocontact.shoulder_exoskeleton.device import Wearer
from geocontact.shoulder_exoskeleton.from_markers.arm_motions import MarkerSettings
from geocontact.shoulder_exoskeleton.human_arm.elevation_torque import CUTOFF
from geocontact.shoulder_exoskeleton.human_arm.hand_load import ToolWork
from geocontact.shoulder_exoskeleton.support.arm_trial import ArmTrial
from geocontact.shoulder_exoskeleton.support.phases import SCREW
from geocontact.shoulder_exoskeleton.support.recorded_arms import ToolUse, Worker, recorded_arms
from geocontact.shoulder_exoskeleton.synthetic.design import CONDITIONS, PARTICIPANTS, TASKS, Condition
from geocontact.shoulder_exoskeleton.synthetic.trial import OverheadTrial, synthetic_trial

UPRIGHT = (0.0, 0.25)
"""Span in which a synthetic wearer stands still [s]."""


def arms_of(trial: OverheadTrial, dominant_share: float = 1.0, cutoff: float = CUTOFF) -> list[ArmTrial]:
    """Both arms of one trial, the right one first, from its markers.

    Parameters
    ----------
    dominant_share
        Of the push force; see `hand_load.ToolWork`.
    cutoff
        Of the markers' low-pass [Hz].
    """
    person, task = trial.participant, trial.task
    work = ToolWork(task.tool, task.push * person.push, dominant_share=dominant_share)
    use = ToolUse(work, trial.phase == SCREW, trial.current)
    lengths = Wearer(upper_arm=person.upper_arm, shoulder_width=person.shoulders)
    worker = Worker(person.name, person.mass, person.sex, person.dominant, lengths)
    arms, _ = recorded_arms(trial.name, worker, task.name, trial.markers, MarkerSettings(upright=UPRIGHT), use, cutoff)
    return arms


def all_arms(
    conditions: Sequence[Condition] = CONDITIONS[:1], dominant_share: float = 1.0, cutoff: float = CUTOFF
) -> list[ArmTrial]:
    """Both arms of every participant and task; without the device unless told otherwise."""
    trials = [synthetic_trial(person, task, each) for person in PARTICIPANTS for task in TASKS for each in conditions]
    return [arm for trial in trials for arm in arms_of(trial, dominant_share, cutoff)]
