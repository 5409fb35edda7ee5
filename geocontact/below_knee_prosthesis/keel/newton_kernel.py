"""Frames of the chain in balance: by Newton's steps, and along a path where they do not arrive.

The path leads from the last frame's angles y0, where the torques are g0, through g(y) = r g0, r from 1 to 0: it meets
the edges of contact, of loading and of sliding one after the other, between which Newton's steps go to and fro (the
homotopy of Davidenko; Allgower & Georg, Introduction to Numerical Continuation Methods, ch. 1). A foot that wedges
itself, with friction of about 1 on a steep toe, may have no path: then the frame is refused.

Rates of the joints are those of the backward differentiation formula of second order for uneven steps (BDF2; Hairer,
Nørsett & Wanner, Solving Ordinary Differential Equations I, sec. III.5), in the first step of Euler's rule; 1/dt = 0
leaves them out.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

from geocontact.below_knee_prosthesis.keel.balance_kernel import balance, rubbed
from geocontact.geometry.kernels.compile import kernel

MOST, HALVINGS = 2000, 4
"""Evaluations in a frame, and how often a step of Newton is halved for torques that shrink before the path is taken."""
FIRST, PATIENCE, SHORTEST = 0.25, 6, 1e-5
"""Stride to begin with, steps of Newton in it, and shortest stride."""
NEAR = 1e-3
"""Share of a stride: torque that may be left on the way."""
RATIO, STRIDE, TAKEN, MERIT, FAILED, ON_PATH = range(6)
"""How a search stands: r that was reached, stride, steps in it; least sum of squares, halvings, whether on the path."""


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
def largest(values: Float[np.ndarray, " m"]) -> float:
    """Magnitude of the largest."""
    found = 0.0
    for value in values:
        found = max(found, abs(value))
    return found


@kernel
def newton_step(
    y: Float[np.ndarray, " m"],
    step: Float[np.ndarray, " m"],
    reached: Float[np.ndarray, " m"],
    start: Float[np.ndarray, " m"],
    state: Float[np.ndarray, " six"],
    torque: Float[np.ndarray, " m"],
    slope: Float[np.ndarray, "m m"],
) -> bool:
    """Newton's next place, or one at half of the step; whether the path has to be taken instead, from the start."""
    m, merit = y.size, 0.0
    for j in range(m):
        merit += torque[j] ** 2
    if merit < state[MERIT]:
        eliminate(slope, torque)
        for j in range(m):
            reached[j], step[j] = y[j], -torque[j]
        state[MERIT], state[FAILED] = merit, 0.0
    else:
        state[FAILED] += 1.0
        for j in range(m):
            step[j] *= 0.5
    over = bool(state[FAILED] > HALVINGS)
    for j in range(m):
        y[j] = start[j] if over else reached[j] + step[j]
        if over:
            reached[j] = start[j]
    return over


@kernel
def path_step(
    y: Float[np.ndarray, " m"],
    reached: Float[np.ndarray, " m"],
    first: Float[np.ndarray, " m"],
    state: Float[np.ndarray, " six"],
    torque: Float[np.ndarray, " m"],
    slope: Float[np.ndarray, "m m"],
    tolerance: float,
) -> bool:
    """The next place on the path; whether it ends without hope. Torque and slope are overwritten."""
    m, goal = y.size, max(state[RATIO] - state[STRIDE], 0.0)
    for j in range(m):
        torque[j] -= goal * first[j]
    left = largest(torque)
    if left <= max(tolerance, NEAR * state[STRIDE] * largest(first)) and goal > 0.0:
        state[RATIO], state[STRIDE], state[TAKEN] = goal, min(2.0 * state[STRIDE], goal), 0.0
        for j in range(m):
            reached[j] = y[j]
            torque[j] += min(state[STRIDE], goal) * first[j]
    elif state[TAKEN] >= PATIENCE or not np.isfinite(left):
        state[STRIDE], state[TAKEN] = 0.25 * state[STRIDE], 0.0
        for j in range(m):
            y[j] = reached[j]
        return bool(state[STRIDE] < SHORTEST)
    state[TAKEN] += 1.0
    eliminate(slope, torque)
    for j in range(m):
        y[j] -= torque[j]
    return False


@kernel
def begin(
    y: Float[np.ndarray, " m"],
    older: Float[np.ndarray, " m"],
    before: Float[np.ndarray, " m"],
    reached: Float[np.ndarray, " m"],
    state: Float[np.ndarray, " six"],
    per_time: float,
    ratio: float,
) -> float:
    """A new search: what rates are differences from, and by what factor.

    The ratio is that of this step in time to the one before; 0 for Euler's rule.
    """
    newer, old = (1.0 + ratio) ** 2 / (1.0 + 2.0 * ratio), ratio**2 / (1.0 + 2.0 * ratio)
    for j in range(y.size):
        before[j] = newer * y[j] - old * older[j]
        older[j] = reached[j] = y[j]
    state[RATIO], state[STRIDE], state[TAKEN] = 1.0, FIRST, 0.0
    state[MERIT], state[FAILED], state[ON_PATH] = np.inf, 0.0, 0.0
    return per_time * (1.0 + 2.0 * ratio) / (1.0 + ratio)


@kernel
def advanced(
    y: Float[np.ndarray, " m"],
    step: Float[np.ndarray, " m"],
    reached: Float[np.ndarray, " m"],
    older: Float[np.ndarray, " m"],
    first: Float[np.ndarray, " m"],
    state: Float[np.ndarray, " six"],
    torque: Float[np.ndarray, " m"],
    slope: Float[np.ndarray, "m m"],
    tolerance: float,
) -> bool:
    """One step of either way; False where the path ends without hope."""
    if state[MERIT] == np.inf:
        for j in range(y.size):
            first[j] = torque[j]
    if state[ON_PATH] > 0.0:
        return not path_step(y, reached, first, state, torque, slope, tolerance)
    if newton_step(y, step, reached, older, state, torque, slope):
        state[ON_PATH] = 1.0
    return True


@kernel
def solve_frames(
    start: Float[np.ndarray, " m"],
    per_time: Float[np.ndarray, " t"],
    springs: Float[np.ndarray, "five m"],
    rest: Float[np.ndarray, "m 3"],
    axes: Float[np.ndarray, "m 3"],
    points: Float[np.ndarray, "n 3"],
    last: Int[np.ndarray, " n"],
    numbers: Float[np.ndarray, "n five"],
    law: Float[np.ndarray, " three"],
    weights: Float[np.ndarray, " w"],
    centres: Float[np.ndarray, "w 3"],
    bearer: Int[np.ndarray, " w"],
    planes: Float[np.ndarray, "t n four"],
    twists: Float[np.ndarray, "t six"],
    gravities: Float[np.ndarray, "t 3"],
    tolerance: float,
    angles: Float[np.ndarray, "t m"],
    outputs: Float[np.ndarray, "t n outputs"],
    left: Float[np.ndarray, " t"],
    steps: Int[np.ndarray, " t"],
) -> bool:
    """Frame by frame from those before; whether all ended below the tolerance."""
    m = start.size
    y, older, before, reached, step = start.copy(), start.copy(), np.empty(m), np.empty(m), np.empty(m)
    first, torque, slope, state = np.empty(m), np.empty(m), np.empty((m, m)), np.empty(6)
    memory = np.zeros((2, m))
    memory[0] = start
    for i in range(planes.shape[0]):
        ratio = per_time[i - 1] / per_time[i] if i > 1 and per_time[i] > 0.0 else 0.0
        per_step = begin(y, older, before, reached, state, per_time[i], ratio)
        for trial in range(MOST):
            steps[i] = trial
            balance(
                y,
                before,
                per_step,
                springs,
                memory,
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
                outputs[i],
            )
            left[i] = largest(torque)
            if left[i] <= tolerance or not advanced(y, step, reached, older, first, state, torque, slope, tolerance):
                break
        for j in range(m):
            angles[i, j] = y[j]
            if springs[2, j] + springs[3, j] > 0.0:
                memory[1, j] = rubbed(y[j] - memory[0, j], memory[1, j], springs[4, j])[0]
                memory[0, j] = y[j]
        if not left[i] <= tolerance:
            return False
    return True
