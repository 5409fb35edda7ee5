"""The limb's motion where the markers below the knee are on the socket: found in turns with the simulated socket.

Markers on a socket show the limb and what the socket gives on it. Taken for the limb's they bring the socket's motion
into pelvis, hip and knee, and the bushing of a simulation moves it once more. So fit and simulation take turns: the
displacement that a simulation finds is taken back out of the socket's markers, pelvis, hip and knee are fitted anew,
and the stance is simulated along them, until the ground's force no longer changes. Then limb and simulated socket
together have the socket's markers where they were seen.

A turn leaves of an error what the ground is stiffer than the bushing: little of a shift along the limb, where the
pelvis gives way, and up to some eight tenths of a fast one fore and aft while the foot sticks to the floor.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.from_markers import BODIES, Walked, walked
from geocontact.below_knee_prosthesis.leg import Leg
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY, LegMotion
from geocontact.below_knee_prosthesis.leg_tree import TURNS as CARDAN
from geocontact.below_knee_prosthesis.simulate import Stance
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.dynamics.functional_joint import segment_poses

ENOUGH = 5e-3
"""Change of the force from turn to turn, root mean square over body weight, that is not worth another."""
GROWS = 2.0
"""Times more than the turn before that a change may be."""


@dataclass(frozen=True, eq=False)
class LimbInSocket:
    """A motion of the limb, and the stance along it.

    Parameters
    ----------
    walked
        Of the last fit.
    stance
        Along it.
    turns
        Fits after the first.
    change
        Of the force by the last turn, root mean square over body weight; NaN without turns.
    settled
        Whether that was little enough.
    """

    walked: Walked
    stance: Stance
    turns: int
    change: float
    settled: bool


def limb_in_socket(
    seen: MarkerTrajectories,
    first: Walked,
    simulated: Callable[[LegMotion], Stance],
    *,
    cutoff: float | None,
    gap_limit: float,
    turns: int,
) -> LimbInSocket:
    """Motion of a right limb, from the fit in which the socket does not give.

    Parameters
    ----------
    seen
        Markers of the walk.
    first
        Their fit by `walked`.
    simulated
        A stance along a motion; always of the same times.
    cutoff, gap_limit
        As those of `walked`.
    turns
        Most fits after the first; with 0 the socket's motion is counted twice.

    Where a turn cannot be simulated, or changes the force much more than the one before, the one before is kept.
    ArithmeticError or ValueError of `simulated` along the first motion.
    """
    leg = first.motion.leg
    weight = leg.person.mass * GRAVITY
    fit, stance, change = first, simulated(first.motion), np.nan
    for turn in range(turns):
        try:
            again = walked(without_socket(seen, leg, stance), leg, cutoff=cutoff, gap_limit=gap_limit)
            found = simulated(again.motion)
        except (ArithmeticError, ValueError):
            return LimbInSocket(fit, stance, turn, change, settled=False)
        changed = float(np.sqrt(np.mean(np.sum((found.force - stance.force) ** 2, axis=1)))) / weight
        if changed > GROWS * change:
            return LimbInSocket(fit, stance, turn, change, settled=False)
        fit, stance, change = again, found, changed
        if change < ENOUGH:
            return LimbInSocket(fit, stance, turn + 1, change, settled=True)
    return LimbInSocket(fit, stance, turns, change, settled=False)


def without_socket(seen: MarkerTrajectories, leg: Leg, stance: Stance) -> MarkerTrajectories:
    """Markers of a walk with those on the socket where they were, had it not given on the limb in the stance.

    In frames that show fewer than three of them, they are left out. Before and after the stance the socket stays as at
    its ends.
    """
    names = BODIES["shank"]
    columns = [seen.names.index(name) for name in names]
    at = {marker.name: marker.location for marker in leg.markers}
    cluster, known, _ = segment_poses(seen.of(names), np.array([at[name] for name in names]))
    back = cluster * displaced(leg, stance, seen.time[known]).inv() * cluster.inv()
    places = seen.positions.copy()
    places[:, columns] = np.nan
    for column in columns:
        places[known, column] = back.apply(seen.positions[known, column])
    return MarkerTrajectories(seen.time, places, seen.names, seen.source)


def displaced(leg: Leg, stance: Stance, time: Float[np.ndarray, " t"]) -> RigidTransform:
    """What the socket has moved by at some times [s], in the shank's frame: from where it is at rest to where it is."""
    turns, shifts = stance.found.q[:, 2:5], stance.found.q[:, 5:8]
    at = np.column_stack([np.interp(time, stance.time, column) for column in (*turns.T, *shifts.T)])
    bushing = RigidTransform.from_components(at[:, 3:], Rotation.from_euler(CARDAN, at[:, :3]))
    return leg.X_SB * bushing * leg.X_SB.inv()
