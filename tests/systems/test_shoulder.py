"""The shoulder against its equation integrated by another method, a pendulum, its equilibrium, and finer steps."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from geocontact.chain.system import NotConverged, System
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.effects.catalogue import candidates
from geocontact.systems import shoulder as shoulder_exoskeleton
from geocontact.systems import shoulder_motion
from geocontact.systems.shoulder_motion import GRAVITY, MOST, SHORTEST
from tests.systems.examples import SHOULDER_CONSTANTS, recording, shoulder, shoulder_trial, support

NOISE = np.array([0.002, 0.4])
"""Of the angle [rad] and of the force [N], as the practice cases tell it."""
VALUES = {"k_t": 700.0, "b_t": 20.0, "m": 1.6}
Motion = Callable[[float], float]


def torque(
    e: float, v: float, a: float, a_rate: float, known: dict[str, float], level: float, table: pd.DataFrame
) -> tuple[float, float]:
    """Torque on the exoskeleton's arm [N m] and force on the human one [N], written out again from the text."""
    p = known["L_h"] * np.array([np.sin(a), -np.cos(a)])
    p_rate = known["L_h"] * a_rate * np.array([np.cos(a), np.sin(a)])
    w = p - [known["o_x"], known["o_y"]]
    tube, across = np.array([np.sin(e), -np.cos(e)]), np.array([np.cos(e), np.sin(e)])
    s, r, r_rate = w @ tube, w @ across, p_rate @ across - v * (w @ tube)
    n = known["k_t"] * r + known["b_t"] * r_rate
    lifted = level * np.interp(e, table["angle [rad]"], table["torque [N m]"])
    weight = known["m"] * GRAVITY * known["l_c"] * np.sin(e)
    return lifted - weight + n * s - known["c"] * v, -n


def integrated(arm: Motion, arm_rate: Motion, time: np.ndarray, level: float, **changed: float) -> np.ndarray:
    """Angle and force at `time`, from rest in equilibrium, by an explicit method of order 8 at a tight tolerance."""
    known, table = {**SHOULDER_CONSTANTS, **VALUES, **changed}, support()

    def rates(t: float, y: np.ndarray) -> list[float]:
        return [y[1], torque(y[0], y[1], arm(t), arm_rate(t), known, level, table)[0] / known["I"]]

    rest = brentq(lambda e: torque(e, 0.0, arm(0.0), 0.0, known, level, table)[0], arm(0.0) - 0.4, arm(0.0) + 0.4)
    found = solve_ivp(rates, time[[0, -1]], [rest, 0.0], "DOP853", time, rtol=1e-11, atol=1e-12, max_step=0.01).y
    force = [torque(e, v, arm(t), arm_rate(t), known, level, table)[1] for t, (e, v) in zip(time, found.T, strict=True)]
    return np.column_stack((found[0], force))


def raised(t: float) -> float:
    """An arm that starts at rest, is raised, lowered, and trembles a little."""
    return 0.3 + 0.7 * (1.0 - np.cos(1.9 * t)) + 0.02 * (1.0 - np.cos(9.0 * t))


def raised_rate(t: float) -> float:
    return 1.33 * np.sin(1.9 * t) + 0.18 * np.sin(9.0 * t)


def raised_trial(level: float, step: float = 0.01) -> Trial:
    time = np.arange(round(4.0 / step) + 1) * step
    nothing = np.full(time.size, np.nan)
    columns = {"arm": np.array([raised(t) for t in time]), "event": np.zeros(time.size)}
    return recording("t", time, {**columns, "exo": nothing, "force": nothing}, level=level)


@pytest.mark.parametrize("level", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("k_t", [700.0, 5000.0])
def test_motion_and_force_are_those_of_the_equation(level: float, k_t: float) -> None:
    trial = raised_trial(level)
    want = integrated(raised, raised_rate, trial.time, level, k_t=k_t)
    got = shoulder().simulate(trial, {**VALUES, "k_t": k_t})
    assert np.ptp(want[:, 0]) > 1.0
    assert np.ptp(want[:, 1]) > 4.0
    # What is left is how a recording is differentiated: rates are smoothed, most so at its ends.
    np.testing.assert_allclose(got / NOISE, want / NOISE, rtol=0.0, atol=0.03)


@pytest.mark.parametrize("k_t", [300.0, 700.0, 5000.0])
def test_half_the_step_changes_next_to_nothing(k_t: float) -> None:
    system = shoulder()
    for trial, most in ((raised_trial(0.0), 1e-3), (raised_trial(0.5), 2e-3), (shoulder_trial("t", 2.0, 1.0), 4e-3)):
        whole, half = (with_step(system, h).simulate(trial, {**VALUES, "k_t": k_t}) / NOISE for h in (1e-2, 5e-3))
        assert np.sqrt(np.mean((whole - half) ** 2)) < 1e-3
        assert np.abs(whole - half).max() < most  # support torques have kinks, without support there are none


def with_step(system: System, longest: float) -> System:
    return replace(system, geometry=replace(system.geometry, longest=longest))


def test_steps_are_of_fourth_order() -> None:
    trial = raised_trial(0.0, 0.04)  # without support: its torque is no smooth function of the angle
    got = [with_step(shoulder(), 0.04 / n).simulate(trial, VALUES) / NOISE for n in (4, 8, 16, 32)]
    errors = [float(np.sqrt(np.mean((a - b)[25:] ** 2))) for a, b in itertools.pairwise(got)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders.min() > 3.5, (errors, orders)


def test_an_arm_that_runs_away_is_not_followed_for_ever() -> None:
    """A damper that feeds energy, along an uneven clock; no interval begins with what is left of the last one."""
    time = np.cumsum(np.random.default_rng(1).uniform(0.016, 0.048, 300))
    nothing = np.full(time.size, np.nan)
    columns = {"arm": np.array([raised(t) for t in time]), "event": np.zeros(time.size)}
    thrown = recording("t", time, {**columns, "exo": nothing, "force": nothing}, level=1.0)
    with pytest.raises(NotConverged, match="the motion runs away"):
        shoulder().demand(thrown, {**VALUES, "b_t": -30.0})
    longest = max(len(path) for path in shoulder_exoskeleton._STEPS.values())
    assert longest <= 2 + MOST * (time.size + np.ptp(time) / SHORTEST)
    path = max(shoulder_exoskeleton._STEPS.values(), key=len)
    first = path[1:][path[:-1, shoulder_motion.SAMPLE] >= 0.0]
    assert first[:, shoulder_motion.STATE + shoulder_motion.STEP].min() >= 0.5 * SHORTEST


def pendulum(c: float) -> tuple[System, Trial, np.ndarray]:
    """A light spring on a still arm that is set off by a small step; its system, trial and time."""
    constants = {"L_h": 0.25, "o_x": 0.0, "o_y": 0.0, "I": 0.09, "c": c, "l_c": 0.2}
    parameters = tuple(Parameter(n, u, 1.0, 0.0, 1e4) for n, u in (("k_t", "N/m"), ("b_t", "N s/m"), ("m", "kg")))
    system = shoulder_exoskeleton.build(parameters, constants, {"support": support()})
    time = np.arange(601) * 0.005
    step = np.where(time < 0.02, 0.0, 1e-3)
    columns = {"arm": step, "event": np.zeros(time.size), "exo": step, "force": step}
    return system, recording("t", time, columns, level=0.0), time


@pytest.mark.parametrize("c", [0.0, 0.12])
def test_small_swings_are_those_of_a_linear_pendulum(c: float) -> None:
    system, trial, time = pendulum(c)
    got = system.simulate(trial, {"k_t": 200.0, "b_t": 0.0, "m": 2.0})[:, 0]
    stiff = 200.0 * 0.25**2 + 2.0 * GRAVITY * 0.2
    fade, rest = c / (2.0 * 0.09), 1e-3 * 200.0 * 0.25**2 / stiff
    omega = np.sqrt(stiff / 0.09 - fade**2)
    after = time > 0.05
    waves = np.exp(-fade * time) * np.array([np.cos(omega * time), np.sin(omega * time)])
    left = got - rest
    fitted = np.linalg.lstsq(waves[:, after].T, left[after], rcond=None)[0]
    assert np.hypot(*fitted) == pytest.approx(rest, rel=0.03)
    np.testing.assert_allclose(left[after], (fitted @ waves)[after], atol=2e-4 * rest)


def test_without_friction_a_swing_keeps_its_energy() -> None:
    system, trial, time = pendulum(0.0)
    got = system.simulate(trial, {"k_t": 200.0, "b_t": 0.0, "m": 2.0})[:, 0]
    first, last = np.ptp(got[(time > 0.05) & (time < 1.0)]), np.ptp(got[time > 2.0])
    assert last == pytest.approx(first, rel=2e-3)


@pytest.mark.parametrize("level", [0.0, 1.0])
@pytest.mark.parametrize("angle", [0.1, 1.0, 2.2])
def test_a_still_arm_stays_in_equilibrium(level: float, angle: float) -> None:
    time = np.arange(101) * 0.01
    still = np.full(101, angle)
    trial = recording("t", time, {"arm": still, "event": 0.0 * still, "exo": still, "force": still}, level=level)
    got = shoulder().simulate(trial, VALUES)
    np.testing.assert_allclose(got, got[:1].repeat(101, axis=0), atol=1e-7)
    known = {**SHOULDER_CONSTANTS, **VALUES}
    left, force = torque(got[0, 0], 0.0, angle, 0.0, known, level, support())
    assert left == pytest.approx(0.0, abs=1e-8)
    assert got[0, 1] == pytest.approx(force, rel=1e-9)


def with_effect(name: str, trial: Trial, **values: float) -> np.ndarray:
    system = shoulder()
    one = next(each for each in candidates(system.scaled([trial])) if each.label == name)
    given = {p.name: values[p.name.split(".")[-1]] for p in one.parameters}
    return one.apply(system).simulate(trial, {**VALUES, **given})


def test_a_wandering_shoulder_moves_the_hinge() -> None:
    trial = raised_trial(0.5)
    got = with_effect("axis_migration", trial, slope=0.03, curvature=0.0)
    base = shoulder().simulate(trial, VALUES)
    hinge = SHOULDER_CONSTANTS["o_x"] + 0.03 * trial.column("arm")[0]
    moved = replace(shoulder(), constants={**SHOULDER_CONSTANTS, "o_x": hinge}).simulate(trial, VALUES)
    assert got[0, 0] == pytest.approx(moved[0, 0], abs=1e-9)  # at rest: the hinge is where it is at this angle
    assert got[0, 1] == pytest.approx(moved[0, 1], abs=5e-3)
    assert np.abs(got - base)[:, 0].max() > 0.01


def test_friction_at_the_hinge_holds_the_arm() -> None:
    trial = raised_trial(0.5)
    base = shoulder().simulate(trial, VALUES)
    got = with_effect("dry_friction.rate", trial, limit=0.9, turning=0.02)
    lever = SHOULDER_CONSTANTS["L_h"]
    up = (np.gradient(got[:, 0], trial.time) > 0.5) & (np.gradient(base[:, 0], trial.time) > 0.5)
    down = (np.gradient(got[:, 0], trial.time) < -0.5) & (np.gradient(base[:, 0], trial.time) < -0.5)
    # Lifted against friction the exoskeleton pulls the arm down by T/s more, lowered it supports it by so much more.
    assert np.mean((got - base)[up, 1]) == pytest.approx(-0.9 / lever, rel=0.15)
    assert np.mean((got - base)[down, 1]) == pytest.approx(0.9 / lever, rel=0.15)


def test_more_inertia_is_the_same_as_a_larger_one() -> None:
    trial = raised_trial(0.5)
    heavy = replace(shoulder(), constants={**SHOULDER_CONSTANTS, "I": 0.13}).simulate(trial, VALUES)
    got = with_effect("inertia_load.exo", trial, inertia=0.13 - SHOULDER_CONSTANTS["I"])
    np.testing.assert_allclose(got, heavy, rtol=1e-12)


def test_more_weight_is_the_same_as_a_larger_mass() -> None:
    trial = raised_trial(0.5)
    got = with_effect("gravity_load.exo", trial, moment=0.4 * GRAVITY * SHOULDER_CONSTANTS["l_c"], phase=0.0)
    np.testing.assert_allclose(got, shoulder().simulate(trial, {**VALUES, "m": 2.0}), rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("k_t", [700.0, 1003.0, 1050.0, 2400.0])
def test_rounding_of_the_input_stays_rounding(k_t: float) -> None:
    """A step that ended in the middle of a bracket, not at the root, made 1e-8 rad of it, and slopes of that."""
    system, trial = shoulder(), raised_trial(0.5, 0.02)
    rng = np.random.default_rng(0)
    signals = trial.signals
    rounded = signals.values * (1.0 + 1e-15 * rng.standard_normal((len(trial), len(signals.channels))))  # noqa: PD011
    other = replace(trial, signals=replace(signals, values=rounded))
    known = {**VALUES, "k_t": k_t}
    off = np.abs(system.simulate(trial, known) - system.simulate(other, known)).max(axis=0)
    assert (off < 1e-11 * NOISE / NOISE[0]).all()


def test_a_linear_spring_in_series_is_a_softer_spring() -> None:
    trial = raised_trial(0.5)
    softer = with_effect("series_compliance", trial, compliance=1.0 / 2100.0, exponent=1.0)
    system, held = shoulder(), {**VALUES, "b_t": 0.0}
    one = next(each for each in candidates(system.scaled([trial])) if each.label == "series_compliance")
    values = {**held, one.parameters[0].name: 1.0 / 2100.0, one.parameters[1].name: 1.0}
    got = one.apply(system).simulate(trial, values)
    np.testing.assert_allclose(got, system.simulate(trial, {**held, "k_t": 525.0}), atol=1e-6)
    assert np.abs(softer - got).max() > 1e-3  # the dashpot stands beside the first spring, not beside both


def test_a_push_is_felt_by_the_sensor_alone_while_the_tool_runs() -> None:
    trial = shoulder_trial("t", 2.0, 0.5)
    base, got = shoulder().simulate(trial, VALUES), with_effect("event_load", trial, push=5.0, tau=0.0)
    np.testing.assert_array_equal(got[:, 0], base[:, 0])
    np.testing.assert_allclose((got - base)[:, 1], 5.0 * trial.column("event"), atol=1e-12)
    slow = with_effect("event_load", trial, push=5.0, tau=0.1)
    on = int(np.argmax(trial.column("event") > 0.5))
    assert 0.0 < (slow - base)[on + 5, 1] < 2.5 < (slow - base)[on + 20, 1] < 5.0


def test_missing_rows_change_little() -> None:
    trial = raised_trial(0.5)
    kept = np.r_[0:100, 103:250, 251:401]
    signals = replace(trial.signals, time=trial.time[kept], values=trial.signals.values[kept])  # noqa: PD011
    got = shoulder().simulate(replace(trial, signals=signals), VALUES)
    np.testing.assert_allclose(got / NOISE, shoulder().simulate(trial, VALUES)[kept] / NOISE, atol=0.05)


@pytest.mark.parametrize(
    ("tables", "constants", "words"),
    [
        ({}, {}, "table of support torques is missing"),
        ({"support": support().rename(columns={"torque [N m]": "torque [N]"})}, {}, "no column 'torque"),
        ({"support": support().iloc[::-1]}, {}, "do not increase"),
        ({"support": support()}, {"I": 0.0}, "is not positive"),
    ],
)
def test_what_is_wrong_is_said(tables: dict[str, pd.DataFrame], constants: dict[str, float], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        shoulder_exoskeleton.build(shoulder().parameters, {**SHOULDER_CONSTANTS, **constants}, tables)


def test_a_missing_number_is_named() -> None:
    without = {name: value for name, value in SHOULDER_CONSTANTS.items() if name != "l_c"}
    with pytest.raises(ValueError, match="l_c is missing"):
        shoulder_exoskeleton.build(shoulder().parameters, without, {"support": support()})
