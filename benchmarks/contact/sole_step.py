"""What a step of a foot on spheres costs: `python -m benchmarks.contact.sole_step [--rounds 7] [--spheres 0,24]`.

A synthetic prosthetic side: a mass that is free fore, aft and upwards, a socket of six directions whose upper frame is
prescribed, a keel of eight joints, the spheres in five zones whose stiffness, damping and friction are symbols; 16
coordinates are found. Told are operations of the loads, of the equations and of the step, CPU seconds of the
translation (nothing kept from before), and microseconds of a step, as machine code and by CasADi itself: medians.
"""

from __future__ import annotations

import argparse
import json
import os
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from benchmarks.one_core import pin

if TYPE_CHECKING:
    from casadi import Function

    from geocontact.dynamics.compiled import Buffered

HERE = Path(__file__).resolve().parents[1]
STEPS = 300
"""Of one round, for the time of one."""
ZONES, JOINTS = 5, 8


def main() -> None:
    """Measure, print, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.contact.sole_step", description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--spheres", default="0,24", help="how many, one run each")
    parser.add_argument("--out", type=Path, default=HERE / "results")
    options = parser.parse_args()
    pin()
    from benchmarks.machine import machine, versions

    report = {
        "machine": machine(),
        "versions": versions({"casadi", "numpy"}),
        "steps": [measured(int(count), options.rounds) for count in options.spheres.split(",")],
    }
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / "sole_step.json").write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")
    print(json.dumps(report, indent=2))


def measured(spheres: int, rounds: int) -> dict[str, Any]:
    """Operations, CPU seconds to compile, microseconds of a step."""
    from casadi import Function, vertcat

    from geocontact.dynamics.compiled import Buffered
    from geocontact.dynamics.equations import equations_of_motion
    from geocontact.dynamics.rosenbrock import rosenbrock_step, without_repeats

    tree, given = side(spheres)
    equations = equations_of_motion(tree, **given)
    acting = [vertcat(*pair) for pair in given["loads"].values()]
    loads = Function("loads", [tree.q, tree.u, equations.p], acting)
    parts = Function("parts", equations.state, [equations.mass, equations.force])
    step = without_repeats(rosenbrock_step(equations))
    with tempfile.TemporaryDirectory() as folder:
        os.environ["GEOCONTACT_CACHE"] = folder
        began = time.process_time()
        fast = Buffered(step, compiled=True)
        seconds = time.process_time() - began
        times = {"machine code": fast, "CasADi": Buffered(step)} if fast.code is not None else {"CasADi": fast}
        told = {name: 1e6 * seconds_of(of, step, rounds) for name, of in times.items()}
    return {
        "spheres": spheres,
        "coordinates": len(equations.names),
        "operations_of_loads": loads.n_instructions(),
        "operations_of_equations": parts.n_instructions(),
        "operations_of_a_step": step.n_instructions(),
        "compiler_cpu_s": seconds,
        "microseconds_of_a_step": told,
    }


def seconds_of(run: Buffered, step: Function, rounds: int) -> float:
    """CPU seconds of one call from a state on the ground, the median of the rounds."""
    import numpy as np

    x, w = np.zeros(step.size1_in("x")), np.zeros(step.size1_in("w"))
    x[1] = 0.418
    p = np.concatenate([np.full(JOINTS, 60.0), np.full(JOINTS, 0.05), np.repeat([5e4, 200.0, 0.8, 0.6], ZONES)])
    given = [x, np.array([1e-4]), w, w, w, p]
    found = []
    for _ in range(rounds):
        began = time.process_time()
        for _ in range(STEPS):
            run(*given)
        found.append((time.process_time() - began) / STEPS)
    if not np.isfinite(run(*given)[0]).all():
        raise ArithmeticError("the step is not finite")
    return float(np.median(found))


def side(spheres: int) -> tuple[Any, dict[str, Any]]:
    """The tree, and what `equations_of_motion` takes besides it."""
    import numpy as np
    from casadi import SX
    from scipy.spatial.transform import RigidTransform

    from geocontact.contact.bushing import SOCKET
    from geocontact.data.multibody.joint import free, prismatic, revolute
    from geocontact.data.multibody.model import GROUND, Body, Multibody
    from geocontact.dynamics.tree import tree_of

    along, up, across = np.eye(3)
    none = (0.0, np.zeros(3), np.zeros((3, 3)))
    bodies = [
        Body("sledge", *none),
        Body("carried", 75.0, np.zeros(3), np.eye(3)),
        Body("bearing", *none),
        Body("foot", 1.5, np.array([0.02, -0.2, 0.0]), 0.02 * np.eye(3)),
    ]
    joints = [
        prismatic("x", GROUND, "sledge", along),
        prismatic("y", "sledge", "carried", up),
        free("bearing", "carried", "bearing"),
        free("socket", "bearing", "foot"),
    ]
    before, at = "foot", RigidTransform.from_translation([0.1, -0.4, 0.0])
    for k in range(JOINTS):
        bodies.append(Body(f"keel_{k}", 0.02, np.array([6e-3, 0.0, 0.0]), 1e-5 * np.eye(3)))
        joints.append(revolute(f"keel_{k}", before, f"keel_{k}", across, at))
        before, at = f"keel_{k}", RigidTransform.from_translation([11.64e-3, 0.0, 0.0])
    tree = tree_of(Multibody("side", tuple(bodies), tuple(joints), (), np.array([0.0, -9.81, 0.0])))
    k, c, law = SX.sym("k", JOINTS), SX.sym("c", JOINTS), SX.sym("law", 4 * ZONES)
    acting = {}
    for i in range(JOINTS):
        at_joint = tree.names.index(f"keel_{i}")
        acting[f"keel_{i}"] = -k[i] * tree.q[at_joint] - c[i] * tree.u[at_joint]
    socket = [name for name in tree.names if name.startswith("socket")]
    places = [tree.names.index(name) for name in socket]
    held = SOCKET.load([tree.q[i] for i in places], [tree.u[i] for i in places])
    return tree, {
        "loads": on_ground(tree, spheres, law),
        "along": acting | dict(zip(socket, held, strict=True)),
        "prescribed": [name for name in tree.names if name.startswith("bearing")],
        "parameters": [k, c, law],
    }


def on_ground(tree: Any, count: int, law: Any) -> dict[str, Any]:
    """A third of the spheres under the foot, the others two by two under the joints of the keel."""
    import numpy as np

    from geocontact.dynamics.sphere_contact import SphereLaw, laws_by_zone, sole_wrench
    from geocontact.geometry.shapes import HalfSpace
    from geocontact.loads.sphere_set import SphereSet

    laws = {
        str(zone): SphereLaw(law[zone], 1.5, law[5 + zone], 2e-3, 0.25, law[10 + zone], law[15 + zone])
        for zone in range(ZONES)
    }
    places: dict[str, list[int]] = {}
    for i in range(count):
        places.setdefault("foot" if i < count // 3 else f"keel_{i % JOINTS}", []).append(i)
    loads = {}
    for name, here in places.items():
        down = 0.41 if name == "foot" else 0.01
        centre = np.array([[0.01 * (i % 4), -down, 0.03 * (-1.0) ** (i // JOINTS)] for i in here])
        sole = SphereSet(centre, np.full(len(here), 0.012), tuple(str(i % ZONES) for i in here))
        mine = laws_by_zone(sole, {zone: laws[zone] for zone in sole.zones})
        loads[name] = sole_wrench(tree.bodies[name], sole, mine, HalfSpace())
    return loads


if __name__ == "__main__":
    main()
