"""Events of a walk, heel strikes and toe offs by side, and the cycles between them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise
from math import inf
from typing import Literal

STRIKE, OFF = "heel strike", "toe off"
STANCE = "stance"
"""Said of the part of a cycle that ends where the toes leave the ground."""

Part = float | Literal["stance"] | None
"""Share of a cycle that is used, from its heel strike on; None: all of it."""


@dataclass(frozen=True)
class GaitEvent:
    """One event.

    Parameters
    ----------
    side
        "right" or "left".
    event
        "heel strike" or "toe off".
    time
        [s], on the clock of its recording.
    recording
        Name of the recording; empty where there is only one.
    style
        Gait style of the cycle that begins here; that of the recording where it is empty.
    """

    side: str
    event: str
    time: float
    recording: str = ""
    style: str = ""


@dataclass(frozen=True)
class GaitCycle:
    """The used part of one cycle of a side, from `start` to `end` [s]."""

    style: str
    side: str
    start: float
    end: float


def of_recording(events: Iterable[GaitEvent], recording: str) -> list[GaitEvent]:
    """Events of one recording, and those that name none."""
    return [each for each in events if each.recording in ("", recording)]


def times_of(events: Iterable[GaitEvent], event: str, side: str) -> list[float]:
    """Times of one kind of event of a side [s], increasing, each once."""
    return sorted({each.time for each in events if each.event == event and each.side == side})


def cycles_between(events: Iterable[GaitEvent], recording: str, side: str, part: Part = None) -> list[GaitCycle]:
    """Cycles of one side of a recording: from each heel strike to the next, or a first part of that.

    A stance ends at the toe off that follows its heel strike before the next one; the last one needs no further strike.
    Those without a toe off are left out.
    """
    own = of_recording(events, recording)
    strikes, offs = times_of(own, STRIKE, side), times_of(own, OFF, side)
    styles = {each.time: each.style for each in own if each.event == STRIKE and each.side == side}
    found = []
    for start, following in pairwise([*strikes, *([inf] if part == STANCE else [])]):
        if part == STANCE:
            end = next((off for off in offs if start < off < following), None)
            if end is None:
                continue
        else:
            end = following if part is None else start + float(part) * (following - start)
        found.append(GaitCycle(styles[start] or recording, side, start, end))
    return found
