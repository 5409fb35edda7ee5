"""One simulated stance beside its plate: force by component, impulse, centre of pressure, and ankle moment."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.model.leg_motion import LegMotion
from geocontact.below_knee_prosthesis.model.leg_tree import recorded_tree
from geocontact.below_knee_prosthesis.simulate import Stance
from geocontact.below_knee_prosthesis.stance_errors import (
    PlateStance,
    StanceErrors,
    at_times,
    simulated_at,
    stance_errors,
)
from geocontact.identify.signals.agreement import agreement

ANKLE = "ankle_moment"
QUANTITIES = (
    "resultant",
    "vertical",
    "fore_aft",
    "medio_lateral",
    "impulse",
    "cop_ground",
    "cop_sphere",
    ANKLE,
)
"""In the order of the tables."""


@dataclass(frozen=True, eq=False)
class JudgedStance:
    """What is known of one stance of a study.

    Parameters
    ----------
    name, person, setting
        Whose it is, and on which foot: low, medium, high or a fulcrum in words.
    calibrated
        Whether the sole was fitted to it: then it is no prediction.
    errors
        Beside the plate, with the ankle's moment over body mass [N m/kg].
    """

    name: str
    person: str
    setting: str
    calibrated: bool
    stance: Stance
    plate: PlateStance
    errors: StanceErrors

    def measured(self, quantity: str) -> Float[np.ndarray, " s"]:
        """By the plate, over its stance."""
        return self.errors.curves[quantity][1]

    def simulated(self, quantity: str) -> Float[np.ndarray, " s"]:
        """By the model, over the plate's stance."""
        return self.errors.curves[quantity][0]


def judged(
    name: str, person: str, setting: str, stance: Stance, plate: PlateStance, *, calibrated: bool = False
) -> JudgedStance:
    """A stance with its errors; ValueError where the plate has none."""
    errors = stance_errors(stance, plate)
    moments = _ankle_moments(stance, plate, errors)
    step = errors.stance[1] / (len(errors.share) - 1)
    told = agreement(*moments, step)
    more = replace(
        errors,
        curves={**errors.curves, ANKLE: moments},
        table={**errors.table, ANKLE: (told.r2, told.rmsd)},
    )
    return JudgedStance(name, person, setting, calibrated, stance, plate, more)


def plate_ankle_moment(plate: PlateStance, motion: LegMotion) -> Float[np.ndarray, " t"]:
    """Moment of the plate's force about the recorded ankle in the foot's sagittal plane [N m], at the plate's times.

    Positive where it bends the toes up, as `Stance.ankle_moment`. Zero where the foot is not loaded; the plate's couple
    about its own surface is in the centre of pressure, that about the vertical is left out.
    """
    leg = motion.leg
    shank = recorded_tree(leg).poses(motion.values)["shank"]
    keel = shank * RigidTransform.from_components(leg.keel, leg.turn)
    ankle = at_times(plate.time, motion.time, shank.apply(leg.ankle))
    across = at_times(plate.time, motion.time, keel.rotation.apply([0.0, 0.0, 1.0]))
    arm = np.where(np.isfinite(plate.centre), plate.centre - ankle, 0.0)
    return np.asarray(np.einsum("ti,ti->t", np.cross(arm, plate.force), across))


def _ankle_moments(
    stance: Stance, plate: PlateStance, errors: StanceErrors
) -> tuple[Float[np.ndarray, " s"], Float[np.ndarray, " s"]]:
    """Simulated, as far as it was, and measured over the plate's stance, over body mass [N m/kg]."""
    mass, start = stance.motion.leg.person.mass, errors.start
    time = start + errors.share * errors.stance[1]
    seen = plate_ankle_moment(plate, stance.motion)
    return (
        simulated_at(time, stance.time, stance.ankle_moment[:, None])[:, 0] / mass,
        np.interp(time, plate.time, seen) / mass,
    )
