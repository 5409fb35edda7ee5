"""Synthetic participants, tasks and conditions: the design is the paper's, every number is invented unless marked.

Yao et al. (2024), Robotics 13:27, sec. 3: three participants; P1 holds the screwdriver in the right hand, P2 and P3
in the left one; two overhead tasks, T2 more demanding, its push force applied by both hands (sec. 5.3); without the
device (S0), at 50 % and at 100 % of its power. The paper's recordings are not public.
"""

from __future__ import annotations

from dataclasses import dataclass

from geocontact.data.body_segments import Sex
from geocontact.shoulder_exoskeleton.arm_motion import Side


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
    """Of that name; KeyError where there is none."""
    return {each.name: each for each in PARTICIPANTS}[name]


def task(name: str) -> OverheadTask:
    """Of that name; KeyError where there is none."""
    return {each.name: each for each in TASKS}[name]


def condition(name: str) -> Condition:
    """Of that name; KeyError where there is none."""
    return {each.name: each for each in CONDITIONS}[name]
