"""Terms of a law beside its spring: each a few lines of compiled arithmetic that a law calls."""

from __future__ import annotations

import math

from geocontact.geometry.kernels.compile import kernel


@kernel
def strap_tension(u: float, tension: float, slackening: float) -> float:
    """Force of a strap that is tight at rest, tension min(max(1 + slackening u, 0), 1) [N].

    A strap that is let out by 1/slackening hangs slack; with `slackening` = 0 [1/m] its tension is constant.
    """
    return tension * min(max(1.0 + slackening * u, 0.0), 1.0)


@kernel
def stiffening_factor(u: float, gain: float, exponent: float, reference: float) -> float:
    """Secant stiffness over that at rest, 1 + gain (|u| / reference)^exponent [-]."""
    return 1.0 + gain * math.pow(abs(u) / reference, exponent)


@kernel
def direction_factor(rate: float, excess: float, turning: float) -> float:
    """1 + excess tanh(rate / turning) [-]: 1 + excess while loading, 1 - excess while unloading.

    `rate` is positive while the deflection grows in magnitude; `turning` [m/s] is the rate at which the change from one
    to the other is three quarters done.
    """
    return 1.0 + excess * math.tanh(rate / turning)


@kernel
def power_damping(rate: float, b: float, exponent: float, reference: float) -> float:
    """b v |v / reference|^(exponent - 1) [N]: linear for exponent 1, and b v at the reference rate for any."""
    if rate == 0.0:
        return 0.0
    return b * rate * math.pow(abs(rate / reference), exponent - 1.0)


@kernel
def branch_force(branch: float, elastic_step: float, h: float, ratio: float, tau: float) -> float:
    """Force of the branch after a step of `h` seconds over which the spring's force rose by `elastic_step` [N].

    q' = ratio F_el' - q / tau, exact for a spring force that is linear in time over the step.
    """
    if h <= 0.0:
        return branch
    return branch * math.exp(-h / tau) - ratio * elastic_step * (tau / h) * math.expm1(-h / tau)


@kernel
def friction_state(state: float, step: float, reach: float) -> float:
    """Friction over its limit, in -1..1, after a displacement `step` [m].

    Dahl's model dz/du = (sign(u') - z) / reach, which is solved exactly while the direction does not change; so the
    answer does not depend on how finely a stroke is sampled. `reach` [m] is the pre-sliding range.
    """
    if step == 0.0:
        return state
    towards = math.copysign(1.0, step)
    return towards + (state - towards) * math.exp(-abs(step) / reach)


@kernel
def friction_at_rate(rate: float, turning: float) -> float:
    """Friction over its limit, tanh(rate / turning), in -1..1: a contact that creeps below the rate `turning` [m/s]."""
    return math.tanh(rate / turning)


@kernel
def beyond_play(u: float, width: float, share: float) -> float:
    """Deflection beyond a play of `width` around rest, u - min(max(u, -(1 - share) width), share width) [m].

    `share` of the play lies on the positive side; 0.5 is a body at rest in the middle of its slack.
    """
    return u - min(max(u, -(1.0 - share) * width), share * width)


@kernel
def stop_force(u: float, stiffness: float, limit: float, side: float, power: float, reference: float) -> float:
    """Force of a stop on the upper (`side` +1) or lower (-1) side, side k D (max(side (u - limit), 0)/D)^p [N].

    D is the `reference` [m]; p = 1 is a second spring, p = 3/2 a rounded buffer, pressed as in Hertz's contact.
    """
    beyond = max(side * (u - limit), 0.0)
    if power != 1.0:
        beyond = reference * math.pow(beyond / reference, power)
    return side * stiffness * beyond


@kernel
def transmitted(force: float, opening: float, rounding: float, side: float) -> float:
    """What is left of a `force` once the contact has closed [N]; `side` +1 or -1 is the sign of a push.

    max(x, 0), x = side force - opening, for `rounding` 0; else (x + sqrt(x² + rounding²))/2: a pad whose edge meets the
    body before the rest. The opening is the load that closing the gap would take without one: stiffness times gap.
    """
    x = side * force - opening
    if rounding <= 0.0:
        return side * max(x, 0.0)
    return side * 0.5 * (x + math.hypot(x, rounding))


@kernel
def stretch(e: float, rate: float, duration: float, reach: float, relax: float) -> float:
    """What the spring is stretched by after `duration`, when the deflection grows at `rate` and e <= -reach is not met.

    e' = rate - relax max(e - reach, 0): slides above `reach` = limit / k, `relax` = k mobility [1/s]. Exact.
    """
    if e <= reach:
        if rate <= 0.0 or e + rate * duration <= reach:
            return e + rate * duration
        duration -= (reach - e) / rate
        e = reach
    settled = rate / relax
    above = settled + (e - reach - settled) * math.exp(-relax * duration)
    if above >= 0.0:
        return reach + above
    back = math.log1p(-(e - reach) / settled) / relax
    return reach + rate * (duration - back)


@kernel
def slipped(slip: float, before: float, u: float, h: float, k: float, mobility: float, limit: float) -> float:
    """Where the attachment is after a step of `h` seconds from deflection `before` to `u` [m].

    slip' = mobility sign(f) max(|f| - limit, 0) with the spring's force f = k (u - slip); exact for a deflection that
    is linear in time over the step, unless it slides both ways within one.
    """
    if h <= 0.0 or mobility <= 0.0 or k <= 0.0:
        return slip
    e = before - slip
    side = 1.0 if e + (u - before) >= 0.0 else -1.0
    if abs(e) > limit / k:
        side = math.copysign(1.0, e)
    left = stretch(side * e, side * (u - before) / h, h, limit / k, k * mobility)
    return u - side * left
