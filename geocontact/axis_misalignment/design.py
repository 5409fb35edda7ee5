"""Largest forces of many people in one exoskeleton, and the offsets and stroke that keep the force on the limb under a
limit.

Everything is asked over a range of angles and answered from the least and the largest deflection in it. The numbers of
a joint are l, z, x, y as in `planar_joint`; none of the answers knows damping, so they are those of slow motion.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int

from geocontact.axis_misalignment.axis_drift import STILL, AxisDrift
from geocontact.axis_misalignment.compensation import Compensation, beyond, needed_ends
from geocontact.axis_misalignment.planar_joint import (
    SOUND,
    STEP,
    PlanarJoint,
    deflections,
    drift_numbers,
    extremes_of,
    grid,
)

QUANTITIES = ("k", "l", "z", "x", "y")
"""Stiffness [N/m], link length, distance of the attachment, offsets [m]: columns of a sample."""


@dataclass(frozen=True, eq=False)
class Exposure:
    """What all of them do: range of angles [rad], stroke ends [m], drift."""

    start: float
    stop: float
    lower: float = 0.0
    upper: float = 0.0
    drift: AxisDrift = STILL


def peak_forces(
    people: Float[np.ndarray, "n 5"], exposure: Exposure, step: float = STEP
) -> tuple[Float[np.ndarray, " n"], Int[np.ndarray, " n"]]:
    """Largest |F| [N] of each person (columns as `QUANTITIES`), and what became of the joint.

    Infinite for a pole, a fold or a joint without an angle: there is no force that would hold it. `step` [rad] is that
    of the grid of angles before each extreme is refined; the error falls with its fourth power.
    """
    value, _, fate = extremes_of(
        grid(exposure.start, exposure.stop, step), np.ascontiguousarray(people[:, 1:]), exposure.drift
    )
    force = people[:, 0] * beyond(value, exposure.lower, exposure.upper)
    return np.where(fate == SOUND, force, np.inf), fate


RAYS = 360
"""Directions in which offsets around a centre are looked at."""

RINGS = 20
"""Distances from the centre at which a disc of offsets is looked at, the rim among them."""

WALK = 200
"""Steps in which a ray is walked until the limit is exceeded."""

HALVINGS = 40
"""Halvings of the last step, until where the limit is exceeded is known."""

FINE = np.radians(0.1)
"""rad; step of the mean square of the force."""

CHANGE = 1e-4
"""Relative change of a number for its slope: of its own size, or of the link's length where the number is near 0."""


NOTHING = 1e-12
"""Share of the link's length: a deflection of less is rounding."""


@dataclass(frozen=True, eq=False)
class DesignTask:
    """An exoskeleton's numbers that are not offsets, the range of angles [rad] and the limit of |F| [N]."""

    length: float
    distance: float
    start: float
    stop: float
    limit: float
    compensation: Compensation
    drift: AxisDrift = STILL

    @property
    def slack(self) -> float:
        """Deflection beyond the stroke at which the limit is reached [m]."""
        return self.limit / self.compensation.stiffness

    def joint(self, x: float, y: float) -> PlanarJoint:
        """The joint with these offsets [m]."""
        return PlanarJoint(self.length, self.distance, x, y, self.drift)

    def extremes(self, offsets: Float[np.ndarray, "n 2"]) -> tuple[Float[np.ndarray, "n 2"], Int[np.ndarray, " n"]]:
        """Least and largest deflection [m] of each pair of offsets, NaN without one, and what became of it."""
        joints = np.empty((len(offsets), 4))
        joints[:, :2] = self.length, self.distance
        joints[:, 2:] = offsets
        value, _, fate = extremes_of(grid(self.start, self.stop), joints, self.drift)
        return value, fate

    def admissible(self, offsets: Float[np.ndarray, "n 2"]) -> np.ndarray:
        """Whether |F| stays at or under the limit; not where there is no deflection."""
        return self.compensation.peak(self.extremes(offsets)[0]) <= self.limit


@dataclass(frozen=True, eq=False)
class OffsetMap:
    """Every pair of offsets [m], x inner, with extremes of the deflection [m] and of |F| [N] and what became of it."""

    offsets: Float[np.ndarray, "n 2"]
    extremes: Float[np.ndarray, "n 2"]
    peak: Float[np.ndarray, " n"]
    fate: Int[np.ndarray, " n"]


def offset_map(task: DesignTask, x: Float[np.ndarray, " a"], y: Float[np.ndarray, " b"]) -> OffsetMap:
    """Extremes over a grid of offsets."""
    offsets = np.array([(u, v) for v in y for u in x])
    found, fate = task.extremes(offsets)
    return OffsetMap(offsets, found, task.compensation.peak(found), fate)


@dataclass(frozen=True, eq=False)
class Boundary:
    """How far offsets may go from a centre [m] in each direction [rad]; `most` where the limit is not exceeded."""

    angles: Float[np.ndarray, " r"]
    distances: Float[np.ndarray, " r"]
    most: float

    @property
    def least(self) -> float:
        """Radius of the largest disc that stays admissible [m]."""
        return float(self.distances.min())


def boundary(task: DesignTask, centre: tuple[float, float], most: float) -> Boundary:
    """Where |F| first exceeds the limit around `centre`, looked for up to `most` [m].

    Every direction is walked outwards until the limit is exceeded for the first time, in steps of `most`/200; distances
    are 0 where the centre itself is beyond it. The directions lie closer around the one that is least.
    """
    angles = 2.0 * np.pi * np.arange(RAYS) / RAYS
    if not task.admissible(np.array([centre]))[0]:
        return Boundary(angles, np.zeros(RAYS), most)
    found = _exceeded(task, centre, angles, most)
    near = angles[int(np.argmin(found))] + (np.arange(RAYS) / RAYS - 0.5) * (4.0 * np.pi / RAYS)
    angles = np.mod(np.concatenate([angles, near]), 2.0 * np.pi)
    order = np.argsort(angles)
    return Boundary(angles[order], np.concatenate([found, _exceeded(task, centre, near, most)])[order], most)


def _exceeded(
    task: DesignTask, centre: tuple[float, float], angles: Float[np.ndarray, " r"], most: float
) -> Float[np.ndarray, " r"]:
    """Distance from the centre at which the limit is first exceeded in each direction."""
    way = np.column_stack([np.cos(angles), np.sin(angles)])
    walked = most * np.arange(1, WALK + 1) / WALK
    offsets = np.array(centre) + walked[:, None, None] * way
    inside = task.admissible(offsets.reshape(-1, 2)).reshape(WALK, -1)
    outer = np.where(inside.all(axis=0), most, walked[np.argmin(inside, axis=0)])
    inner = np.where(inside.all(axis=0), most, outer - most / WALK)
    for _ in range(HALVINGS):
        middle = 0.5 * (inner + outer)
        good = task.admissible(np.array(centre) + middle[:, None] * way)
        inner, outer = np.where(good, middle, inner), np.where(good, outer, middle)
    return inner


def disc(centre: tuple[float, float], radius: float) -> Float[np.ndarray, "n 2"]:
    """Offsets in a disc [m]: its centre, and rings of 360 directions the outermost of which is the rim."""
    angles = 2.0 * np.pi * np.arange(RAYS) / RAYS
    ring = np.column_stack([np.cos(angles), np.sin(angles)])
    rings = [radius * (k + 1) / RINGS * ring for k in range(RINGS if radius > 0.0 else 0)]
    return np.array(centre) + np.vstack([np.zeros((1, 2)), *rings])


def force_band(
    task: DesignTask, centre: tuple[float, float], radius: float, beta: Float[np.ndarray, " m"]
) -> tuple[Float[np.ndarray, " m"], Float[np.ndarray, " m"]]:
    """Least and largest force [N] at each angle [rad] over a disc of offsets that all have a deflection."""
    offsets = disc(centre, radius)
    joints = np.column_stack([np.tile([task.length, task.distance], (len(offsets), 1)), offsets])
    force = task.compensation.force(deflections(beta, joints, *drift_numbers(task.drift))[0])
    return force.min(axis=0), force.max(axis=0)


@dataclass(frozen=True)
class NeededStroke:
    """What a disc of offsets asks of the stroke ends [m].

    least, largest
        Deflection in the disc: with these stroke ends there is no force at all.
    lower, upper
        The lower end must not be above the first, the upper not below the second, for |F| to stay under the limit.
    """

    least: float
    largest: float
    lower: float
    upper: float

    @property
    def length(self) -> float:
        """Least stroke [m]; 0 where a locked joint will do."""
        return max(self.upper - self.lower, 0.0)


def needed_stroke(task: DesignTask, centre: tuple[float, float], radius: float) -> NeededStroke:
    """Stroke that offsets in a disc ask for; ValueError names offsets at which there is no deflection.

    What lies between the offsets of `disc` is missed by less than 1e-4 of the radius where links are several times as
    long as it.
    """
    offsets = disc(centre, radius)
    found, fate = task.extremes(offsets)
    if fate.any():
        x, y = offsets[int(np.argmax(fate > 0))]
        task.joint(float(x), float(y)).extremes(task.start, task.stop)
    least, largest = float(found[:, 0].min()), float(found[:, 1].max())
    ((lower, upper),) = needed_ends(np.array([[least, largest]]), task.slack)
    return NeededStroke(least, largest, float(lower), float(upper))


@dataclass(frozen=True)
class Sensitivity:
    """What one number does to the largest and to the root mean square |F| over the range.

    The slopes are N per SI unit; an elasticity is per cent of force per per cent of the number. All are NaN where there
    is no force: |F| has a kink there, or none of the numbers does anything.
    """

    name: str
    value: float
    peak_slope: float
    rms_slope: float
    peak_elasticity: float
    rms_elasticity: float


def sensitivities(task: DesignTask, x: float, y: float) -> list[Sensitivity]:
    """Slopes and elasticities for k, x, y, l, z and both stroke ends at one pair of offsets, central differences.

    F(k/s, s · lengths) = F: the elasticity to k is 1, and those to all lengths, stroke ends among them, add up to 1
    where the axis stays. The largest |F| is followed at the angle at which it is now (envelope theorem): with a tie the
    slope is that of one of the two.
    """
    c = task.compensation
    values = {"k": c.stiffness, "x": x, "y": y, "l": task.length, "z": task.distance}
    if (c.lower, c.upper) != (0.0, 0.0):
        values |= {"stroke_lower": c.lower, "stroke_upper": c.upper}
    ends, where = task.joint(x, y).extremes(task.start, task.stop)
    forces = np.abs(c.force(ends))
    at, peak = where[int(np.argmax(forces))], float(forces.max())
    fine = grid(task.start, task.stop, FINE)

    def evaluated(changed: dict[str, float]) -> tuple[float, float]:
        return float(np.abs(_force(task, changed, np.array([at])))[0]), _rms(_force(task, changed, fine))

    if peak <= NOTHING * task.length * c.stiffness:
        return [Sensitivity(name, value, np.nan, np.nan, np.nan, np.nan) for name, value in values.items()]
    rms = _rms(_force(task, values, fine))
    found = []
    for name, value in values.items():
        step = CHANGE * (value if name == "k" else max(abs(value), 1e-2 * task.length))
        above, below = (evaluated({**values, name: value + side * step}) for side in (1.0, -1.0))
        slopes = [(one - other) / (2.0 * step) for one, other in zip(above, below, strict=True)]
        share = [slope * value / of for slope, of in zip(slopes, (peak, rms), strict=True)]
        found.append(Sensitivity(name, value, *slopes, *share))
    return found


def _force(task: DesignTask, values: dict[str, float], beta: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
    """Force [N] with these numbers in place of the task's own."""
    joint = PlanarJoint(values["l"], values["z"], values["x"], values["y"], task.drift)
    c = task.compensation
    changed = replace(
        c, stiffness=values["k"], lower=values.get("stroke_lower", c.lower), upper=values.get("stroke_upper", c.upper)
    )
    return changed.force(joint.deflection(beta))


def _rms(force: Float[np.ndarray, " n"]) -> float:
    """Root mean square over an even grid of angles, by the trapezium rule."""
    weight = np.ones(len(force))
    weight[[0, -1]] = 0.5
    return float(np.sqrt(weight @ force**2 / weight.sum()))
