"""A semi-active foot over strides: where its fulcrum is in each stance, and whether its actuator can bring it there.

The fulcrum cannot move under load, so that it has the swing before a stance for every move, and stays through the
stance. A schedule by stride or by walking speed moves it from toe-off on; one by time or by phase of gait when it says,
which must be in swing. The walking speed is that of the pelvis from one toe-off to the next, from which the fulcrum
moves: no later one is known to a controller then. Before the first stance none is known, and the first place holds.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np

from geocontact.below_knee_prosthesis.leg_tree import LegMotion

NONE = 1e-9
"""m; moves that are none."""


@dataclass(frozen=True)
class ScheduledPlace:
    """From `start` on (stride, s, m/s, or share of the stride) the fulcrum is at a place [m] with a name."""

    start: float
    name: str
    fulcrum: float


@dataclass(frozen=True)
class FulcrumSchedule:
    """Places in rising order of what they are by."""

    by: Literal["stride", "time", "speed", "phase"]
    places: tuple[ScheduledPlace, ...]

    def at(self, where: float) -> ScheduledPlace | None:
        """Place at a stride, time, speed or phase; None before the first."""
        return next((each for each in reversed(self.places) if each.start <= where), None)


@dataclass(frozen=True)
class FulcrumMove:
    """A move of the fulcrum in a swing.

    Parameters
    ----------
    travel
        How far [m].
    start, end
        From when to when it may last [s].
    """

    travel: float
    start: float
    end: float

    @property
    def speed(self) -> float:
        """Least speed of an actuator that can do it [m/s]."""
        return self.travel / (self.end - self.start) if self.end > self.start else np.inf


@dataclass(frozen=True)
class Stride:
    """A stance of the prosthetic foot, and the swing before it.

    Parameters
    ----------
    number
        From 1.
    swing
        When the foot left the floor before; when the recording began, of the first [s].
    stance
        Touch-down and toe-off [s].
    speed
        Of the pelvis forward over the stride before, up to the toe-off from which the fulcrum moves; of the second
        stride from the recording's beginning on; NaN of the first [m/s].
    place
        Of the fulcrum in the stance.
    moves
        Of the fulcrum in the swing before.
    """

    number: int
    swing: float
    stance: tuple[float, float]
    speed: float
    place: ScheduledPlace
    moves: tuple[FulcrumMove, ...]


def strides_by(
    schedule: FulcrumSchedule, stances: Sequence[tuple[float, float]], motion: LegMotion
) -> tuple[Stride, ...]:
    """Every stance with its place of the fulcrum; `stances` are touch-downs and toe-offs in order [s].

    ValueError for a schedule that does not say where the first stance begins, moves the fulcrum under load, or counts
    phases of a stride that is not known.
    """
    swings = [float(motion.time[0]), *(off for _, off in stances[:-1])]
    speeds = [np.nan, *(_speed(motion, start, stop) for start, stop in pairwise(swings))]
    if schedule.by in ("time", "phase"):
        commands = _timed(schedule, stances)
        _require_in_swing(commands, stances)
        return tuple(_after_commands(k, swings[k], stances[k], speeds[k], commands) for k in range(len(stances)))
    found: list[Stride] = []
    for k, (swing, stance, speed) in enumerate(zip(swings, stances, speeds, strict=True)):
        where = k + 1.0 if schedule.by == "stride" else speed
        place = schedule.places[0] if np.isnan(where) else schedule.at(where)
        if place is None:
            at = f"stride {k + 1}" if schedule.by == "stride" else f"stride {k + 1}, walked at {speed:.2f} m/s"
            raise ValueError(f"the schedule begins later than {at}")
        travel = abs(place.fulcrum - found[-1].place.fulcrum) if found else 0.0
        moves = (FulcrumMove(travel, swing, stance[0]),) if travel > NONE else ()
        found.append(Stride(k + 1, swing, stance, speed, place, moves))
    return tuple(found)


def _speed(motion: LegMotion, start: float, stop: float) -> float:
    x = np.interp([start, stop], motion.time, motion.of("pelvis_tx"))
    return float((x[1] - x[0]) / (stop - start))


def _timed(schedule: FulcrumSchedule, stances: Sequence[tuple[float, float]]) -> list[tuple[float, ScheduledPlace]]:
    """When each place is commanded [s]; of phases over all strides, the one before the first stance among them."""
    if schedule.by == "time":
        return [(each.start, each) for each in schedule.places]
    if len(stances) < 2:
        raise ValueError("one stance has no stride whose phases could be counted")
    downs = [down for down, _ in stances]
    lasting = [later - down for down, later in pairwise(downs)]
    starts = zip([downs[0] - lasting[0], *downs], [lasting[0], *lasting, lasting[-1]], strict=True)
    return [(down + each.start * long, each) for down, long in starts for each in schedule.places]


def _require_in_swing(commands: Sequence[tuple[float, ScheduledPlace]], stances: Sequence[tuple[float, float]]) -> None:
    """ValueError where the place changes while the foot is loaded."""
    for (_, before), (when, place) in pairwise(commands):
        moved = abs(place.fulcrum - before.fulcrum) > NONE
        for k, (down, off) in enumerate(stances, start=1):
            if moved and down <= when < off:
                what = f"moves the fulcrum to {place.name} at {when:.2f} s, in stance {k} ({down:.2f} to {off:.2f} s)"
                raise ValueError(f"{what}: under load it cannot move")


def _after_commands(
    k: int,
    swing: float,
    stance: tuple[float, float],
    speed: float,
    commands: Sequence[tuple[float, ScheduledPlace]],
) -> Stride:
    """A stride with the commands of its swing, each of which has until the next one, the last until touch-down."""
    known = [each for each in commands if each[0] <= stance[0]]
    if not known:
        raise ValueError(f"the schedule begins later than stride {k + 1}, at {stance[0]:.2f} s")
    ends = [*(when for when, _ in known[1:]), stance[0]]
    moves = [
        FulcrumMove(abs(place.fulcrum - before.fulcrum), when, end)
        for ((_, before), (when, place)), end in zip(pairwise(known), ends[1:], strict=True)
        if when >= swing and abs(place.fulcrum - before.fulcrum) > NONE
    ]
    return Stride(k + 1, swing, stance, speed, known[-1][1], tuple(moves))


def never_reached(schedule: FulcrumSchedule, strides: Sequence[Stride]) -> tuple[ScheduledPlace, ...]:
    """Places of the schedule that no stride comes to; by time those from the last touch-down on."""
    if schedule.by == "phase":
        return ()
    if schedule.by == "time":
        return tuple(each for each in schedule.places if each.start > strides[-1].stance[0])
    reached = [stride.place for stride in strides]
    return tuple(each for each in schedule.places if each not in reached)


def fastest(strides: Sequence[Stride]) -> tuple[Stride, FulcrumMove] | None:
    """The move that asks most of an actuator, and its stride; None where nothing moves."""
    moves = [(stride, move) for stride in strides for move in stride.moves]
    return max(moves, key=lambda each: each[1].speed, default=None)
