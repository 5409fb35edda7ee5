"""Several bodies at rest on each other: derivatives, a stack of balls and two balls on one plate by hand."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.loads import settling_bodies
from geocontact.loads.foundation import FoundationState, layer_loads
from geocontact.loads.settling import not_held
from geocontact.loads.settling_bodies import (
    COORDINATES,
    Assembly,
    FreeBody,
    PressedPair,
    settled,
    turned_too_far,
)
from geocontact.loads.settling_potential import Bed, poses_of
from tests.loads.test_foundation import R, ball, slab
from tests.loads.test_settling import AT, H, M, bed, knee

ALL = np.ones(6, bool)


def pressed(name: str, moving: str, given: Bed) -> PressedPair:
    return PressedPair(given.layer, name, given.moving, given.normals, moving)


def askew(seed: int) -> RigidTransform:
    rng = np.random.default_rng(seed)
    return RigidTransform.from_components(rng.uniform(-0.1, 0.1, 3), Rotation.random(rng=rng))


def free(force: tuple[float, float, float], which: np.ndarray = ALL, springs: float = 0.0) -> FreeBody:
    return FreeBody(np.array([2e-3, -1e-3, 3e-3]), which, np.array(force), np.full(6, springs))


def test_slope_and_stiffness_are_derivatives_with_both_bodies_free() -> None:
    """Central differences in twelve coordinates: femur and insert free in frames that lie askew."""
    given, _ = knee()
    base = askew(1)
    own = poses_of(AT[None], np.zeros(3))[0]
    poses = {"insert": base, "femur": base * own}
    axes = {"insert": base * RigidTransform.from_rotation(Rotation.from_rotvec([0.2, 0.1, -0.3])), "femur": base}
    bodies = {"femur": free((100.0, -900.0, 50.0), springs=10.0), "insert": free((0.0, 400.0, 30.0), springs=20.0)}
    whole = Assembly([pressed("insert", "femur", given)], poses, axes, bodies)
    at = whole.recorded + np.tile([1e-5, -2e-5, 1e-5, 1e-3, -1e-3, 1e-3], 2)
    here = whole.at(at)
    step = np.tile([1e-6, 1e-6, 1e-6, 5e-5, 5e-5, 5e-5], 2)
    ends = [[whole.at(at + sign * step * unit) for sign in (1.0, -1.0)] for unit in np.eye(12)]
    slope = np.array([a.potential - b.potential for a, b in ends]) / (2.0 * step)
    bend = np.array([a.slope - b.slope for a, b in ends]) / (2.0 * step[:, None])
    scale = np.sqrt(np.abs(np.diag(here.stiffness)))
    np.testing.assert_allclose(here.slope, slope, atol=2e-3 * float(np.abs(slope).max()))
    np.testing.assert_allclose(here.stiffness / np.outer(scale, scale), bend / np.outer(scale, scale), atol=0.02)
    np.testing.assert_allclose(here.stiffness, here.stiffness.T, atol=1e-6 * float(np.abs(here.stiffness).max()))


def force(depth: float) -> float:
    """A rigid ball in a flat layer: 2 pi c w(d), c = R - d, w = M d^2/(2 h), the energy of all points."""
    return 2.0 * np.pi * (R - depth) * 0.5 * M * depth**2 / H


def sunk(load: float) -> float:
    return float(brentq(lambda d: force(d) - load, 1e-7, 2e-3))


def test_second_derivatives_are_exact_where_the_energy_is_smooth(monkeypatch: pytest.MonkeyPatch) -> None:
    """A weight on a long arm of MOVING that falls in FIXED, U = c . (R q + t): no more than what turns do to it."""
    c, q = np.array([30.0, -70.0, 20.0]), np.array([0.1, 0.25, -0.15])

    def weight(_layer: object, _surface: object, _normals: object, turn: np.ndarray, t: np.ndarray, about: np.ndarray):  # type: ignore[no-untyped-def]
        s = turn @ q + t - about
        bend = np.zeros((6, 6))
        bend[3:, 3:] = 0.5 * (np.outer(c, s) + np.outer(s, c)) - (c @ s) * np.eye(3)
        empty = np.zeros(0)
        height = float(c @ (turn @ q + t))
        return FoundationState(
            height, np.r_[c, np.cross(s, c)], bend, empty.astype(int), empty, empty, np.zeros((0, 3))
        )

    monkeypatch.setattr(settling_bodies, "foundation_state", weight)
    base = askew(5)
    poses = {"arm": base * askew(6), "frame": base}
    axes = {"arm": askew(7), "frame": askew(8)}
    bodies = {"arm": free((0.0, 0.0, 0.0)), "frame": free((0.0, 0.0, 0.0))}
    whole = Assembly([pressed("frame", "arm", knee()[0])], poses, axes, bodies)
    at, step = whole.recorded, 1e-6
    here = whole.at(at)
    ends = [[whole.at(at + sign * step * unit) for sign in (1.0, -1.0)] for unit in np.eye(12)]
    slope = np.array([a.potential - b.potential for a, b in ends]) / (2.0 * step)
    bend = np.array([a.slope - b.slope for a, b in ends]) / (2.0 * step)
    np.testing.assert_allclose(here.slope, slope, atol=1e-7 * float(np.abs(slope).max()))
    np.testing.assert_allclose(here.stiffness, bend, atol=1e-7 * float(np.abs(bend).max()))


def balls(*pairs: str) -> list[PressedPair]:
    """The same ball in the same layer of each of these bodies."""
    plate = bed(slab(), ball(40), 0.25e-3)
    return [pressed(name, moving, plate) for moving, name in (pair.split("/") for pair in pairs)]


def only(force: tuple[float, float, float], *which: str) -> FreeBody:
    return FreeBody(np.zeros(3), np.isin(COORDINATES, which), np.array(force), np.zeros(6))


UPSIDE_DOWN = RigidTransform.from_rotation(Rotation.from_rotvec([np.pi, 0.0, 0.0]))


def shifted(x: float, y: float, z: float = 0.0) -> RigidTransform:
    return RigidTransform.from_translation([x, y, z])


def test_a_stack_of_two_free_bodies_sinks_twice_as_deep() -> None:
    """Floor, ball, and a plate on it that bears the load: each layer carries it, and each is as deep as one alone."""
    base, load = askew(2), 1500.0
    poses = {"floor": base, "ball": base * shifted(0, R + 1e-3), "top": base * shifted(0, 2 * R + 3e-3) * UPSIDE_DOWN}
    bodies = {"ball": only((0.0, 0.0, 0.0), "ty"), "top": only((0.0, -load, 0.0), "ty")}
    stack = Assembly(balls("ball/floor", "ball/top"), poses, {"ball": base, "top": base}, bodies)
    rest = settled(stack, stack.recorded)
    assert rest.converged
    deep = sunk(load)
    assert R - rest.total.values[1] == pytest.approx(deep, rel=2e-3)
    assert 2 * R - rest.total.values[7] == pytest.approx(2 * deep, rel=2e-3)
    for state, sign in zip(rest.total.states, (-1.0, -1.0), strict=True):  # the top's own y points down
        found = layer_loads(stack.pairs[0].layer, state)["total"].wrench.force[1]
        assert found == pytest.approx(sign * load, rel=1e-5)


def test_a_ball_between_floor_and_ceiling_and_on_a_wall_shares_its_load() -> None:
    """Floor F(d + x), ceiling F(d - x) with the press fit d, their difference the load; the wall its own share."""
    base, load, fit, aside = askew(3), 700.0, 0.25e-3, 300.0
    wall = RigidTransform.from_rotation(Rotation.from_rotvec([0.0, 0.0, -0.5 * np.pi]))
    poses = {
        "floor": base,
        "ceiling": base * shifted(0, 2 * (R - fit)) * UPSIDE_DOWN,
        "wall": base * shifted(-R, R) * wall,
        "ball": base * shifted(0, R - fit),
    }
    bodies = {"ball": only((-aside, -load, 0.0), "tx", "ty")}
    pair = Assembly(balls("ball/floor", "ball/ceiling", "ball/wall"), poses, {"ball": base}, bodies)
    rest = settled(pair, pair.recorded)
    assert rest.converged
    lower = brentq(lambda x: force(fit + x) - force(fit - x) - load, 0.0, fit)
    assert 0.1 * fit < lower < 0.9 * fit, "both bear some of it"
    x, y = rest.total.values[:2]
    assert R - fit - y == pytest.approx(lower, rel=5e-3)
    assert -x == pytest.approx(sunk(aside), rel=5e-3)
    layer = pair.pairs[0].layer
    floor, ceiling = (layer_loads(layer, one)["total"].wrench.force[1] for one in rest.total.states[:2])
    assert floor == pytest.approx(-force(fit + lower), rel=5e-3)
    assert ceiling == pytest.approx(-force(fit - lower), rel=5e-3)
    names = [f"ball {name}" for name in COORDINATES]
    turns = rest.total.stiffness, np.isin(COORDINATES, ("tx", "ty", "ry")), load, names
    assert not_held(*turns) == ("ball ry",), "a ball turns freely"


@pytest.mark.parametrize("count", [3, 11, 12, 30])
def test_a_row_of_bodies_that_slides_as_one_is_held_by_nothing(count: int) -> None:
    """Each presses into the next along x and all are free along it: however many, all of them are named."""
    fit = 0.2e-3
    pair = bed(slab(), ball(16), 1e-3)
    along = RigidTransform.from_rotation(Rotation.from_rotvec([0.0, 0.0, -0.5 * np.pi]))
    names = [f"b{k}" for k in range(count)]
    poses = {name: shifted(k * (R - fit), 0.0) * along for k, name in enumerate(names)}
    bodies = {name: only((0.0, 0.0, 0.0), "tx") for name in names}
    bodies[names[0]], bodies[names[-1]] = only((400.0, 0.0, 0.0), "tx"), only((-400.0, 0.0, 0.0), "tx")
    pairs = [pressed(one, other, pair) for one, other in pairwise(names)]
    row = Assembly(pairs, poses, {name: RigidTransform.identity() for name in names}, bodies)
    total = row.at(row.recorded)
    assert all(len(state.pressed) for state in total.states)
    assert row.loose(total) == tuple(f"{name} tx" for name in names)
    held = dict(bodies) | {names[0]: FreeBody(np.zeros(3), np.zeros(6, bool), np.zeros(3), np.zeros(6))}
    fast = Assembly(pairs, poses, row.axes, held)
    assert fast.loose(fast.at(fast.recorded)) == ()


def over(rx: float, *which: str) -> Assembly:
    """A body in a frame that lies askew, turned by this about its x; these coordinates settle."""
    base = askew(4)
    turned = {"ball": base * RigidTransform.from_rotation(Rotation.from_rotvec([rx, 0.0, 0.0]))}
    return Assembly([], turned, {"ball": base}, {"ball": only((0.0, -1.0, 0.0), "ty", *which)})


@pytest.mark.parametrize("which", [("ry", "rz"), ("rx",), ("ry", "rx", "rz")])
def test_a_turn_at_which_two_coordinates_are_one_is_found(which: tuple[str, ...]) -> None:
    assert turned_too_far(over(1.5, *which), over(1.5, *which).recorded) == "ball"
    straight = over(0.0, *which)
    assert turned_too_far(straight, straight.recorded) is None
    far = np.where(np.isin(COORDINATES, "rx"), 1.5, straight.recorded)
    assert turned_too_far(straight, far) == ("ball" if len(which) > 1 else None), "its axis is where it was"


@pytest.mark.parametrize("which", [(), ("ry",), ("rz",)])
@pytest.mark.parametrize("turn", [1.5, 0.5 * np.pi])
def test_a_steep_body_that_does_not_settle_about_two_axes_is_none(which: tuple[str, ...], turn: float) -> None:
    """A displacement does not mind; ry alone is about y of the axes, rz alone about the body's own z."""
    steep = over(turn, *which)
    assert turned_too_far(steep, steep.recorded) is None
    moved = steep.recorded + 0.2 * steep.free
    was, now = (steep.axes["ball"].inv() * steep.placed(at)["ball"] for at in (steep.recorded, moved))
    turned = np.array([0.0, 0.2, 0.0]) if "ry" in which else was.rotation.apply([0.0, 0.0, 0.2 * ("rz" in which)])
    np.testing.assert_allclose((now.rotation * was.rotation.inv()).as_rotvec(), turned, atol=1e-9)
