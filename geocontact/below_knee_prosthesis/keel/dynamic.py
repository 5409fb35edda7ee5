"""The keel with inertia: a tree on a foot whose motion is prescribed; stiffness and damping are parameters.

So one set of equations serves every fulcrum. The same spheres and law as in `quasi_static`, with both coefficients of
friction, on the equations and steps of `dynamics`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.keel.on_tree import (
    along_keel,
    coordinates,
    joint_numbers,
    keel_bodies,
    keel_friction,
    rubbing_numbers,
    sole_wrenches,
)
from geocontact.below_knee_prosthesis.keel.quasi_static import DOWNWARDS
from geocontact.below_knee_prosthesis.keel.sole import KeelSole
from geocontact.data.multibody.joint import free
from geocontact.data.multibody.model import GROUND, Body, Multibody
from geocontact.dynamics.equations import Equations, equations_of_motion
from geocontact.dynamics.recorded_inputs import recorded_inputs
from geocontact.dynamics.simulate import SimulatedMotion, Stepper
from geocontact.dynamics.tree import tree_of
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.sphere_set import SoleLaw

FOOT = "foot"


@dataclass(frozen=True, eq=False)
class DynamicKeel:
    """Equations of a keel on a foot, and their steps.

    Parameters
    ----------
    equations
        Coordinates of the keel; inputs are the foot's six with their derivatives; parameters stiffness, damping, and
        with friction those of `rubbing_numbers`.
    stepper
        For motion.
    """

    keel: Keel
    equations: Equations
    stepper: Stepper

    def simulate(
        self,
        fulcrum: float,
        time: Float[np.ndarray, " t"],
        poses: RigidTransform,
        start: Float[np.ndarray, " m"],
        *,
        tolerance: float = 1e-6,
    ) -> SimulatedMotion:
        """Along poses `X_GK` at some times [s], by splines of degree 5, from angles at rest."""
        turns = np.unwrap(poses.rotation.as_euler("XYZ"), axis=0)
        inputs = recorded_inputs(time, np.hstack([turns, poses.translation]), derivatives=2)
        numbers = [*joint_numbers(self.keel, fulcrum)]
        if self.keel.rubs:
            numbers += rubbing_numbers(self.keel, fulcrum)
        memory = np.zeros(self.equations.z.shape[0])
        at_rest = (np.asarray(start, float), np.zeros(len(start)), memory)
        return self.stepper.simulate(
            at_rest, time, inputs=inputs, parameters=np.concatenate(numbers), tolerance=tolerance
        )


def dynamic_keel(
    keel: Keel,
    sole: KeelSole,
    law: SoleLaw,
    ground: HalfSpace,
    *,
    gravity: tuple[float, float, float] = DOWNWARDS,
    machine_code: bool = True,
) -> DynamicKeel:
    """A keel on its sole above a plane; `gravity` in the ground's frame [m/s²]."""
    from casadi import SX

    still = RigidTransform.identity()
    bodies, joints = keel_bodies(keel, FOOT, still)
    foot = Body(FOOT, 1.0, np.zeros(3), np.eye(3))  # its motion is given, so its mass does not matter
    model = Multibody("keel", (foot, *bodies), (free("root", GROUND, FOOT), *joints), (), np.asarray(gravity, float))
    tree = tree_of(model)
    names = coordinates(keel)
    stiffness, damping = SX.sym("stiffness", len(names)), SX.sym("damping", len(names))
    more = SX.sym("rubbing", 3 * len(names) if keel.rubs else 0)
    rubbing, memory = keel_friction(tree, names, more) if keel.rubs else ([], [])
    equations = equations_of_motion(
        tree,
        loads=sole_wrenches(tree, FOOT, still, keel, sole, law, ground),
        along=along_keel(tree, names, stiffness, damping, rubbing),
        memory=memory,
        prescribed=[name for name in tree.names if name not in names],
        parameters=[stiffness, damping, more],
    )
    return DynamicKeel(keel, equations, Stepper(equations, machine_code=machine_code))
