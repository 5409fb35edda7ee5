"""Angles of both arms over a synthetic trial, and which work phase it is in."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.shoulder_exoskeleton.arm_motion import Side
from geocontact.shoulder_exoskeleton.synthetic.design import (
    PAUSE,
    RATE,
    REST,
    TREMOR,
    Condition,
    OverheadTask,
    Participant,
)

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
