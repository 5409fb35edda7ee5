"""Arithmetic of the finer truth of a shoulder exoskeleton: its three bodies, and the cells of its cuff; compiled.

Written for `benchmarks.shoulder.truth`, by code of its own; the package's model is not used.
"""

from __future__ import annotations

import numba
import numpy as np

Bodies = tuple[np.ndarray, np.ndarray, np.ndarray]
compiled = numba.njit(cache=True)


@compiled
def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """a x b of two vectors."""
    found = np.zeros(3)
    add_cross(found, a, b)
    return found


@compiled
def add_cross(to: np.ndarray, a: np.ndarray, b: np.ndarray) -> None:
    """Add a x b to a vector."""
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        to[i] += a[j] * b[k] - a[k] * b[j]


@compiled
def turned(axis: np.ndarray, angle: float) -> np.ndarray:
    """cos a 1 + sin a [n]x + (1 - cos a) n n'."""
    cos, sin, found = np.cos(angle), np.sin(angle), np.empty((3, 3))
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        found[i, i] = cos + (1.0 - cos) * axis[i] * axis[i]
        found[i, j] = (1.0 - cos) * axis[i] * axis[j] - sin * axis[k]
        found[i, k] = (1.0 - cos) * axis[i] * axis[k] + sin * axis[j]
    return found


@compiled
def frames_of(q: np.ndarray, own_axes: np.ndarray, base: np.ndarray, links: np.ndarray) -> Bodies:
    """Rotations (3, 3, 3), joints' places (3, 3) and axes (3, 3) in the device's frame."""
    turns, places, axes = np.empty((3, 3, 3)), np.empty((3, 3)), np.empty((3, 3))
    turn, place = np.eye(3), base.copy()
    for i in range(3):
        if i:
            place = place + turn @ links[i - 1]
        axes[i] = turn @ own_axes[i]
        turn = turn @ turned(own_axes[i], q[i])
        turns[i], places[i] = turn, place
    return turns, places, axes


@compiled
def equations(
    frames: Bodies,
    u: np.ndarray,
    gravity: np.ndarray,
    centres: np.ndarray,
    masses: np.ndarray,
    inertias: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Mass matrix (3, 3), and what Coriolis, centrifugal forces and gravity ask of the joints (3)."""
    turns, places, axes = frames
    mass, bias = np.zeros((3, 3)), np.zeros(3)
    spin, spin_rate, acceleration = np.zeros(3), np.zeros(3), -gravity
    for i in range(3):
        if i:
            arm = places[i] - places[i - 1]
            acceleration = acceleration + cross(spin_rate, arm) + cross(spin, cross(spin, arm))
        spin_rate = spin_rate + cross(spin, axes[i] * u[i])
        spin = spin + axes[i] * u[i]
        out = turns[i] @ centres[i]
        inertia = turns[i] @ inertias[i] @ turns[i].T
        at_centre = acceleration + cross(spin_rate, out) + cross(spin, cross(spin, out))
        moment = inertia @ spin_rate + cross(spin, inertia @ spin)
        for j in range(i + 1):
            moved = cross(axes[j], places[i] + out - places[j])
            bias[j] += masses[i] * (moved @ at_centre) + axes[j] @ moment
            for k in range(i + 1):
                other = cross(axes[k], places[i] + out - places[k])
                mass[j, k] += masses[i] * (moved @ other) + axes[j] @ (inertia @ axes[k])
    return mass, bias


@compiled
def pressed_cells(
    frames: Bodies,
    u: np.ndarray,
    arm: tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray],
    cuff: tuple[np.ndarray, np.ndarray, np.ndarray],
    law: np.ndarray,
    pressed: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Torque of the arm on each joint [N m], the normal force at each cell (a, b) [N], and the sums over the cells of
    their shear on the arm along the cuff, towards the hand, and around it, from medial towards raising [N].

    Parameters
    ----------
    arm
        Place and velocity of the interface's middle, direction of the arm and its rate.
    cuff
        Its middle in the arm link's frame, places of the rings along it, directions around it (medial, raising).
    law
        Half of its length, its radius, depth of the strap less the play, depth from which damping acts fully, stiffness
        and damping of a cell, static and kinetic friction, threshold speed.
    pressed
        Depth by which the arm is pressed down [m].
    """
    turns, places, axes = frames
    place, rate, along, along_rate = arm
    own, rings, around = cuff
    half, radius, strap, full, k, b, mu_s, mu_k, v_th = law
    turn, origin = turns[2], places[2]
    distal, medial, raising = -turn[:, 2].copy(), turn[:, 0].copy(), -turn[:, 1].copy()
    middle, spin = origin + turn @ own, axes[0] * u[0] + axes[1] * u[1] + axes[2] * u[2]
    joint_speed = cross(axes[0], origin - places[0]) * u[0] + cross(axes[1], origin - places[1]) * u[1]
    turning = cross(along, along_rate)
    total, moment, pressing = np.zeros(3), np.zeros(3), np.zeros((len(rings), len(around)))
    rubbing = np.zeros(2)
    out, lever, velocity, force = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    around_axis = radius * (turning - spin)
    for i in range(len(rings)):
        offset = place + rings[i] * along - middle
        if abs(offset @ distal) >= half:
            continue
        to = middle + offset - origin
        speed = rate + cross(turning, rings[i] * along) - cross(spin, to) - joint_speed
        for j in range(len(around)):
            depth, closing, square = strap + pressed * max(-around[j, 1], 0.0), 0.0, 0.0
            for c in range(3):
                out[c] = around[j, 0] * medial[c] + around[j, 1] * raising[c]
                depth, velocity[c], lever[c] = depth + offset[c] * out[c], speed[c], to[c] + radius * out[c]
            if depth <= 0.0:
                continue
            add_cross(velocity, around_axis, out)
            for c in range(3):
                closing += velocity[c] * out[c]
            for c in range(3):
                square += (velocity[c] - closing * out[c]) ** 2
            soft, size = min(depth / full, 1.0), np.sqrt(square) + 1e-12
            normal = k * depth + b * max(closing, 0.0) * soft * soft * (3.0 - 2.0 * soft)
            node = size / v_th
            mu = mu_s * min(node, 1.0) + (mu_k - mu_s) * min(max((node - 1.5) / 1.5, 0.0), 1.0)
            for c in range(3):
                force[c] = -normal * (out[c] + mu / size * (velocity[c] - closing * out[c]))
                total[c] += force[c]
                rubbing[0] += force[c] * distal[c]
                rubbing[1] += force[c] * (around[j, 0] * raising[c] - around[j, 1] * medial[c])
            add_cross(moment, lever, force)
            pressing[i, j] = normal
    torque = np.empty(3)
    for joint in range(3):
        torque[joint] = -axes[joint] @ (moment + cross(origin - places[joint], total))
    return torque, pressing, rubbing


@compiled
def stops_of(q: np.ndarray, u: np.ndarray, ends: np.ndarray, law: np.ndarray) -> np.ndarray:
    """Torque of the joints' stops [N m]: `ends` lower and upper (2, 3), `law` stiffness, width and damping."""
    stiffness, width, damping = law
    torque = np.zeros(3)
    for joint in range(3):
        for end, sign in ((0, 1.0), (1, -1.0)):
            beyond = max(sign * (ends[end, joint] - q[joint]), 0.0)
            soft = min(beyond, width)
            ramp = soft * soft / (2.0 * width) + beyond - soft
            torque[joint] += sign * stiffness * ramp * max(1.0 - sign * damping * u[joint], 0.0)
    return torque
