"""Markers of a synthetic trial, with the tool's current and what is exactly known of it.

Markers are exact points of rigid segments: no noise, no skin. What finer models make of the device's response to the
motion (angle on its logger, force on its mat) is not made here.
"""

from __future__ import annotations

from dataclasses import dataclass
from zlib import crc32

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial.transform import Rotation

from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.shoulder_exoskeleton.arm_motion import Side
from geocontact.shoulder_exoskeleton.from_markers.marker_names import (
    ELBOW,
    FINGER,
    LEFT_OF_MIDDLE,
    LOWER,
    MIDDLE,
    T10,
    UPPER,
    WRIST,
)
from geocontact.shoulder_exoskeleton.support import phases as phase_numbers
from geocontact.shoulder_exoskeleton.synthetic.course import (
    ArmCourse,
    Times,
    arm_course,
    minimum_jerk,
    time_of,
    times_of,
    tremor,
)
from geocontact.shoulder_exoskeleton.synthetic.design import CURRENT, SWAY, Condition, OverheadTask, Participant

Places = Float[np.ndarray, "t 3"]
R_G0 = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]])
"""An upright device in OpenSim's axes (x forward, y up, z to the right): columns are left, back, up."""
BAR_HEIGHT = 0.80
"""Of Lucy_MC over the stature; this and what follows is invented [m]."""
IN_FRONT, BELOW_BAR = 0.13, 0.03
"""Of the shoulder joints relative to Lucy_MC."""
HALF_BAR, T10_BELOW, T10_BEHIND = 0.10, 0.26, -0.02
CUFF = 0.6
"""Of the way from shoulder to elbow."""
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
    found = np.full(len(time), phase_numbers.REST)
    found[(time >= times.lift) & (time < times.lower)] = phase_numbers.LIFT
    found[(time >= times.screw) & (time < times.screwed)] = phase_numbers.SCREW
    found[(time >= times.lower) & (time < times.lowered)] = phase_numbers.LOWER
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
