"""Torques about the hinges of a chain whose spheres press each on a plane, their exact derivatives.

Everything is in the frame K that carries the chain. A joint j stands at P and turns about A; what moves with it goes by
J(p) = A × (p - P) per rate. For a point that joint k carries as well, dJ_j/dy_k is A_k × J_j for k <= j and A_j × J_k
for k > j.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

from geocontact.below_knee_prosthesis.keel.chain_kernel import Vector, along, carried, chain, cross, dot, plus, row
from geocontact.contact import sphere_foot
from geocontact.dynamics.sphere_contact import STILL
from geocontact.geometry.kernels.compile import kernel

RADIUS, K, B, STATIC, KINETIC = range(5)
"""Rows of the spheres' numbers."""
EXPONENT, FULL_DEPTH, THRESHOLD = range(3)
"""Numbers that all spheres share."""

normal_force = kernel(sphere_foot.normal_force)
friction_coefficient = kernel(sphere_foot.friction_coefficient)


@kernel
def force_slopes(depth: float, rate: float, k: float, n: float, b: float, full: float) -> tuple[float, float]:
    """Derivatives of `sphere_foot.normal_force` by depth and rate where depth > 0."""
    u = min(depth / full, 1.0)
    approach = max(rate, 0.0)
    by_depth = k * n * max(depth, 1e-12) ** (n - 1.0)
    if u < 1.0:
        by_depth += b * approach * 6.0 * u * (1.0 - u) / full
    return by_depth, (b * u * u * (3.0 - 2.0 * u) if rate > 0.0 else 0.0)


@kernel
def friction_slope(speed: float, threshold: float, static: float, kinetic: float) -> float:
    """Derivative of `sphere_foot.friction_coefficient` by speed >= 0."""
    u = speed / threshold
    if u < sphere_foot.STATIC:
        return static / threshold
    if u < sphere_foot.SLIDING:
        return (kinetic - static) / (sphere_foot.SLIDING - sphere_foot.STATIC) / threshold
    return 0.0


@kernel
def sphere_force(
    outputs: Float[np.ndarray, " outputs"],
    numbers: Float[np.ndarray, " five"],
    law: Float[np.ndarray, " three"],
    n: Vector,
    v: Vector,
    sliding: Vector,
    depth: float,
) -> tuple[Vector, Vector, Vector, Vector, float, float]:
    """Force of a sphere that touches, and what its change is made of.

    Pressing and force are written to `outputs`. Returned are the force, the same per pressing, the direction of
    sliding, the slopes of the pressing by depth and rate and of the friction by speed, the friction, and the speed,
    which is never 0.
    """
    rate = -dot(n, v)
    pressing = normal_force(depth, rate, numbers[K], law[EXPONENT], numbers[B], law[FULL_DEPTH])
    by_depth, by_rate = force_slopes(depth, rate, numbers[K], law[EXPONENT], numbers[B], law[FULL_DEPTH])
    speed = np.sqrt(dot(sliding, sliding) + STILL * STILL)
    mu = friction_coefficient(speed, law[THRESHOLD], numbers[STATIC], numbers[KINETIC])
    by_speed = friction_slope(speed, law[THRESHOLD], numbers[STATIC], numbers[KINETIC])
    direction = plus((0.0, 0.0, 0.0), sliding, 1.0 / speed)
    per_pressing = plus(n, direction, -mu)
    force = plus((0.0, 0.0, 0.0), per_pressing, pressing)
    outputs[2] = pressing
    outputs[3], outputs[4], outputs[5] = force
    return force, per_pressing, direction, (by_depth, by_rate, pressing * by_speed), pressing * mu, speed


@kernel
def add_sphere(
    torque: Float[np.ndarray, " m"],
    slope: Float[np.ndarray, "m m"],
    outputs: Float[np.ndarray, " outputs"],
    point: Float[np.ndarray, " 3"],
    last: int,
    numbers: Float[np.ndarray, " five"],
    law: Float[np.ndarray, " three"],
    plane: Float[np.ndarray, " four"],
    twist: Float[np.ndarray, " six"],
    speeds: Float[np.ndarray, " m"],
    per_time: float,
    rest: Float[np.ndarray, "m 3"],
    place: Float[np.ndarray, "m 3"],
    axis: Float[np.ndarray, "m 3"],
    turned: Float[np.ndarray, "m 3 3"],
    goes: Float[np.ndarray, "m 3"],
) -> None:
    """A sphere's part in torques and derivatives; `outputs`: depth, its rate, pressing, force, centre, sliding."""
    n, spin, flow = (plane[0], plane[1], plane[2]), (twist[0], twist[1], twist[2]), (twist[3], twist[4], twist[5])
    radius = numbers[RADIUS]
    c = carried(point, last, rest, place, turned)
    height = dot(n, c) + plane[3]
    v, whole = plus(flow, cross(spin, c), 1.0), spin
    for j in range(last + 1):
        way = cross(row(axis, j), plus(c, row(place, j), -1.0))
        goes[j, 0], goes[j, 1], goes[j, 2] = way
        v, whole = plus(v, way, speeds[j]), plus(whole, row(axis, j), speeds[j])
    sliding = along(n, plus(v, cross(whole, n), -radius))
    outputs[0], outputs[1], outputs[2], outputs[3], outputs[4], outputs[5] = (
        radius - height,
        -dot(n, v),
        0.0,
        0.0,
        0.0,
        0.0,
    )
    outputs[6], outputs[7], outputs[8] = c
    outputs[9], outputs[10], outputs[11] = sliding
    if not radius - height > 0.0:
        return
    force, per_pressing, direction, slopes, rubbing, speed = sphere_force(
        outputs, numbers, law, n, v, sliding, radius - height
    )
    ground = plus(c, n, -height)
    ahead, spun = plus(plus(v, flow, -1.0), cross(spin, c), -1.0), plus(whole, spin, -1.0)
    behind = spin
    for k in range(last + 1):
        axis_k, goes_k = row(axis, k), row(goes, k)
        # a point's velocity changes by A_k × what joints from k on do, and by what turns joint k itself
        spun = plus(spun, axis_k, -speeds[k])
        dv = plus(plus(cross(axis_k, ahead), cross(behind, goes_k), 1.0), goes_k, per_time)
        dspin = plus(cross(axis_k, spun), axis_k, per_time)
        ahead, behind = plus(ahead, goes_k, -speeds[k]), plus(behind, axis_k, speeds[k])
        sinking = -dot(n, goes_k)
        dpressing = slopes[0] * sinking - slopes[1] * dot(n, dv)
        dsliding = along(n, plus(dv, cross(dspin, n), -radius))
        dspeed = dot(direction, dsliding)
        dforce = plus(plus((0.0, 0.0, 0.0), per_pressing, dpressing), direction, (rubbing / speed - slopes[2]) * dspeed)
        dforce = plus(dforce, dsliding, -rubbing / speed)
        dground = plus(goes_k, n, sinking)
        for j in range(last + 1):
            axis_j, place_j = row(axis, j), row(place, j)
            arm = plus(ground, place_j, -1.0)
            change = dot(cross(axis_j, arm), dforce)
            moved = dground
            if k < j:
                moved = plus(moved, cross(axis_k, plus(place_j, row(place, k), -1.0)), -1.0)
                change += dot(cross(axis_k, axis_j), cross(arm, force))
            slope[j, k] += change + dot(moved, cross(force, axis_j))
        torque[k] += dot(cross(axis_k, plus(ground, row(place, k), -1.0)), force)


@kernel
def add_weight(
    torque: Float[np.ndarray, " m"],
    slope: Float[np.ndarray, "m m"],
    point: Float[np.ndarray, " 3"],
    last: int,
    force: Vector,
    rest: Float[np.ndarray, "m 3"],
    place: Float[np.ndarray, "m 3"],
    axis: Float[np.ndarray, "m 3"],
    turned: Float[np.ndarray, "m 3 3"],
) -> None:
    """A constant force's part, at a point that joint `last` carries."""
    c = carried(point, last, rest, place, turned)
    for j in range(last + 1):
        goes = cross(row(axis, j), plus(c, row(place, j), -1.0))
        torque[j] += dot(goes, force)
        slope[j, j] += dot(cross(row(axis, j), goes), force)
        for k in range(j):
            both = dot(cross(row(axis, k), goes), force)
            slope[j, k] += both
            slope[k, j] += both


@kernel
def rubbed(turned: float, before: float, reach: float) -> tuple[float, float]:
    """Friction over its limit after a further turn, z' = (1 - z sign) / reach along it, and its derivative (Dahl)."""
    way = 1.0 if turned >= 0.0 else -1.0
    z = way + (before - way) * np.exp(-way * turned / reach)
    return z, (1.0 - way * z) / reach


@kernel
def balance(
    y: Float[np.ndarray, " m"],
    before: Float[np.ndarray, " m"],
    per_time: float,
    springs: Float[np.ndarray, "five m"],
    memory: Float[np.ndarray, "two m"],
    rest: Float[np.ndarray, "m 3"],
    axes: Float[np.ndarray, "m 3"],
    points: Float[np.ndarray, "n 3"],
    last: Int[np.ndarray, " n"],
    numbers: Float[np.ndarray, "n five"],
    law: Float[np.ndarray, " three"],
    weights: Float[np.ndarray, " w"],
    centres: Float[np.ndarray, "w 3"],
    bearer: Int[np.ndarray, " w"],
    planes: Float[np.ndarray, "n four"],
    twist: Float[np.ndarray, " six"],
    gravity: Float[np.ndarray, " 3"],
    torque: Float[np.ndarray, " m"],
    slope: Float[np.ndarray, "m m"],
    outputs: Float[np.ndarray, "n outputs"],
) -> None:
    """Torques about the joints and their derivatives, and what the spheres do.

    Parameters
    ----------
    springs
        Stiffness, damping, friction over the angle's size and at any angle, and the turn over which both build up.
    memory
        Angles and friction over its limit in the frame before.
    planes
        Under each sphere: normal, and height of K's origin.
    """
    speeds = np.empty(y.size)
    place, axis, turned = chain(y, rest, axes)
    goes = np.empty((y.size, 3))
    for j in range(y.size):
        speeds[j] = per_time * (y[j] - before[j])
        for k in range(y.size):
            slope[j, k] = 0.0
        torque[j] = -springs[0, j] * y[j] - springs[1, j] * speeds[j]
        slope[j, j] = -springs[0, j] - springs[1, j] * per_time
        if springs[2, j] + springs[3, j] > 0.0:
            z, by_turn = rubbed(y[j] - memory[0, j], memory[1, j], springs[4, j])
            limit = springs[2, j] * abs(y[j]) + springs[3, j]
            torque[j] -= limit * z
            slope[j, j] -= springs[2, j] * (z if y[j] >= 0.0 else -z) + limit * by_turn
    for i in range(weights.size):
        heavy = (weights[i] * gravity[0], weights[i] * gravity[1], weights[i] * gravity[2])
        add_weight(torque, slope, centres[i], bearer[i], heavy, rest, place, axis, turned)
    for i in range(last.size):
        add_sphere(
            torque,
            slope,
            outputs[i],
            points[i],
            last[i],
            numbers[i],
            law,
            planes[i],
            twist,
            speeds,
            per_time,
            rest,
            place,
            axis,
            turned,
            goes,
        )
