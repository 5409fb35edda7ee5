"""Trees of bodies made here, with joints of every kind that is read."""

from __future__ import annotations

from itertools import product

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.multibody import joint as joint_kinds
from geocontact.data.multibody.joint import Affine, Coordinate, JointFunction, JointModel, TransformAxis
from geocontact.data.multibody.model import Body, Marker, Multibody
from geocontact.io.opensim.osim_functions import piecewise_linear, polynomial, simm_spline

STILL = Affine(np.zeros(0), 0.0)
ITSELF = Affine(np.ones(1), 0.0)
GRAVITY = np.array([0.0, -9.81, 0.0])


def axes(*moving: tuple[int, np.ndarray, tuple[str, ...], JointFunction]) -> tuple[TransformAxis, ...]:
    """Six axes of a transform; those of these slots move."""
    found = [TransformAxis(direction, (), STILL) for direction in (*np.eye(3), *np.eye(3))]
    for slot, direction, names, function in moving:
        found[slot] = TransformAxis(direction / np.linalg.norm(direction), names, function)
    return tuple(found)


def joint(
    name: str,
    parent: str,
    child: str,
    moves: tuple[TransformAxis, ...],
    at: RigidTransform | None = None,
    child_at: RigidTransform | None = None,
    reverse: bool = False,
) -> JointModel:
    names = dict.fromkeys(c for axis in moves for c in axis.coordinates)
    coordinates = tuple(Coordinate(each, 0.0, "rotational") for each in names)
    none = RigidTransform.identity()
    ends = [none if each is None else each for each in (at, child_at)]
    return JointModel(name, parent, child, coordinates, moves, *ends, reverse, "")


def placed(rng: np.random.Generator) -> RigidTransform:
    return RigidTransform.from_components(rng.normal(size=3) * 0.3, Rotation.random(random_state=rng))


def body(name: str, rng: np.random.Generator) -> Body:
    """A body whose inertia some distribution of mass has."""
    points = rng.normal(size=(12, 3)) * 0.2
    spread = np.einsum("ij,ij->", points, points) * np.eye(3) - points.T @ points
    return Body(name, float(rng.uniform(0.5, 4.0)), rng.normal(size=3) * 0.1, spread / 12.0)


def pendulum(lengths: tuple[float, ...], masses: tuple[float, ...]) -> Multibody:
    """Point masses on rods without mass in a plane, hanging along -y for q = 0; every angle counts from its parent."""
    bodies, joints, parent, at = [], [], "ground", None
    for i, (length, mass) in enumerate(zip(lengths, masses, strict=True)):
        name = f"bob{i}"
        bodies.append(Body(name, mass, np.array([0.0, -length, 0.0]), np.zeros((3, 3))))
        joints.append(joint(f"pin{i}", parent, name, axes((2, np.array([0.0, 0.0, 1.0]), (f"q{i}",), ITSELF)), at))
        parent, at = name, RigidTransform.from_translation([0.0, -length, 0.0])
    return Multibody("pendulum", tuple(bodies), tuple(joints), (), GRAVITY)


def all_kinds(seed: int = 0) -> Multibody:
    """Two branches: a free body, a joint of every function with coupled axes, reversed ones, a slider, a weld."""
    rng = np.random.default_rng(seed)
    x, y, z = np.eye(3)
    free = axes(*((slot, np.eye(3)[slot % 3], (f"free{slot}",), ITSELF) for slot in range(6)))
    knots, heights = np.array([-1.5, -0.5, 0.2, 0.9, 1.6]), rng.normal(size=5)
    lines = piecewise_linear(knots, np.sort(heights))
    coupled = axes(
        (0, x + y, ("a",), simm_spline(knots, heights)),
        (1, z, ("a", "b"), Affine(np.array([0.7, -1.2]), 0.1)),
        (2, y - z, ("b",), polynomial(np.array([0.3, -0.2, 0.5, 0.1]))),
        (3, x, ("a",), simm_spline(knots, 0.1 * heights)),
        (4, x + z, ("b",), ITSELF.scaled(-0.2)),
    )
    made = (
        joint("free", "ground", "trunk", free, placed(rng), placed(rng)),
        joint("coupled", "trunk", "thigh", coupled, placed(rng), placed(rng)),
        joint("coupled_back", "thigh", "shank", _renamed(coupled, "_2"), placed(rng), placed(rng), reverse=True),
        joint("slider", "trunk", "mast", axes((3, x - y, ("s",), ITSELF)), placed(rng), placed(rng)),
        joint("weld", "mast", "head", axes(), placed(rng), placed(rng)),
        joint("lines", "head", "hat", axes((1, y, ("l",), lines)), placed(rng), placed(rng)),
    )
    bodies = tuple(body(each.child, rng) for each in made)
    markers = tuple(Marker(f"{b.name}{i}", b.name, rng.normal(size=3) * 0.2) for b, i in product(bodies, range(4)))
    return Multibody("all kinds", bodies, made, markers, rng.normal(size=3) * 5.0)


def _renamed(moves: tuple[TransformAxis, ...], ending: str) -> tuple[TransformAxis, ...]:
    return tuple(TransformAxis(a.direction, tuple(c + ending for c in a.coordinates), a.function) for a in moves)


def plain_joints(seed: int = 0) -> Multibody:
    """Free, gimbal, pin, slider and weld joints with frames anywhere, two branches: what other libraries have too."""
    rng = np.random.default_rng(seed)
    x, y, z = np.eye(3)
    made = (
        joint_kinds.free("free", "ground", "trunk", placed(rng), placed(rng)),
        joint_kinds.gimbal("gimbal", "trunk", "thigh", placed(rng), placed(rng)),
        joint_kinds.revolute("pin", "thigh", "shank", z, placed(rng), placed(rng)),
        joint_kinds.revolute("oblique", "shank", "foot", x + 2 * y - z, placed(rng), placed(rng)),
        joint_kinds.prismatic("slider", "trunk", "mast", x - y, placed(rng), placed(rng)),
        joint_kinds.weld("weld", "mast", "head", placed(rng), placed(rng)),
        joint_kinds.revolute("hat", "head", "hat", y, placed(rng), placed(rng)),
    )
    bodies = tuple(body(each.child, rng) for each in made)
    return Multibody("plain joints", bodies, made, (), rng.normal(size=3) * 5.0)


def free_ball(mass: float = 2.0, gravity: np.ndarray = GRAVITY, radius: float = 0.05) -> Multibody:
    """A ball with six free coordinates: turns about x, y, z, then shifts along them."""
    solid = Body("ball", mass, np.zeros(3), 0.4 * mass * radius**2 * np.eye(3))
    return Multibody("ball", (solid,), (joint_kinds.free("j", "ground", "ball"),), (), gravity)
