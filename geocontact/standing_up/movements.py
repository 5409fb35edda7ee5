"""A recording cut into its movements: where somebody rises, goes down, and stands or sits still in between.

What rises and goes down is the hip. With both angles of the lower limb its height over the ankle is

    h = L_shank cos φ + L_thigh cos ψ

for the leans φ of the shank and ψ of the thigh. A movement is a passage between the lower and the upper part of the
range of h, so that swaying in between is none; it begins and ends where the hip's speed falls below a part of the
movement's largest. The chair's force, where it was recorded, says what the movement was: it is gone after standing up,
and comes when sitting down; in a squat nothing is sat on. Levels are invented.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Literal

import numpy as np
from jaxtyping import Float

from geocontact.identify.signals.filters import zero_lag
from geocontact.standing_up.chain import SHANK, THIGH, Subject
from geocontact.standing_up.trial_forces import SEATED

LOW, HIGH = 0.25, 0.75
"""Parts of the range of the hip's height: a passage from one to the other is a movement."""
STILL = 0.05
"""Part of the largest speed of a movement, below which the hip stands still before and after it."""
LEAST_RANGE = 0.1
"""Range of the hip's height [m] below which nothing was done."""
SMOOTHED = 6.0
"""Cut-off of the hip's height [Hz], the study's for its channels."""
PAUSE = 1.0
"""Time at the bottom [s] up to which going down and rising are one squat."""
Kind = Literal["standing up", "sitting down", "squat", "rising", "going down"]
Times = Float[np.ndarray, " t"]


@dataclass(frozen=True)
class RecordedMovement:
    """One movement of a recording.

    Parameters
    ----------
    kind
        What it was; rising and going down where no chair was recorded.
    start, end
        From standing or sitting still on, until it again [s].
    contact
        Seat-off or seat contact by the chair's force [s]; not a number where there is none.
    before, after
        Force on the chair amid the rest before and after it [N]; not numbers where it was not recorded.
    rise
        By which the hip is higher at its end [m]; of a squat by which it goes down.
    agrees
        Whether the chair's force is what the coordinates make it; True where none was recorded.
    """

    kind: Kind
    start: float
    end: float
    contact: float
    before: float
    after: float
    rise: float
    agrees: bool


def hip_height(subject: Subject, q: Float[np.ndarray, "t n"]) -> Times:
    """Height of the hip over the ankle [m], from coordinates of `chain.COORDINATES`."""
    shank, thigh = q[:, 2] + q[:, 3], q[:, 2] + q[:, 3] + q[:, 4]
    return np.asarray(subject.height * (SHANK.length * np.cos(shank) + THIGH.length * np.cos(thigh)))


def movements_of(time: Times, height: Times, chair: Times | None = None) -> tuple[RecordedMovement, ...]:
    """All of them, in order; none where the hip hardly moves.

    ValueError where the recording cannot be filtered.

    Parameters
    ----------
    height
        Of the hip over the ankle [m], at even times.
    chair
        Normal force on the chair at these times, without a sign [N].
    """
    step = float(np.ptp(time)) / (len(time) - 1)
    smooth = zero_lag(height, step, SMOOTHED)
    low, size = float(smooth.min()), float(np.ptp(smooth))
    if size < LEAST_RANGE:
        return ()
    level = np.where(smooth < low + LOW * size, -1, np.where(smooth > low + HIGH * size, 1, 0))
    ends = np.flatnonzero(level)
    turns = [(int(a), int(b)) for a, b in pairwise(ends) if level[a] != level[b]]
    speed = np.gradient(smooth, step)
    spans = [_span(speed, a, b) for a, b in turns]
    # the chair may be left before the hip moves, so that half of the rest to either side is looked at
    amid = [0, *((one[1] + other[0]) // 2 for one, other in pairwise(spans)), len(time) - 1]
    beside = list(pairwise(amid))
    passed = [_passage(time, smooth, chair, *span, *rest) for span, rest in zip(spans, beside, strict=True)]
    return tuple(_with_squats(passed) if chair is not None else passed)


def _span(speed: Times, a: int, b: int) -> tuple[int, int]:
    """First and last sample of a passage, from still to still."""
    way = np.sign(speed[a : b + 1].sum())
    going, top = way * speed, int(a + np.argmax(way * speed[a : b + 1]))
    still = going < STILL * going[top]
    before, after = np.flatnonzero(still[:top]), np.flatnonzero(still[top:])
    return (int(before[-1]) if len(before) else 0), (int(top + after[0]) if len(after) else len(speed) - 1)


def _passage(
    time: Times, height: Times, chair: Times | None, first: int, last: int, rest: int, to: int
) -> RecordedMovement:
    """From the first to the last sample; the chair's force counts from one rest to the other."""
    up, none = bool(height[last] > height[first]), float("nan")
    kind: Kind = "rising" if up else "going down"
    rise = float(height[last] - height[first])
    made = RecordedMovement(kind, float(time[first]), float(time[last]), none, none, none, rise, True)
    if chair is None:
        return made
    force = chair[rest : to + 1]
    before, after, seated = float(force[0]), float(force[-1]), np.flatnonzero(force >= SEATED)
    if not len(seated):
        return replace(made, before=before, after=after)
    # the last seated sample of a rise, the first of going down that is left no more
    off = np.flatnonzero(force < SEATED)
    at = seated[-1] + 1 if up else (off[-1] + 1 if len(off) else 0)
    agrees = bool(before >= SEATED > after) if up else bool(before < SEATED <= after)
    contact = float(time[rest + min(int(at), len(force) - 1)])
    kind = "standing up" if up else "sitting down"
    start, end = min(made.start, contact), max(made.end, contact)
    return replace(made, kind=kind, start=start, end=end, before=before, after=after, contact=contact, agrees=agrees)


def _with_squats(passed: Sequence[RecordedMovement]) -> list[RecordedMovement]:
    """Going down and rising without a chair, one after the other, are a squat; alone they contradict the chair."""
    found: list[RecordedMovement] = []
    for each in passed:
        last = found[-1] if found else None
        if last is not None and (last.kind, each.kind) == ("going down", "rising") and each.start - last.end <= PAUSE:
            found[-1] = replace(last, kind="squat", end=each.end, after=each.after)
        else:
            found.append(each)
    return [replace(one, agrees=False) if one.kind in ("rising", "going down") else one for one in found]
