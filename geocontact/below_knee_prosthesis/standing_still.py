"""A person who stands still on the prosthesis: the load that the model's foot carries in the end.

The study's check of its model (002, sec. 2.5): from rest, ten seconds, and the force of the ground is the body's
weight. Here the other foot carries a stated share of it, nothing turns, and the foot starts flat on the floor without
load.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.leg import Leg
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY, PELVIS, RECORDED, LegMotion, recorded_tree
from geocontact.below_knee_prosthesis.plate_checks import lowest_sphere
from geocontact.below_knee_prosthesis.simulate import Push, Stance, simulate_stance
from geocontact.below_knee_prosthesis.stance_model import FLOOR
from geocontact.contact.bushing import SOCKET, Bushing
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.sphere_set import SphereSet

LASTING, SHARE, TOLERANCE = 10.0, 0.5, 1e-5
"""s, share of the weight on the other foot, and the error that a step may have."""
FRAMES = 41


@dataclass(frozen=True, eq=False)
class StandingStill:
    """Standing on the foot.

    Parameters
    ----------
    stance
        From rest to the end.
    share
        Of the weight that the other foot carries.
    """

    stance: Stance
    share: float

    @property
    def missing(self) -> float:
        """Vertical force at the end less that which the foot should carry, over body weight."""
        return float(self.stance.force[-1, 1] / (self.stance.motion.leg.person.mass * GRAVITY) - (1.0 - self.share))

    @property
    def slid(self) -> float:
        """Way of the foot along the floor [m]."""
        places = self.stance.poses.translation
        return float(np.linalg.norm((places[-1] - places[0])[::2]))


def standing_motion(leg: Leg, spheres: SphereSet, lasting: float = LASTING) -> LegMotion:
    """Joints straight, turned as a whole so that the keel is level, its sole just on the floor."""
    values = np.zeros((1, len(RECORDED)))
    forward = _keel(leg, values).rotation.apply([1.0, 0.0, 0.0])[0]
    values[0, RECORDED.index("pelvis_tilt")] = -np.arctan2(forward[1], forward[0])
    height = float(lowest_sphere(_keel(leg, values), spheres)[0])
    values[0, RECORDED.index(PELVIS[4])] = -height
    time = np.linspace(0.0, lasting, FRAMES)
    return LegMotion(leg, time, np.repeat(values, len(time), axis=0))


def _keel(leg: Leg, values: np.ndarray) -> RigidTransform:
    return recorded_tree(leg).poses(values)["shank"] * RigidTransform.from_components(leg.keel, leg.turn)


def standing_still(
    leg: Leg,
    foot: VariableStiffnessFoot,
    fulcrum: float,
    *,
    lasting: float = LASTING,
    share: float = SHARE,
    bushing: Bushing = SOCKET,
    ground: HalfSpace = FLOOR,
    tolerance: float = TOLERANCE,
    machine_code: bool = True,
) -> StandingStill:
    """Standing for a time [s]; ArithmeticError where the motion cannot go on.

    Parameters
    ----------
    fulcrum
        [m].
    share
        Of the weight that the other foot carries, 0 to 1.
    """
    motion = standing_motion(leg, foot.sole.spheres, lasting)
    weight = leg.person.mass * GRAVITY
    push = Push(motion.time, np.repeat([[0.0, share * weight, 0.0]], len(motion.time), axis=0))
    stance = simulate_stance(
        motion,
        foot,
        fulcrum,
        push,
        (0.0, lasting),
        bushing=bushing,
        ground=ground,
        tolerance=tolerance,
        machine_code=machine_code,
    )
    return StandingStill(stance, share)
