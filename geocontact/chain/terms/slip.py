"""An attachment that creeps along the body while its load is above a limit, and stays where it got to."""

from __future__ import annotations

import math

from geocontact.geometry.kernels.compile import kernel


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
