"""Spheres in symbols: the same loads as in numbers, on level and tilted ground, with laws by zone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from casadi import SX, Function, vertcat
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.chain.contact_law import CONTACT_LAW
from geocontact.data.multibody.joint import free
from geocontact.data.multibody.model import GROUND, Body, Multibody
from geocontact.dynamics.sphere_contact import STILL, ContactLaw, SphereLaw, laws_by_zone, laws_of, sole_wrench
from geocontact.dynamics.symbolic_ground import SymbolicPlane, SymbolicStairs, plane_numbers, stairs_numbers
from geocontact.dynamics.tree import tree_of
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.ground import Stairs
from geocontact.loads.sphere_set import SoleLaw, SphereLoads, SphereSet, sphere_loads
from geocontact.systems.foot_spheres import approach, rub, stand
from tests.loads.scenes import law, scattered, twist
from tests.systems.examples import foot
from tests.systems.examples import spheres as spheres_of_foot

TILTED = HalfSpace((0.01, -0.002, 0.03), (0.1, 0.98, -0.15))


def wrench_at(spheres: SphereSet, laws: Sequence[ContactLaw], ground: HalfSpace) -> Function:
    """(q, u) of a free body to the force on it and its moment about the origin, and its pose and twist."""
    body = Body("foot", 1.0, np.zeros(3), np.eye(3))
    tree = tree_of(Multibody("foot", (body,), (free("root", GROUND, "foot"),), (), np.zeros(3)))
    force, moment = sole_wrench(tree.bodies["foot"], spheres, laws, ground)
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
        np.array(each) for each in wrench_at(spheres, laws_of(numbers), ground)(q, u)
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


FLIGHT = Stairs((-0.05, 0.03), (-0.01, 0.004, 0.012))


@pytest.mark.parametrize("ground", [TILTED, FLIGHT], ids=["plane", "stairs"])
def test_grounds_in_symbols_are_those_of_numbers(ground: HalfSpace | Stairs) -> None:
    """Slope and stairs as parameters: the wrench of spheres on treads, risers and edges."""
    told = stairs_numbers(ground) if isinstance(ground, Stairs) else plane_numbers(ground)
    numbers, spheres = SX.sym("ground", len(told)), scattered(3, 24)
    symbols = SymbolicStairs(numbers) if isinstance(ground, Stairs) else SymbolicPlane(numbers)
    tree = tree_of(
        Multibody(
            "foot", (Body("foot", 1.0, np.zeros(3), np.eye(3)),), (free("root", GROUND, "foot"),), (), np.zeros(3)
        )
    )
    body, ours = tree.bodies["foot"], law(24, k=5e4, b=300.0, mu=0.8, v_th=0.25)
    wrench = sole_wrench(body, spheres, laws_of(ours), symbols)
    pose = [body.rotation, body.place, body.spin, body.speed]
    at = Function("wrench", [tree.q, tree.u, numbers], [*wrench, *pose])
    rng, slanting = np.random.default_rng(7), 0
    for _ in range(8):
        q = np.concatenate([0.02 * rng.normal(size=3), 0.01 * rng.normal(size=3)])
        force, moment, turn, place, spin, speed = (np.array(each) for each in at(q, 0.3 * rng.normal(size=6), told))
        where = RigidTransform.from_components(place.ravel(), Rotation.from_matrix(turn))
        loads = sphere_loads(spheres, ours, *twist(where, speed.ravel(), spin.ravel()), ground)
        wanted, arms = loads.force[0].sum(axis=0), np.nan_to_num(loads.point[0])
        slanting += int((np.abs(loads.normal[0, :, 0]) > 0.01).sum())
        np.testing.assert_allclose(force.ravel(), wanted, atol=1e-6 * np.linalg.norm(wanted))
        turned = np.cross(arms, loads.force[0]).sum(axis=0)
        np.testing.assert_allclose(moment.ravel(), turned, atol=1e-6 * np.linalg.norm(wanted) * 0.3)
    assert slanting > 5


class Coulomb(SphereLaw):
    """Friction that does not depend on the speed."""

    def friction(self, speed: SX) -> SX:
        return SX(self.mu_k)


@pytest.mark.parametrize("speed", [1e-7, 1e-6, 1e-5, 1e-3, 0.05, 0.12, 1.0])
def test_slow_sliding_is_smoothed_as_far_as_is_stated(speed: float) -> None:
    """Not at all below the threshold, by (STILL / v_th)² above; a jump at rest by v / sqrt(v² + STILL²)."""
    ball = SphereSet(np.zeros((1, 3)), np.array([0.02]), ("heel",))
    q, u = np.array([0.0, 0.0, 0.0, 0.0, 0.019, 0.0]), np.array([0.0, 0.0, 0.0, speed, 0.0, 0.0])
    pressing, table, v_th = 5e4 * 1e-3**1.5, SphereLaw(5e4, 1.5, 0.0, 2e-3, 0.1, 0.8, 0.64), 0.1
    ours = np.array(wrench_at(ball, [table], HalfSpace())(q, u)[0]).ravel()[0]
    exact = -pressing * np.interp(speed / v_th, [0.0, 1.0, 1.5], [0.0, 0.8, 0.64])
    assert ours == pytest.approx(exact, rel=1e-12, abs=(STILL / v_th) ** 2 * pressing * (speed > v_th))
    jumping = Coulomb(5e4, 1.5, 0.0, 2e-3, 0.1, 0.8, 0.64)
    ours = np.array(wrench_at(ball, [jumping], HalfSpace())(q, u)[0]).ravel()[0]
    assert ours == pytest.approx(-0.64 * pressing * speed / np.hypot(speed, STILL), rel=1e-12)


def test_symbols_give_the_foot_of_the_sagittal_plane() -> None:
    """Base model `foot` at random states of a sole in three zones: force and centre of pressure."""
    system, table, rng = foot(), spheres_of_foot(), np.random.default_rng(5)
    values = {**system.known, **system.start}
    centre = np.column_stack([table["px [m]"], table["py [m]"], np.zeros(len(table))])
    sole = SphereSet(centre, table["radius [m]"].to_numpy(float), tuple(map(str, table["zone"])))
    shared = [values[name] for name in ("delta_full", "v_th", "mu_s", "mu_k")]
    laws = {zone: SphereLaw(values[f"k_{zone}"], values["n"], values[f"b_{zone}"], *shared) for zone in sole.zones}
    at, loaded = wrench_at(sole, laws_by_zone(sole, laws), HalfSpace()), 0
    for pose, rate in zip(rng.normal(size=(40, 3)) * [1.0, 2e-3, 0.03], rng.normal(size=(40, 3)), strict=True):
        depth, closing, speed = approach(pose[:, None], rate[:, None], system.geometry.spheres(values))
        law = CONTACT_LAW.having({name: name for name in ("n", "delta_full", "mu_s", "mu_k", "v_th")}).numbers(values)
        none = np.array([0.0, 1.0, 1.0])
        normal, _ = stand(np.zeros(1), depth, closing, system.geometry.spheres(values), law, none)
        wanted = np.array([rub(normal, speed, rate[2:], law, none).sum(), normal.sum()])
        q, u = ([0.0, 0.0, each[2], each[0], each[1], 0.0] for each in (pose, rate))
        force, moment = (np.array(each).ravel() for each in at(q, u)[:2])
        np.testing.assert_allclose(force[:2], wanted, atol=1e-6 * max(np.linalg.norm(wanted), 1e-3))
        contact = pose[0] + centre[:, 0] * np.cos(pose[2]) - centre[:, 1] * np.sin(pose[2])
        np.testing.assert_allclose(moment[2], normal[0] @ contact, atol=1e-6 * max(np.linalg.norm(wanted), 1e-3))
        loaded += normal.sum() > 1.0
    assert loaded > 10


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
