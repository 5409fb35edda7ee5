"""Both legs along a recorded walk: coordinates by its markers, the other foot's plate as its load of the ground."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.both_sides.amputee import Amputee
from geocontact.below_knee_prosthesis.both_sides.amputee_tree import amputee_tree
from geocontact.below_knee_prosthesis.both_sides.standing_model import model_poses
from geocontact.below_knee_prosthesis.both_sides.walk import GivenWalk, WholeMotion, coordinate_names
from geocontact.below_knee_prosthesis.evaluation import CUTOFF as FORCE_CUTOFF
from geocontact.below_knee_prosthesis.evaluation import (
    SAMPLES,
    SLOWEST,
    PlateStance,
    at_times,
    longest_stance,
    simulated_at,
)
from geocontact.below_knee_prosthesis.from_markers import MAP
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY
from geocontact.below_knee_prosthesis.simulate import GATE
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.dynamics.inverse_kinematics import Poses
from geocontact.identify.signals.agreement import Agreement, agreement
from geocontact.identify.signals.filters import filled_and_smoothed, zero_lag


@dataclass(frozen=True, eq=False)
class RecordedSteps:
    """A walk as its markers tell it, as of a right prosthesis.

    Parameters
    ----------
    given
        Coordinates, filtered, and the load on the intact foot.
    poses
        Of the model with socket and keel held, frame by frame as fitted.
    """

    given: GivenWalk
    poses: Poses


def recorded_steps(
    amputee: Amputee, seen: MarkerTrajectories, other: PlateStance, *, cutoff: float | None, gap_limit: float
) -> RecordedSteps:
    """Coordinates of both legs by markers; socket and keel, which these do not tell, are not among what is given.

    Parameters
    ----------
    seen
        Markers of pelvis and both legs while walking, as of a right prosthesis.
    other
        Plate under the intact foot; its force is 0 where it does not reach.
    cutoff
        Zero-lag low-pass of the coordinates [Hz]; None for none.
    gap_limit
        Longest gap that is bridged [s].

    The couple of that plate about the vertical is left out. InputError where markers are missing.
    """
    model = amputee_tree(amputee, held=True)
    missing = [m.name for m in model.markers if m.name not in seen.names]
    if missing:
        raise InputError(seen.source, "", f"no marker {', '.join(missing)}", MAP)
    poses = model_poses(model, seen)
    try:
        time, values = filled_and_smoothed(poses.time, poses.values, cutoff=cutoff, longest_gap=gap_limit)
    except ValueError as error:
        raise InputError(seen.source, "", str(error), "fill the gaps, or give another `gap_limit`") from error
    names = coordinate_names(amputee)
    whole = np.zeros((len(time), len(names)))
    for name, column in zip(poses.names, values.T, strict=True):
        if name in names:
            whole[:, names.index(name)] = column
    force = _covered(time, other, at_times(time, other.time, other.force))
    centre = np.nan_to_num(at_times(time, other.time, np.nan_to_num(other.centre)))
    return RecordedSteps(GivenWalk(time, names, whole, np.hstack([force, np.cross(centre, force)])), poses)


def _covered(
    time: Float[np.ndarray, " t"], plate: PlateStance, values: Float[np.ndarray, "t 3"]
) -> Float[np.ndarray, "t 3"]:
    """Values where the plate was recorded, 0 elsewhere."""
    there = (time >= plate.time[0]) & (time <= plate.time[-1])
    return np.where(there[:, None], values, 0.0)


def centre_on_floor(wrench: Float[np.ndarray, "t 6"]) -> Float[np.ndarray, "t 3"]:
    """Where a load crosses the floor y = 0 [m], by its force and moment about the origin; NaN below `GATE` upwards."""
    force, moment = wrench[:, :3], wrench[:, 3:]
    up = np.where(force[:, 1] >= GATE, force[:, 1], np.nan)
    return np.column_stack([moment[:, 2] / up, 0.0 * up, -moment[:, 0] / up])


def single_support(own: PlateStance, other: PlateStance) -> tuple[float, float] | None:
    """The longest span in which the prosthetic foot alone is loaded [s]; None where there is none."""
    beside = np.interp(own.time, other.time, other.force[:, 1], 0.0, 0.0)
    alone = np.where(beside < GATE, own.force[:, 1], 0.0)
    return longest_stance(own.time, alone)


AXES = {"vertical": 1, "fore_aft": 0, "medio_lateral": 2}
"""Component of a force by name."""


def force_errors(
    time: Float[np.ndarray, " t"], force: Float[np.ndarray, "t 3"], plate: PlateStance, mass: float
) -> dict[str, Agreement]:
    """Force of the ground beside a plate's over its stance, in body weights: resultant and components.

    Both pass one zero-lag low-pass; samples outside of what was simulated do not count. Empty where the plate has no
    stance.
    """
    span = longest_stance(plate.time, plate.force[:, 1])
    if span is None:
        return {}
    steps = [float(np.median(np.diff(each))) for each in (time, plate.time)]
    cutoff = min(FORCE_CUTOFF, *(SLOWEST / step for step in steps))
    at = np.linspace(*span, SAMPLES)
    inside = (at >= time[0]) & (at <= time[-1])
    weight = mass * GRAVITY
    own = at_times(at, time, zero_lag(force, steps[0], cutoff)) / weight
    seen = at_times(at, plate.time, zero_lag(plate.force, steps[1], cutoff)) / weight
    own[~inside] = np.nan
    curves = {"resultant": (np.linalg.norm(own, axis=1), np.linalg.norm(seen, axis=1))}
    curves |= {name: (own[:, axis], seen[:, axis]) for name, axis in AXES.items()}
    return {name: agreement(model, measured, float(at[1] - at[0])) for name, (model, measured) in curves.items()}


def load_errors(
    time: Float[np.ndarray, " t"], wrench: Float[np.ndarray, "t 6"], plate: PlateStance, mass: float
) -> dict[str, Agreement]:
    """`force_errors` of a load, force and moment about the ground's origin [N, N m], and of its centre of pressure
    along the walk and across it [m], where both are known.
    """
    found = force_errors(time, wrench[:, :3], plate, mass)
    span = longest_stance(plate.time, plate.force[:, 1])
    if span is None:
        return found
    at = np.linspace(*span, SAMPLES)
    own, seen = simulated_at(at, time, centre_on_floor(wrench)), at_times(at, plate.time, plate.centre)
    centres = {name: agreement(own[:, k], seen[:, k], float(at[1] - at[0])) for name, k in CENTRES.items()}
    return found | centres


CENTRES = {"cop_x": 0, "cop_z": 2}
"""Component of a centre of pressure by name."""
HELD_TURN, HELD_FORCE = 0.5, 0.02
"""deg, and body weights: within these a walk by forces still is that by angles."""
AFTER, SMALL, FEW = 0.06, 5.0, 5
"""s from which on growth is fitted, deg up to which, and samples that it needs more than."""


@dataclass(frozen=True, eq=False)
class PlayedBack:
    """A walk by forces beside the walk that these forces are of.

    Parameters
    ----------
    since
        Since its start [s].
    turn, shift, force
        Largest difference up to then: of an angle [deg], of a length [mm], of the prosthetic foot's force over body
        weight.
    """

    since: Float[np.ndarray, " t"]
    turn: Float[np.ndarray, " t"]
    shift: Float[np.ndarray, " t"]
    force: Float[np.ndarray, " t"]

    @property
    def held(self) -> float:
        """How long both stay within 0.5 degrees and 2 % of body weight [s]."""
        return float(self.since[(self.turn <= HELD_TURN) & (self.force <= HELD_FORCE)].max(initial=0.0))

    @property
    def growth(self) -> float:
        """Rate at which the turn's difference grows [1/s]; NaN where too few samples tell it."""
        fitted = (self.since > AFTER) & (self.turn < SMALL) & (self.turn > 0.0)
        return float(np.polyfit(self.since[fitted], np.log(self.turn[fitted]), 1)[0]) if fitted.sum() > FEW else np.nan


def played_back(walk: WholeMotion, again: WholeMotion, mass: float) -> PlayedBack:
    """Differences of two motions at the same times of a person of a mass [kg]."""
    lengths = [name.startswith(("pelvis_t", "socket_t")) and not name.startswith("pelvis_tilt") for name in walk.names]
    off, is_length = np.abs(again.q - walk.q), np.array(lengths)
    turn = np.maximum.accumulate(np.degrees(off[:, ~is_length].max(axis=1)))
    shift = np.maximum.accumulate(1e3 * off[:, is_length].max(axis=1))
    force = np.linalg.norm(again.force - walk.force, axis=1) / (mass * GRAVITY)
    return PlayedBack(walk.time - walk.time[0], turn, shift, np.maximum.accumulate(force))
