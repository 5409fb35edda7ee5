"""Arms of a recorded trial as the choice of a support profile needs them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.body_segments import Sex
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.shoulder_exoskeleton.arm_motion import Side
from geocontact.shoulder_exoskeleton.device import Wearer
from geocontact.shoulder_exoskeleton.from_markers.arm_motions import MarkerSettings, arm_motions
from geocontact.shoulder_exoskeleton.human_arm.arm_track import arm_track
from geocontact.shoulder_exoskeleton.human_arm.arm_weight import arm_moment
from geocontact.shoulder_exoskeleton.human_arm.elevation_torque import CUTOFF, elevation_torque
from geocontact.shoulder_exoskeleton.human_arm.hand_load import ToolWork, hand_load
from geocontact.shoulder_exoskeleton.smoothed_motion import smoothed_motion
from geocontact.shoulder_exoskeleton.support.arm_trial import ArmTrial
from geocontact.shoulder_exoskeleton.support.support_case import Hand


@dataclass(frozen=True)
class Worker:
    """A person at work: mass of the body [kg], sex, the side that holds the tool, lengths for the device."""

    name: str
    mass: float
    sex: Sex
    dominant: Side
    lengths: Wearer


@dataclass(frozen=True, eq=False)
class ToolUse:
    """What the tool does at the markers' times.

    Parameters
    ----------
    work
        Its mass, and how it is pushed while it runs.
    running
        Whether it runs.
    current
        As the controller gets to see it [A].
    """

    work: ToolWork
    running: Bool[np.ndarray, " t"]
    current: Float[np.ndarray, " t"]


def recorded_arms(
    name: str,
    worker: Worker,
    task: str,
    markers: MarkerTrajectories,
    settings: MarkerSettings,
    use: ToolUse,
    cutoff: float = CUTOFF,
) -> tuple[list[ArmTrial], tuple[str, ...]]:
    """The arms of one trial, the right one first, and what was assumed of the markers, which must not have gaps.

    Parameters
    ----------
    cutoff
        Of the zero-lag low-pass on joints and on the motion of the upper arms [Hz].
    """
    motions = arm_motions(markers, settings)
    gravity = np.array(settings.gravity)
    kept = np.isin(markers.time, motions.arms[0].time)
    seen = MarkerTrajectories(markers.time[kept], markers.positions[kept], markers.names, markers.source)
    found = []
    for motion in motions.arms:
        track = arm_track(seen, motions.frame, motion.side)
        load = hand_load(use.work, motion.side, worker.dominant, use.running[kept])
        needed = elevation_torque(track, load, mass=worker.mass, sex=worker.sex, gravity=gravity, cutoff=cutoff)
        own = smoothed_motion(motion, cutoff, settings.gap_limit)
        lever = float(np.linalg.norm(motion.interface - motion.shoulder, axis=1).mean())
        hand: Hand = "dominant" if motion.side == worker.dominant else "other"
        label = f"{name} {motion.side}"
        current = use.current[kept]
        reach = float(np.linalg.norm(track.elbow - track.shoulder, axis=1).mean())
        moment = arm_moment(worker.mass, worker.sex, reach)
        found.append(
            ArmTrial(label, worker.name, task, hand, needed, own.elevation, current, lever, own, worker.lengths, moment)
        )
    return found, motions.notes
