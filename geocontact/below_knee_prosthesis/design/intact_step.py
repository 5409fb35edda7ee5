"""A step of the intact foot, from markers and a plate alone: what a prosthetic foot may be meant to be near to.

In the upright plane of the foot's long axis, as a stance is taken for a prosthetic foot (`foot_task`). The ankle lies
fixed in the shank, as it was found while standing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.both_sides.intact_leg import IntactLeg
from geocontact.below_knee_prosthesis.both_sides.joint_work import joint_moments
from geocontact.below_knee_prosthesis.calibration.recorded_stance import RATE, body_poses
from geocontact.below_knee_prosthesis.design.aims import Aim
from geocontact.below_knee_prosthesis.design.foot_task import EVERY, LOADED
from geocontact.below_knee_prosthesis.design.outcomes import LANDING, MEASURES, radius_of_path
from geocontact.below_knee_prosthesis.evaluation import PlateStance, at_times, longest_stance
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY
from geocontact.below_knee_prosthesis.plate_checks import lowest_sphere, require_one_clock
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories

OF_INTACT: tuple[Aim, ...] = ("ankle_moment", "radius", "loading_rate", "ankle_mean")
NOT_INTACT: tuple[Aim, ...] = ("socket_moment", "energy", "socket_mean")
"""What a step of an intact foot has of a prosthetic one, and what it has none of: neither socket nor keel."""
BESIDE = 0.75
"""Lengths of the foot from its middle beyond which the centre of pressure of a step is not its in the median."""


@dataclass(frozen=True, eq=False)
class IntactStep:
    """Loaded frames of a step of the intact foot.

    Parameters
    ----------
    time
        [s].
    centre
        Of pressure, forward and up from the ankle [m].
    shank
        From the ankle to the knee, forward and up [m].
    force
        Of the ground, forward and up [N].
    weight
        Of the body [N].
    rise
        How fast the load rises as the foot lands [N/s].
    beside
        Median distance of the centre of pressure from the middle of the foot, seen from above, over the foot's length.
    """

    time: Float[np.ndarray, " t"]
    centre: Float[np.ndarray, "t 2"]
    shank: Float[np.ndarray, "t 2"]
    force: Float[np.ndarray, "t 2"]
    weight: float
    rise: float
    beside: float

    @property
    def ankle_moment(self) -> Float[np.ndarray, " t"]:
        """Moment of the ground's force about the ankle [N m]; positive: toes up."""
        return np.asarray(self.centre[:, 0] * self.force[:, 1] - self.centre[:, 1] * self.force[:, 0])

    @property
    def path(self) -> Float[np.ndarray, "t 2"]:
        """Centre of pressure in the shank's frame, forward and up from the ankle [m]: the roll-over shape."""
        up = self.shank / np.linalg.norm(self.shank, axis=1, keepdims=True)
        forward = np.column_stack([up[:, 1], -up[:, 0]])
        return np.column_stack([np.einsum("ti,ti->t", self.centre, axis) for axis in (forward, up)])

    def outcomes(self) -> dict[Aim, float]:
        """Those of `OF_INTACT`, in SI.

        The rate of loading is that of the plate between half of the load at which the stiffness of a prosthetic foot is
        taken and that load: of a foot that comes down evenly, its stiffness times its speed as well.
        """
        radius = radius_of_path(self.time, self.force[:, 1] / self.weight, self.path)
        moment = self.ankle_moment
        (size,) = joint_moments(self.time, ("ankle",), moment[:, None]).values()
        peak = float(moment.max())
        return {"ankle_moment": peak, "radius": radius, "loading_rate": self.rise, "ankle_mean": size.mean}


def intact_step(
    seen: MarkerTrajectories, leg: IntactLeg, plate: PlateStance, *, cutoff: float | None, gap_limit: float
) -> IntactStep:
    """Step of the longest stance on a plate; InputError where markers or plate do not tell it.

    Parameters
    ----------
    cutoff
        Of a zero-lag low-pass of the markers [Hz]; None for none.
    gap_limit
        Longest gap that is bridged [s].
    """
    span, weight = longest_stance(plate.time, plate.force[:, 1]), leg.person.mass * GRAVITY
    if span is None:
        raise InputError("", "`intact_plate`", "it carries no whole stance", "give another plate")
    if span[0] < seen.time[0] or span[1] > seen.time[-1]:
        what = f"markers are from {seen.time[0]:.2f} to {seen.time[-1]:.2f} s, the step from {span[0]:.2f} to"
        raise InputError(seen.source, "", f"{what} {span[1]:.2f} s", "markers must cover the step; one clock for both")
    time = np.arange(span[0], span[1], EVERY / RATE)
    force = at_times(time, plate.time, plate.force)
    on = force[:, 1] > LOADED * weight
    time, force = time[on], force[on]
    shank, foot = (
        body_poses(seen, leg.markers, f"intact_{name}", time, cutoff, gap_limit) for name in ("shank", "foot")
    )
    level = foot.rotation.apply([1.0, 0.0, 0.0]) * np.array([1.0, 0.0, 1.0])
    level /= np.linalg.norm(level, axis=1, keepdims=True)
    ankle, centre = shank.apply(leg.ankle), at_times(time, plate.time, plate.centre)

    def flat(vectors: Float[np.ndarray, "t 3"]) -> Float[np.ndarray, "t 2"]:
        return np.column_stack([np.einsum("ti,ti->t", level, vectors), vectors[:, 1]])

    return IntactStep(
        time,
        flat(centre - ankle),
        flat(shank.translation - ankle),
        flat(force),
        weight,
        _rise(plate, span, weight),
        _beside(foot, leg, centre),
    )


def _rise(plate: PlateStance, span: tuple[float, float], weight: float) -> float:
    on = (plate.time >= span[0] - 1e-9) & (plate.time <= span[1] + 1e-9)
    time, load = plate.time[on], plate.force[on, 1]
    reached = []
    for share in (0.5, 1.0):
        at = int(np.argmax(load >= share * LANDING * weight))
        before = slice(max(at - 1, 0), at + 1)
        reached.append(float(np.interp(share * LANDING * weight, load[before], time[before])))
    return 0.5 * LANDING * weight / max(reached[1] - reached[0], 1e-6)


def _beside(foot: RigidTransform, leg: IntactLeg, centre: Float[np.ndarray, "t 3"]) -> float:
    middle = foot.apply(0.5 * (leg.heel + leg.hallux))
    return float(np.median(np.linalg.norm((centre - middle)[:, ::2], axis=1))) / leg.length


def require_intact(
    step: IntactStep,
    seen: MarkerTrajectories,
    leg: IntactLeg,
    plate: PlateStance,
    own: PlateStance,
    *,
    cutoff: float | None,
    gap_limit: float,
) -> None:
    """InputError where a step is not that of the intact foot on its plate, or has outcomes that no step has.

    Parameters
    ----------
    seen, leg, plate, cutoff, gap_limit
        That the step was found with, as those of `intact_step`.
    own
        Plate under the prosthetic foot, which may have been named by mistake.
    """
    foot = body_poses(seen, leg.markers, "intact_foot", seen.time, cutoff, gap_limit)
    same = np.array_equal(plate.force, own.force)
    if same or not step.beside < BESIDE:
        where = f"is {step.beside:.1f} lengths of it from its middle in the median"
        whose = f"{plate.name} is under the prosthetic foot" if same else "no plate under the intact foot"
        what = f"{whose}: the centre of pressure of {plate.name} {where}"
        raise InputError(plate.source, "`intact_plate`", what, "name the plate of the intact foot's step")
    require_one_clock(plate, seen.time, lowest_sphere(foot, leg.spheres()[0]), "`intact_plate`")
    try:
        values = step.outcomes()
    except ValueError as error:
        what = f"the step of the intact foot is too short: {error}"
        raise InputError(seen.source, "", what, "give another") from error
    for aim, value in values.items():
        if not 0.0 < value < np.inf:
            what = f"the intact foot would have a {MEASURES[aim].words} of {value:.3g} {MEASURES[aim].unit}"
            remedy = "are markers and plate in the same axes, x forward along the walk?"
            raise InputError(seen.source, "", what, remedy)
