"""An arm on a hinge that the interface to a recorded arm drives: its equation of motion, and the steps that solve it.

I e'' + c e' = level τ(e) - m g l_c sin e - F s, with F the interface law's force at u = -r, positive where the hinged
arm is pressed against the recorded one: N = -F in the words of the model. Angles from hanging down.

The trapezoidal rule (Newmark's β = 1/4, γ = 1/2; 1959, J. Eng. Mech. Div. 85(EM3):67) neither damps nor excites a
linear oscillation whatever the step; it is implicit, one unknown per step, the angular acceleration. Its error goes
with (ω h)²/12, so steps are at most `LONGEST` long. Laws with memory make one step with it each time.
"""

from __future__ import annotations

from math import atan2, cos, pi, sin, sqrt

import numpy as np
from jaxtyping import Float

from geocontact.chain.history import between
from geocontact.chain.interface_law import MEMORY, interface_force
from geocontact.chain.links import LawParameters
from geocontact.chain.single_deflection import gives_way
from geocontact.chain.system import ATTEMPTS, SLOPE, TOLERANCE, next_load, nothing_known, start_over
from geocontact.chain.terms import friction_at_rate, friction_state
from geocontact.geometry.kernels.compile import kernel, part

HINGED_ARM = LawParameters(
    {
        "L_h": 1.0,
        "o_x": 0.0,
        "o_y": 0.0,
        "I": 1.0,
        "c": 0.0,
        "l_c": 0.0,
        "m": 0.0,
        "level": 0.0,
        "axis_migration.slope": 0.0,
        "axis_migration.curvature": 0.0,
        "axis_migration.centre": 0.0,
        "series_compliance.compliance": 0.0,
        "series_compliance.exponent": 1.0,
        "series_compliance.reference": 1.0,
        "dry_friction.stroke.limit": 0.0,
        "dry_friction.stroke.reach": 1.0,
        "dry_friction.rate.limit": 0.0,
        "dry_friction.rate.turning": 1.0,
        "gravity_load.moment": 0.0,
        "gravity_load.phase": 0.0,
        "inertia_load.inertia": 0.0,
    }
)
"""Numbers of the arm in the order in which the kernels read them."""
GRAVITY = 9.81
LONGEST, SHORTEST = 1e-2, 1.25e-3
"""Steps of the integration [s]; samples that are further apart are stepped over in equal parts."""
WELL_RESOLVED = 25.0
"""Frequency [rad/s] of the arm on its interface from which steps are shorter in proportion to its period."""
JUMP = 2e-2
"""Change of rate [rad/s] that a step may make unforeseen; else it is halved, down to `SHORTEST`."""
MOST = 4.0
"""Steps, times those that a motion takes if all are the shortest: beyond them it runs away and has no solution."""
SETTING_OUT = 1.0 / 32.0
"""First step over the time to the next sample."""
STIFF = 1.5
"""Slope of a step's equation from which the trapezoidal rule is used as it is: 1 for a free arm, more the stiffer."""
CLOSE = 1e-6
"""Share of e'' that it may be off for the next secant step to be the last; that one is not evaluated any more."""
SLOW = 10.0
"""Angular acceleration [rad/s²] below which a step is solved to `CLOSE` of this instead of to that of its own."""
FIRST, WIDER, HALVINGS = 0.01, 1.5, 52
"""First stride of the search for equilibrium [rad], how much longer each next one is, and halvings of the last."""
WX, WY, WX_RATE, WY_RATE = range(4)
ANGLE, RATE, ACCELERATION, CHORD, JERK, STEP, FRICTION, GIVEN, FORCE, PLACE = range(10)
"""What is remembered of a step, beside what the law remembers; `PLACE` is where τ was last looked up."""
SMOOTH, ARM, ARM_RATE, SAMPLE, STATE, REMEMBERED, COLUMNS = 0, 1, 2, 3, 4, 14, 19
"""What is recorded of a step: whether e'' was taken as smooth, the recorded arm's angle and rate, which sample it ends
at (-1 between samples), what is remembered of it and what the law remembers."""


@kernel
def attachment(arm: float, rate: float, n: Float[np.ndarray, " slots"], w: Float[np.ndarray, " four"]) -> None:
    """Interface sphere relative to the hinge, w = L_h (sin a, -cos a) - (o_x(a), o_y) [m], and its rate [m/s]."""
    angle = arm - n[10]
    s, c = sin(arm), cos(arm)
    w[WX] = n[0] * s - n[1] - angle * (n[8] + n[9] * angle)
    w[WY] = -n[0] * c - n[2]
    w[WX_RATE] = (n[0] * c - n[8] - 2.0 * n[9] * angle) * rate
    w[WY_RATE] = n[0] * s * rate


@kernel
def support(angle: float, table: Float[np.ndarray, "two k"], state: Float[np.ndarray, " ten"]) -> float:
    """τ(e), linear between the rows of a table and constant beyond its ends [N m]."""
    last = table.shape[1] - 1
    if last == 0 or angle <= table[0, 0]:
        return float(table[1, 0])
    if angle >= table[0, last]:
        return float(table[1, last])
    i = int(state[PLACE])
    while angle < table[0, i]:
        i -= 1
    while angle > table[0, i + 1]:
        i += 1
    state[PLACE] = i
    share = (angle - table[0, i]) / (table[0, i + 1] - table[0, i])
    return float(table[1, i] + share * (table[1, i + 1] - table[1, i]))


@part
def interface(
    u: float,
    rate: float,
    h: float,
    n: Float[np.ndarray, " slots"],
    law: Float[np.ndarray, " numbers"],
    old: Float[np.ndarray, " memory"],
    new: Float[np.ndarray, " memory"],
    before: Float[np.ndarray, " ten"],
    inner: Float[np.ndarray, " six"],
) -> tuple[float, bool]:
    """Force of the interface [N], and whether it was found; with a spring in series u - give(F) is what deflects."""
    force = interface_force(u, rate, h, law, old, new)
    if n[11] == 0.0:
        return force, True
    start_over(inner)
    guess = before[FORCE] if h > 0.0 else force
    for _ in range(ATTEMPTS):
        given = gives_way(guess, n[11:14])
        speed = rate - (given - before[GIVEN]) / h if h > 0.0 else rate
        force = interface_force(u - given, speed, h, law, old, new)
        if abs(guess - force) <= 1e-2 * TOLERANCE * max(abs(force), n[13]):
            return force, True
        guess = next_load(guess, guess - force, inner)
    return force, False


@part
def acceleration(
    angle: float,
    rate: float,
    h: float,
    w: Float[np.ndarray, " four"],
    n: Float[np.ndarray, " slots"],
    table: Float[np.ndarray, "two k"],
    law: Float[np.ndarray, " numbers"],
    old: Float[np.ndarray, " memory"],
    new: Float[np.ndarray, " memory"],
    before: Float[np.ndarray, " ten"],
    after: Float[np.ndarray, " ten"],
    inner: Float[np.ndarray, " six"],
) -> tuple[float, bool]:
    """e'' [rad/s²] at angle e and rate e', `h` seconds after what `old` and `before` remember; and whether it is known.

    r = w·(cos e, sin e), s = w·(sin e, -cos e), r' = w'·(cos e, sin e) - e' s.
    """
    sine, cosine = sin(angle), cos(angle)
    along = w[WX] * sine - w[WY] * cosine
    off = w[WX] * cosine + w[WY] * sine
    off_rate = w[WX_RATE] * cosine + w[WY_RATE] * sine - rate * along
    force, known = interface(-off, -off_rate, h, n, law, old, new, before, inner)
    torque = -n[6] * GRAVITY * n[5] * sine - force * along - n[4] * rate
    if n[7] != 0.0:
        torque += n[7] * support(angle, table, after)
    friction = 0.0
    if n[14] != 0.0:
        friction = friction_state(before[FRICTION], angle - before[ANGLE], n[15]) if h > 0.0 else 0.0
        torque -= n[14] * friction
    if n[16] != 0.0:
        torque -= n[16] * friction_at_rate(rate, n[17])
    if n[18] != 0.0:
        torque -= n[18] * sin(angle + n[19])
    after[ANGLE], after[RATE], after[FRICTION], after[FORCE] = angle, rate, friction, force
    after[GIVEN] = gives_way(force, n[11:14]) if n[11] != 0.0 else 0.0
    return torque / (n[3] + n[20]), known


@kernel
def at_rest(
    w: Float[np.ndarray, " four"],
    n: Float[np.ndarray, " slots"],
    table: Float[np.ndarray, "two k"],
    law: Float[np.ndarray, " numbers"],
    inner: Float[np.ndarray, " six"],
) -> float:
    """Angle of equilibrium [rad]: the first that is met from where the sphere lies on the tube's axis.

    Where there is none within half a turn, half a turn away.
    """
    still = w.copy()
    still[WX_RATE] = still[WY_RATE] = 0.0
    old, new = np.zeros(MEMORY), np.zeros(MEMORY)
    before, after = np.zeros(10), np.zeros(10)
    here = atan2(w[WX], -w[WY])
    first, _ = acceleration(here, 0.0, 0.0, still, n, table, law, old, new, before, after, inner)
    if first == 0.0:
        return here
    side = 1.0 if first > 0.0 else -1.0
    near, far, stride = 0.0, 0.0, FIRST
    while far < pi:
        near, far = far, min(far + stride, pi)
        stride *= WIDER
        there, _ = acceleration(here + side * far, 0.0, 0.0, still, n, table, law, old, new, before, after, inner)
        if there * side <= 0.0:
            break
    else:
        return here + side * far
    for _ in range(HALVINGS):
        middle = 0.5 * (near + far)
        there, _ = acceleration(here + side * middle, 0.0, 0.0, still, n, table, law, old, new, before, after, inner)
        if there * side > 0.0:
            near = middle
        else:
            far = middle
    return here + side * 0.5 * (near + far)


@kernel
def moved(
    reached: float, h: float, start: float, beta: float, ahead: float, before: Float[np.ndarray, " ten"]
) -> tuple[float, float, float, float]:
    """Angle, rate, and slopes of e'' over and at the end of a step of `h` seconds in which e'' comes to `reached`."""
    chord = (reached - before[ACCELERATION]) / h
    jerk = chord + (chord - before[CHORD]) * h / (h + before[STEP]) if before[STEP] > 0.0 else chord
    angle = before[ANGLE] + h * (start + h * ((0.5 - beta) * before[ACCELERATION] + beta * reached))
    return angle, start + 0.5 * h * (before[ACCELERATION] + reached) - ahead * jerk, chord, jerk


@part
def step(
    h: float,
    w: Float[np.ndarray, " four"],
    n: Float[np.ndarray, " slots"],
    table: Float[np.ndarray, "two k"],
    law: Float[np.ndarray, " numbers"],
    old: Float[np.ndarray, " memory"],
    new: Float[np.ndarray, " memory"],
    before: Float[np.ndarray, " ten"],
    after: Float[np.ndarray, " ten"],
    search: Float[np.ndarray, " six"],
    inner: Float[np.ndarray, " six"],
) -> tuple[float, bool]:
    """One step of `h` seconds; how far e'' ends from where it was headed [rad/s²], and whether the step was solved.

    The trapezoidal sum of e'' is ahead of its integral by h² e'''/12: that is in `summed` and not in the rate.
    """
    smooth = search[SLOPE] < STIFF
    beta, ahead = (1.0 / 12.0, h * h / 12.0) if smooth else (0.25, 0.0)
    headed = guess = before[ACCELERATION] + before[CHORD] * h
    if before[STEP] > 0.0:
        guess += (before[JERK] - before[CHORD]) * h * (1.0 + h / before[STEP])
    start = before[RATE] + ahead * before[JERK]
    solved = False
    start_over(search)
    for _ in range(ATTEMPTS):
        angle, rate, _, _ = moved(guess, h, start, beta, ahead, before)
        found, known = acceleration(angle, rate, h, w, n, table, law, old, new, before, after, inner)
        off = abs(guess - found)
        solved = known and off <= CLOSE * max(abs(found), SLOW)
        there = next_load(guess, guess - found, search)
        if solved:
            guess -= (guess - found) / search[SLOPE]
            break
        guess = there
    after[ANGLE], after[RATE], after[CHORD], after[JERK] = moved(guess, h, start, beta, ahead, before)
    after[ACCELERATION], after[STEP] = guess, h
    return abs(guess - headed), solved


@kernel
def recorded(
    path: Float[np.ndarray, "rows nineteen"],
    at: int,
    smooth: bool,
    arm: float,
    rate: float,
    sample: int,
    state: Float[np.ndarray, " ten"],
    memory: Float[np.ndarray, " memory"],
) -> Float[np.ndarray, "more nineteen"]:
    """The path with one more step in row `at`, twice as long where there was no room."""
    if at == len(path):
        longer = np.empty((2 * at, COLUMNS))
        longer[:at] = path
        path = longer
    path[at, SMOOTH], path[at, ARM], path[at, ARM_RATE], path[at, SAMPLE] = 1.0 if smooth else 0.0, arm, rate, sample
    for k in range(state.size):
        path[at, STATE + k] = state[k]
    for k in range(memory.size):
        path[at, REMEMBERED + k] = memory[k]
    return path


@kernel
def swing(
    time: Float[np.ndarray, " t"],
    arm: Float[np.ndarray, " t"],
    rate: Float[np.ndarray, " t"],
    longest: float,
    n: Float[np.ndarray, " slots"],
    table: Float[np.ndarray, "two k"],
    law: Float[np.ndarray, " numbers"],
) -> tuple[Float[np.ndarray, "four t"], int, Float[np.ndarray, "rows nineteen"]]:
    """Angle e [rad], force F [N], u [m] and u' [m/s] at every sample; how many steps have no solution; all steps.

    Between samples the recorded arm's angle and rate run along cubics. Steps are at most `longest` [s]. A motion that
    runs away, of an arm that a law throws, is not followed for ever: the samples after `MOST` steps have no solution
    and are zero.
    """
    out = np.empty((4, time.size))
    w = np.empty(4)
    old, new = np.zeros(MEMORY), np.zeros(MEMORY)
    before, after = np.zeros(10), np.zeros(10)
    search, inner = nothing_known(), nothing_known()
    attachment(arm[0], rate[0], n, w)
    rest = at_rest(w, n, table, law, inner)
    found, known = acceleration(rest, 0.0, 0.0, w, n, table, law, new, old, after, before, inner)
    before[ACCELERATION] = found
    unsolved = 0 if known else 1
    longest *= min(1.0, WELL_RESOLVED / max(n[0] * sqrt(law[0] / (n[3] + n[20])), 1e-9))
    most = MOST * (time.size + (time[time.size - 1] - time[0]) / min(longest, SHORTEST))
    share = SETTING_OUT
    path = recorded(np.empty((2 * time.size, COLUMNS)), 0, False, arm[0], rate[0], 0, before, old)
    steps = 1
    for i in range(time.size):
        whole = time[i] - time[i - 1] if i else 0.0
        widest = 1.0 / max(np.ceil(whole / longest - 1e-6), 1.0)
        done = 0.0 if i else 1.0
        if i > 1:  # the rest of the last interval, however short, is no step to begin with
            share = max(share, SHORTEST / whole)
        while done < 1.0:
            share = min(share, widest, 1.0 - done)
            ended = done + share > 1.0 - 1e-9
            here, here_rate = arm[i], rate[i]
            if not ended:
                at = time[i - 1] + (done + share) * whole
                here, here_rate = between(time, arm, i - 1, at), between(time, rate, i - 1, at)
            attachment(here, here_rate, n, w)
            h = share * whole
            after[PLACE] = before[PLACE]
            smooth = search[SLOPE] < STIFF
            off, solved = step(h, w, n, table, law, old, new, before, after, search, inner)
            rough = off * h / JUMP
            if not solved:  # a force that jumps: the slope over the jump is none to go on with
                search[SLOPE] = 1.0
            if h > SHORTEST and (rough > 1.0 or not solved):
                share *= 0.5
                continue
            unsolved += not solved
            done = 1.0 if ended else done + share
            old, new, before, after = new, old, after, before
            path = recorded(path, steps, smooth, here, here_rate, i if ended else -1, before, old)
            steps += 1
            if rough < 0.1:
                share *= 2.0
            if steps > most:
                out[:, i:] = 0.0
                return out, unsolved + time.size - i, path[:steps]
        out[0, i], out[1, i] = before[ANGLE], before[FORCE]
        sine, cosine = sin(before[ANGLE]), cos(before[ANGLE])
        along = w[WX] * sine - w[WY] * cosine
        out[2, i] = -(w[WX] * cosine + w[WY] * sine)
        out[3, i] = before[RATE] * along - w[WX_RATE] * cosine - w[WY_RATE] * sine
    return out, unsolved, path[:steps]
