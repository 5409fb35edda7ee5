"""Force plates against the feet that stand on them: where, how high, and when."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float

from geocontact.data.multibody.force_plate import LOADED
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.trial_checks.landmarks import FOOT, SIDES, points, the_foot
from geocontact.trial_checks.plate_checks import HEAVY, Step, steps, velocity_of_floor
from geocontact.trial_checks.recorded import Check, Contradiction, FootPlate, TrialInputs

AWAY = 0.3
"""m, from a foot's heel and toes to the centre of pressure, seen from above, in the median."""
LONE = 0.2
"""s, of either end of the load alone: another clock's rate, or a second foot on the plate."""
BESIDE, NEARLY_ALL = 0.09, 90.0
"""m, from the line between heel and toes, seen from above, and per cent of the loaded samples that are nearer; in 12
steps of 5 people 0.005 to 0.034."""
HEIGHT = (-0.025, 0.075)
"""m, of the lowest marker of a foot's heel and toes above the plate; in 14 steps of 5 people 0.027 to 0.049."""
HEEL = 0.0
"""m, of the heel's marker above the plate in 95 % of the loaded samples; the middle of a marker is 5 to 7 mm above what
it is stuck on, and in 13 steps of 5 people it comes down to 19 to 76 mm."""
SOLE = 0.03
"""m, between the lowest point of a sole and the plate: a sole gives way, and its floor is known to a centimetre."""
FAST, OFTEN = 1.0, 0.12
"""m/s beside the floor, of the nearest foot, and share of the loaded samples in which it is; a foot that swings reaches
3 to 4 m/s, and under load it is faster than the one in 0 to 5.5 % of the samples of 12 steps of 5 people."""
UNLOADED, SWUNG = 15.0, 10
"""N that a plate which was set to zero does not show while its foot swings, and samples of swing that are looked at."""
SLOW = 0.5
"""m/s beside the floor, of the slower one of heel and toes while the foot stands."""
WIDER = (-0.036, 0.03)
"""s, of both: a filter at 5 Hz makes a load begin and end 0.04 s beyond the rest. Loads of real walks begin at -0.032 s
at the earliest (a force that was filtered before it was published)."""
TOUCH, LEAVE, ALONE = (-0.05, 0.05), (-0.03, 0.07), 0.08
"""s, of touch-down and of the end of the load after the foot begins and ends to be slow. In 10 steps of 4 people the
one was -0.013 to 0.016 s, the other -0.014 to 0.058 s: toes move before they leave the floor. A foot that hovers before
it lands is slow too, so that touch-down alone, where markers end before toe-off, has to be later still."""


def under_a_foot(trial: TrialInputs) -> Iterator[Contradiction]:
    """The centre of pressure against the landmarks of the feet, and against those of the foot that was named."""
    seen = trial.markers
    if seen is None:
        return
    for on in trial.plates:
        centre = on.plate.centre_of_pressure()
        heavy = (on.normal >= max(HEAVY * float(on.normal.max(initial=0.0)), 20.0)) & np.isfinite(centre).all(axis=1)
        heavy &= (on.plate.time >= seen.time[0]) & (on.plate.time <= seen.time[-1])
        if not heavy.any():
            continue
        time, flat = on.plate.time[heavy], np.eye(3) - np.outer(trial.up, trial.up)
        away = {side: _distance(seen, side, time, centre[heavy], flat) for side in SIDES}
        known = {side: d for side, d in away.items() if np.isfinite(d)}
        if not known:
            continue
        nearest = min(known, key=lambda side: known[side])
        if known[nearest] > AWAY and (len(known) >= 2 or on.side == nearest):
            what = f"its centre of pressure is {known[nearest]:.2f} m from {the_foot(nearest)} (median)"
            remedy = "are plates and markers in the same axes and unit, on one clock, and of one trial?"
            yield Contradiction(on.source, on.plate.name, what, remedy)
        elif on.side in known and nearest != on.side and known[on.side] > max(AWAY, 2.0 * known[nearest]):
            what = f"the {nearest} foot stands on it ({known[nearest]:.2f} m), not the {on.side} one"
            what += f" ({known[on.side]:.2f} m)"
            yield Contradiction(on.source, on.plate.name, what, "are the plates of the two feet exchanged?")
        elif on.side in ("", nearest) and (beside := _beside(seen, nearest, time, centre[heavy], flat)) > BESIDE:
            what = f"its centre of pressure is up to {beside:.2f} m beside the line from heel to toes"
            what += f" of {the_foot(nearest)}"
            remedy = "are plates and markers of one trial, with one origin and the same axes?"
            yield Contradiction(on.source, on.plate.name, what, remedy)


def _beside(
    seen: MarkerTrajectories,
    side: str,
    time: Float[np.ndarray, " n"],
    centre: Float[np.ndarray, "n 3"],
    flat: Float[np.ndarray, "3 3"],
) -> float:
    """Distance from the line between heel and toes that nearly all samples are within [m]; NaN without both."""
    ends = [points(seen, (kind,), side) for kind in ("heel", "toe")]
    if not all(each.shape[1] for each in ends):
        return float("nan")
    frames = np.clip(np.searchsorted(seen.time, time), 0, len(seen.time) - 1)
    heel, toe = (np.nanmean(each[frames], axis=1) @ flat for each in ends)
    along, out = toe - heel, centre @ flat - heel
    share = np.clip(np.sum(out * along, axis=1) / np.sum(along**2, axis=1), 0.0, 1.0)
    off = np.linalg.norm(out - share[:, None] * along, axis=1)
    off = off[np.isfinite(off)]
    return float(np.percentile(off, NEARLY_ALL)) if len(off) else float("nan")


def _distance(
    seen: MarkerTrajectories,
    side: str,
    time: Float[np.ndarray, " n"],
    centre: Float[np.ndarray, "n 3"],
    flat: Float[np.ndarray, "3 3"],
) -> float:
    """Median distance of a centre of pressure from the nearest landmark of a foot, seen from above [m]."""
    foot = points(seen, FOOT, side)
    if not foot.shape[1]:
        return float("nan")
    frames = np.clip(np.searchsorted(seen.time, time), 0, len(seen.time) - 1)
    apart = np.linalg.norm((foot[frames] - centre[:, None]) @ flat, axis=2)
    apart = apart[np.isfinite(apart).any(axis=1)]
    return float(np.median(np.nanmin(apart, axis=1))) if len(apart) else float("nan")


def clocks(trial: TrialInputs) -> Iterator[Contradiction]:
    """When a foot stands still against when the plate under it is loaded."""
    seen = trial.markers
    if seen is None or len(seen) < 10:
        return
    flat = np.eye(3) - np.outer(trial.up, trial.up)
    for step in steps(trial):
        if step.time[0] < seen.time[0]:
            continue
        there = step.heavy & np.isfinite(step.centre).all(axis=1)
        away = {s: _distance(seen, s, step.time[there], step.centre[there], flat) for s in SIDES}
        known = {side: d for side, d in away.items() if np.isfinite(d)}
        if not known or min(known.values()) > AWAY:
            continue
        ends = _ends(seen, min(known, key=lambda side: known[side]), step)
        if ends is None:
            continue
        touch, leave = ends
        late = _late(touch, leave)
        if touch < WIDER[0] and leave > WIDER[1] and not late:
            what = f"its load begins {_beside_rest(touch)} and ends {_beside_rest(leave)} the foot on it stands still"
            remedy = "was the force filtered at too low a frequency?"
            yield Contradiction(step.on.source, step.on.plate.name, what, remedy)
        elif late:
            when = "after" if late > 0.0 else "before"
            what = f"its load begins or ends about {abs(late):.2f} s {when} the foot on it stands still"
            remedy = "plates and markers need one clock that runs alike: shift one of them"
            yield Contradiction(step.on.source, step.on.plate.name, what, remedy)


def _beside_rest(by: float) -> str:
    return f"{abs(by):.2f} s {'after' if by > 0.0 else 'before'}"


def _late(touch: float, leave: float) -> float:
    """By how much the load is later than the foot's rest [s]; 0 where touch-down and toe-off do not both say so."""
    if np.isnan(leave):
        return touch if abs(touch) > ALONE else 0.0
    far = max(touch, leave, key=abs)
    if abs(far) > LONE:
        return far
    later = touch > TOUCH[1] and leave > LEAVE[1]
    earlier = touch < TOUCH[0] and leave < LEAVE[0]
    return 0.5 * (touch + leave) - 0.25 * sum(LEAVE) if later or earlier else 0.0


def _ends(seen: MarkerTrajectories, side: str, step: Step) -> tuple[float, float] | None:
    """By how much the load begins and ends after the foot begins and ends to stand still [s]; None where it does not.

    Not a number where the markers end before toe-off. Speeds are beside that of the foot in the middle of the step, so
    that a treadmill's belt does not count.
    """
    foot = points(seen, ("heel", "toe"), side)
    if not foot.shape[1]:
        return None
    velocity, floor_velocity = np.gradient(foot, seen.time, axis=0), velocity_of_floor(seen, step)
    slow = np.nan_to_num(np.nanmin(np.linalg.norm(velocity - floor_velocity, axis=2), axis=1), nan=np.inf) < SLOW
    last = min(step.time[-1], seen.time[-1])
    middle_of = int(np.searchsorted(seen.time, 0.5 * (step.time[0] + last)))
    fast = np.flatnonzero(~slow)
    before, after = fast[fast < middle_of], fast[fast > middle_of]
    if middle_of >= len(slow) or not slow[middle_of] or not len(before):
        return None
    touch = float(step.time[0]) - float(seen.time[before[-1] + 1])
    return touch, float(step.time[-1]) - float(seen.time[after[0] - 1]) if len(after) else float("nan")


def stands_under_load(trial: TrialInputs) -> Iterator[Contradiction]:
    """How fast the nearest foot is while a plate is loaded, whole steps or not."""
    seen = trial.markers
    if seen is None or len(seen) < 10:
        return
    flat = np.eye(3) - np.outer(trial.up, trial.up)
    for on in trial.plates:
        feet = [points(seen, FOOT, side) for side in SIDES if on.side in ("", side)]
        feet = [foot.mean(axis=1) for foot in feet if foot.shape[1]]
        centre = on.plate.centre_of_pressure()
        heavy = (on.normal >= max(HEAVY * float(on.normal.max(initial=0.0)), LOADED)) & np.isfinite(centre).all(axis=1)
        heavy &= (on.plate.time >= seen.time[0]) & (on.plate.time <= seen.time[-1])
        if not feet or not heavy.any():
            continue
        frames = np.clip(np.searchsorted(seen.time, on.plate.time[heavy]), 0, len(seen.time) - 1)
        places, rates = np.stack(feet), np.stack([np.gradient(foot, seen.time, axis=0) for foot in feet])
        away = np.nan_to_num(np.linalg.norm((places[:, frames] - centre[heavy]) @ flat, axis=2), nan=np.inf)
        rate = rates[np.argmin(away, axis=0), frames]
        speed = np.linalg.norm(rate - np.nanmedian(rate, axis=0), axis=1)
        share = float(np.mean(speed[np.isfinite(speed)] > FAST)) if np.isfinite(speed).any() else 0.0
        if share > OFTEN:
            what = f"the foot on it moves faster than {FAST:g} m/s in {share:.0%} of the samples in which it is loaded"
            remedy = "is it the plate of this foot, on the markers' clock?"
            yield Contradiction(on.source, on.plate.name, what, remedy)
        elif len(feet) == 1:
            yield from _zero(on, seen, rates[0] - np.nanmedian(rate, axis=0))


def _zero(on: FootPlate, seen: MarkerTrajectories, rate: Float[np.ndarray, "n 3"]) -> Iterator[Contradiction]:
    """What the plate of a foot shows while that foot swings, `rate` [m/s] beside the floor."""
    speed = np.interp(on.plate.time, seen.time, np.linalg.norm(rate, axis=1), np.nan, np.nan)
    shown = on.normal[speed > FAST]
    if len(shown) < SWUNG:
        return
    low, level, high = (float(each) for each in np.percentile(shown, (25.0, 50.0, 75.0)))
    if UNLOADED < abs(level) < HEAVY * float(on.normal.max(initial=0.0)) and high - low < 0.5 * abs(level):
        what = f"it shows {level:.0f} N while the foot on it swings"
        yield Contradiction(on.source, on.plate.name, what, "was the plate set to zero?")


def floor(trial: TrialInputs) -> Iterator[Contradiction]:
    """The height of the lowest landmark of a foot above the plate that it stands on."""
    seen = trial.markers
    if seen is None:
        return
    flat = np.eye(3) - np.outer(trial.up, trial.up)
    for step in steps(trial):
        there = step.heavy & np.isfinite(step.centre).all(axis=1)
        there &= (step.time >= seen.time[0]) & (step.time <= seen.time[-1])
        if not there.any():
            continue
        for side in SIDES:
            if not _distance(seen, side, step.time[there], step.centre[there], flat) < AWAY:
                continue
            frames = np.clip(np.searchsorted(seen.time, step.time[there]), 0, len(seen.time) - 1)
            above = (points(seen, ("heel", "toe"), side)[frames] - step.on.plate.point) @ trial.up
            if not np.isfinite(above).any():
                continue
            height = float(np.nanmedian(np.nanmin(above, axis=1)))
            low, high = (-SOLE, SOLE) if trial.on_sole else HEIGHT
            if not low <= height <= high:
                what = (
                    f"the lowest marker of {the_foot(side)} is {1e3 * height:.0f} mm above the plate that it stands on"
                )
                remedy = "is the floor at the same height in plates and markers"
                remedy += ", and are the spheres where the sole is?" if trial.on_sole else "?"
                yield Contradiction(step.on.source, step.on.plate.name, what, remedy)
            elif not trial.on_sole:
                yield from _heel_below(step, points(seen, ("heel",), side)[frames], trial)
            break


def _heel_below(step: Step, heel: Float[np.ndarray, "n m 3"], trial: TrialInputs) -> Iterator[Contradiction]:
    """The markers of a heel under load against the surface of the plate; toes are over a forefoot that gives way."""
    above = (heel - step.on.plate.point) @ trial.up
    for each in above.T[np.isfinite(above).any(axis=0)] if above.size else ():
        least = float(np.nanpercentile(each, 5.0))
        if least < HEEL:
            what = f"the heel's marker comes down to {-1e3 * least:.0f} mm below the plate that the foot stands on"
            remedy = "is it at the heel, and the floor at the same height in plates and markers?"
            yield Contradiction(step.on.source, step.on.plate.name, what, remedy)
            return


FOOT_CHECKS = (
    Check(
        "foot on plate",
        "centre of pressure with heel, toes and ankle of the foot",
        f"{AWAY:g} m, in the median under load; {BESIDE:g} m from the line from heel to toes in "
        f"{100 - NEARLY_ALL:.0f} % of the samples, of real steps 0.005 to 0.034 m",
        under_a_foot,
    ),
    Check(
        "floor",
        "height of the lowest marker of heel and toes above the plate",
        f"{1e3 * HEIGHT[0]:.0f} to {1e3 * HEIGHT[1]:.0f} mm in the median under load; 27 to 49 mm in real recordings; "
        f"the heel's least {1e3 * HEEL:.0f} mm, there 19 to 76 mm; "
        f"the sole itself, of `cop` and `gap gather`, {1e3 * SOLE:.0f} mm",
        floor,
    ),
    Check(
        "at rest under load",
        "speed of the nearest foot beside the floor with the load on the plate",
        f"above {FAST:g} m/s in {OFTEN:.0%} of the loaded samples; {UNLOADED:g} N that stay in swing",
        stands_under_load,
    ),
    Check(
        "clock",
        "when a plate is loaded with when heel or toes of the foot on it are slow",
        f"{TOUCH[1]:g} s at touch-down and {LEAVE[1]:g} s at toe-off (earlier: {-TOUCH[0]:g} and {-LEAVE[0]:g} s), or "
        f"{LONE:g} s at one of them; {-WIDER[0]:g} s before and {WIDER[1]:g} s after; slow is below {SLOW:g} m/s",
        clocks,
    ),
)
"""Checks that need plates, and markers of the feet on them."""
