"""What is known of one arm in one recorded trial as the choice of a support profile needs it."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.body_segments import BodySegments
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion, Side, smoothed_motion
from geocontact.shoulder_exoskeleton.arms_from_markers import MarkerSettings, arm_motions
from geocontact.shoulder_exoskeleton.device import Device, Wearer, lever
from geocontact.shoulder_exoskeleton.human_arm import (
    CUTOFF,
    ElevationTorque,
    ToolWork,
    arm_moment,
    arm_track,
    elevation_torque,
    hand_load,
)
from geocontact.shoulder_exoskeleton.support.phase_machine import Sensing, Thresholds, detected, sensed
from geocontact.shoulder_exoskeleton.support.profile_limits import Hand, SupportCase


def scales_of(moments: Mapping[str, float], makers: Collection[str]) -> dict[str, float]:
    """By person what a profile is multiplied by: the moment of the arm's weight over the largest of its makers.

    Whoever has a heavier arm than all of them gets what the heaviest has: no simulation shows how a cuff holds more.

    Parameters
    ----------
    moments
        Of all persons [N m], see `human_arm.arm_weight`.
    makers
        Persons the profile is made with.
    """
    largest = max(moments[each] for each in makers)
    return {person: min(1.0, moment / largest) for person, moment in moments.items()}


@dataclass(frozen=True, eq=False)
class ArmTrial:
    """One arm in one trial.

    Parameters
    ----------
    needed
        Torque of the shoulder without support, in parts, at the times of the trial.
    elevation
        Of the arm [rad].
    current
        Of the tool [A].
    lever
        Middle of the cuff from the shoulder [m].
    motion
        Of the upper arm in the device's frame, smoothed and without gaps, at the same times.
    wearer
        To whom the device is adjusted.
    arm_moment
        Of the arm's weight about the shoulder when it is stretched out level [N m]; see `human_arm.arm_weight`.
    """

    name: str
    person: str
    task: str
    hand: Hand
    needed: ElevationTorque
    elevation: Float[np.ndarray, " t"]
    current: Float[np.ndarray, " t"]
    lever: float
    motion: ArmMotion
    wearer: Wearer
    arm_moment: float


@dataclass(frozen=True)
class Support:
    """What the device can do.

    Parameters
    ----------
    torque
        At factor 1, of the elevation of its arm [rad] to [N m]; in proportion at other factors.
    lag
        Time constant of the pressure [s].
    """

    torque: Callable[[Float[np.ndarray, " t"]], Float[np.ndarray, " t"]]
    lag: float


def support_of(device: Device) -> Support:
    """Torque of the device's cylinder at full level over the elevation of its arm, and the lag of its pressure."""
    a, b, phase = (np.array(device[name]) for name in ("lever_a", "lever_b", "lever_phase"))

    def torque(elevation: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
        return np.asarray(device.peak_force * lever(elevation, a, b, phase))

    return Support(torque, device["lag"])


@dataclass(frozen=True, eq=False)
class Transfer:
    """What of the cylinder's torque reaches an arm, from a simulation of the device along its motion.

    Parameters
    ----------
    elevation
        Of the device's arm [rad]: the controller sees it, and the cylinder's lever follows it.
    gain
        Torque on the arm over the cylinder's torque, where more or less of it is given [-].
    own, own_force
        Torque on the arm [N m] and force at the interface [N] that no factor changes.
    """

    elevation: Float[np.ndarray, " t"]
    gain: Float[np.ndarray, " t"] | float = 1.0
    own: Float[np.ndarray, " t"] | float = 0.0
    own_force: Float[np.ndarray, " t"] | float = 0.0


@dataclass(frozen=True)
class ModelError:
    """Standard deviations of what the model does not know of a person.

    Parameters
    ----------
    weight
        Of the arm's mass, relative; invented, about the scatter between regressions of segment masses.
    push
        Of the push force, relative; invented.
    elevation
        Of the device's elevation [rad]: the paper's 6.0° (sec. 5.1.1, RMSD while support is desired).
    sensing
        Of the controller.
    """

    weight: float = 0.10
    push: float = 0.20
    elevation: float = np.radians(6.0)
    sensing: Sensing = field(default_factory=Sensing)


def support_case(
    trial: ArmTrial, support: Support, thresholds: Thresholds | None = None, transfer: Transfer | None = None
) -> SupportCase:
    """The case as the model has it: true angle and current at the controller, no delay.

    Parameters
    ----------
    transfer
        Of the torque to the arm; without it the device's arm is where the human one is, and all of its torque counts.
    """
    way = transfer or Transfer(trial.elevation)
    return _case(trial, support, way, trial.needed.total, way.elevation, (way.elevation, trial.current), thresholds)


def varied_case(
    trial: ArmTrial,
    support: Support,
    error: ModelError,
    rng: np.random.Generator,
    thresholds: Thresholds | None = None,
    transfer: Transfer | None = None,
) -> SupportCase:
    """The case with errors drawn: one of each kind for the whole trial, sensor noise for each sample."""
    parts, way = trial.needed, transfer or Transfer(trial.elevation)
    heavier, harder = 1.0 + error.weight * rng.normal(), 1.0 + error.push * rng.normal()
    needed = heavier * (parts.weight + parts.motion) + parts.tool + harder * parts.push
    elevation = way.elevation + error.elevation * rng.normal()
    signals = sensed(parts.time, elevation, trial.current, error.sensing, rng)
    return _case(trial, support, way, needed, elevation, signals, thresholds)


def _case(
    trial: ArmTrial,
    support: Support,
    way: Transfer,
    needed: Float[np.ndarray, " t"],
    elevation: Float[np.ndarray, " t"],
    signals: tuple[Float[np.ndarray, " t"], Float[np.ndarray, " t"]],
    thresholds: Thresholds | None,
) -> SupportCase:
    time = trial.needed.time
    return SupportCase(
        trial.name,
        trial.person,
        trial.task,
        trial.hand,
        time,
        detected(time, *signals, thresholds),
        needed,
        np.asarray(way.gain * support.torque(elevation)),
        support.lag,
        trial.lever,
        way.own,
        way.own_force,
    )


@dataclass(frozen=True)
class Worker:
    """A person at work: mass of the body [kg], its segments, the side that holds the tool, lengths for the device."""

    name: str
    mass: float
    segments: BodySegments
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
    push
        Measured force of both hands on the work, in the laboratory [N]; None: that of `work` while it runs.
    """

    work: ToolWork
    running: Bool[np.ndarray, " t"]
    current: Float[np.ndarray, " t"]
    push: Float[np.ndarray, "t 3"] | None = None


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
        push = None if use.push is None else use.push[kept]
        load = hand_load(use.work, motion.side, worker.dominant, use.running[kept], push)
        needed = elevation_torque(
            track, load, mass=worker.mass, segments=worker.segments, gravity=gravity, cutoff=cutoff
        )
        own = smoothed_motion(motion, cutoff, settings.gap_limit)
        to_cuff = float(np.linalg.norm(motion.interface - motion.shoulder, axis=1).mean())
        hand: Hand = "dominant" if motion.side == worker.dominant else "other"
        label = f"{name} {motion.side}"
        current = use.current[kept]
        reach = float(np.linalg.norm(track.elbow - track.shoulder, axis=1).mean())
        moment = arm_moment(worker.mass, worker.segments, reach)
        found.append(
            ArmTrial(
                label, worker.name, task, hand, needed, own.elevation, current, to_cuff, own, worker.lengths, moment
            )
        )
    return found, motions.notes
