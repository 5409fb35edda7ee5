"""Synthetic trials of overhead work: participants and conditions after the paper's design, courses of both arms,
markers. Every number is invented.

Yao et al. (2024), Robotics 13:27, sec. 3: three participants; P1 holds the screwdriver in the right hand, P2 and P3
in the left one; two overhead tasks, T2 more demanding, its push force applied by both hands (sec. 5.3); without the
device (S0), at 50 % and at 100 % of its power. The paper's recordings are not public.

Markers are exact points of rigid segments: no noise, no skin. What finer models make of the device's response to the
motion (angle on its logger, force on its mat) is not made here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from zlib import crc32

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial.transform import Rotation

from geocontact.data.body_segments import Sex, body_segments
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.shoulder_exoskeleton.arm_motion import Side
from geocontact.shoulder_exoskeleton.arms_from_markers import MarkerSettings
from geocontact.shoulder_exoskeleton.device import Wearer
from geocontact.shoulder_exoskeleton.device_frame import (
    ELBOW,
    FINGER,
    LEFT_OF_MIDDLE,
    LOWER,
    MIDDLE,
    T10,
    UPPER,
    WRIST,
)
from geocontact.shoulder_exoskeleton.human_arm import CUTOFF, ToolWork
from geocontact.shoulder_exoskeleton.support import phase_machine
from geocontact.shoulder_exoskeleton.support.arm_trial import ArmTrial, ToolUse, Worker, recorded_arms
from geocontact.shoulder_exoskeleton.support.phase_machine import SCREW


@dataclass(frozen=True)
class Participant:
    """A synthetic person.

    Parameters
    ----------
    dominant
        Side that holds the tool; the paper's.
    mass, stature
        [kg, m].
    upper_arm, forearm, hand
        Lengths [m]: about de Leva's shares of the stature.
    shoulders
        Distance of both shoulder joints [m].
    raised
        Elevation at which this person works, more or less than the task's [rad].
    pace
        Duration of phases over the task's.
    push
        Force on the tool over the task's.
    """

    name: str
    sex: Sex
    dominant: Side
    mass: float
    stature: float
    upper_arm: float
    forearm: float
    hand: float
    shoulders: float
    raised: float
    pace: float
    push: float


@dataclass(frozen=True)
class OverheadTask:
    """An overhead task: lift the arms, screw in, lower them.

    Parameters
    ----------
    elevation
        Of the upper arm while screwing [rad], the dominant side and the other.
    plane
        Azimuth of the plane of elevation, from the side (0) to the front (π/2) [rad].
    flexion
        Of the elbow while screwing [rad].
    lift, screw, lower
        Durations [s].
    tool
        Mass of the screwdriver [kg].
    push
        Force on the screw while screwing, upward [N].
    """

    name: str
    elevation: tuple[float, float]
    plane: float
    flexion: float
    lift: float
    screw: float
    lower: float
    tool: float
    push: float


@dataclass(frozen=True)
class Condition:
    """How the device was worn.

    Parameters
    ----------
    level
        Support level, share of the full force [-]; the paper's. None: not worn.
    raised
        Elevation more than without the device [rad]; the paper finds 8.2° of difference in the mean (sec. 5.2).
    """

    name: str
    level: float | None
    raised: float


PARTICIPANTS = (
    Participant("P1", "male", "right", 82.0, 1.83, 0.296, 0.283, 0.091, 0.385, 0.07, 1.00, 1.00),
    Participant("P2", "male", "left", 70.0, 1.72, 0.278, 0.266, 0.085, 0.355, 0.00, 0.90, 0.85),
    Participant("P3", "female", "left", 61.0, 1.69, 0.268, 0.257, 0.076, 0.330, -0.05, 1.10, 1.15),
)
TASKS = (
    OverheadTask("T1", (1.92, 1.66), 1.05, 0.87, 1.5, 3.4, 1.4, 1.3, 35.0),
    OverheadTask("T2", (2.09, 2.01), 1.22, 0.70, 1.7, 3.0, 1.5, 1.3, 55.0),
)
CONDITIONS = (Condition("S0", None, 0.0), Condition("S50", 0.5, 0.10), Condition("S100", 1.0, 0.17))
REST, PAUSE = 0.6, 0.35
"""Standing still before and after, and holding the arms up before and after screwing [s]; times the person's pace."""
RATE = 100.0
"""Hz; as in laboratories of motion capture."""
SWAY = 0.03
"""Amplitude of the trunk's turns [rad]."""
TREMOR = 0.006
"""Amplitude of each sine in the angles of the arm while it is held up [rad]."""
CURRENT = (0.3, 4.0, 0.25)
"""Current of the screwdriver idle and under load, and standard deviation of its noise [A]."""


def participant(name: str) -> Participant:
    """Participant of that name; KeyError where there is none."""
    return {each.name: each for each in PARTICIPANTS}[name]


def task(name: str) -> OverheadTask:
    """Task of that name; KeyError where there is none."""
    return {each.name: each for each in TASKS}[name]


def condition(name: str) -> Condition:
    """Condition of that name; KeyError where there is none."""
    return {each.name: each for each in CONDITIONS}[name]


HANGING, HANGING_FLEXION = 0.16, 0.35
"""Elevation and elbow flexion at rest [rad]; invented."""
SINES = 4
LOWEST, HIGHEST = 0.3, 1.5
"""Frequencies of tremor and sway [Hz]; invented."""


@dataclass(frozen=True)
class Times:
    """When the phases begin and end [s].

    The arms move up from `lift` to `raised`, are held until the tool runs from `screw` to `screwed`, are held until
    `lower` and hang down again from `lowered`.
    """

    lift: float
    raised: float
    screw: float
    screwed: float
    lower: float
    lowered: float
    end: float


@dataclass(frozen=True)
class ArmCourse:
    """Angles of one arm [rad]: elevation, azimuth of its plane from the side to the front, elbow flexion."""

    elevation: Float[np.ndarray, " t"]
    plane: Float[np.ndarray, " t"]
    flexion: Float[np.ndarray, " t"]


def times_of(person: Participant, task: OverheadTask) -> Times:
    """Phases one after the other, at the person's pace."""
    lengths = person.pace * np.array([REST, task.lift, PAUSE, task.screw, PAUSE, task.lower, REST])
    return Times(*(float(t) for t in np.round(np.cumsum(lengths), 2)))


def time_of(times: Times) -> Float[np.ndarray, " t"]:
    """Frames of the trial [s]."""
    return np.arange(round(times.end * RATE) + 1) / RATE


def arm_course(
    person: Participant, task: OverheadTask, condition: Condition, side: Side, rng: np.random.Generator
) -> ArmCourse:
    """Minimum jerk from hanging to overhead and back (Flash & Hogan 1985, J. Neurosci. 5:1688), with tremor."""
    times = times_of(person, task)
    time = time_of(times)
    up = minimum_jerk(time, times.lift, times.raised) - minimum_jerk(time, times.lower, times.lowered)
    working = task.elevation[0 if side == person.dominant else 1] + person.raised + condition.raised
    return ArmCourse(
        HANGING + (working - HANGING) * up + up * tremor(time, rng),
        task.plane + 0.2 * (1.0 - up) + up * tremor(time, rng),
        HANGING_FLEXION + (task.flexion - HANGING_FLEXION) * up + up * tremor(time, rng),
    )


def minimum_jerk(time: Float[np.ndarray, " t"], start: float, stop: float) -> Float[np.ndarray, " t"]:
    """From 0 before `start` to 1 after `stop`, with rate and acceleration 0 at both."""
    s = np.clip((time - start) / (stop - start), 0.0, 1.0)
    return np.asarray(s**3 * (10.0 - 15.0 * s + 6.0 * s**2))


def tremor(
    time: Float[np.ndarray, " t"], rng: np.random.Generator, amplitude: float = TREMOR
) -> Float[np.ndarray, " t"]:
    """Sines of random frequency and phase."""
    frequency, phase = rng.uniform(LOWEST, HIGHEST, SINES), rng.uniform(0.0, 2.0 * np.pi, SINES)
    return np.asarray(amplitude * np.sin(2.0 * np.pi * frequency[:, None] * time + phase[:, None]).sum(axis=0))


Places = Float[np.ndarray, "t 3"]
R_G0 = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]])
"""An upright device in OpenSim's axes (x forward, y up, z to the right): columns are left, back, up."""
BAR_HEIGHT = 0.80
"""Height of Lucy_MC over the stature; this and what follows is invented [m]."""
IN_FRONT, BELOW_BAR = 0.13, 0.03
"""Place of the shoulder joints relative to Lucy_MC."""
HALF_BAR, T10_BELOW, T10_BEHIND = 0.10, 0.26, -0.02
CUFF = 0.6
"""Share of the way from shoulder to elbow."""
GIRDLE = (0.015, 0.04)
"""How far raising an arm takes its shoulder joint inward and up: the shoulder girdle moves."""
STEP = 0.02
"""Amplitude of the trunk's shifts."""


@dataclass(frozen=True)
class OverheadTrial:
    """A trial made by formula.

    Parameters
    ----------
    name
        Such as "P1T1S0".
    markers
        In OpenSim's axes [m].
    current
        Of the screwdriver at the markers' times [A], with noise.
    times
        When the phases begin and end.
    phase
        0 rest, 1 arms raised, 2 screw-in, 3 lowering, frame by frame.
    courses
        True angles of both arms by side [rad].
    """

    name: str
    participant: Participant
    task: OverheadTask
    condition: Condition
    markers: MarkerTrajectories
    current: Float[np.ndarray, " t"]
    times: Times
    phase: Int[np.ndarray, " t"]
    courses: dict[Side, ArmCourse]


def synthetic_trial(person: Participant, task: OverheadTask, condition: Condition) -> OverheadTrial:
    """One trial; the same numbers every time for the same person, task and condition."""
    name = f"{person.name}{task.name}{condition.name}"
    rng = np.random.default_rng(crc32(name.encode()))
    times = times_of(person, task)
    time = time_of(times)
    courses: dict[Side, ArmCourse] = {
        side: arm_course(person, task, condition, side, rng) for side in ("right", "left")
    }
    in_device = _device_markers(len(time))
    for side, course in courses.items():
        in_device |= arm_markers(person, side, course)
    turn, origin = _trunk(person, time, rng)
    places = np.stack([turn.apply(place @ R_G0.T) + origin for place in in_device.values()], axis=1)
    running = (time >= times.screw) & (time < times.screwed)
    current = np.where(running, CURRENT[1], CURRENT[0]) + rng.normal(0.0, CURRENT[2], len(time))
    markers = MarkerTrajectories(time, places, tuple(in_device), f"synthetic {name}")
    return OverheadTrial(name, person, task, condition, markers, current, times, phases(time, times), courses)


def phases(time: Float[np.ndarray, " t"], times: Times) -> Int[np.ndarray, " t"]:
    """Work phase of every frame: arms that are held up before and after screwing count as raised."""
    found = np.full(len(time), phase_machine.REST)
    found[(time >= times.lift) & (time < times.lower)] = phase_machine.LIFT
    found[(time >= times.screw) & (time < times.screwed)] = phase_machine.SCREW
    found[(time >= times.lower) & (time < times.lowered)] = phase_machine.LOWER
    return found


def arm_markers(person: Participant, side: Side, course: ArmCourse) -> dict[str, Places]:
    """Markers of one arm in the device's frame [m], the upper one on the shoulder joint."""
    outward = 1.0 if side == "left" else -1.0
    raised = np.sin(0.5 * course.elevation) ** 2
    shoulder = np.column_stack(
        (
            outward * (0.5 * person.shoulders - GIRDLE[0] * raised),
            np.full(len(raised), -IN_FRONT),
            -BELOW_BAR + GIRDLE[1] * raised,
        )
    )
    flat = np.column_stack(
        (outward * np.cos(course.plane), -np.sin(course.plane), np.zeros(len(raised)))
    )  # the horizontal direction in which the arm is raised
    upper = _in_plane(flat, course.elevation)
    elbow = shoulder + person.upper_arm * upper
    lower = _in_plane(flat, course.elevation + course.flexion)
    wrist = elbow + person.forearm * lower
    return {
        UPPER[side]: shoulder,
        LOWER[side]: shoulder + CUFF * person.upper_arm * upper,
        ELBOW[side]: elbow,
        WRIST[side]: wrist,
        FINGER[side]: wrist + person.hand * lower,
    }


def _in_plane(flat: Places, angle: Float[np.ndarray, " t"]) -> Places:
    """Direction at that angle from hanging down."""
    down = np.array([0.0, 0.0, -1.0])
    return np.asarray(np.cos(angle)[:, None] * down + np.sin(angle)[:, None] * flat)


def _device_markers(frames: int) -> dict[str, Places]:
    fixed = {MIDDLE: (0.0, 0.0, 0.0), LEFT_OF_MIDDLE: (HALF_BAR, 0.0, 0.0), T10: (0.0, T10_BEHIND, -T10_BELOW)}
    return {name: np.tile(place, (frames, 1)) for name, place in fixed.items()}


def _trunk(person: Participant, time: Float[np.ndarray, " t"], rng: np.random.Generator) -> tuple[Rotation, Places]:
    """Turn of the trunk and place of Lucy_MC in the laboratory; it stands still for the first tenths of a second."""
    started = minimum_jerk(time, 0.3, 1.3)
    turn = Rotation.from_rotvec(np.column_stack([started * tremor(time, rng, SWAY / 4.0) for _ in range(3)]))
    shift = np.column_stack([started * tremor(time, rng, STEP / 4.0) for _ in range(3)])
    return turn, shift + np.array([0.0, BAR_HEIGHT * person.stature, 0.0])


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
    worker = Worker(person.name, person.mass, body_segments(person.sex), person.dominant, lengths)
    arms, _ = recorded_arms(trial.name, worker, task.name, trial.markers, MarkerSettings(upright=UPRIGHT), use, cutoff)
    return arms


def all_arms(
    conditions: Sequence[Condition] = CONDITIONS[:1], dominant_share: float = 1.0, cutoff: float = CUTOFF
) -> list[ArmTrial]:
    """Both arms of every participant and task; without the device by default."""
    trials = [synthetic_trial(person, task, each) for person in PARTICIPANTS for task in TASKS for each in conditions]
    return [arm for trial in trials for arm in arms_of(trial, dominant_share, cutoff)]
