"""The elastic joint against its formulas, a curve against its own points, and a spring in series against a root."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from geocontact.chain.interface_law import INTERFACE_LAW
from geocontact.chain.links import Law, Motion
from geocontact.chain.single_deflection import SingleDeflection, read_off
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.effects.catalogue import candidates
from geocontact.systems import elastic_joint
from tests.systems.examples import joint, joint_trial, measured, recording

K = Parameter("k", "N m/rad", 200.0, 0.0, 1e4)
POINTS = ([-0.2, -0.05, 0.0, 0.1, 0.25], [-30.0, -4.0, 1.0, 9.0, 60.0])
SECANT = Parameter("k", "N m/rad", 90.0 / 0.45, 0.0, 1e4)


def curve(angle: list[float], torque: list[float]) -> pd.DataFrame:
    return pd.DataFrame({"angle [rad]": angle, "torque [N m]": torque})


def torque(system: System, *angles: float, **covariates: float) -> np.ndarray:
    trial = recording("t", np.arange(float(len(angles))), {"angle": np.array(angles)}, **covariates)
    return system.simulate(trial, system.start)[:, 0]


def test_torque_by_hand() -> None:
    # 200 N m/rad; 0.3 - 0.1 = 0.2 rad; hardening 5: 0.2 (1 + 5 x 0.04) = 0.24 rad
    straight = elastic_joint.build((K,), {}, {})
    np.testing.assert_allclose(torque(straight, 0.0, 0.1, -0.2), [0.0, 20.0, -40.0], atol=1e-14)
    hard = elastic_joint.build((K,), {"angle0": 0.1, "hardening": 5.0}, {})
    np.testing.assert_allclose(torque(hard, 0.3, 0.1, -0.1), [48.0, 0.0, -48.0], atol=1e-13)


def test_setting_changes_the_stiffness() -> None:
    growth, bend = Parameter("growth", "1/mm", 0.02, -1.0, 1.0), Parameter("bend", "1/mm^2", 1e-3, -1.0, 1.0)
    system = elastic_joint.build((K, growth, bend), {}, {})
    for setting, factor in ((0.0, 1.0), (10.0, np.exp(0.3)), (-10.0, np.exp(-0.1)), (1e9, np.exp(50.0))):
        np.testing.assert_allclose(torque(system, 0.1, -0.2, setting=setting), factor * np.array([20.0, -40.0]))


def test_curve_is_met_at_its_points_and_goes_on_straight() -> None:
    system = elastic_joint.build((SECANT,), {}, {"curve": curve(*POINTS)})
    np.testing.assert_allclose(torque(system, *POINTS[0]), POINTS[1], rtol=1e-13, atol=1e-12)
    far = torque(system, 0.25, 0.3, 0.35, 0.4, -0.2, -0.25, -0.3)
    np.testing.assert_allclose(np.diff(far[:4], 2), 0.0, atol=1e-10)
    np.testing.assert_allclose(np.diff(far[4:], 2), 0.0, atol=1e-10)
    moved = elastic_joint.build((SECANT,), {"angle0": 0.03}, {"curve": curve(*POINTS)})
    np.testing.assert_allclose(torque(moved, *(a + 0.03 for a in POINTS[0])), POINTS[1], rtol=1e-12, atol=1e-12)


@given(st.lists(st.floats(-0.5, 0.5), min_size=2, max_size=20, unique=True))
def test_a_rising_curve_gives_a_rising_torque(angles: list[float]) -> None:
    system = elastic_joint.build((K,), {}, {"curve": curve(*POINTS)})
    assert np.all(np.diff(torque(system, *sorted(angles))) >= -1e-12)


@pytest.mark.parametrize(
    ("table", "word"),
    [
        (curve([0.0, 0.0, 1.0], [0.0, 1.0, 2.0]), "each larger than the one before"),
        (curve([0.0], [0.0]), "two angles or more"),
        (curve([0.0, 1.0], [0.0, -1.0]), "not larger at its last angle"),
        (curve([0.0, 1.0], [0.0, 1.0]).rename(columns={"torque [N m]": "force [N]"}), "no column 'torque"),
    ],
)
def test_what_is_no_curve_is_refused(table: pd.DataFrame, word: str) -> None:
    with pytest.raises(ValueError, match=word):
        elastic_joint.build((K,), {}, {"curve": table})


def test_numbers_that_are_missing_or_unknown_are_named() -> None:
    with pytest.raises(ValueError, match="k is missing"):
        elastic_joint.build((), {}, {})
    with pytest.raises(ValueError, match="no parameter angel0; it has k, angle0"):
        elastic_joint.build((K, Parameter("angel0", "rad", 0.0, -1.0, 1.0)), {}, {})


def test_series_spring_solves_its_equation() -> None:
    system, c = elastic_joint.build((K,), {"angle0": 0.1, "hardening": 0.6}, {}), 0.002
    soft = system.geometry.having(
        {"series_compliance.compliance": c, "series_compliance.reference": 50.0, "series_compliance.exponent": 1.4}
    )
    trial = joint_trial("t", 2.0, 0.0, 0.05)

    def miss(load: float, angle: float) -> float:
        turned = angle - 0.1 - c * 50.0 * np.sign(load) * abs(load / 50.0) ** 1.4
        return float(load - 200.0 * turned * (1.0 + 0.6 * turned**2))

    values = {**system.known, **system.start}
    got = soft.loads(system.motion.seen(trial, {}), system.law, values).normal[:, 0]
    want = [brentq(miss, -1e3, 1e3, args=(angle,), xtol=1e-12, rtol=1e-14) for angle in trial.column("angle")]
    np.testing.assert_allclose(got, want, rtol=1e-8, atol=1e-8)


def test_a_spring_in_series_with_a_damped_one_is_a_standard_linear_solid() -> None:
    """F = K θ with 1/K = c + 1/(s (k + i ω b)), where the deflection is s θ; first order in the step."""
    k, b, c, s, w = 200.0, 15.0, 0.002, 2.5, 4.0
    damped = Law(INTERFACE_LAW).having({"k": k, "damping.b": b})
    soft = SingleDeflection("angle", lambda x, _: s * x).having({"series_compliance.compliance": c})
    stiffness = 1.0 / (c + 1.0 / (s * (k + 1j * w * b)))
    error, steps = [], (0.01, 0.005, 0.0025)
    for step in steps:
        time = np.arange(round(6.0 / step)) * step
        trial = recording("t", time, {"angle": 0.3 * np.sin(w * time)})
        got = soft.loads(Motion(("angle",)).seen(trial, {}), damped, {}).normal[:, 0]
        want = 0.3 * np.abs(stiffness) * np.sin(w * time + np.angle(stiffness))
        settled = (time > 2.0) & (time < 5.5)
        error.append(np.abs(got - want)[settled].max() / np.abs(want).max())
    assert error[-1] < 2e-3, error
    assert np.polyfit(np.log(steps), np.log(error), 1)[0] == pytest.approx(1.0, abs=0.2), error


def test_table_of_the_deflection_converges_at_fourth_order() -> None:
    x = np.linspace(-1.4, 1.4, 997)
    error = []
    for count in (20, 40, 80):
        at = np.linspace(-1.0, 1.0, count + 1)
        knots = np.array([at, np.sin(3.0 * at), 3.0 * np.cos(3.0 * at)])
        inside = np.abs(x) < 1.0
        got = np.array([read_off(float(one), knots)[0] for one in x])
        error.append(np.abs(got - np.sin(3.0 * x))[inside].max())
        beyond = x > 1.0
        straight = np.sin(3.0) + 3.0 * np.cos(3.0) * (x - 1.0)
        np.testing.assert_allclose(got[beyond], straight[beyond], atol=1e-12)
    order = np.polyfit(np.log([20, 40, 80]), np.log(error), 1)[0]
    assert order == pytest.approx(-4.0, abs=0.2), error


def test_a_damped_joint_lags_by_the_closed_form() -> None:
    """k θ + b θ' of a sine is a sine, larger by sqrt(1 + (b ω/k)²) and earlier by atan(b ω/k)."""
    system = elastic_joint.build((K,), {}, {})
    time, b, w = np.arange(0.0, 6.0, 0.005), 15.0, 4.0
    trial = recording("t", time, {"angle": 0.3 * np.sin(w * time), "torque": np.zeros(time.size)})
    known = system.scaled((measured(system, trial),))
    damper = next(one for one in candidates(known) if one.label == "damping")
    assert damper.parameters[0].unit == "N m s/rad"
    values = {**system.start, "damping.b": b, "damping.exponent": 1.0}
    got = damper.apply(known).simulate(trial, values)[40:-40, 0]
    want = 200.0 * 0.3 * np.hypot(1.0, b * w / 200.0) * np.sin(w * time + np.arctan(b * w / 200.0))
    np.testing.assert_allclose(got, want[40:-40], atol=0.002 * 60.0)


def test_loading_is_stiffer_than_unloading_on_both_sides() -> None:
    """k (1 ± a) u at rates far above the turning rate; the loop loses 2 a k A² of the cycle's energy."""
    system, share = elastic_joint.build((K,), {}, {}), 0.2
    time = np.arange(0.0, 4.0, 0.001)
    trial = recording("t", time, {"angle": 0.3 * np.sin(np.pi * time), "torque": np.zeros(time.size)})
    known = system.scaled((measured(system, trial),))
    uneven = next(one for one in candidates(known) if one.name == "asymmetry")
    values = {**system.start, "asymmetry.excess": share, "asymmetry.turning": 1e-9}
    angle, got = trial.column("angle"), uneven.apply(known).simulate(trial, values)[:, 0]
    loading = np.sign(np.gradient(angle**2))
    off_turns = np.abs(np.cos(np.pi * time)) > 0.05
    np.testing.assert_allclose(got[off_turns], (200.0 * (1.0 + share * loading) * angle)[off_turns], atol=0.1)
    cycle = slice(500, 2501)
    assert np.trapezoid(got[cycle], angle[cycle]) == pytest.approx(2.0 * share * 200.0 * 0.3**2, rel=1e-2)


def test_loop_of_dry_friction_loses_four_limits_times_amplitude() -> None:
    """Coulomb friction of ±T over ±A dissipates 4 T A a cycle, whatever the rate and the spring."""
    system = elastic_joint.build((K,), {}, {})
    time, limit = np.arange(0.0, 4.0, 0.001), 3.0
    trial = recording("t", time, {"angle": 0.3 * np.sin(np.pi * time), "torque": np.zeros(time.size)})
    known = system.scaled((measured(system, trial),))
    friction = next(one for one in candidates(known) if one.label == "dry_friction.stroke")
    values = {**system.start, "dry_friction.stroke.limit": limit, "dry_friction.stroke.reach": 1e-5}
    got = friction.apply(known).simulate(trial, values)[:, 0]
    cycle = slice(500, 2501)
    assert np.trapezoid(got[cycle], trial.column("angle")[cycle]) == pytest.approx(4.0 * limit * 0.3, rel=2e-3)


def test_the_example_knows_its_setting() -> None:
    system, trial = joint(), joint_trial("t", 2.0, 1.0)
    other = recording("u", trial.time, {"angle": trial.column("angle")}, setting=0.0)
    ratio = system.simulate(trial, system.start) / system.simulate(other, system.start)
    np.testing.assert_allclose(ratio, np.exp(0.3), rtol=1e-12)
