"""Whether a force plate is under a foot, carries a walking person, and runs on the markers' clock.

The clock is checked by when the sole is on the floor beside when the plate is loaded.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.evaluation import PlateStance, at_times, longest_stance
from geocontact.below_knee_prosthesis.simulate import GATE
from geocontact.data.errors import InputError
from geocontact.geometry.shapes import HalfSpace
from geocontact.identify.signals.cycles import loaded_spans
from geocontact.loads.ground import Ground
from geocontact.loads.sphere_set import SphereSet

FLOOR = HalfSpace()
LEAST, MOST = 0.3, 5.0
"""Shares of the body weight between which the largest vertical force of a step lies."""
BESIDE = 1.0
"""Lengths of the foot from its middle beyond which a centre of pressure is not its."""
APART = 0.06
"""s by which clocks may differ: a foot that hovers before it lands, and a plate's threshold, make up to that."""
FARTHEST = 0.4
"""m; of the centre of pressure from the heel, seen from above."""
LATE = 0.02
"""s; by which recordings may be shorter than needed."""


def lowest_sphere(poses: RigidTransform, spheres: SphereSet, ground: Ground = FLOOR) -> Float[np.ndarray, " t"]:
    """Height of the lowest point of a sole that does not bend [m]; negative where markers say that it is pressed.

    `poses` are X_GK of the spheres' frame in the ground's.
    """
    pairs = zip(spheres.centre, spheres.radius, strict=True)
    low = [ground.proximity(poses.apply(centre)).distance - radius for centre, radius in pairs]
    return np.asarray(np.min(low, axis=0))


def clock_offset(
    time: Float[np.ndarray, " t"],
    height: Float[np.ndarray, " t"],
    plate_time: Float[np.ndarray, " p"],
    load: Float[np.ndarray, " p"],
) -> float:
    """By how much the plate is later than the markers [s], at least: the smaller one of touch-down's and toe-off's.

    0 where they differ in sign, as by a height that is off, or where either is not seen. A foot that hovers close to
    the floor before it lands makes one of them uncertain, hardly both in the same sense.

    Parameters
    ----------
    height
        `lowest_sphere` at the markers' times.
    load
        Vertical force on the plate [N].
    """
    seen = longest_stance(plate_time, load)
    down = np.flatnonzero(height < 0.0)
    if seen is None or not len(down):
        return 0.0
    first, last = down[0], down[-1]
    if first == 0 or last == len(time) - 1:
        early = np.nan if first == 0 else seen[0] - time[first]
        late = np.nan if last == len(time) - 1 else seen[1] - time[last]
        return float(np.nan_to_num(early if np.isnan(late) else late))
    early, late = seen[0] - float(time[first]), seen[1] - float(time[last])
    return 0.0 if early * late <= 0.0 else float(np.sign(early) * min(abs(early), abs(late)))


def whole_stances(plate: PlateStance) -> list[tuple[float, float]]:
    """Touch-downs and toe-offs of all whole stances on a plate [s]."""
    return [(float(each.start), float(each.end)) for each in loaded_spans(plate.time, plate.force[:, 1], GATE)]


def covered_stances(plate: PlateStance, start: float, stop: float) -> list[tuple[float, float]]:
    """Those of `whole_stances` that markers between two times [s] see from before touch-down to after toe-off."""
    return [(down, off) for down, off in whole_stances(plate) if down >= start + LATE and off <= stop]


def part_of(plate: PlateStance, first: float, last: float) -> PlateStance:
    """A plate from the whole stance before a touch-down [s] to the one after a toe-off [s]: without either."""
    spans = whole_stances(plate)
    begin = max((off for _, off in spans if off <= first), default=-np.inf)
    end = min((down for down, _ in spans if down >= last), default=np.inf)
    on = (plate.time >= begin) & (plate.time <= end)
    return replace(plate, time=plate.time[on], force=plate.force[on], centre=plate.centre[on])


def require_weight(plate: PlateStance, weight: float, option: str = "`plate`") -> None:
    """InputError for a vertical force that no step of a person of that weight [N] makes.

    `option` is what the plate was named by, for the error.
    """
    most = float(np.max(plate.force[:, 1], initial=0.0)) / weight
    if LEAST <= most <= MOST:
        return
    what = f"the vertical force on {plate.name} is {most:.3g} times body weight at most"
    raise InputError(plate.source, option, what, "is it in N, `mass` in kg, and y up?")


def require_one_clock(
    plate: PlateStance, time: Float[np.ndarray, " t"], height: Float[np.ndarray, " t"], option: str = "`plate`"
) -> None:
    """InputError where plate and markers differ by more than clocks on one time can (`clock_offset`, `APART`).

    Parameters
    ----------
    time, height
        Of the markers [s], and `lowest_sphere` at these [m].
    option
        By which the plate was named.
    """
    offset = clock_offset(time, height, plate.time, plate.force[:, 1])
    if abs(offset) > APART:
        when = "after" if offset > 0.0 else "before"
        what = f"{plate.name} is loaded {abs(offset):.2f} s {when} the markers touch the floor"
        raise InputError(plate.source, option, what, "markers and forces need one clock: shift one of them")


def require_under_foot(plate: PlateStance, centre: Float[np.ndarray, " t"]) -> None:
    """InputError where a centre of pressure is not under the foot.

    `centre` is in lengths of the foot from its heel towards the toes; NaN where there is none.
    """
    known = centre[np.isfinite(centre)]
    if not len(known) or np.median(np.abs(known - 0.5)) > BESIDE:
        what = f"no plate under the foot: the centre of pressure of {plate.name} is not under it"
        raise InputError(plate.source, "`plate`", what, "check frame, side and clock, and that this plate is meant")


def require_near_heel(plate: PlateStance, keel: RigidTransform, time: Float[np.ndarray, " t"]) -> None:
    """InputError where the centre of pressure is further than `FARTHEST` from the heel, in the median.

    `keel` are poses of the keel's frame, with its origin at the heel, at some times [s].
    """
    centre = at_times(time, plate.time, plate.centre)
    away = float(np.nanmedian(np.linalg.norm((centre - keel.translation)[:, ::2], axis=1)))
    if away > FARTHEST:
        where = f"is {away:.2f} m from its heel in the median"
        what = f"no plate under the foot: the centre of pressure of {plate.name} {where}"
        raise InputError(plate.source, "`plate`", what, "name another plate; are plates and markers in the same axes?")


def require_covering(plate: PlateStance, time: Float[np.ndarray, " t"], remedy: str = "both need one clock") -> None:
    """InputError where a plate was not recorded as long as the markers, whose times these are [s], within `LATE`."""
    if plate.time[0] > time[0] + LATE or plate.time[-1] < time[-1] - LATE:
        what = f"plates are from {plate.time[0]:.2f} to {plate.time[-1]:.2f} s, markers from {time[0]:.2f} to"
        raise InputError(plate.source, "", f"{what} {time[-1]:.2f} s", remedy)
