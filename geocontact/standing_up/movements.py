"""A recording cut into its movements: where somebody rises, goes down, and stands or sits still in between.

What rises and goes down is the hip. With both angles of the lower limb its height over the ankle is

    h = L_shank cos φ + L_thigh cos ψ

for the leans φ of the shank and ψ of the thigh. A movement is a passage of `LEAST_RANGE` or more between two turns of
h, so that swaying in between is none, whatever other movements are like; it begins and ends where the hip's speed falls
below a part of its largest. The chair's force, where it was recorded, says what the movement was: it is gone after
standing up, and comes when sitting down; in a squat nothing is sat on. Its running median is used; seat-off and seat
contact are where it passes `SEATED` nearest to the passage. Levels are invented.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Literal

import numpy as np
from jaxtyping import Float

from geocontact.identify.signals.filters import zero_lag
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.trial_forces import SEATED, steady

LOW, HIGH = 0.25, 0.75
"""Parts of a movement's height between which its largest speed is looked for."""
STILL = 0.05
"""Part of the largest speed of a movement, below which the hip stands still before and after it."""
LEAST_RANGE = 0.1
"""Height [m] that a movement has at least, and that the hip turns back by between two of them."""
SMOOTHED = 6.0
"""Cut-off of the hip's height [Hz], the study's for its channels."""
PAUSE = 1.0
"""Time at the bottom [s] up to which going down and rising are one squat."""
BESIDE = 0.5
"""Time before or after a passage of the hip [s] beyond which seat-off or seat contact is none of it."""
Kind = Literal["standing up", "sitting down", "squat", "rising", "going down"]
TASKS = {"rising": "standing up", "going down": "sitting down"}
"""What a movement is in a study where no chair says it."""
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
        By which the hip is higher at its end [m]; of a squat at its bottom, so that both ways down are negative.
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
    segments = subject.segments
    return np.asarray(segments["shank"].length * np.cos(shank) + segments["thigh"].length * np.cos(thigh))


def movements_of(
    time: Times, height: Times, chair: Times | None = None, *, squats: bool = False
) -> tuple[RecordedMovement, ...]:
    """All of them, in order; none where the hip hardly moves.

    ValueError where the recording cannot be filtered.

    Parameters
    ----------
    height
        Of the hip over the ankle [m], at even times.
    chair
        Normal force on the chair at these times, without a sign [N].
    squats
        Whether going down and rising at once is a squat where no chair was recorded, too.
    """
    step = float(np.ptp(time)) / (len(time) - 1)
    smooth = zero_lag(height, step, SMOOTHED)
    speed = np.gradient(smooth, step)
    spans = [_span(speed, *_middle(smooth, *turns)) for turns in pairwise(_turns(smooth))]
    if not spans:
        return ()
    # the chair may be left before the hip moves, so that half of the rest to either side is looked at
    amid = [0, *((one[1] + other[0]) // 2 for one, other in pairwise(spans)), len(time) - 1]
    beside = list(pairwise(amid))
    force = None if chair is None else steady(time, chair)
    passed = [_passage(time, smooth, force, *span, *rest) for span, rest in zip(spans, beside, strict=True)]
    joined = _with_squats(passed) if squats or chair is not None else passed
    return tuple(joined if chair is None else [_contradicted(one) for one in joined])


def contradiction(one: RecordedMovement) -> str:
    """What of the chair's force the coordinates contradict; empty where they agree."""
    if one.agrees:
        return ""
    if np.isfinite(one.contact) and not one.start <= one.contact <= one.end:
        return f"the chair's force passes {SEATED:g} N at {one.contact:.2f} s, more than {BESIDE:g} s off the movement"
    return f"the chair carries {one.before:.0f} N before and {one.after:.0f} N after it"


def contacts_beside(time: Times, chair: Times, movements: Sequence[RecordedMovement]) -> tuple[float, ...]:
    """Times [s] at which somebody sits down or leaves the chair by its force, farther than `BESIDE` from any movement;
    `chair` as for `movements_of`.
    """
    seated = steady(time, chair) >= SEATED
    passed = time[1:][seated[1:] != seated[:-1]]
    near = [(passed >= one.start - BESIDE) & (passed <= one.end + BESIDE) for one in movements]
    return tuple(passed[~np.any(near, axis=0)].tolist()) if near else tuple(passed.tolist())


def _turns(height: Times) -> list[int]:
    """Samples of the lowest and highest heights in turn, with `LEAST_RANGE` or more between neighbours."""
    found: list[int] = []
    way = low = high = 0
    for k, h in enumerate(height):
        low, high = (k if h < height[low] else low), (k if h > height[high] else high)
        if way <= 0 and h - height[low] >= LEAST_RANGE:
            found.append(low)
            way, high = 1, k
        elif way >= 0 and height[high] - h >= LEAST_RANGE:
            found.append(high)
            way, low = -1, k
    return found if not way else [*found, high if way > 0 else low]


def _middle(height: Times, first: int, last: int) -> tuple[int, int]:
    """Samples of a passage between `LOW` and `HIGH` of its height."""
    part = (height[first : last + 1] - height[first]) / (height[last] - height[first])
    end = int(np.argmax(part > HIGH))
    return first + int(np.flatnonzero(part[:end] < LOW)[-1]), first + end


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
    before, after, seated = float(force[0]), float(force[-1]), force >= SEATED
    made = replace(made, before=before, after=after)
    if not seated.any():
        return made
    made = replace(made, kind="standing up" if up else "sitting down")
    agrees = bool(before >= SEATED > after) if up else bool(before < SEATED <= after)
    passed = rest + 1 + np.flatnonzero(seated[:-1] & ~seated[1:] if up else ~seated[:-1] & seated[1:])
    if not len(passed):
        return replace(made, agrees=False)
    # the last of those within the passage, else the one nearest to it
    off = np.maximum(np.maximum(time[first] - time[passed], time[passed] - time[last]), 0.0)
    at = int(np.flatnonzero(off == off.min())[-1])
    contact = float(time[passed[at]])
    if off[at] > BESIDE:
        return replace(made, contact=contact, agrees=False)
    start, end = min(made.start, contact), max(made.end, contact)
    return replace(made, start=start, end=end, contact=contact, agrees=agrees)


def _with_squats(passed: Sequence[RecordedMovement]) -> list[RecordedMovement]:
    """Going down and rising without a chair, one after the other, are a squat."""
    found: list[RecordedMovement] = []
    for each in passed:
        last = found[-1] if found else None
        if last is not None and (last.kind, each.kind) == ("going down", "rising") and each.start - last.end <= PAUSE:
            found[-1] = replace(last, kind="squat", end=each.end, after=each.after)
        else:
            found.append(each)
    return found


def _contradicted(one: RecordedMovement) -> RecordedMovement:
    """Rising or going down alone contradicts a chair that was recorded."""
    return replace(one, agrees=False) if one.kind in ("rising", "going down") else one
