"""Bodies on joints beside their peers: `python -m benchmarks.dynamics.multibody --data DIR [--rounds 5]`.

Inverse kinematics of `opensim_walk/subject01_walk1.trc` with its model, weights and span, ours and OpenSim's own solver
in turns, CPU seconds of one core; ours per frame once its functions are built, and the building. Inverse dynamics at
random states of a tree with the joints that all have, beside MuJoCo and Pinocchio. Forward dynamics of a ball that
drops and slides on stiff ground: error against a far smaller tolerance, and how much faster than real time, as machine
code and by CasADi's own evaluation. The data are real recordings, the rest is synthetic.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Any

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parents[1]
REPEATED = 10
"""Times that the walk is gone through, to and fro, for the time of a frame."""
STATES = 200
TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
FALL = 1.0  # s


def main() -> None:
    """Measure, print, write the JSON."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.dynamics.multibody", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--data", type=Path, required=True, help="folder of the real data")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--out", type=Path, default=HERE / "results")
    options = parser.parse_args()
    pin()
    from benchmarks.machine import machine, versions

    report = {
        "machine": machine(),
        "versions": versions({"casadi", "numpy", "scipy", "opensim", "mujoco", "pin"}),
        "inverse kinematics": kinematics(options.data / "opensim_walk", options.rounds),
        "inverse dynamics": dynamics(),
        "forward dynamics": motion(options.rounds),
    }
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / "multibody.json").write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")
    print(json.dumps(report, indent=2))


def kinematics(walk: Path, rounds: int) -> dict[str, Any]:
    """Frames per second and the difference of the angles."""
    from dataclasses import replace
    from importlib.util import find_spec

    import numpy as np

    from geocontact.dynamics.inverse_kinematics import inverse_kinematics
    from geocontact.dynamics.tree import tree_of
    from geocontact.io.mocap.trc import read_trc
    from geocontact.io.opensim.marker_weights import read_marker_weights
    from geocontact.io.opensim.osim_multibody import read_multibody
    from tests import opensim_oracle
    from tests.elsewhere import another_process

    tree = tree_of(read_multibody(walk / "subject01_simbody.osim"))
    seen = read_trc(walk / "subject01_walk1.trc").between(0.4, 1.6)
    tasks = read_marker_weights(walk / "subject01_Setup_IK.xml")
    order = np.concatenate([np.arange(len(seen))[:: 1 - 2 * (k % 2)] for k in range(REPEATED)])
    long = replace(seen, time=np.arange(len(order)) / 60.0, positions=seen.positions[order])
    ours: list[float] = []
    building: list[float] = []
    theirs: list[float] = []
    found = inverse_kinematics(tree, seen, tasks)
    values = np.zeros((0, 0))
    with another_process() as call:
        for _ in range(rounds):
            times = []
            for each in (seen, long):
                began = time.process_time()
                inverse_kinematics(tree, each, tasks)
                times.append(time.process_time() - began)
            per_frame = (times[1] - times[0]) / (len(long) - len(seen))
            ours.append(1.0 / per_frame)
            building.append(times[0] - len(seen) * per_frame)
            if find_spec("opensim") is not None:
                seconds, values = call(
                    opensim_oracle.inverse_kinematics, walk / "subject01_simbody.osim", walk / "subject01_walk1.trc",
                    dict(tasks.markers), dict(tasks.coordinates), list(seen.time), list(tree.names),
                )  # fmt: skip
                theirs.append(len(seen) / seconds)
    told = {
        "frames": len(seen),
        "coordinates": len(tree.names),
        "frames_per_second": ours,
        "seconds_to_build": building,
    }
    if theirs:
        angular = np.array([c.kind == "rotational" for c in tree.model.coordinates])
        off = np.degrees(np.sqrt(np.mean((found.values - values) ** 2, axis=0)))[angular]
        told |= {"opensim_frames_per_second": theirs, "angle_difference_rms_deg": float(off.max())}
    return told


def dynamics() -> dict[str, Any]:
    """Largest difference over the largest force, and states per second of our function."""
    from importlib.util import find_spec

    import casadi
    import numpy as np

    from geocontact.dynamics.inverse_dynamics import generalised_forces
    from geocontact.dynamics.tree import tree_of
    from tests import rigid_body_oracle
    from tests.dynamics.models import plain_joints
    from tests.elsewhere import another_process

    tree = tree_of(plain_joints())
    rng = np.random.default_rng(0)
    n = len(tree.names)
    states = [rng.uniform(-3.0, 3.0, (STATES, n)), *rng.normal(size=(2, STATES, n))]
    run = casadi.Function("id", [tree.q, tree.u, tree.a], [generalised_forces(tree)]).map(STATES)
    ours = np.array(run(*(each.T for each in states))).T
    told: dict[str, Any] = {"states": STATES, "coordinates": n}
    peers = {
        "mujoco": rigid_body_oracle.mujoco_inverse_dynamics,
        "pinocchio": rigid_body_oracle.pinocchio_inverse_dynamics,
    }
    with another_process() as call:
        for name, theirs in peers.items():
            if find_spec(name) is not None:
                wanted = call(theirs, tree.model, *states)
                told[f"largest_difference_to_{name}"] = float(np.abs(ours - wanted).max() / np.abs(wanted).max())
    return told


def motion(rounds: int) -> list[dict[str, Any]]:
    """Steps, error and speed by tolerance."""
    import numpy as np

    from geocontact.dynamics.equations import equations_of_motion
    from geocontact.dynamics.simulate import Stepper
    from geocontact.dynamics.sphere_contact import SphereLaw, sole_wrench
    from geocontact.dynamics.tree import tree_of
    from geocontact.geometry.shapes import HalfSpace
    from geocontact.loads.sphere_set import SphereSet
    from tests.dynamics.models import free_ball

    tree = tree_of(free_ball())
    law = SphereLaw(1e5, 1.5, 100.0, 1e-3, 0.01, 0.5, 0.4)
    ball = SphereSet(np.zeros((1, 3)), np.array([0.05]), ("ball",))
    loads = {"ball": sole_wrench(tree.bodies["ball"], ball, [law], HalfSpace())}
    equations = equations_of_motion(tree, loads=loads)
    fast, slow = Stepper(equations), Stepper(equations, machine_code=False)
    start, speed, wanted = np.zeros(6), np.zeros(6), np.linspace(0.0, FALL, 101)
    start[4], speed[3] = 0.1, 1.0
    state = (start, speed, np.zeros(0))
    exact = fast.simulate(state, wanted, tolerance=1e-11)
    rows = []
    for tolerance in TOLERANCES:
        course = fast.simulate(state, wanted, tolerance=tolerance)
        seconds: dict[str, list[float]] = {"machine code": [], "CasADi": []}
        for _ in range(rounds):
            for name, stepper in (("machine code", fast), ("CasADi", slow)):
                began = time.process_time()
                stepper.simulate(state, wanted, tolerance=tolerance)
                seconds[name].append(time.process_time() - began)
        rows.append(
            {
                "tolerance": tolerance,
                "steps": course.steps,
                "refused": course.refused,
                "error_mm": 1e3 * float(np.abs(course.q[:, 3:] - exact.q[:, 3:]).max()),
                "compiled": fast.compiled,
                "times_real_time": {name: FALL / float(np.median(each)) for name, each in seconds.items()},
            }
        )
    return rows


if __name__ == "__main__":
    main()
