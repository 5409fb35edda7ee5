"""Motions from equations: observed order, closed forms, energy, stiff contact, friction that sticks, derivatives."""

from __future__ import annotations

from pathlib import Path

import casadi
import numpy as np
import pytest
from casadi import SX
from scipy.special import ellipj, ellipk

from geocontact.contact.bristle_friction import bristle_force, deflection_rate
from geocontact.data.multibody.joint import prismatic
from geocontact.data.multibody.model import Body, Multibody
from geocontact.dynamics import compiled as code
from geocontact.dynamics import machine_code
from geocontact.dynamics.equations import Equations, LawState, equations_of_motion
from geocontact.dynamics.simulate import Stepper
from geocontact.dynamics.sphere_contact import SphereLaw, sole_wrench
from geocontact.dynamics.tree import tree_of
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.sphere_set import SphereSet
from tests.dynamics.models import all_kinds, free_ball, pendulum
from tests.dynamics.test_tree import energy

NONE = np.zeros(0)
X, Y, Z = np.eye(3)
GROUND = HalfSpace(normal=(0.0, 2.0, 0.0))
BALL = SphereSet(np.zeros((1, 3)), np.array([0.05]), ("ball",))


def slider(mass: float = 2.0) -> Multibody:
    """A body that slides along x without gravity."""
    solid = Body("b", mass, np.zeros(3), np.eye(3))
    return Multibody("slider", (solid,), (prismatic("s", "ground", "b", X),), (), np.zeros(3))


def spring(k: float, b: float, mass: float) -> Equations:
    tree = tree_of(slider(mass))
    return equations_of_motion(tree, along={"s": -k * tree.q[0] - b * tree.u[0]})


def end_errors(stepper: Stepper, start: tuple, time: np.ndarray, exact: np.ndarray, counts: tuple[int, ...]) -> list:
    return [float(np.abs(stepper.simulate(start, time, steps=n).q[-1] - exact).max()) for n in counts]


def orders(errors: list[float]) -> np.ndarray:
    return np.log2(np.array(errors[:-1]) / np.array(errors[1:]))


def test_order_on_a_pendulum_of_any_size() -> None:
    """Against Jacobi's elliptic functions, let go at 2 rad: errors shrink with the third power of the step."""
    length, g, wide = 0.7, 9.81, 2.0
    stepper = Stepper(equations_of_motion(tree_of(pendulum((length,), (1.3,)))))
    m = np.sin(wide / 2) ** 2
    time = np.linspace(0.0, 2.0, 5)
    sn = ellipj(ellipk(m) - np.sqrt(g / length) * time, m)[0]
    exact = 2.0 * np.arcsin(np.sqrt(m) * sn)
    start = (np.array([wide]), np.zeros(1), NONE)
    found = orders(end_errors(stepper, start, time, exact[-1:], (200, 400, 800, 1600)))
    assert np.all(found[1:] > 2.8) and np.all(found < 3.3), found
    course = stepper.simulate(start, time, tolerance=1e-9)
    np.testing.assert_allclose(course.q[:, 0], exact, atol=1e-7)
    assert np.abs(course.q[-1, 0] - exact[-1]) < course.error[0]


def test_order_holds_where_inputs_change() -> None:
    """A mass whose suspension is moved, and a force that swings: x'' + 4 x = cos 3t has a closed form."""
    tree = tree_of(slider(1.0))
    push = SX.sym("push")
    equations = equations_of_motion(tree, along={"s": push - 4.0 * tree.q[0]}, inputs=[push])
    stepper, time = Stepper(equations), np.array([0.0, 3.0])

    def inputs(t: float) -> tuple[np.ndarray, np.ndarray]:
        return np.array([np.cos(3 * t)]), np.array([-3 * np.sin(3 * t)])

    exact = (np.cos(2 * 3.0) - np.cos(9.0)) / 5.0
    start = (np.zeros(1), np.zeros(1), NONE)
    found = [abs(stepper.simulate(start, time, inputs=inputs, steps=n).q[-1, 0] - exact) for n in (100, 200, 400)]
    assert np.all(np.abs(orders(found) - 3.0) < 0.2), found


@pytest.mark.parametrize("count", [0, 1, 2])
def test_one_coordinate_takes_any_number_of_inputs(count: int) -> None:
    """x'' + 4 x = cos 3t + t, with as many terms of the right-hand side as there are inputs, from x = 1."""
    tree = tree_of(slider(1.0))
    pushes = [SX.sym(f"push{i}") for i in range(count)]
    equations = equations_of_motion(tree, along={"s": sum(pushes, -4.0 * tree.q[0])}, inputs=pushes)
    assert equations.w.shape == (count, 1)

    def inputs(t: float) -> tuple[np.ndarray, np.ndarray]:
        return np.array([np.cos(3 * t), t][:count]), np.array([-3 * np.sin(3 * t), 1.0][:count])

    time = np.linspace(0.0, 2.0, 9)
    terms = [(np.cos(2 * time) - np.cos(3 * time)) / 5.0, time / 4.0 - np.sin(2 * time) / 8.0]
    start = (np.ones(1), np.zeros(1), NONE)
    course = Stepper(equations, machine_code=False).simulate(start, time, inputs=inputs, tolerance=1e-9)
    np.testing.assert_allclose(course.q[:, 0], np.cos(2 * time) + sum(terms[:count]), atol=1e-7)


def test_derivative_by_a_parameter_without_inputs() -> None:
    """x'' = -k x from x = 1: dx/dk = -t sin(√k t) / (2 √k)."""
    k, tree = SX.sym("k"), tree_of(slider(1.0))
    equations = equations_of_motion(tree, along={"s": -k * tree.q[0]}, parameters=[k])
    stepper, time = Stepper(equations, machine_code=False, by_parameter=True), np.linspace(0.0, 1.0, 5)
    course = stepper.simulate((np.ones(1), np.zeros(1), NONE), time, parameters=np.array([4.0]), steps=400)
    np.testing.assert_allclose(course.by_parameter[:, 0, 0], -time * np.sin(2 * time) / 4.0, atol=1e-6)


@pytest.mark.parametrize("count", [1, 2])
def test_memories_grow_where_every_coordinate_is_prescribed(count: int) -> None:
    """z' = c (1 - z) along a course with rate 1: 1 - exp(-c t)."""
    tree, paces = tree_of(slider(1.0)), np.array([1.0, 3.0])[:count]
    memory = [LawState(z, c * (tree.u[0] - z)) for c in paces for z in [SX.sym("z")]]
    equations = equations_of_motion(tree, prescribed=["s"], memory=memory)
    assert (equations.q.shape, equations.balance.shape, equations.w.shape) == ((0, 1), (0, 1), (3, 1))
    time = np.linspace(0.0, 1.0, 5)
    course = Stepper(equations, machine_code=False).simulate(
        (NONE, NONE, np.zeros(count)), time, inputs=lambda t: (np.array([t, 1.0, 0.0]), X), tolerance=1e-9
    )
    np.testing.assert_allclose(course.z, 1.0 - np.exp(-np.outer(time, paces)), atol=1e-7)


def test_a_stiff_spring_costs_no_more_steps() -> None:
    """Damped a million times faster than it is watched: the fast part dies at once, as in an L-stable method."""
    soft, stiff = (Stepper(spring(k, b, 1.0)) for k, b in ((10.0, 1.0), (1e9, 1e8)))
    time = np.array([0.0, 2.0])
    counts = [s.simulate((np.array([0.1]), np.zeros(1), NONE), time, tolerance=1e-4).steps for s in (soft, stiff)]
    assert counts[1] < 3 * counts[0]
    last = stiff.simulate((np.array([0.1]), np.zeros(1), NONE), time, steps=20).q[-1, 0]
    assert last == pytest.approx(0.1 * np.exp(-10.0 * 2.0), abs=2e-5)


def test_energy_is_kept_where_nothing_takes_it() -> None:
    """Two branches with joints of every kind, half a second; what is lost shrinks with the tolerance."""
    tree = tree_of(all_kinds())
    stepper = Stepper(equations_of_motion(tree), machine_code=False)
    stored = casadi.Function("e", [tree.q, tree.u], [energy(tree)])
    n = len(tree.names)
    rng = np.random.default_rng(4)
    start = (rng.uniform(-0.4, 0.4, n), rng.normal(size=n) * 0.5, NONE)
    lost = []
    for tolerance in (1e-4, 1e-6):
        course = stepper.simulate(start, np.array([0.0, 0.3]), tolerance=tolerance)
        first, last = (float(stored(course.q[k], course.u[k])) for k in (0, -1))
        lost.append(abs(last - first) / abs(first))
    assert lost[1] < 1e-5 and lost[1] < 0.1 * lost[0]


def test_work_of_a_motor_is_the_change_of_energy() -> None:
    tree = tree_of(pendulum((0.7, 0.4), (1.3, 2.1)))
    torque = 3.0 - 0.5 * tree.u[0]
    stepper = Stepper(equations_of_motion(tree, along={"q0": torque}))
    stored = casadi.Function("e", [tree.q, tree.u], [energy(tree)])
    time = np.linspace(0.0, 1.0, 4001)
    course = stepper.simulate((np.zeros(2), np.zeros(2), NONE), time, tolerance=1e-9)
    power = (3.0 - 0.5 * course.u[:, 0]) * course.u[:, 0]
    change = float(stored(course.q[-1], course.u[-1])) - float(stored(course.q[0], course.u[0]))
    assert np.trapezoid(power, time) == pytest.approx(change, rel=1e-5)


def test_a_prescribed_joint_drives_the_others() -> None:
    """The first rod turns as it is told; the second moves as Lagrange's equation for it says."""
    (l1, l2), (m1, m2), g = (0.7, 0.4), (1.3, 2.1), 9.81
    stepper = Stepper(equations_of_motion(tree_of(pendulum((l1, l2), (m1, m2))), prescribed=["q0"]))

    def inputs(t: float) -> tuple[np.ndarray, np.ndarray]:
        s, c = np.sin(2 * t), np.cos(2 * t)
        return np.array([0.5 * s, c, -2 * s]), np.array([c, -2 * s, -4 * c])

    time = np.linspace(0.0, 1.5, 16)
    course = stepper.simulate((np.array([0.3]), np.zeros(1), NONE), time, inputs=inputs, tolerance=1e-9)
    assert course.names == ("q1",)

    def rate(t: float, y: np.ndarray) -> list[float]:
        (q1, u1, a1), (q2, u2) = inputs(t)[0], y
        turned = m2 * l2**2 * a1 + m2 * l1 * l2 * np.cos(q2) * a1 + m2 * l1 * l2 * np.sin(q2) * u1**2
        return [u2, -(turned + m2 * g * l2 * np.sin(q1 + q2)) / (m2 * l2**2)]

    from scipy.integrate import solve_ivp

    wanted = solve_ivp(rate, (0.0, 1.5), [0.3, 0.0], t_eval=time, rtol=1e-11, atol=1e-12)
    np.testing.assert_allclose(course.q[:, 0], wanted.y[0], atol=1e-7)


def test_a_dropped_ball_comes_to_rest_where_the_law_carries_it() -> None:
    """k d^n = m g, from the laws of the foot's spheres."""
    tree = tree_of(free_ball())
    law = SphereLaw(1e5, 1.5, 300.0, 1e-3, 0.01, 0.5, 0.4)
    loads = {"ball": sole_wrench(tree.bodies["ball"], BALL, [law], GROUND)}
    stepper = Stepper(equations_of_motion(tree, loads=loads))
    start = np.zeros(6)
    start[4] = 0.06
    course = stepper.simulate((start, np.zeros(6), NONE), np.array([0.0, 3.0]), tolerance=1e-6)
    assert 0.05 - course.q[-1, 4] == pytest.approx((2.0 * 9.81 / 1e5) ** (1 / 1.5), rel=1e-3)
    assert np.abs(course.u[-1]).max() < 1e-3


def test_a_ball_that_slides_begins_to_roll_at_five_sevenths_of_its_speed() -> None:
    tree = tree_of(free_ball())
    law = SphereLaw(1e9, 1.5, 0.0, 1e-3, 1e-4, 0.4, 0.4)
    loads = {"ball": sole_wrench(tree.bodies["ball"], BALL, [law], GROUND)}
    start, speed = np.zeros(6), np.zeros(6)
    start[4], speed[3] = 0.05 - (2.0 * 9.81 / 1e9) ** (1 / 1.5), 1.0
    course = Stepper(equations_of_motion(tree, loads=loads)).simulate(
        (start, speed, NONE), np.array([0.0, 0.5]), tolerance=1e-6
    )
    assert course.u[-1, 3] == pytest.approx(5 / 7, rel=2e-3)
    assert course.u[-1, 2] == pytest.approx(-5 / 7 / 0.05, rel=3e-3)


def sticking(push: float) -> Stepper:
    """2 kg on bristles of 1e5 N/m that hold 4 N, pushed by a force that comes and goes."""
    tree = tree_of(slider())
    s, force = SX.sym("bristles"), SX.sym("push")
    growth = deflection_rate(s, tree.u[0], 4.0 / 1e5, 0.7)
    friction = bristle_force(s, growth, 1e5, 300.0)
    along = {"s": push * force + friction}
    return Stepper(equations_of_motion(tree, along=along, memory=[LawState(s, growth)], inputs=[force]))


def there_and_back(t: float) -> tuple[np.ndarray, np.ndarray]:
    """1 - cos, twice."""
    return np.array([0.5 - 0.5 * np.cos(2 * np.pi * t)]), np.array([np.pi * np.sin(2 * np.pi * t)])


def test_what_sticks_moves_elastically_and_comes_back() -> None:
    """2 N where 4 would slide: the place follows the force over the bristles' stiffness and does not creep away."""
    time = np.linspace(0.0, 2.0, 41)
    course = sticking(2.0).simulate(
        (np.zeros(1), np.zeros(1), np.zeros(1)), time, inputs=there_and_back, tolerance=1e-7
    )
    wanted = np.array([2.0 * there_and_back(t)[0][0] for t in time]) / 1e5
    np.testing.assert_allclose(course.q[:, 0], wanted, atol=0.02 * wanted.max())
    assert abs(course.q[-1, 0]) < 1e-3 * wanted.max()

    # at rest under a constant push nothing creeps
    def held(t: float) -> tuple[np.ndarray, np.ndarray]:
        return np.array([1.0]), np.zeros(1)

    rest = sticking(2.0).simulate((np.zeros(1), np.zeros(1), np.zeros(1)), np.linspace(0, 60, 61), inputs=held)
    assert abs(rest.q[-1, 0] - rest.q[30, 0]) < 1e-9
    slid = sticking(6.0).simulate((np.zeros(1), np.zeros(1), np.zeros(1)), time, inputs=there_and_back)
    assert slid.q[-1, 0] > 1e-2 and slid.z.max() == pytest.approx(4e-5, rel=1e-3)


def test_derivatives_by_parameters() -> None:
    """Masses, a joint's place, a motor's stiffness: against differences of whole motions with the same steps."""
    mass, place, k = SX.sym("m"), SX.sym("place", 3), SX.sym("k")
    tree = tree_of(pendulum((0.7, 0.4), (1.3, 2.1)), masses={"bob1": mass}, places={"pin1": place})
    p = casadi.vertcat(mass, place, k)
    equations = equations_of_motion(tree, along={"q1": -k * tree.q[1]}, parameters=[p])
    start, time = (np.array([0.6, -0.3]), np.zeros(2), NONE), np.linspace(0.0, 0.8, 9)
    values = np.array([2.1, 0.0, -0.7, 0.0, 1.5])
    stepper = Stepper(equations, by_parameter=True)
    course = stepper.simulate(start, time, parameters=values, steps=200)
    assert course.by_parameter.shape == (9, 4, 5)
    for i in range(5):
        step = 1e-5 * np.eye(5)[i]
        up, down = (stepper.simulate(start, time, parameters=values + s * step, steps=200) for s in (1, -1))
        slope = (np.hstack([up.q, up.u]) - np.hstack([down.q, down.u])) / 2e-5
        np.testing.assert_allclose(course.by_parameter[:, :, i], slope, atol=1e-7)
    assert np.abs(course.by_parameter[-1]).max(axis=0)[[0, 2, 4]].min() > 1e-3
    np.testing.assert_array_equal(
        Stepper(equations).simulate(start, time, parameters=values, steps=9).by_parameter.shape, (9, 4, 0)
    )


def _forget() -> None:
    """As in a new process."""
    machine_code._IN_MEMORY.clear()
    code._LOADED.clear()


def test_all_ways_of_evaluation_agree(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """CasADi's own, machine code in Python's loop and in C's; both kinds of code are kept and used again."""
    monkeypatch.setenv("GEOCONTACT_CACHE", str(tmp_path))
    _forget()
    equations = equations_of_motion(tree_of(pendulum((0.7, 0.4), (1.3, 2.1))))
    start, time = (np.array([1.0, 0.2]), np.zeros(2), NONE), np.linspace(0.0, 1.0, 5)
    steppers = [Stepper(equations, machine_code=False)]
    assert not steppers[0].compiled and steppers[0].loop is None
    if code.compiler() is not None:
        steppers.append(Stepper(equations))
        assert steppers[-1].compiled and steppers[-1].loop is not None
        made = {each: each.stat().st_mtime_ns for each in tmp_path.iterdir()}
        assert sorted(each.suffix for each in made) == [".o", ".so"]
        for forgotten in (False, True):
            if forgotten:
                _forget()
            assert Stepper(equations).loop is not None
            assert {each: each.stat().st_mtime_ns for each in tmp_path.iterdir()} == made
        (library,) = tmp_path.glob("*.so")
        library.write_bytes(b"damaged")
        _forget()
        steppers.append(Stepper(equations))
        assert steppers[-1].loop is not None and library.read_bytes() != b"damaged"
    for without in (lambda: None, lambda: "/nowhere/cc"):
        monkeypatch.setattr(code, "compiler", without)
        steppers.append(Stepper(equations))
        assert steppers[-1].compiled and steppers[-1].loop is None
    runs = [each.simulate(start, time, tolerance=1e-8) for each in steppers]
    for each in runs[1:]:
        for name in ("q", "u", "ends", "error"):
            np.testing.assert_array_equal(
                getattr(each, name), getattr(runs[0], name), "the same operations in the same order"
            )


def test_what_cannot_go_on_says_so() -> None:
    """A force that grows beyond all bounds in finite time."""
    tree = tree_of(slider(1.0))
    stepper = Stepper(equations_of_motion(tree, along={"s": 6.0 * tree.q[0] ** 2}))
    with pytest.raises(ArithmeticError, match="no step is short enough at 1"):
        stepper.simulate((np.ones(1), 2.0 * np.ones(1), NONE), np.array([0.0, 2.0]), tolerance=1e-4)
    with pytest.raises(ValueError, match="1 parameters given, 0 needed"):
        stepper.simulate((np.ones(1), np.ones(1), NONE), np.array([0.0, 1.0]), parameters=np.ones(1))
    with pytest.raises(ValueError, match="there is no coordinate knee"):
        equations_of_motion(tree, prescribed=["knee"])
