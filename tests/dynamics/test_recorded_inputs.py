"""Recordings as inputs: derivatives in closed form, gaps, and the loop in machine code beside that in Python."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from casadi import SX

from geocontact.dynamics import compiled as code
from geocontact.dynamics.equations import LawState, equations_of_motion
from geocontact.dynamics.recorded_inputs import RecordedInputs, recorded_inputs, stepped_inputs
from geocontact.dynamics.simulate import Stepper
from geocontact.dynamics.tree import tree_of
from geocontact.identify.signals.filters import filled_and_smoothed
from tests.dynamics.models import pendulum

NONE = np.zeros(0)


def sines(time: np.ndarray, k: int = 0) -> np.ndarray:
    """Derivative k of two sines."""
    pace = np.array([3.0, 5.0])
    return pace**k * np.sin(np.multiply.outer(time, pace) + 0.5 * np.pi * k)


def test_derivatives_converge_to_those_of_the_motion() -> None:
    """Values, rates and accelerations, in this order; errors fall with the powers 6, 5 and 4 of the interval."""
    wanted = np.linspace(0.5, 1.5, 77)
    errors = []
    for count in (101, 201):
        time = np.linspace(0.0, 2.0, count)
        found = recorded_inputs(time, sines(time), derivatives=2).at(wanted).reshape(len(wanted), 3, 2)
        errors.append([np.abs(found[:, k] - sines(wanted, k)).max() for k in range(3)])
    orders = np.log2(np.array(errors[0]) / np.array(errors[1]))
    np.testing.assert_allclose(orders, [6.0, 5.0, 4.0], atol=0.3)


def test_a_single_time_gives_values_and_slopes() -> None:
    time = np.linspace(0.0, 2.0, 41)
    inputs = recorded_inputs(time, sines(time), derivatives=1)
    value, slope = inputs(0.73)
    np.testing.assert_allclose(value, inputs.at(np.array([0.73]))[0], atol=1e-14)
    np.testing.assert_allclose(slope[:2], value[2:], atol=1e-12)


def test_inputs_of_several_kinds_stand_side_by_side() -> None:
    time = np.linspace(0.0, 1.0, 11)
    curve, level = recorded_inputs(time, sines(time)), stepped_inputs(time, np.arange(10.0)[:, None])
    both = curve.beside(level)
    for t in (0.0, 0.31, 0.55, 0.999):
        value, slope = both(t)
        np.testing.assert_allclose(value, [*curve(t)[0], np.floor(10.0 * t + 1e-9)], atol=1e-13)
        np.testing.assert_allclose(slope, [*curve(t)[1], 0.0], atol=1e-12)
    with pytest.raises(ValueError, match="5 samples are too few"):
        recorded_inputs(time[:5], sines(time[:5]))
    with pytest.raises(ValueError, match="samples are missing"):
        recorded_inputs(time, np.where(time > 0.5, np.nan, 1.0)[:, None])


def test_gaps_are_bridged_up_to_a_limit() -> None:
    """A tenth of a second of slow sines is bridged within 3 % of their size, more is refused."""
    time = np.linspace(0.0, 2.0, 201)
    values = sines(time)
    values[60:69, 1] = np.nan
    even, filled = filled_and_smoothed(time, values, cutoff=None, longest_gap=0.1)
    np.testing.assert_array_equal(even, time)
    np.testing.assert_allclose(filled, sines(time), atol=0.03)
    values[60:90, 1] = np.nan
    with pytest.raises(ValueError, match=r"column 2 has a gap of 0\.31 s after 0\.59 s; up to 0\.1 s is bridged"):
        filled_and_smoothed(time, values, cutoff=None, longest_gap=0.1)
    values = sines(time)
    values[:30, 0] = np.nan
    with pytest.raises(ValueError, match=r"column 1 has a gap of 0\.3 s after 0 s"):
        filled_and_smoothed(time, values, cutoff=None, longest_gap=0.1)


def test_the_low_pass_takes_noise_and_leaves_the_motion() -> None:
    time = np.linspace(0.0, 4.0, 401)
    shaken = sines(time) + 0.1 * np.sin(2 * np.pi * 40.0 * time)[:, None]
    _, smooth = filled_and_smoothed(time, shaken, cutoff=6.0, longest_gap=0.1)
    inside = (time > 0.5) & (time < 3.5)
    assert np.abs(smooth - sines(time))[inside].max() < 5e-3


def driven() -> Stepper:
    """A double pendulum whose first rod is prescribed, with a memory of its second rod's rate."""
    tree = tree_of(pendulum((0.7, 0.4), (1.3, 2.1)))
    z = SX.sym("z")
    memory = [LawState(z, 4.0 * (tree.u[1] - z))]
    return Stepper(equations_of_motion(tree, prescribed=["q0"], memory=memory, along={"q1": -0.5 * z}))


@pytest.mark.skipif(code.compiler() is None, reason="no C compiler")
@pytest.mark.parametrize("how", [{"tolerance": 1e-7}, {"steps": 500}, {"tolerance": 1e-5, "longest": 5e-3}])
def test_both_loops_take_the_same_steps(how: dict[str, float]) -> None:
    stepper, time = driven(), np.linspace(0.0, 2.0, 41)
    inputs = recorded_inputs(time, sines(time)[:, :1], derivatives=2)
    start = (np.array([0.3]), np.zeros(1), np.zeros(1))
    wanted = np.linspace(0.1, 1.9, 33)
    fast = stepper.simulate(start, wanted, inputs=inputs, **how)
    assert stepper.loop is not None
    stepper.loop = None
    slow = stepper.simulate(start, wanted, inputs=inputs, **how)
    assert (fast.steps, fast.refused) == (slow.steps, slow.refused)
    for name in ("q", "u", "z", "error"):
        np.testing.assert_allclose(getattr(fast, name), getattr(slow, name), rtol=1e-9, atol=1e-12)
    assert np.ptp(fast.q) > 0.3


@pytest.mark.parametrize("loop", [True, False])
def test_inputs_have_to_fit(loop: bool) -> None:
    stepper, time = driven(), np.linspace(0.0, 2.0, 41)
    if not loop:
        stepper.loop = None
    start, inputs = (np.zeros(1), np.zeros(1), np.zeros(1)), recorded_inputs(time, sines(time)[:, :1], derivatives=2)
    with pytest.raises(ValueError, match="known from 0 to 2 s, wanted from 0 to 3 s"):
        stepper.simulate(start, np.array([0.0, 3.0]), inputs=inputs)
    with pytest.raises(ValueError, match="2 inputs given, 3 needed"):
        stepper.simulate(start, time, inputs=replace(inputs, coefficients=inputs.coefficients[:, :2]))
    endless = RecordedInputs(inputs.breaks, np.full_like(inputs.coefficients, np.nan))
    with pytest.raises(ArithmeticError, match="no step is short enough at 0 s"):
        stepper.simulate(start, time, inputs=endless)
