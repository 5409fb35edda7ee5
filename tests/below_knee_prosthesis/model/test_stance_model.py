"""The small tree of a stance against the whole one, whose pelvis, hip and knee are prescribed."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.keel.on_tree import along_keel, coordinates, joint_numbers, sole_wrenches
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from geocontact.below_knee_prosthesis.leg_tree import RECORDED, SOCKET, driving_inputs, whole_tree
from geocontact.below_knee_prosthesis.stance_model import stance_model, stance_numbers
from geocontact.contact.bushing import SOCKET as BUSHING
from geocontact.dynamics.equations import equations_of_motion
from geocontact.dynamics.recorded_inputs import recorded_inputs
from geocontact.dynamics.tree import tree_of
from geocontact.geometry.shapes import HalfSpace
from tests.below_knee_prosthesis.model.legs import a_leg, a_motion

FULCRUM = 0.11


def test_accelerations_are_those_of_the_whole_tree() -> None:
    from casadi import SX

    foot, leg = vsf_foot(), a_leg()
    motion = a_motion(leg)
    push = np.column_stack([np.sin(9.0 * motion.time), 5.0 * motion.time, 0.0 * motion.time]) * 100.0
    tree = tree_of(whole_tree(leg, foot.keel))
    names, pushing = coordinates(foot.keel), SX.sym("pushing", 2)
    stiffness, damping = joint_numbers(foot.keel, FULCRUM)
    along = along_keel(tree, names, SX(stiffness), SX(damping))
    at = [tree.names.index(name) for name in SOCKET]
    along |= dict(zip(SOCKET, BUSHING.load([tree.q[i] for i in at], [tree.u[i] for i in at]), strict=True))
    along |= {"pelvis_tx": pushing[0], "pelvis_ty": pushing[1]}
    held = [name for name in RECORDED if name not in ("pelvis_tx", "pelvis_ty")]
    ground = HalfSpace()
    loads = sole_wrenches(tree, "foot", RigidTransform.identity(), foot.keel, foot.sole, foot.law, ground)
    whole = equations_of_motion(tree, loads=loads, along=along, prescribed=held, inputs=[pushing])
    small = stance_model(foot, machine_code=False).equations
    p = stance_numbers(leg, foot, FULCRUM, BUSHING)
    columns = [RECORDED.index(name) for name in tree.names if name in held]
    given = recorded_inputs(motion.time, motion.values[:, columns], derivatives=2).beside(
        recorded_inputs(motion.time, push[:, :2])
    )
    driven = driving_inputs(motion, push)
    rng = np.random.default_rng(1)
    for when in motion.time[[10, 20, 28]]:
        place = [motion.place(axis, when) for axis in "xy"]
        q = np.concatenate([[place[0][0], 0.1], rng.normal(0.0, 0.02, 14)])
        height = rng.uniform(0.85, 0.95)
        q[1] = height
        u = rng.normal(0.0, 0.3, 16)
        found = small.accelerations()(q, u, [], driven.at(np.array([when]))[0], p)
        wanted = whole.accelerations()(q, u, [], given.at(np.array([when]))[0], [])
        pair = found.full().ravel(), wanted.full().ravel()
        np.testing.assert_allclose(*pair, rtol=1e-6)
