"""No parallel model: with locked passive joints and the arm in the plane it is the base model `shoulder`."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from geocontact.data.parameter import Parameter
from geocontact.dynamics.recorded_inputs import recorded_inputs, stepped_inputs
from geocontact.shoulder_exoskeleton.arm_model import arm_model, output_slices
from geocontact.shoulder_exoskeleton.arm_numbers import adjusted_numbers, slices
from geocontact.shoulder_exoskeleton.device import Wearer, lever, lucy
from geocontact.systems import shoulder as base_shoulder
from tests.shoulder_exoskeleton.arms import GRAVITY, raised
from tests.systems.examples import recording

REACH, OFFSET = 0.21, (0.015, 0.03)
"""Human shoulder to the sphere, and from there to the hinge, forwards and upwards [m]."""
DEVICE = lucy().having(b=0.0, mu_s=0.0, mu_k=0.0, elevation_lower=-1.5, elevation_upper=3.0)


@pytest.mark.parametrize("level", [0.0, 0.6])
def test_angle_and_force_are_those_of_the_hinged_arm(level: float) -> None:
    time = np.arange(601) * 0.01
    arm = raised(time, 0.2, 1.9)
    p = adjusted_numbers(DEVICE, Wearer(), level)
    ours = _ours(time, arm, p)
    theirs = _base(time, arm, p, level)
    assert np.degrees(np.abs(ours[:, 0] - theirs[:, 0])).max() < 0.01
    assert np.abs(ours[:, 1] - theirs[:, 1]).max() < 0.05
    assert np.ptp(ours[:, 0]) > 1.5 and np.ptp(ours[:, 1]) > 3.0


def _ours(time: np.ndarray, arm: np.ndarray, p: np.ndarray) -> np.ndarray:
    """Elevation and the force across the cuff, the passive joints held at 0."""
    model, of = arm_model(DEVICE, locked=("passive_1", "passive_2")), slices()
    hinge = p[of["base"]] + p[of["link_1"]] + p[of["link_2"]]
    shoulder = hinge + np.array([p[of["cuff"]][0], OFFSET[0], -OFFSET[1]])
    place = shoulder + REACH * np.column_stack([np.zeros(len(time)), -np.sin(arm), -np.cos(arm)])
    locked = stepped_inputs(time[[0, -1]], np.zeros((1, 6)))
    inputs = (
        locked.beside(recorded_inputs(time, place, derivatives=1))
        .beside(stepped_inputs(time[[0, -1]], GRAVITY[None]))
        .beside(stepped_inputs(time[[0, -1]], np.array([[1.0, 0.0]])))
    )
    at = inputs.at(time)
    still = at[0].copy()
    still[9:12] = 0.0
    q, z = model.equilibrium.find((arm[:1], p[of["push"]]), inputs=still, parameters=p)
    found = model.stepper.simulate((q, np.zeros(1), z), time, inputs=inputs, parameters=p, tolerance=1e-8)
    told = np.array(model.outputs.map(len(time))(found.q.T, found.u.T, found.z.T, at.T, np.tile(p[:, None], len(time))))
    return np.column_stack([found.q[:, 0], told.T[:, output_slices()["in_cuff"]][:, 2]])


def _base(time: np.ndarray, arm: np.ndarray, p: np.ndarray, level: float) -> np.ndarray:
    of, d = slices(), DEVICE
    mass, centre, inertia = p[of["masses"]][2], -p[of["centres"]][8], p[of["inertias"]][12]
    constants = {
        "L_h": REACH,
        "o_x": OFFSET[0],
        "o_y": OFFSET[1],
        "I": inertia + mass * centre**2,
        "c": d["elevation_damping"],
        "l_c": centre,
    }
    numbers = {"k_t": d["k"], "b_t": 0.0, "m": mass}
    parameters = tuple(Parameter(name, "-", value, 0.0, 1e6) for name, value in numbers.items())
    angles = np.linspace(-0.5, 2.6, 4001)
    torque = d.peak_force * lever(angles, d["lever_a"], d["lever_b"], d["lever_phase"])
    table = pd.DataFrame({"angle [rad]": angles, "torque [N m]": torque})
    system = base_shoulder.build(parameters, constants, {"support": table})
    nothing = np.full(time.size, np.nan)
    columns = {"arm": arm, "event": np.zeros(time.size), "exo": nothing, "force": nothing}
    return system.simulate(recording("t", time, columns, level=level), numbers)
