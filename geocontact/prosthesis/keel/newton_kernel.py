"""Frames of the chain in balance, by steps of Newton that are halved or damped where the torques do not shrink.

Rates of the joints are those of the backward differentiation formula of second order for uneven steps (BDF2; Hairer,
Nørsett & Wanner, Solving Ordinary Differential Equations I, sec. III.5), in the first step of Euler's rule; 1/dt = 0
leaves them out. Damping as Marquardt (1963), SIAM J. Appl. Math. 11, 431.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

from geocontact.geometry.kernels.compile import kernel
from geocontact.prosthesis.keel.balance_kernel import balance

MOST, HALVINGS, TURN = 200, 4, 0.3
"""Trials in a frame, how often a step of Newton is halved before it is damped, most that a joint turns in one [rad]."""
FIRST, SOFTER, HARDER, LEAST = 1e-3, 0.1, 4.0, 1e-7
"""Marquardt's damping to begin with, its factors after a success and a failure, and below it none."""


@kernel
def eliminate(matrix: Float[np.ndarray, "m m"], right: Float[np.ndarray, " m"]) -> None:
    """The solution in place of the right side, by Gauss with pivots; both are overwritten.

    Loops, because numba takes seconds to compile its call of a library, which is no faster for ten unknowns.
    """
    m = right.size
    for k in range(m):
        pivot = k
        for i in range(k + 1, m):
            if abs(matrix[i, k]) > abs(matrix[pivot, k]):
                pivot = i
        for j in range(k, m):
            matrix[k, j], matrix[pivot, j] = matrix[pivot, j], matrix[k, j]
        right[k], right[pivot] = right[pivot], right[k]
        for i in range(k + 1, m):
            factor = matrix[i, k] / matrix[k, k]
            for j in range(k, m):
                matrix[i, j] -= factor * matrix[k, j]
            right[i] -= factor * right[k]
    for k in range(m - 1, -1, -1):
        for j in range(k + 1, m):
            right[k] -= matrix[k, j] * right[j]
        right[k] /= matrix[k, k]


@kernel
def damped_step(
    step: Float[np.ndarray, " m"],
    slope: Float[np.ndarray, "m m"],
    torque: Float[np.ndarray, " m"],
    damping: float,
    spare: Float[np.ndarray, "m m"],
) -> None:
    """Newton's step, or Marquardt's where it is damped; shortened where a joint would turn too far."""
    m = torque.size
    for i in range(m):
        step[i] = -torque[i] if damping == 0.0 else 0.0
        for j in range(m):
            spare[i, j] = slope[i, j] if damping == 0.0 else 0.0
            if damping > 0.0:
                step[i] -= slope[j, i] * torque[j]
                for k in range(m):
                    spare[i, j] += slope[k, i] * slope[k, j]
        if damping > 0.0:
            spare[i, i] *= 1.0 + damping
    eliminate(spare, step)
    longest = 0.0
    for i in range(m):
        longest = max(longest, abs(step[i]))
    if longest > TURN:
        for i in range(m):
            step[i] *= TURN / longest


@kernel
def tried_out(
    found: Float[np.ndarray, " m"],
    merit: float,
    torque: Float[np.ndarray, " m"],
    slope: Float[np.ndarray, "m m"],
    tried: Float[np.ndarray, " m"],
    step: Float[np.ndarray, " m"],
    kept: Float[np.ndarray, "one m"],
    spare: Float[np.ndarray, "m m"],
    state: Float[np.ndarray, " two"],
) -> float:
    """What a trial leads to: a new place, its merit and next step where it is better; else a shorter or damped step.

    Kept are slope and, in the last row, torque of the best place; the state is damping, and steps that failed.
    """
    m, now = torque.size, 0.0
    for j in range(m):
        now += torque[j] ** 2
    if now < merit:
        for j in range(m):
            found[j], kept[m, j] = tried[j], torque[j]
            for k in range(m):
                kept[j, k] = slope[j, k]
        state[0], state[1] = state[0] * SOFTER if state[0] * SOFTER > LEAST else 0.0, 0.0
        merit = now
    elif state[0] == 0.0 and state[1] < HALVINGS:
        for j in range(m):
            step[j] *= 0.5
        state[1] += 1.0
        return merit
    else:
        state[0] = max(state[0] * HARDER, FIRST)
    damped_step(step, kept[:m], kept[m], state[0], spare)
    return merit


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
) -> bool:
    """Frame by frame from those before; whether all ended below the tolerance."""
    m = start.size
    y, older, before, tried, step = start.copy(), start.copy(), np.empty(m), np.empty(m), np.empty(m)
    torque, slope, kept, spare, state = (
        np.empty(m),
        np.empty((m, m)),
        np.empty((m + 1, m)),
        np.empty((m, m)),
        np.zeros(2),
    )
    for i in range(planes.shape[0]):
        per_step, newer, old = per_time[i], 1.0, 0.0
        if i > 1 and per_step > 0.0:
            w = per_time[i - 1] / per_step
            newer, old = (1.0 + w) ** 2 / (1.0 + 2.0 * w), -(w**2) / (1.0 + 2.0 * w)
            per_step *= (1.0 + 2.0 * w) / (1.0 + w)
        for j in range(m):
            before[j] = newer * y[j] + old * older[j]
            older[j], step[j] = y[j], 0.0
        merit, state[0], state[1], steps[i] = np.inf, 0.0, 0.0, 0
        while True:
            for j in range(m):
                tried[j] = y[j] + step[j]
            balance(
                tried,
                before,
                per_step,
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
            left[i] = 0.0
            for j in range(m):
                left[i] = max(left[i], abs(torque[j]))
            if left[i] <= tolerance or steps[i] == MOST:
                break
            merit = tried_out(y, merit, torque, slope, tried, step, kept, spare, state)
            steps[i] += 1
        for j in range(m):
            y[j] = tried[j]
            angles[i, j] = y[j]
        if not left[i] <= tolerance:
            return False
    return True
