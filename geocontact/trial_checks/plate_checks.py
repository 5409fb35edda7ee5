"""Force plates against the person's mass, the direction of the walk, the feet that stand on them, and their clock."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.trial_checks.landmarks import FOOT, middle, points
from geocontact.trial_checks.recorded import Check, Contradiction, FootPlate, TrialInputs

GRAVITY = 9.80665
STANCE, STILL = 0.45, 1.5
"""s; a foot of somebody who walks is on the floor for longer than the one, for less than the other."""
MEAN = (0.55, 1.02)
"""Shares of the body weight between which the mean vertical force of such a step lies. Each foot carries half of the
weight over a cycle and is on the floor for a share D of it, so that the mean is 1 / (2 D): 0.76 to 0.86 for walking
people, D = 0.58 to 0.66 (Perry, Gait Analysis, 1992), and below 1 where both feet are on the floor at times."""
STANDING, WEIGHT, OTHER_WEIGHT = 0.3, 0.1, 0.2
"""s, over which the weight of who stands is averaged; shares of it: rising at 1 m/s^2 is as much as the one, and with
twice as much the mass is another one."""
LEAST = 0.3
"""Share of the weight that somebody who steps on a plate exceeds."""
HEAVY = 0.3
"""Share of the largest normal force from which samples are compared."""
SHEAR, TWIST = 0.5, 0.12
"""Force along the floor and free moment [m] in parts of the normal force, in the median under load. People who walk
have 0.1 and 0.02 m."""
SPEED, IMPULSE = 0.5, 0.02
"""m/s, from which somebody walks; share of the body's weight that braking or propulsion has in the mean of half a
step."""
AWAY = 0.3
"""m, from a foot's heel and toes to the centre of pressure, seen from above, in the median."""
HEIGHT = (-0.025, 0.075)
"""m, of the lowest marker of a foot's heel and toes above the plate; in 14 steps of 5 people 0.027 to 0.049."""
SLOW = 0.5
"""m/s beside the floor, of the slower one of heel and toes while the foot stands."""
TOUCH, LEAVE, ALONE = (-0.05, 0.05), (-0.03, 0.07), 0.08
"""s, of touch-down and of the end of the load after the foot begins and ends to be slow. In 10 steps of 4 people the
one was -0.013 to 0.016 s, the other -0.014 to 0.058 s: toes move before they leave the floor. A foot that hovers before
it lands is slow too, so that touch-down alone, where markers end before toe-off, has to be later still."""


@dataclass(frozen=True)
class Step:
    """One step on a plate: when, with which load, and where.

    Parameters
    ----------
    on
        The plate, with its file.
    time
        [s].
    force
        On the foot [N].
    normal
        Its part out of the floor [N].
    centre
        Centre of pressure [m], NaN where there is none.
    """

    on: FootPlate
    time: Float[np.ndarray, " t"]
    force: Float[np.ndarray, "t 3"]
    normal: Float[np.ndarray, " t"]
    centre: Float[np.ndarray, "t 3"]

    @property
    def heavy(self) -> Bool[np.ndarray, " t"]:
        """Where the load is large enough to be compared."""
        return np.asarray(self.normal >= HEAVY * self.normal.max())


def steps(trial: TrialInputs) -> Iterator[Step]:
    """All whole steps on all plates."""
    for on in trial.plates:
        centre = on.plate.centre_of_pressure()
        for part in on.steps(STANCE):
            force = np.nan_to_num(on.plate.wrench.force[part])
            yield Step(on, on.plate.time[part], force, on.normal[part], centre[part])


def mass(trial: TrialInputs) -> Iterator[Contradiction]:
    """The weight by the plates against the mass."""
    if trial.mass is None:
        return
    weight = trial.mass * GRAVITY
    most = max((float(on.normal.max(initial=0.0)) for on in trial.plates), default=np.inf)
    if most < LEAST * weight:
        first = trial.plates[0]
        what = f"no plate ever carries more than {most:.3g} N, {most / weight:.1%} of the weight of {trial.mass:.4g} kg"
        remedy = f"is the force in N, {trial.mass_option} in kg, and does anybody stand on it?"
        yield Contradiction(first.source, first.plate.name, what, remedy)
    walked = [step for step in steps(trial) if step.time[-1] - step.time[0] < STILL]
    if not walked:
        return
    means = np.array([step.normal.mean() for step in walked]) / weight
    worst = walked[int(np.argmax(np.abs(np.log(means / 0.8))))]
    low, high = MEAN
    if low <= np.median(means) <= high:
        return
    person = worst.normal.mean() / 0.8 / GRAVITY
    what = f"its mean force during a step is {np.median(means):.2f} times the weight of {trial.mass:.4g} kg"
    remedy = (
        f"by a walking person's step, 0.8, the mass is about {person:.0f} kg: check {trial.mass_option} and its unit"
    )
    yield Contradiction(worst.on.source, worst.on.plate.name, what, remedy)


def standing_weight(trial: TrialInputs) -> Iterator[Contradiction]:
    """The weight by the plates while the person stands on them against the mass."""
    if trial.mass is None or trial.stands_at is None or not trial.plates:
        return
    normal = 0.0
    for on in trial.plates:
        there = np.abs(on.plate.time - trial.stands_at) <= 0.5 * STANDING
        normal += float(on.normal[there].mean()) if there.any() else np.nan
    share = normal / (trial.mass * GRAVITY)
    if np.isfinite(share) and abs(share - 1.0) > WEIGHT:
        names = " and ".join(on.plate.name for on in trial.plates)
        what = f"carries {share:.2f} times the weight of {trial.mass:.4g} kg while the person stands, at"
        remedy = (
            f"by the plates it is {normal / GRAVITY:.1f} kg: check {trial.mass_option}, and that no plate is missing"
        )
        what += f" {trial.stands_at:.2f} s"
        yield Contradiction(trial.plates[0].source, names, what, remedy, refuse=abs(share - 1.0) > OTHER_WEIGHT)


def sizes(trial: TrialInputs) -> Iterator[Contradiction]:
    """Force along the floor and free moment against the force out of it."""
    for on in trial.plates:
        plate, normal = on.plate, on.normal
        heavy = normal >= max(HEAVY * float(normal.max(initial=0.0)), 20.0)
        if not heavy.any():
            continue
        along = plate.wrench.force - normal[:, None] * plate.normal
        shear = float(np.nanmedian(np.linalg.norm(along[heavy], axis=1) / normal[heavy]))
        if shear > SHEAR:
            what = f"force along the floor is {shear:.2g} times that out of it (median under load)"
            yield Contradiction(on.source, plate.name, what, "are the plate's axes exchanged, or is another one up?")
        free = np.abs(plate.free_moment()[heavy]) / normal[heavy]
        if np.isfinite(free).any() and np.nanmedian(free) > TWIST:
            moment = np.nanmedian(free * normal[heavy])
            what = f"its free moment is {moment:.3g} N m under {np.median(normal[heavy]):.3g} N (medians)"
            yield Contradiction(on.source, plate.name, what, "is it in N m, and about the centre of pressure?")


def _velocity(seen: MarkerTrajectories) -> Float[np.ndarray, " 3"] | None:
    """Mean velocity of the pelvis, else of all markers [m/s]; None for less than 0.3 s."""
    body = middle(seen, ("asis", "psis", "sacrum"))
    body = np.nanmean(seen.positions, axis=1) if body is None else body
    there = np.flatnonzero(np.isfinite(body).all(axis=1))
    if len(there) < 2 or seen.time[there[-1]] - seen.time[there[0]] < 0.3:
        return None
    return np.asarray((body[there[-1]] - body[there[0]]) / (seen.time[there[-1]] - seen.time[there[0]]))


def _of_the_floor(seen: MarkerTrajectories, step: Step) -> Float[np.ndarray, " 3"]:
    """Velocity of the foot that is slower in the middle third of a step [m/s]: of a belt, else about 0."""
    third = (step.time[-1] - step.time[0]) / 3.0
    inside = (seen.time >= step.time[0] + third) & (seen.time <= step.time[-1] - third)
    if inside.sum() < 2:
        return np.zeros(3)
    feet = [np.gradient(points(seen, ("heel", "toe"), side), seen.time, axis=0)[inside] for side in ("right", "left")]
    steady = [(float(np.nanmax(np.nanstd(v, axis=0))), np.nanmedian(v, axis=(0, 1))) for v in feet if v.size]
    steady = [(sd, mean) for sd, mean in steady if np.isfinite(sd)]
    return min(steady, key=lambda one: one[0])[1] if steady else np.zeros(3)


def braking(trial: TrialInputs) -> Iterator[Contradiction]:
    """The force along the walk: against it in the first half of a step, with it in the second."""
    body = None if trial.markers is None else _velocity(trial.markers)
    if body is None or trial.markers is None:
        return
    for step in steps(trial):
        velocity = body - _of_the_floor(trial.markers, step)
        velocity = velocity - (velocity @ trial.up) * trial.up
        if np.linalg.norm(velocity) < SPEED:
            continue
        forwards = velocity / np.linalg.norm(velocity)
        across = np.cross(trial.up, forwards)
        half, weight = len(step.time) // 2, float(step.normal.mean())
        along, beside = step.force @ forwards / weight, step.force @ across / weight
        first, second = along[:half].mean(), along[half:].mean()
        if first > IMPULSE and second < -IMPULSE:
            what = f"it pushes along the walk before it brakes, {first:.1%} and {second:.1%} of the load"
            remedy = "is the sign of the force along the walk turned, or an axis of plates or markers?"
            yield Contradiction(step.on.source, step.on.plate.name, what, remedy)
        sideways, fore = np.abs(np.diff(_halves(beside))), np.abs(np.diff(_halves(along)))
        if sideways > 2.0 * IMPULSE and fore < 0.5 * sideways:
            what = "it brakes and propels across the walk, not along it"
            remedy = "are plates and markers in the same axes?"
            yield Contradiction(step.on.source, step.on.plate.name, what, remedy)


def _halves(values: Float[np.ndarray, " t"]) -> Float[np.ndarray, " 2"]:
    half = len(values) // 2
    return np.array([values[:half].mean(), values[half:].mean()])


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
        away = {side: _distance(seen, side, time, centre[heavy], flat) for side in ("right", "left")}
        known = {side: d for side, d in away.items() if np.isfinite(d)}
        if not known:
            continue
        nearest = min(known, key=lambda side: known[side])
        if known[nearest] > AWAY and (len(known) == 2 or on.side == nearest):
            what = f"its centre of pressure is {known[nearest]:.2f} m from the {nearest} foot (median)"
            remedy = "are plates and markers in the same axes and unit, on one clock, and of one trial?"
            yield Contradiction(on.source, on.plate.name, what, remedy)
        elif on.side in known and nearest != on.side and known[on.side] > max(AWAY, 2.0 * known[nearest]):
            what = f"the {nearest} foot stands on it ({known[nearest]:.2f} m), not the {on.side} one"
            what += f" ({known[on.side]:.2f} m)"
            yield Contradiction(on.source, on.plate.name, what, "are the plates of the two feet exchanged?")


def one_foot_each(trial: TrialInputs) -> Iterator[Contradiction]:
    """The loads of two plates against each other."""
    for k, one in enumerate(trial.plates):
        for other in trial.plates[k + 1 :]:
            same = one.plate.wrench.force.shape == other.plate.wrench.force.shape and np.array_equal(
                one.plate.wrench.force, other.plate.wrench.force, equal_nan=True
            )
            if same and one.side != other.side and one.normal.any():
                what = f"its force is that of {other.plate.name}, sample by sample, under the other foot"
                yield Contradiction(one.source, one.plate.name, what, "name the plate of each foot", refuse=True)


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
        away = {s: _distance(seen, s, step.time[there], step.centre[there], flat) for s in ("right", "left")}
        known = {side: d for side, d in away.items() if np.isfinite(d)}
        if not known or min(known.values()) > AWAY:
            continue
        late = _late(seen, min(known, key=lambda side: known[side]), step)
        if late:
            when = "after" if late > 0.0 else "before"
            what = f"it is loaded about {abs(late):.2f} s {when} the foot on it stands still, at both ends of a step"
            remedy = "plates and markers need one clock: shift one of them"
            yield Contradiction(step.on.source, step.on.plate.name, what, remedy)


def _late(seen: MarkerTrajectories, side: str, step: Step) -> float:
    """By how much the load is later than the foot's rest [s]; 0 where touch-down and toe-off do not both say so.

    Speeds are beside that of the foot in the middle of the step, so that a treadmill's belt does not count.
    """
    foot = points(seen, ("heel", "toe"), side)
    if not foot.shape[1]:
        return 0.0
    velocity, floor_velocity = np.gradient(foot, seen.time, axis=0), _of_the_floor(seen, step)
    slow = np.nan_to_num(np.nanmin(np.linalg.norm(velocity - floor_velocity, axis=2), axis=1), nan=np.inf) < SLOW
    middle_of = int(np.searchsorted(seen.time, 0.5 * (step.time[0] + step.time[-1])))
    fast = np.flatnonzero(~slow)
    before, after = fast[fast < middle_of], fast[fast > middle_of]
    if middle_of >= len(slow) or not slow[middle_of] or not len(before):
        return 0.0
    touch = step.time[0] - float(seen.time[before[-1] + 1])
    if not len(after):
        return touch if touch > ALONE else 0.0
    leave = step.time[-1] - float(seen.time[after[0] - 1])
    later = touch > TOUCH[1] and leave > LEAVE[1]
    earlier = touch < TOUCH[0] and leave < LEAVE[0]
    return 0.5 * (touch + leave) - 0.25 * sum(LEAVE) if later or earlier else 0.0


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
        for side in ("right", "left"):
            if not _distance(seen, side, step.time[there], step.centre[there], flat) < AWAY:
                continue
            frames = np.clip(np.searchsorted(seen.time, step.time[there]), 0, len(seen.time) - 1)
            above = (points(seen, ("heel", "toe"), side)[frames] - step.on.plate.point) @ trial.up
            if not np.isfinite(above).any():
                continue
            height = float(np.nanmedian(np.nanmin(above, axis=1)))
            if not HEIGHT[0] <= height <= HEIGHT[1]:
                what = (
                    f"the lowest marker of the {side} foot is {1e3 * height:.0f} mm above the plate that it stands on"
                )
                remedy = "is the floor at the same height in plates and markers?"
                yield Contradiction(step.on.source, step.on.plate.name, what, remedy)
            break


PLATE_CHECKS = (
    Check(
        "mass",
        "mean vertical force of each step with the weight of the mass that was given",
        f"{MEAN[0]:g} to {MEAN[1]:g} times the weight, for steps of {STANCE:g} to {STILL:g} s; walking people: 0.76 to "
        "0.86 (half of the weight over 0.58 to 0.66 of the cycle; Perry, Gait Analysis, 1992)",
        mass,
    ),
    Check(
        "standing weight",
        "force out of the floor of all plates, while the person stands on them, with the weight of the mass",
        f"{WEIGHT:.0%} of the weight, mean of {STANDING:g} s; rising at 1 m/s² is as much; refused from "
        f"{OTHER_WEIGHT:.0%} on",
        standing_weight,
    ),
    Check(
        "size of shear",
        "force along the floor and free moment with the force out of the floor",
        f"{SHEAR:g}, and {TWIST:g} m; walking people: 0.1, and 0.02 m",
        sizes,
    ),
    Check(
        "braking",
        "force along the walk in the first and in the second half of a step, with the direction in which markers move",
        f"{IMPULSE:.0%} of the load, of somebody faster than {SPEED:g} m/s",
        braking,
    ),
    Check(
        "foot on plate",
        "centre of pressure with heel, toes and ankle of the foot that is said to stand there",
        f"{AWAY:g} m, in the median under load; a foot is 0.2 to 0.3 m long",
        under_a_foot,
    ),
    Check(
        "one plate for each foot",
        "forces of the two plates with each other",
        "equal in every sample",
        one_foot_each,
    ),
    Check(
        "floor",
        "height of the lowest marker of heel and toes with the surface of the plate under the foot",
        f"{1e3 * HEIGHT[0]:.0f} to {1e3 * HEIGHT[1]:.0f} mm in the median under load; 27 to 49 mm in real recordings",
        floor,
    ),
    Check(
        "clock",
        "when a plate is loaded with when heel or toes of the foot on it are slow",
        f"{TOUCH[1]:g} s at touch-down and {LEAVE[1]:g} s at toe-off (earlier: {-TOUCH[0]:g} and {-LEAVE[0]:g} s); "
        f"slow is below {SLOW:g} m/s",
        clocks,
    ),
)
"""Checks that need plates."""
