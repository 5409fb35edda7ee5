"""Equations of the prosthetic side on the ground: the pelvis' place, the socket's six directions, the keel's joints.

One set of equations for all persons, fulcrums and soles with the same number of joints and spheres: their numbers are
parameters, so that machine code is made once.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.keel.on_tree import (
    along_keel,
    coordinates,
    joint_numbers,
    keel_bodies,
    keel_friction,
    posterior_part,
    rubbing_numbers,
)
from geocontact.below_knee_prosthesis.leg import Leg
from geocontact.below_knee_prosthesis.leg_tree import FORWARD, GRAVITY, SOCKET, UP, carried_mass
from geocontact.contact.bushing import Bushing, bushing_force
from geocontact.data.multibody.joint import free, prismatic, weld
from geocontact.data.multibody.model import GROUND, Body, Multibody
from geocontact.dynamics.equations import Equations, equations_of_motion
from geocontact.dynamics.inverse_dynamics import Wrenches
from geocontact.dynamics.simulate import Stepper
from geocontact.dynamics.sphere_contact import SphereLaw, sole_wrench, together
from geocontact.dynamics.symbolic_ground import (
    SymbolicGround,
    SymbolicPlane,
    SymbolicStairs,
    plane_numbers,
    stairs_numbers,
)
from geocontact.dynamics.tree import Tree, tree_of
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.ground import Stairs
from geocontact.loads.sphere_set import SphereSet

if TYPE_CHECKING:
    from casadi import SX, Function

FLOOR = HalfSpace()
COLUMN = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
BEARING = tuple(f"bearing_{kind}{axis}" for kind in "rt" for axis in "xyz")
"""Coordinates of the bushing's frame that are given."""
PLACE = ("pelvis_x", "pelvis_y")
"""Place of the pelvis, fore and aft and vertical: free."""
OUTPUTS = {"rotation": 9, "place": 3, "spin": 3, "speed": 3, "socket": 6}
"""Pose of the keel's frame (rotation by rows), its angular velocity and velocity, in the ground's frame; load of the
residual limb on the socket along the bushing's directions [N m, N]."""


@dataclass(frozen=True, eq=False)
class StanceModel:
    """Equations and what is made of them.

    Parameters
    ----------
    equations
        Coordinates `PLACE`, `SOCKET`, keel; inputs of `leg_motion.driving_inputs`; parameters of `stance_numbers`.
    outputs
        (q, u, z, w, p) to `OUTPUTS`.
    on_sole
        Force of the ground on the foot [N] and its moment about the ground's origin [N m], in symbols.
    stepper
        For motion.
    """

    equations: Equations
    outputs: Function
    on_sole: SX
    stepper: Stepper


def stance_model(
    foot: VariableStiffnessFoot, ground: HalfSpace | Stairs = FLOOR, *, machine_code: bool = True
) -> StanceModel:
    """The model of a foot at any fulcrum under any person; numbers of the sole's law are parameters by zone.

    So are those of a slope and of stairs with that many edges; the floor y = 0 has none.
    """
    spheres = foot.sole.spheres
    sole = (tuple(map(tuple, spheres.centre.tolist())), tuple(spheres.radius.tolist()), spheres.zone, foot.sole.segment)
    shared = (foot.law.exponent, foot.law.full_depth, foot.law.threshold_speed)
    edges = len(ground.edges) if isinstance(ground, Stairs) else None
    return _made(foot.keel, sole, shared, edges, len(_ground_numbers(ground)), machine_code)


def stance_numbers(
    leg: Leg,
    foot: VariableStiffnessFoot,
    fulcrum: float,
    bushing: Bushing,
    ground: HalfSpace | Stairs = FLOOR,
) -> Float[np.ndarray, " p"]:
    """Parameters of the equations, in the order of `_sizes`.

    ValueError for a fulcrum out of range, or stairs that do not go along x.
    """
    keel = foot.keel
    mass, centre, inertia = leg.prosthesis_body()
    zones = [int(np.flatnonzero(of)[0]) for of in foot.sole.spheres.zones.values()]
    law = foot.law
    own = keel.posterior_mass + keel.joints * keel.segment_mass
    under = _ground_numbers(ground)
    parts = {
        "carried": [carried_mass(leg, own)],
        "mass": [mass],
        "centre": centre,
        "inertia": [inertia[at] for at in COLUMN],
        "keel_place": leg.keel_place,
        "joints": joint_numbers(keel, fulcrum),
        "rubbing": rubbing_numbers(keel, fulcrum) if keel.rubs else [],
        "bushing": [bushing.stiffness, bushing.damping],
        "sole": [np.broadcast_to(each, len(law.stiffness))[zones] for each in _by_sphere(foot)],
        "ground": under,
    }
    sizes = _sizes(keel, len(zones), len(under))
    return np.concatenate([np.ravel(np.asarray(parts[name], float)) for name in sizes])


def sole_places(foot: VariableStiffnessFoot, ground: HalfSpace | Stairs = FLOOR) -> range:
    """Where stiffness, damping, static and kinetic friction are in `stance_numbers`, each by zone."""
    sizes = _sizes(foot.keel, len(foot.sole.spheres.zones), len(_ground_numbers(ground)))
    first = sum(size for name, size in list(sizes.items())[: list(sizes).index("sole")])
    return range(first, first + sizes["sole"])


def _ground_numbers(ground: HalfSpace | Stairs) -> list[float]:
    if isinstance(ground, Stairs):
        return stairs_numbers(ground)
    return [] if ground == FLOOR else plane_numbers(ground)


def _by_sphere(foot: VariableStiffnessFoot) -> tuple[Float[np.ndarray, ...], ...]:
    law = foot.law
    return law.stiffness, law.damping, np.asarray(law.static), np.asarray(law.kinetic)


def _sizes(keel: Keel, zones: int, ground: int) -> dict[str, int]:
    return {
        "carried": 1,
        "mass": 1,
        "centre": 3,
        "inertia": 6,
        "keel_place": 3,
        "joints": 2 * keel.hinges,
        "rubbing": 3 * keel.hinges if keel.rubs else 0,
        "bushing": 12,
        "sole": 4 * zones,
        "ground": ground,
    }


@lru_cache(maxsize=8)
def _made(
    keel: Keel,
    sole: tuple[tuple[tuple[float, ...], ...], tuple[float, ...], tuple[str, ...], tuple[int, ...]],
    shared: tuple[float, float, float],
    edges: int | None,
    ground: int,
    machine_code: bool,
) -> StanceModel:
    from casadi import SX, Function, densify, vertcat

    sizes = _sizes(keel, len(set(sole[2])), ground)
    p, pushing = SX.sym("numbers", sum(sizes.values())), SX.sym("pushing", 2)
    ends = np.cumsum([0, *sizes.values()])
    of = {name: p[int(ends[k]) : int(ends[k + 1]), :] for k, name in enumerate(sizes)}
    tree = _tree(keel, of)
    under = FLOOR if not ground else SymbolicPlane(of["ground"]) if edges is None else SymbolicStairs(of["ground"])
    names, n = coordinates(keel), keel.hinges
    rubbing, memory = keel_friction(tree, names, of["rubbing"]) if keel.rubs else ([], [])
    along = along_keel(tree, names, of["joints"][:n, :], of["joints"][n:, :], rubbing)
    along |= dict(zip(PLACE, (pushing[0], pushing[1]), strict=True))
    at = [tree.names.index(name) for name in SOCKET]
    held = [bushing_force(tree.q[i], tree.u[i], of["bushing"][k], of["bushing"][6 + k]) for k, i in enumerate(at)]
    along |= {name: -force for name, force in zip(SOCKET, held, strict=True)}
    loads = _on_ground(tree, keel, sole, of["sole"], shared, under)
    equations = equations_of_motion(
        tree,
        loads=loads,
        along=along,
        memory=memory,
        prescribed=BEARING,
        inputs=[pushing],
        parameters=[p],
    )
    frame = tree.bodies["foot"]
    told = vertcat(frame.rotation.T.reshape((9, 1)), frame.place, frame.spin, frame.speed, *held)
    outputs = Function("outputs", equations.state, [densify(told)])
    on_sole = sum((vertcat(*each) for each in loads.values()), SX(6, 1))
    return StanceModel(equations, outputs, on_sole, Stepper(equations, machine_code=machine_code))


def _tree(keel: Keel, of: dict[str, SX]) -> Tree:
    """All that is carried as a point mass with two places; the bushing's frame, given against it; what hangs on it."""
    from casadi import SX

    none = (0.0, np.zeros(3), np.zeros((3, 3)))
    bodies, joints = keel_bodies(keel, "foot", RigidTransform.identity())
    upper = (Body("sledge", *none), Body("carried", *none), Body("bearing", *none), Body("socket", *none))
    inertia = SX(3, 3)
    for k, (a, b) in enumerate(COLUMN):
        inertia[a, b] = of["inertia"][k]
        inertia[b, a] = of["inertia"][k]
    model = Multibody(
        "stance",
        (*upper, Body("foot", *posterior_part(keel)), *bodies),
        (
            prismatic(PLACE[0], GROUND, "sledge", FORWARD),
            prismatic(PLACE[1], "sledge", "carried", UP),
            free("bearing", "carried", "bearing"),
            free("socket", "bearing", "socket"),
            weld("foot", "socket", "foot"),
            *joints,
        ),
        (),
        np.array([0.0, -GRAVITY, 0.0]),
    )
    return tree_of(
        model,
        masses={"carried": of["carried"][0], "socket": of["mass"][0]},
        centres={"socket": of["centre"]},
        inertias={"socket": inertia},
        places={"foot": of["keel_place"]},
    )


def _on_ground(
    tree: Tree,
    keel: Keel,
    sole: tuple[tuple[tuple[float, ...], ...], tuple[float, ...], tuple[str, ...], tuple[int, ...]],
    numbers: SX,
    shared: tuple[float, float, float],
    ground: HalfSpace | SymbolicGround,
) -> Wrenches:
    centres, radii, zones, segments = np.array(sole[0]), np.array(sole[1]), sole[2], np.array(sole[3])
    order = list(dict.fromkeys(zones))
    count = len(order)
    n, deep, v_th = shared
    loads = []
    for segment in np.unique(segments):
        chosen = np.flatnonzero(segments == segment)
        origin = np.array([keel.places[segment - 1] if segment else 0.0, 0.0, 0.0])
        own = SphereSet(centres[chosen] - origin, radii[chosen], tuple(zones[k] for k in chosen))
        laws = []
        for zone in own.zone:
            k, b, static, kinetic = (numbers[i * count + order.index(zone)] for i in range(4))
            laws.append(SphereLaw(k, n, b, deep, v_th, static, kinetic))
        body = f"keel_{segment}" if segment else "foot"
        loads.append({body: sole_wrench(tree.bodies[body], own, laws, ground)})
    return together(*loads)
