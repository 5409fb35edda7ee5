"""The foot of CASES.md a second time: spheres in zones over level ground, with whatever is hooked in."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np
from jaxtyping import Float, Int

from geocontact.gap_benchmark.synthetic.body import SyntheticSystem
from geocontact.gap_benchmark.synthetic.compile import loop
from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs, Pull, Values, read
from geocontact.gap_benchmark.synthetic.systems.interface import NotConvergedError

INPUTS, OUTPUTS = ("x", "y", "pitch"), ("force_x", "force_y", "cop_x")
LEAST = 20.0
"""Force below which there is no centre of pressure [N]."""


@dataclass(frozen=True)
class Sole:
    """Spheres in the foot's frame [m], and which zone each belongs to."""

    px: Float[np.ndarray, " n"]
    py: Float[np.ndarray, " n"]
    radius: Float[np.ndarray, " n"]
    zone: Int[np.ndarray, " n"]
    names: tuple[str, ...]


def touch(course: InputCourse, sole: Sole) -> tuple[Values, Values, Values, Values]:
    """Depth [m], its rate, forward speed of the bottom [m/s], place of the contact along the foot [m]; "t n" each."""
    y, pitch = (row[:, None] for row in course.position[1:])
    x_rate, y_rate, turn = (row[:, None] for row in course.rate)
    s, c = np.sin(pitch), np.cos(pitch)
    up = sole.px * s + sole.py * c
    depth = sole.radius - y - up
    closing = -y_rate - turn * (sole.px * c - sole.py * s)
    speed = x_rate - turn * (up - sole.radius)
    return depth, closing, speed, sole.px - sole.radius * s


def grip(speed: Values, constants: Mapping[str, float]) -> Values:
    """Friction coefficient m(v)."""
    nodes = np.array([-3.0, -1.5, -1.0, 1.0, 1.5, 3.0]) * constants["v_th"]
    mu_s, mu_k = constants["mu_s"], constants["mu_k"]
    return np.asarray(np.interp(speed, nodes, np.array([-mu_k, -mu_k, -mu_s, mu_s, mu_k, mu_k])))


def onset(depth: Values, full: float) -> Values:
    """Share of the damping that acts at a depth."""
    u = np.clip(depth / full, 0.0, 1.0)
    return np.asarray(u * u * (3.0 - 2.0 * u))


def power(depth: Values, n: float) -> Values:
    """depth^n, 0 off the ground."""
    return np.asarray(np.maximum(depth, 0.0) ** n)


@loop
def give_way(
    time: Float[np.ndarray, " t"],
    depth: Float[np.ndarray, "t n"],
    closing: Float[np.ndarray, "t n"],
    k: Float[np.ndarray, " n"],
    b: Float[np.ndarray, " n"],
    n: float,
    full: float,
    soft: float,
    hard: float,
    limit: float,
) -> Float[np.ndarray, " t"]:
    """Height w(t) [m] by which the foot gives way to its load through two springs in a row, one of which bottoms out.

    w = hard F + (soft - hard) limit tanh(F / limit). Trapezoidal in w', by bisection.
    """
    way = np.zeros(time.size)
    for i in range(time.size):
        h = time[i] - time[i - 1] if i > 0 else 1.0
        low, high = 0.0, max(depth[i].max(), 0.0)
        for _ in range(60):
            w = 0.5 * (low + high)
            rate = (w - way[i - 1]) / h if i > 0 else 0.0
            force = 0.0
            for j in range(k.size):
                d = depth[i, j] - w
                if d > 0.0:
                    u = min(d / full, 1.0)
                    force += k[j] * d**n + b[j] * max(closing[i, j] - rate, 0.0) * u * u * (3.0 - 2.0 * u)
            if hard * force + (soft - hard) * limit * np.tanh(force / limit) > w:
                low = w
            else:
                high = w
        way[i] = 0.5 * (low + high)
    return way


def respond(course: InputCourse, numbers: Mapping[str, float], hooks: Hooks, sole: Sole) -> Float[np.ndarray, "c t"]:
    """force_x, force_y [N] and cop_x [m] along a course."""
    for moved in hooks.motion:
        course = moved(course)
    k = np.array([numbers[f"k_{name}"] for name in sole.names])[sole.zone]
    b = np.array([numbers[f"b_{name}"] for name in sole.names])[sole.zone]
    n, full = numbers["n"], numbers["delta_full"]
    depth, closing, speed, arm = touch(course, sole)
    time = course.time
    if hooks.series:
        if hooks.has_memory_in_law or len(hooks.series) > 1:
            raise NotConvergedError("a spring in series under the foot stands alone")
        soft, hard, limit = (float(v) for v in hooks.series[0](np.zeros(0)))
        way = give_way(time, depth, closing, k, b, n, full, soft, hard, limit)
        depth = depth - way[:, None]
        closing = closing - np.gradient(way, time)[:, None]
        # the pylon sits below the origin that is measured: the lever grows by what it gave way
        speed = speed - course.rate[2][:, None] * way[:, None]
    elastic = k * power(depth, n)
    for factor in hooks.spring:
        elastic = elastic * factor(time, depth, closing)
    force = elastic + b * np.maximum(closing, 0.0) * onset(depth, full) * (depth > 0.0)
    for term in hooks.beside:
        force = force + term(Pull(time, depth, closing, elastic))
    force = np.maximum(force, 0.0) * (depth > 0.0)
    vertical = force.sum(axis=1)
    moment = (force * arm).sum(axis=1)
    centre = np.divide(moment, vertical, out=np.zeros_like(moment), where=vertical > 0.0)
    outputs = np.array([-(force * grip(speed, numbers)).sum(axis=1), vertical, centre])
    for add in hooks.load:
        outputs = outputs + add(course, numbers)
    return read(hooks, course, outputs)


def base_model(course: InputCourse, constants: Mapping[str, float], sole: Sole) -> Callable[[Values], Values]:
    """Outputs of the base model as a function of (k per zone, b per zone); sums over spheres are taken once."""
    depth, closing, speed, arm = touch(course, sole)
    elastic = power(depth, constants["n"])
    viscous = np.maximum(closing, 0.0) * onset(depth, constants["delta_full"]) * (depth > 0.0)
    m = grip(speed, constants)
    member = (sole.zone[:, None] == np.arange(len(sole.names))).astype(float)
    across, up, turning = (
        np.hstack([(part * weight) @ member for part in (elastic, viscous)]) for weight in (-m, np.ones_like(m), arm)
    )

    def outputs(theta: Values) -> Values:
        vertical = up @ theta
        moment = turning @ theta
        centre = np.divide(moment, vertical, out=np.zeros_like(moment), where=vertical > 0.0)
        return np.array([across @ theta, vertical, centre])

    return outputs


def course_deflection(course: InputCourse, sole: Sole) -> tuple[Values, Values]:
    """Depths and their rates where in contact."""
    depth, closing, _, _ = touch(course, sole)
    inside = depth > 0.0
    return depth[inside], closing[inside]


def without_centre(outputs: Outputs) -> Outputs:
    """The centre of pressure is empty where the vertical force is small."""
    out = outputs.copy()
    out[2, out[1] < LEAST] = np.nan
    return out


def foot(sole: Sole) -> SyntheticSystem:
    """A foot with this sole."""
    return SyntheticSystem(
        partial(respond, sole=sole),
        partial(base_model, sole=sole),
        lambda course, _: course_deflection(course, sole),
        loads=(0, 1),
        normal=(1,),
        quotients={2: 1},
        patchy=(2,),
        recorded=without_centre,
    )
