"""Torques about the hinges of a chain whose spheres press on a plane, their exact derivatives, and Newton's steps.

Everything is in the frame K that carries the chain. A joint j stands at P and turns about A; what moves with it goes by
J(p) = A × (p - P) per rate. For a point that joint k carries as well, dJ_j/dy_k is A_k × J_j for k <= j and A_j × J_k
for k > j. Rates of the joints are backward differences, so that each frame is a step of the implicit Euler rule without
inertia; 1/dt = 0 leaves them out.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.contact import sphere_foot
from geocontact.dynamics.sphere_contact import STILL
from geocontact.geometry.kernels.compile import kernel

MOST, HALVINGS = 60, 20
"""Steps in a frame, and how often one is halved until the torques that are left have shrunk."""
RADIUS, K, B, STATIC, KINETIC = range(5)
"""Rows of the spheres' numbers."""
EXPONENT, FULL_DEPTH, THRESHOLD = range(3)
"""Numbers that all spheres share."""

normal_force = kernel(sphere_foot.normal_force)
friction_coefficient = kernel(sphere_foot.friction_coefficient)


@kernel
def cross(a: Float[np.ndarray, " 3"], b: Float[np.ndarray, " 3"]) -> Float[np.ndarray, " 3"]:
    """A vector product, which numba's own takes longer for."""
    out = np.empty(3)
    out[0] = a[1] * b[2] - a[2] * b[1]
    out[1] = a[2] * b[0] - a[0] * b[2]
    out[2] = a[0] * b[1] - a[1] * b[0]
    return out


@kernel
def dot(a: Float[np.ndarray, " 3"], b: Float[np.ndarray, " 3"]) -> float:
    """A scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def chain(
    y: Float[np.ndarray, " m"], rest: Float[np.ndarray, "m 3"], axes: Float[np.ndarray, "m 3"]
) -> tuple[Float[np.ndarray, "m 3"], Float[np.ndarray, "m 3"], Float[np.ndarray, "m 3 3"]]:
    """Places and axes of the joints, and how each has turned what it carries."""
    count = y.size
    place, axis, turned = np.empty((count, 3)), np.empty((count, 3)), np.empty((count, 3, 3))
    before, own = np.eye(3), np.empty((3, 3))
    for j in range(count):
        for r in range(3):
            if j == 0:
                place[j, r] = rest[j, r]
            else:
                place[j, r] = place[j - 1, r]
                for q in range(3):
                    place[j, r] += before[r, q] * (rest[j, q] - rest[j - 1, q])
            axis[j, r] = before[r, 0] * axes[j, 0] + before[r, 1] * axes[j, 1] + before[r, 2] * axes[j, 2]
        s, c = np.sin(y[j]), np.cos(y[j])
        a = axes[j]
        for r in range(3):
            for q in range(3):
                own[r, q] = (1.0 - c) * a[r] * a[q] + (c if r == q else 0.0)
        own[0, 1] -= s * a[2]
        own[0, 2] += s * a[1]
        own[1, 0] += s * a[2]
        own[1, 2] -= s * a[0]
        own[2, 0] -= s * a[1]
        own[2, 1] += s * a[0]
        for r in range(3):
            for q in range(3):
                turned[j, r, q] = before[r, 0] * own[0, q] + before[r, 1] * own[1, q] + before[r, 2] * own[2, q]
        before = turned[j].copy()
    return place, axis, turned


@kernel
def carried(
    point: Float[np.ndarray, " 3"],
    last: int,
    rest: Float[np.ndarray, "m 3"],
    place: Float[np.ndarray, "m 3"],
    turned: Float[np.ndarray, "m 3 3"],
) -> Float[np.ndarray, " 3"]:
    """Where a point that joint `last` carries has come to; -1 for a point of K."""
    if last < 0:
        return point.copy()
    out = place[last].copy()
    for r in range(3):
        for q in range(3):
            out[r] += turned[last, r, q] * (point[q] - rest[last, q])
    return out


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
def add_sphere(
    torque: Float[np.ndarray, " m"],
    slope: Float[np.ndarray, "m m"],
    told: Float[np.ndarray, " told"],
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
) -> None:
    """A sphere's part in torques and derivatives; told: depth, its rate, pressing, force, centre, sliding."""
    n, spin, flow = plane[:3], twist[:3], twist[3:]
    count = last + 1
    c = carried(point, last, rest, place, turned)
    height = dot(n, c) + plane[3]
    depth, radius = numbers[RADIUS] - height, numbers[RADIUS]
    goes = np.empty((count, 3))
    v, whole = flow + cross(spin, c), spin.copy()
    for j in range(count):
        goes[j] = cross(axis[j], c - place[j])
        v += speeds[j] * goes[j]
        whole += speeds[j] * axis[j]
    rate = -dot(n, v)
    told[0], told[1], told[2] = depth, rate, 0.0
    told[3:6] = 0.0
    told[6:9] = c
    moving = v - radius * cross(whole, n)
    sliding = moving - dot(n, moving) * n
    told[9] = np.sqrt(dot(sliding, sliding))
    if not depth > 0.0:
        return
    pressing = normal_force(depth, rate, numbers[K], law[EXPONENT], numbers[B], law[FULL_DEPTH])
    by_depth, by_rate = force_slopes(depth, rate, numbers[K], law[EXPONENT], numbers[B], law[FULL_DEPTH])
    speed = np.sqrt(dot(sliding, sliding) + STILL * STILL)
    mu = friction_coefficient(speed, law[THRESHOLD], numbers[STATIC], numbers[KINETIC])
    by_speed = friction_slope(speed, law[THRESHOLD], numbers[STATIC], numbers[KINETIC])
    direction = sliding / speed
    force = pressing * (n - mu * direction)
    told[2] = pressing
    told[3:6] = force
    ground = c - height * n
    work = np.empty((count, 3))
    for j in range(count):
        work[j] = cross(axis[j], ground - place[j])
        torque[j] += dot(work[j], force)
    for k in range(count):
        dv, dspin = cross(spin, goes[k]) + per_time * goes[k], per_time * axis[k]
        for j in range(count):
            dv = dv + speeds[j] * (cross(axis[k], goes[j]) if k <= j else cross(axis[j], goes[k]))
            if k < j:
                dspin = dspin + speeds[j] * cross(axis[k], axis[j])
        sinking = -dot(n, goes[k])
        dpressing = by_depth * sinking - by_rate * dot(n, dv)
        dmoving = dv - radius * cross(dspin, n)
        dsliding = dmoving - dot(n, dmoving) * n
        dspeed = dot(sliding, dsliding) / speed
        ddirection = dsliding / speed - sliding * (dspeed / speed**2)
        dforce = dpressing * (n - mu * direction) - pressing * (by_speed * dspeed * direction + mu * ddirection)
        dground = goes[k] + sinking * n
        for j in range(count):
            slope[j, k] += dot(work[j], dforce)
            if k < j:
                dplace = cross(axis[k], place[j] - place[k])
                daxis = cross(axis[k], axis[j])
                dwork = cross(daxis, ground - place[j]) + cross(axis[j], dground - dplace)
            else:
                dwork = cross(axis[j], dground)
            slope[j, k] += dot(dwork, force)


@kernel
def add_weight(
    torque: Float[np.ndarray, " m"],
    slope: Float[np.ndarray, "m m"],
    point: Float[np.ndarray, " 3"],
    last: int,
    force: Float[np.ndarray, " 3"],
    rest: Float[np.ndarray, "m 3"],
    place: Float[np.ndarray, "m 3"],
    axis: Float[np.ndarray, "m 3"],
    turned: Float[np.ndarray, "m 3 3"],
) -> None:
    """A constant force's part, at a point that joint `last` carries."""
    c = carried(point, last, rest, place, turned)
    for j in range(last + 1):
        goes = cross(axis[j], c - place[j])
        torque[j] += dot(goes, force)
        for k in range(last + 1):
            if k <= j:
                slope[j, k] += dot(cross(axis[k], goes), force)
            else:
                slope[j, k] += dot(cross(axis[j], cross(axis[k], c - place[k])), force)


@kernel
def balance(
    y: Float[np.ndarray, " m"],
    before: Float[np.ndarray, " m"],
    per_time: float,
    springs: Float[np.ndarray, "two m"],
    rest: Float[np.ndarray, "m 3"],
    axes: Float[np.ndarray, "m 3"],
    points: Float[np.ndarray, "n 3"],
    last: Int[np.ndarray, " n"],
    numbers: Float[np.ndarray, "n five"],
    law: Float[np.ndarray, " three"],
    weights: Float[np.ndarray, " w"],
    centres: Float[np.ndarray, "w 3"],
    bearer: Int[np.ndarray, " w"],
    plane: Float[np.ndarray, " four"],
    twist: Float[np.ndarray, " six"],
    gravity: Float[np.ndarray, " 3"],
    torque: Float[np.ndarray, " m"],
    slope: Float[np.ndarray, "m m"],
    told: Float[np.ndarray, "n told"],
) -> None:
    """Torques about the joints and their derivatives, and what the spheres do."""
    speeds = per_time * (y - before)
    place, axis, turned = chain(y, rest, axes)
    slope[:] = 0.0
    for j in range(y.size):
        torque[j] = -springs[0, j] * y[j] - springs[1, j] * speeds[j]
        slope[j, j] = -springs[0, j] - springs[1, j] * per_time
    for i in range(weights.size):
        add_weight(torque, slope, centres[i], bearer[i], weights[i] * gravity, rest, place, axis, turned)
    for i in range(last.size):
        add_sphere(
            torque,
            slope,
            told[i],
            points[i],
            last[i],
            numbers[i],
            law,
            plane,
            twist,
            speeds,
            per_time,
            rest,
            place,
            axis,
            turned,
        )


@kernel
def solve_frames(
    start: Float[np.ndarray, " m"],
    per_time: Float[np.ndarray, " t"],
    springs: Float[np.ndarray, "two m"],
    rest: Float[np.ndarray, "m 3"],
    axes: Float[np.ndarray, "m 3"],
    points: Float[np.ndarray, "n 3"],
    last: Int[np.ndarray, " n"],
    numbers: Float[np.ndarray, "n five"],
    law: Float[np.ndarray, " three"],
    weights: Float[np.ndarray, " w"],
    centres: Float[np.ndarray, "w 3"],
    bearer: Int[np.ndarray, " w"],
    planes: Float[np.ndarray, "t four"],
    twists: Float[np.ndarray, "t six"],
    gravities: Float[np.ndarray, "t 3"],
    tolerance: float,
    angles: Float[np.ndarray, "t m"],
    told: Float[np.ndarray, "t n told"],
    left: Float[np.ndarray, " t"],
    steps: Int[np.ndarray, " t"],
) -> Bool[np.ndarray, ""]:
    """Frame by frame from the one before; whether all ended below the tolerance."""
    m = start.size
    y, tried = start.copy(), np.empty(m)
    torque, slope = np.empty(m), np.empty((m, m))
    before = start.copy()
    for i in range(planes.shape[0]):
        before[:] = y
        done = 0
        balance(
            y,
            before,
            per_time[i],
            springs,
            rest,
            axes,
            points,
            last,
            numbers,
            law,
            weights,
            centres,
            bearer,
            planes[i],
            twists[i],
            gravities[i],
            torque,
            slope,
            told[i],
        )
        size = np.abs(torque).max()
        while size > tolerance and done < MOST:
            step = np.linalg.solve(slope, -torque)
            merit, share = (torque * torque).sum(), 1.0
            for _ in range(HALVINGS):
                tried[:] = y + share * step
                balance(
                    tried,
                    before,
                    per_time[i],
                    springs,
                    rest,
                    axes,
                    points,
                    last,
                    numbers,
                    law,
                    weights,
                    centres,
                    bearer,
                    planes[i],
                    twists[i],
                    gravities[i],
                    torque,
                    slope,
                    told[i],
                )
                if (torque * torque).sum() < merit * (1.0 - 0.1 * share):
                    break
                share *= 0.5
            y[:] = tried
            size = np.abs(torque).max()
            done += 1
        angles[i], left[i], steps[i] = y, size, done
        if not size <= tolerance:
            return False
    return True
