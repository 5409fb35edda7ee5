"""Both legs in motion: forces of a motion make it again, momentum is what the forces leave, a walk is a walk."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

from geocontact.below_knee_prosthesis.both_sides.amputee import Amputee
from geocontact.below_knee_prosthesis.both_sides.amputee_tree import amputee_tree
from geocontact.below_knee_prosthesis.both_sides.walk import (
    GivenWalk,
    WholeMotion,
    accelerations_by_angles,
    coordinate_names,
    driven_stepper,
    driving_forces,
    equations_of_both,
    moving_tree,
    passive,
    walk_by_angles,
    walk_by_forces,
)
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_foot
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY
from geocontact.data.wrench import Wrench
from geocontact.dynamics.inverse_dynamics import forces_along
from geocontact.dynamics.recorded_inputs import recorded_inputs
from geocontact.dynamics.tree import tree_of
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.opensim.osim_writer import write_osim
from meshes.amputee import true_amputee
from meshes.amputee_walk import amputee_walk
from meshes.gait_persons import PARTICIPANTS

WEIGHT = 77.3 * GRAVITY


@pytest.fixture(scope="module")
def truth() -> Amputee:
    return true_amputee(PARTICIPANTS[0], vsf_foot(), fulcrum_of("medium", "pinned"))


@pytest.fixture(scope="module")
def given(truth: Amputee) -> GivenWalk:
    return amputee_walk(truth, 0.72)[0]


@pytest.mark.parametrize("spheres", [False, True])
def test_accelerations_of_the_forces_that_some_accelerations_need(truth: Amputee, spheres: bool) -> None:
    """With both feet on the ground; along socket and keel, which nothing drives, the equations' own are put in."""
    names = coordinate_names(truth)
    driven = [name for name in names if name not in passive(names)]
    equations = equations_of_both(truth, driven=driven, intact_on_spheres=spheres)
    forward = equations.accelerations()
    rng = np.random.default_rng(2)
    q, u = 0.05 * rng.standard_normal((2, len(names)))
    q[names.index("pelvis_ty")] = 0.99
    ground = rng.normal(0.0, 100.0, 6)
    push = rng.normal(0.0, 30.0, len(driven))
    a = np.array(forward(q, u, [], np.concatenate([ground, push]), [])).ravel()
    rows = [np.repeat(each[None], 2, axis=0) for each in (q, u)]
    still = WholeMotion(np.arange(2.0), names, rows[0], rows[1], np.zeros((2, 6)), np.zeros((2, 6)), 0)
    given = np.repeat(ground[None], 2, axis=0)
    found = driving_forces(truth, still, np.repeat(a[None], 2, axis=0), given, intact_on_spheres=spheres)[0]
    wanted = np.zeros(len(names))
    wanted[[names.index(name) for name in driven]] = push
    np.testing.assert_allclose(found, wanted, atol=1e-6)


def test_the_intact_foot_rolls_on_the_floor(truth: Amputee, given: GivenWalk) -> None:
    """Where it carries load some point of its sole is on the floor, within what the angles' filter moves it."""
    leg, model = truth.intact, moving_tree(truth)
    pose = model.poses(given.values)["calcn_l"]
    ends = [np.array([leg.heel[0] + 0.01, -leg.sole, 0.0]), np.array([leg.toe_joint[0], -leg.sole, 0.0])]
    lowest = np.min([pose.apply(end)[:, 1] for end in ends], axis=0)
    loaded = given.ground[:, 1] > 0.05 * WEIGHT
    assert np.abs(lowest[loaded]).max() < 0.012
    assert lowest.min() > -0.012
    knee = np.degrees(given.values[:, given.names.index("knee_flexion_l")])
    assert 50.0 < knee.max() < 75.0


@pytest.fixture(scope="module")
def landing(truth: Amputee, given: GivenWalk) -> WholeMotion:
    """Single support by angles, half a millisecond apart."""
    return walk_by_angles(truth, given, np.arange(0.14, 0.24, 5e-4), tolerance=1e-6, machine_code=False)


@pytest.mark.slow
def test_momentum_is_what_the_forces_leave(truth: Amputee, given: GivenWalk, landing: WholeMotion) -> None:
    model = moving_tree(truth)
    centre = model.mass_centre(landing.q)
    speed = np.gradient(centre, landing.time, axis=0, edge_order=2)
    push = recorded_inputs(given.time, given.ground).at(landing.time)[:, :3]
    acting = landing.force + push - np.array([0.0, WEIGHT, 0.0])
    ground = recorded_inputs(given.time, given.ground).at(landing.time)
    forces = driving_forces(truth, landing, accelerations_by_angles(truth, given, landing), ground)
    acting[:, 2] += forces[:, landing.names.index("pelvis_tz")]  # a residual: where the pelvis is sideways is given
    gained = model.mass * (speed - speed[0])
    made = cumulative_trapezoid(acting, landing.time, axis=0, initial=0.0)
    assert landing.force[:, 1].max() > 0.5 * WEIGHT
    np.testing.assert_allclose(gained[5:-5], made[5:-5], atol=0.5)  # of some tens of N s


@pytest.mark.slow
def test_the_written_file_tells_the_same_torques(
    truth: Amputee, given: GivenWalk, landing: WholeMotion, tmp_path: Path
) -> None:
    """By `forces_along`, as the command id does: the file, coordinates over time and the ground's load on each foot.

    Only above the socket and on the intact side: on the keel's segments the load is one wrench there.
    """
    write_osim(tmp_path / "amputee.osim", amputee_tree(truth))
    tree = tree_of(read_multibody(tmp_path / "amputee.osim"))
    values = np.zeros((len(landing.time), len(tree.names)))
    values[:, [tree.names.index(name) for name in landing.names]] = landing.q
    ground = recorded_inputs(given.time, given.ground).at(landing.time)
    inner = slice(20, -20)
    loads = {
        body: Wrench(load[inner, :3], load[inner, 3:], np.zeros((len(load[inner]), 3)), "ground")
        for body, load in (("calcn_r", landing.own), ("calcn_l", ground))
    }
    found = forces_along(tree, landing.time, values, landing.time[inner], loads)
    wanted = driving_forces(truth, landing, accelerations_by_angles(truth, given, landing), ground)[inner]
    told = [name for name in landing.names if name not in passive(landing.names)]
    ours = wanted[:, [landing.names.index(name) for name in told]]
    theirs = found[:, [tree.names.index(name) for name in told]]
    assert np.abs(ours).max() > 50.0
    np.testing.assert_allclose(theirs, ours, atol=0.5)  # N m and N: rates of the file's coordinates are a spline's


@pytest.mark.slow
def test_its_own_torques_make_the_motion_again(truth: Amputee, given: GivenWalk, landing: WholeMotion) -> None:
    """Short form of `benchmarks/prosthesis/both_sides.py`: errors there grow by 15/s in single support."""
    ground = recorded_inputs(given.time, given.ground).at(landing.time)
    forces = driving_forces(truth, landing, accelerations_by_angles(truth, given, landing), ground)
    undriven = [landing.names.index(name) for name in (*passive(landing.names), "pelvis_tx", "pelvis_ty")]
    assert np.abs(forces[:, undriven]).max() < 1e-6
    start = int(np.searchsorted(landing.time, 0.17))
    part = landing.part(float(landing.time[start]), 1.0)
    stepper = driven_stepper(truth, machine_code=False)
    again = walk_by_forces(truth, stepper, part, part.time, ground[start:], forces[start:], tolerance=1e-5)
    turns = [k for k, name in enumerate(part.names) if not name.startswith(("pelvis_t", "socket_t"))]
    assert np.degrees(np.abs(again.q - part.q)[:, turns].max()) < 0.02
    assert np.linalg.norm(again.force - part.force, axis=1).max() < 1e-3 * WEIGHT
