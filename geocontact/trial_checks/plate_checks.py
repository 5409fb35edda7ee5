"""Force plates against the person's mass, the direction of the walk, their own surface, and each other."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.multibody.force_plate import LOADED
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.trial_checks.landmarks import FOOT, landmark, middle, points
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
LITTLE = 0.04
"""Share of the load by which the force along the walk changes from one half of a step to the other; three people
who walk have 0.17 to 0.29."""
CLIPPED = 0.05
"""Share of a step's samples in which the force is at its largest value, no digit changing; noise never is."""
TRAVEL = 0.005
"""m, along the walk, that a load travels during a step at least; under a foot that rolls it is 150 to 250 mm."""

WORN = 0.4
"""Share of the weight that a force may press down with: a device that is worn does, as the reader of plates says."""
EDGE, SAID = 0.05, 0.2
"""Shares of a plate's length beyond its edge, 30 mm of 0.6 m; from the second on the reader of the file says it."""


CARRIED, WHOLE = 0.35, 0.15
"""Share of the largest force of all plates together, which they carry all the time where none is missing; and how far
their mean over a step may be from the weight, two to three times what a walking person's acceleration makes."""


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
    most = max((float(on.normal.max(initial=0.0)) for on in trial.plates), default=np.inf)
    if trial.mass is None:
        if 0.0 < most < LOADED and trial.markers is not None:
            what = f"no plate ever carries more than {most:.3g} N"
            remedy = "is the force in N, and does anybody stand on it?"
            yield Contradiction(trial.plates[0].source, trial.plates[0].plate.name, what, remedy)
        return
    weight = trial.mass * GRAVITY
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
        yield from _whole_steps(trial, walked, weight)
        return
    person = worst.normal.mean() / 0.8 / GRAVITY
    what = f"its mean force during a step is {np.median(means):.2f} times the weight of {trial.mass:.4g} kg"
    remedy = (
        f"by a walking person's step, 0.8, the mass is about {person:.0f} kg: check {trial.mass_option} and its unit"
    )
    yield Contradiction(worst.on.source, worst.on.plate.name, what, remedy)


def _whole_steps(trial: TrialInputs, walked: list[Step], weight: float) -> Iterator[Contradiction]:
    """The mean of all plates, those beside the named ones too, over steps in which they carry the person all the time.

    It is m (g + a) with a the mean acceleration upwards, the change of a velocity of some 0.3 m/s over 0.7 s.
    """
    shares = []
    used = (*trial.plates, *(FootPlate(each, "") for each in trial.beside))
    for step in walked:
        every = [np.interp(step.time, on.plate.time, on.normal, np.nan, np.nan) for on in used]
        total = np.sum(every, axis=0)
        if np.isfinite(total).all() and total.min() > CARRIED * total.max():
            shares.append(float(total.mean()) / weight)
    if not shares or abs(np.median(shares) - 1.0) <= WHOLE:
        return
    share = float(np.median(shares))
    names = " and ".join(on.plate.name for on in used)
    what = f"carry {share:.2f} times the weight of {trial.mass:.4g} kg over a step"
    remedy = f"by the plates it is about {share * weight / GRAVITY:.0f} kg: check {trial.mass_option} and its unit, "
    remedy += "and each plate's gain"
    yield Contradiction(trial.plates[0].source, names, what, remedy)


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
        refuse = trial.surely and abs(share - 1.0) > OTHER_WEIGHT
        yield Contradiction(trial.plates[0].source, names, what, remedy, refuse=refuse)


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


def reaction(trial: TrialInputs) -> Iterator[Contradiction]:
    """The sign of the force under load: out of the floor, on the foot, or into it, on the plate."""
    for on in trial.plates:
        usual = on.plate.usual_load(tuple(other.plate for other in trial.plates))
        if usual < 0.0 and (trial.mass is None or -usual > WORN * trial.mass * GRAVITY):
            what = f"its force out of the floor is {usual:.4g} N under load (median): that is the force on the plate"
            remedy = "give the force on the foot: turn the sign of forces and torques"
            yield Contradiction(on.source, on.plate.name, what, remedy, refuse=True)


COPIED, ROUNDED = 10, 1e-6
"""Samples under load in which two components change and are equal: noise alone keeps them apart; N or m, that is
rounding and no change, as of the centre on a plate without a moment."""


def copied_components(trial: TrialInputs) -> Iterator[Contradiction]:
    """Components of the force, and of the centre of pressure, of one plate with each other."""
    for on in trial.plates:
        loaded = on.normal >= LOADED
        force, centre = on.plate.wrench.force[loaded], on.plate.centre_of_pressure()[loaded]
        for what, columns in (("force", force), ("centre of pressure", centre)):
            for one, other in combinations(range(3), 2):
                pair = columns[:, [one, other]]
                pair = pair[np.isfinite(pair).all(axis=1)]
                if len(np.unique(pair[:, 0])) < COPIED or np.ptp(pair[:, 0]) < ROUNDED:
                    continue
                if np.allclose(pair[:, 0], pair[:, 1], rtol=1e-9, atol=1e-9):
                    line = f"{'xyz'[one]} and {'xyz'[other]} of its {what} are equal in every sample under load"
                    yield Contradiction(on.source, on.plate.name, line, "is a column copied, or named twice?")


def clipped(trial: TrialInputs) -> Iterator[Contradiction]:
    """The largest force of a step against those beside it."""
    for step in steps(trial):
        most = float(step.normal.max())
        share = float(np.mean(step.normal == most))
        if share > CLIPPED and len(step.time) * CLIPPED >= 2.0:
            what = f"its force is {most:.0f} N, the largest, in {share:.0%} of a step's samples"
            yield Contradiction(step.on.source, step.on.plate.name, what, "is that the end of its range?")


def on_its_surface(trial: TrialInputs) -> Iterator[Contradiction]:
    """The centre of pressure against the plate's corners."""
    for on in trial.plates:
        beyond = on.plate.outside()
        if EDGE < beyond <= SAID:
            what = f"under load its centre of pressure lies {beyond:.2g} plate's lengths outside of it (median)"
            remedy = (
                "are its corners, its origin and the unit of its moments right, and does one foot alone stand on it?"
            )
            yield Contradiction(on.source, on.plate.name, what, remedy)


def _velocity(seen: MarkerTrajectories) -> Float[np.ndarray, " 3"] | None:
    """Mean velocity of the pelvis, else of all markers [m/s]; None for less than 0.3 s.

    Of a foot alone it is that of its fastest frame, in which it swings.
    """
    body = middle(seen, ("asis", "psis", "sacrum"))
    if all(landmark(name)[0] in FOOT for name in seen.names) and len(seen) > 1:
        rate = np.gradient(seen.positions.mean(axis=1), seen.time, axis=0)
        size = np.nan_to_num(np.linalg.norm(rate, axis=1))
        return np.asarray(rate[int(np.argmax(size))])
    body = np.nanmean(seen.positions, axis=1) if body is None else body
    there = np.flatnonzero(np.isfinite(body).all(axis=1))
    if len(there) < 2 or seen.time[there[-1]] - seen.time[there[0]] < 0.3:
        return None
    return np.asarray((body[there[-1]] - body[there[0]]) / (seen.time[there[-1]] - seen.time[there[0]]))


def velocity_of_floor(seen: MarkerTrajectories, step: Step) -> Float[np.ndarray, " 3"]:
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
    for step in steps(trial):
        if body is not None and trial.markers is not None:
            velocity = body - velocity_of_floor(trial.markers, step)
        elif trial.walk is not None:
            velocity = trial.walk
        else:
            return
        velocity = velocity - (velocity @ trial.up) * trial.up
        if np.linalg.norm(velocity) < SPEED:
            continue
        forwards = velocity / np.linalg.norm(velocity)
        across = np.cross(trial.up, forwards)
        half, weight = len(step.time) // 2, float(step.normal.mean())
        along, beside = step.force @ forwards / weight, step.force @ across / weight
        first, second = along[:half].mean(), along[half:].mean()
        way = step.centre[step.heavy] @ forwards
        if np.isfinite(way).any() and float(np.ptp(way[np.isfinite(way)])) < TRAVEL:
            what = f"its centre of pressure stays within {1e3 * TRAVEL:.0f} mm along the walk during a step"
            yield Contradiction(step.on.source, step.on.plate.name, what, "is a column of it missing, or constant?")
        if first > IMPULSE and second < -IMPULSE:
            what = f"it pushes along the walk before it brakes, {first:.1%} and {second:.1%} of the load"
            remedy = "is the sign of the force along the walk turned, or an axis of plates or markers?"
            yield Contradiction(step.on.source, step.on.plate.name, what, remedy)
        sideways, fore = (float(np.abs(np.diff(_halves(each)))[0]) for each in (beside, along))
        if sideways > 2.0 * IMPULSE and fore < 0.5 * sideways:
            what = "it brakes and propels across the walk, not along it"
            remedy = "are plates and markers in the same axes?"
            yield Contradiction(step.on.source, step.on.plate.name, what, remedy)
        elif fore < LITTLE:
            what = f"it brakes and propels the walk by {0.5 * fore:.2%} of the load"
            remedy = "does the plate measure along the floor, and in the unit of its other columns?"
            yield Contradiction(step.on.source, step.on.plate.name, what, remedy)


def _halves(values: Float[np.ndarray, " t"]) -> Float[np.ndarray, " 2"]:
    half = len(values) // 2
    return np.array([values[:half].mean(), values[half:].mean()])


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


PLATE_CHECKS = (
    Check(
        "mass",
        "mean vertical force of each step with the weight of the mass",
        f"{MEAN[0]:g} to {MEAN[1]:g} times the weight, for steps of {STANCE:g} to {STILL:g} s; walking people: 0.76 to "
        "0.86 (half of the weight over 0.58 to 0.66 of the cycle; Perry, Gait Analysis, 1992); all plates together, "
        f"where they carry all the time, within {WHOLE:.0%}",
        mass,
    ),
    Check(
        "standing weight",
        "force of all plates, while the person stands on them, with the weight of the mass",
        f"{WEIGHT:.0%} of the weight, mean of {STANDING:g} s; rising at 1 m/s² is as much; refused from "
        f"{OTHER_WEIGHT:.0%} on",
        standing_weight,
    ),
    Check(
        "copied component",
        "components of the force, and of the centre of pressure, of one plate with each other",
        f"equal in every sample under load, {COPIED} different values at least",
        copied_components,
    ),
    Check(
        "end of range",
        "largest force of a step with those beside it",
        f"one value in {CLIPPED:.0%} of the step",
        clipped,
    ),
    Check(
        "force on the foot",
        "sign of the force under load with the way out of the floor",
        f"refused; with a mass from {WORN:.0%} of the weight on, as a device that is worn may press down",
        reaction,
    ),
    Check(
        "size of shear",
        "force along the floor and free moment with the force out of the floor",
        f"{SHEAR:g}, and {TWIST:g} m; walking people: 0.1, and 0.02 m",
        sizes,
    ),
    Check(
        "braking",
        "force along the walk in both halves of a step, with the way that markers go, or the hip over the foot",
        f"{IMPULSE:.0%} of the load, {LITTLE:.0%} from one half to the other, of somebody faster than {SPEED:g} m/s; "
        f"a load that moves by {1e3 * TRAVEL:g} mm",
        braking,
    ),
    Check(
        "on the plate",
        "centre of pressure with the plate's corners, where the file has them",
        f"{EDGE:.0%} of its length beyond its edge, in the median under load; {SAID:.0%} is said, and 100% refused, "
        "where the file is read",
        on_its_surface,
    ),
    Check(
        "one plate for each foot",
        "forces of the two plates with each other",
        "equal in every sample",
        one_foot_each,
    ),
)
"""Checks that need plates, and of the markers no more than where the body goes."""
