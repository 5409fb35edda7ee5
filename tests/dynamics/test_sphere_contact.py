"""Spheres in symbols: the same loads as in numbers, on level and tilted ground, with laws by zone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from casadi import SX, Function, vertcat
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.multibody.joint_kinds import free
from geocontact.data.multibody.model import GROUND, Body, Multibody
from geocontact.dynamics.sphere_contact import STILL, SphereLaw, laws_by_zone, laws_of, sole_wrench
from geocontact.dynamics.tree import tree_of
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.sphere_loads import SphereLoads, sphere_loads
from geocontact.loads.sphere_set import SoleLaw, SphereSet
from tests.loads.scenes import law, scattered, twist

TILTED = HalfSpace((0.01, -0.002, 0.03), (0.1, 0.98, -0.15))


def on_the_ground(spheres: SphereSet, numbers: SoleLaw, ground: HalfSpace) -> Function:
    """(q, u) of a free body to the force on it and its moment about the origin."""
    body = Body("foot", 1.0, np.zeros(3), np.eye(3))
    tree = tree_of(Multibody("foot", (body,), (free("root", GROUND, "foot"),), (), np.zeros(3)))
    force, moment = sole_wrench(tree.bodies["foot"], spheres, laws_of(numbers), ground)
    place = tree.bodies["foot"]
    pose = [place.rotation, place.place, place.spin, place.speed]
    return Function("wrench", [tree.q, tree.u], [force, moment, *pose])


def both(
    seed: int, ground: HalfSpace, numbers: SoleLaw, spheres: SphereSet
) -> tuple[np.ndarray, np.ndarray, SphereLoads]:
    """Force and moment in symbols at a random state near the ground, and the loads of the spheres in numbers."""
    rng = np.random.default_rng(seed)
    upright, _ = Rotation.align_vectors([ground.normal], [[0.0, 1.0, 0.0]])
    turn = upright * Rotation.from_rotvec(rng.normal(size=3) * 0.02)
    place = np.asarray(ground.point) + rng.normal(size=3) * 1e-3
    q, u = np.concatenate([_angles(turn), place]), rng.normal(size=6) * [1.0, 1.0, 1.0, 0.3, 0.3, 0.3]
    force, moment, rotation, origin, spin, speed = (
        np.array(each) for each in on_the_ground(spheres, numbers, ground)(q, u)
    )
    pose = RigidTransform.from_components(origin.ravel(), Rotation.from_matrix(rotation))
    loads = sphere_loads(spheres, numbers, *twist(pose, speed.ravel(), spin.ravel()), ground)
    return force.ravel(), moment.ravel(), loads


def _angles(turn: Rotation) -> np.ndarray:
    return turn.as_euler("XYZ")


@pytest.mark.parametrize("ground", [HalfSpace(), TILTED], ids=["level", "tilted"])
@pytest.mark.parametrize("seed", range(6))
def test_symbols_give_the_loads_of_numbers(seed: int, ground: HalfSpace) -> None:
    rng = np.random.default_rng(100 + seed)
    spheres = scattered(seed, 24)
    numbers = law(24, k=rng.uniform(2e4, 9e4, 24), b=300.0, mu=0.8, v_th=0.25)
    numbers = replace(numbers, static=rng.uniform(0.5, 1.0, 24), kinetic=rng.uniform(0.2, 0.5, 24))
    force, moment, loads = both(seed, ground, numbers, spheres)
    wanted = loads.force[0].sum(axis=0)
    assert loads.pressing.sum() > 5.0
    arms = np.nan_to_num(loads.point[0])
    np.testing.assert_allclose(force, wanted, atol=1e-6 * np.linalg.norm(wanted))
    np.testing.assert_allclose(
        moment, np.cross(arms, loads.force[0]).sum(axis=0), atol=1e-6 * np.linalg.norm(wanted) * 0.3
    )


def test_slow_sliding_is_smoothed_as_far_as_is_stated() -> None:
    """Where v is 1e-5 m/s friction is v / sqrt(v² + STILL²) of that of the table."""
    ball = SphereSet(np.zeros((1, 3)), np.array([0.02]), ("heel",))
    numbers = law(1, mu=0.8)
    at = on_the_ground(ball, numbers, HalfSpace())
    q = np.array([0.0, 0.0, 0.0, 0.0, 0.019, 0.0])
    for speed in (1e-6, 1e-5, 1e-3):
        force = np.array(at(q, np.array([0.0, 0.0, 0.0, speed, 0.0, 0.0]))[0]).ravel()
        pressing, table = 5e4 * 1e-3**1.5, 0.8 * speed / 0.1
        fast = np.hypot(speed, STILL)
        assert force[0] == pytest.approx(-pressing * table * speed / fast * fast / speed, rel=1e-9)
        assert abs(force[0] + pressing * table) <= 1e-6 * pressing


def test_laws_by_zone_take_symbols_and_any_law() -> None:
    """A linear spring of one zone and the printed law of the other, both stiffnesses symbols."""

    class Spring:
        def __init__(self, k: SX) -> None:
            self.k = k

        def pressing(self, depth: SX, closing: SX) -> SX:
            return self.k * (depth > 0.0) * depth

        def friction(self, speed: SX) -> SX:
            return 0.0 * speed

    spheres = SphereSet(np.array([[0.0, 0.019, 0.0], [0.2, 0.018, 0.0]]), np.full(2, 0.02), ("heel", "toe"))
    k = SX.sym("k", 2)
    body = Body("foot", 1.0, np.zeros(3), np.eye(3))
    tree = tree_of(Multibody("foot", (body,), (free("root", GROUND, "foot"),), (), np.zeros(3)))
    laws = laws_by_zone(spheres, {"toe": Spring(k[1]), "heel": SphereLaw(k[0], 1.5, 0.0, 1e-3, 0.1, 0.0, 0.0)})
    force, moment = sole_wrench(tree.bodies["foot"], spheres, laws, HalfSpace())
    at = Function("wrench", [tree.q, tree.u, k], [vertcat(force, moment)])
    found = np.array(at(np.zeros(6), np.zeros(6), [4e4, 3e3])).ravel()
    heel, toe = 4e4 * 1e-3**1.5, 3e3 * 2e-3
    np.testing.assert_allclose(found, [0.0, heel + toe, 0.0, 0.0, 0.0, 0.2 * toe], atol=1e-12)
    with pytest.raises(ValueError, match="zones are heel, toe; laws are given for heel"):
        laws_by_zone(spheres, {"heel": laws[0]})
