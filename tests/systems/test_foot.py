"""The foot against its equations written out again from the text, and against a sphere worked by hand."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from geocontact.chain.differentiated_inputs import recorded
from geocontact.data.parameter import Parameter
from geocontact.systems import foot as prosthetic_foot
from geocontact.systems.foot_spheres import INPUTS
from tests.systems.examples import FOOT_CONSTANTS, foot, foot_trial, recording, spheres


def restated(position: np.ndarray, rate: np.ndarray, table: pd.DataFrame, values: dict[str, float]) -> np.ndarray:
    """Every sample and sphere at once, from the text."""
    n, full, static, kinetic, threshold = (values[name] for name in ("n", "delta_full", "mu_s", "mu_k", "v_th"))
    _, y, pitch = position[:, :, None]
    x_rate, y_rate, pitch_rate = rate[:, :, None]
    px, py, radius = (table[name].to_numpy() for name in ("px [m]", "py [m]", "radius [m]"))
    k, b = (np.array([values[f"{letter}_{zone}"] for zone in table["zone"]]) for letter in "kb")
    height = y + px * np.sin(pitch) + py * np.cos(pitch)
    height_rate = y_rate + pitch_rate * (px * np.cos(pitch) - py * np.sin(pitch))
    depth = radius - height
    u = np.clip(depth / full, 0.0, 1.0)
    pressed = k * np.maximum(depth, 0.0) ** n + b * np.maximum(-height_rate, 0.0) * u**2 * (3.0 - 2.0 * u)
    normal = np.where(depth > 0.0, pressed, 0.0)
    speed = x_rate - pitch_rate * (height - radius - y)
    nodes = np.array([-3.0, -1.5, -1.0, 1.0, 1.5, 3.0])
    mu = np.interp(speed / threshold, nodes, [-kinetic, -kinetic, -static, static, kinetic, kinetic])
    vertical = normal.sum(axis=1)
    with np.errstate(invalid="ignore"):
        centre = (normal * (px - radius * np.sin(pitch))).sum(axis=1) / vertical
    return np.column_stack((-(mu * normal).sum(axis=1), vertical, np.where(vertical < 20.0, np.nan, centre)))


@pytest.mark.parametrize("depth", [0.0005, 0.004, 0.009])
@pytest.mark.parametrize("speed", [1.0, 12.0, 40.0])  # of gliding, through all branches of the friction table
def test_outputs_are_those_of_the_text(depth: float, speed: float) -> None:
    system, trial = foot(), foot_trial("t", depth)
    columns = {name: trial.column(name) for name in trial.signals.channels}
    trial = recording("t", trial.time, columns | {"x": speed * columns["x"]})
    moved = recorded(trial.signals, INPUTS)
    want = restated(moved.position, moved.rate, spheres(), {**system.known, **system.start})
    np.testing.assert_allclose(system.simulate(trial, system.start), want, rtol=1e-12, atol=1e-9)


def one_sphere(**columns: np.ndarray) -> np.ndarray:
    """Outputs for a sphere of 30 mm whose centre is 100 mm ahead and 20 mm above the origin."""
    table = pd.DataFrame({"px [m]": [0.1], "py [m]": [0.02], "radius [m]": [0.03], "zone": ["a"]})
    parameters = (Parameter("k_a", "N/m^n", 1e5, 0.0, 1e6), Parameter("b_a", "N s/m", 400.0, 0.0, 1e4))
    constants = FOOT_CONSTANTS | {"n": 1.0, "delta_full": 0.02}
    system = prosthetic_foot.build(parameters, constants, {"spheres": table})
    time = np.arange(9) * 0.01
    still = dict.fromkeys(("x", "y", "pitch", "force_x", "force_y", "cop_x"), np.zeros(9))
    return system.simulate(recording("t", time, still | columns), system.start)[4]


def test_a_sphere_by_hand() -> None:
    time = np.arange(9) * 0.01 - 0.04
    # depth 0.03 - 0.02 = 0.01 m; sinking at 0.1 m/s, s(0.5) = 0.5: 1e5 x 0.01 + 400 x 0.1 x 0.5 = 1020 N
    # gliding at half the threshold speed: 0.45 of it against the motion
    got = one_sphere(y=-0.1 * time, x=0.125 * time)
    np.testing.assert_allclose(got, [-0.45 * 1020.0, 1020.0, 0.1], rtol=1e-12)
    # rising: no damping; backwards at 1.25 threshold speeds: half-way between static and kinetic
    np.testing.assert_allclose(one_sphere(y=0.1 * time, x=-1.25 * 0.25 * time), [800.0, 1000.0, 0.1], rtol=1e-12)


def test_a_rolling_sphere_contacts_where_it_touches() -> None:
    # pitch 0.1 rad, turning at 1 rad/s: contact at 0.1 - 0.03 sin 0.1; its bottom moves at -(h - radius - y)
    time = np.arange(9) * 0.01 - 0.04
    height = 0.1 * np.sin(0.1) + 0.02 * np.cos(0.1)
    got = one_sphere(pitch=0.1 + time, y=np.full(9, 0.02 - height))
    assert got[2] == pytest.approx(0.1 - 0.03 * np.sin(0.1), rel=1e-12)
    speed = -(height - 0.03)
    assert got[0] == pytest.approx(-0.9 * speed / 0.25 * got[1], rel=1e-9)


def test_off_the_ground_there_is_neither_force_nor_centre() -> None:
    got = one_sphere(y=np.full(9, 0.05))
    np.testing.assert_array_equal(got, [0.0, 0.0, np.nan])


@pytest.mark.parametrize(
    ("missing", "word"), [("n", "n is missing"), ("k_z1", "k_z1 is missing"), ("b_z3", "b_z3 is missing")]
)
def test_what_is_missing_is_named(missing: str, word: str) -> None:
    system = foot()
    parameters = tuple(p for p in system.parameters if p.name != missing)
    constants = {name: value for name, value in FOOT_CONSTANTS.items() if name != missing}
    with pytest.raises(ValueError, match=word):
        prosthetic_foot.build(parameters, constants, {"spheres": spheres()})


def test_a_foot_without_spheres_is_refused() -> None:
    with pytest.raises(ValueError, match="table of spheres is missing"):
        prosthetic_foot.build(foot().parameters, FOOT_CONSTANTS, {})
    with pytest.raises(ValueError, match="no column 'zone'"):
        prosthetic_foot.build(foot().parameters, FOOT_CONSTANTS, {"spheres": spheres().drop(columns="zone")})
