"""What is lost on the way to the spring of an interface: creep of an attachment, slack, a gap, a spring in series."""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.effects.kernels import crept, seated
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, NotFoundError, Rng, SyntheticMagnitudes

LIFTED = 0.3
"""Share of the largest deflection, how far the other way an interface may be moved that cannot pull: further, and the
arm of an exoskeleton would fall off."""
STRIPS = 24
"""Strips of a pad; more change nothing."""


def slip(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """An attachment that creeps along the limb by a power of its load, slower and slower, and stays there.

    No threshold: primary creep, by Norton's law of the load and Andrade's of the time.

    planted:   s' = c sign(f) (|f|/F)^m (e/(e + t/T))^(2/3), f = k (u - s), m = 3..5, e = 0.02..0.1
    candidate: s' = m sign(f) max(|f| - L, 0)
    amplitude: creep rate c at the largest load when it is new [m/s]
    """
    m, begin = rng.uniform(3.0, 5.0), rng.uniform(0.02, 0.1)

    def hooks(rate: float) -> Hooks:
        def attached(time: Values, u: Values, _: float) -> Values:
            return crept(time, u, scale.stroke, rate, m, begin, scale.duration)

        return Hooks(attachment=(attached,))

    most = 60.0 * scale.stroke / scale.duration
    return Draw(1e-4 * most, most, hooks, lambda c: f"the cuff creeps by {c:.3g} m/s under the largest load at first")


def dead_zone(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Slack that is taken up smoothly: padding at its edges.

    planted:   u -> s log(1 + exp((u - w+)/s)) - s log(1 + exp((-u - w-)/s)), less its value at 0; s = 0.15..0.21 of w
               (shoulder, straps 1.5 times that)
    candidate: u - min(max(u, -(1 - a) w), a w)
    amplitude: whole play w [m]
    """
    share, soft = rng.uniform(0.2, 0.8), scale.numbers.softer * rng.uniform(0.15, 0.21)
    if scale.low > 0.0:  # all of it on the side where the strap moves
        share = 1.0 - 0.25 * share

    def hooks(width: float) -> Hooks:
        s = soft * width

        def taken_up(u: Values) -> Values:
            return np.asarray(
                s * np.logaddexp(0.0, (u - share * width) / s) - s * np.logaddexp(0.0, (-u - (1.0 - share) * width) / s)
            )

        return Hooks(play=(lambda u: taken_up(u) - taken_up(np.zeros(1))[0],))

    stroke = scale.high - scale.low
    # a strap that never comes to rest must have more play than it keeps, or it shows a constant only
    least = max(1e-3 * stroke, 1.05 * scale.low / share)
    most = max(0.45 * stroke, 1.6 * least)
    return Draw(least, most, hooks, lambda w: f"play of {w:.3g} m with soft edges")


def contact_loss(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """A pad that opens strip by strip, and sits closer once it was pressed until it has opened again.

    planted:   u -> mean over strips at heights h of max(u - h + s g q, 0); h = (1 - e)g .. (1 + e)g, e = 0.3..0.45, the
               more of them the lower; q from 0 to 1 as u rises from 0.9 g to 1.3 g, back as it falls from 0.8 g to
               0.4 g, s = 0.2..0.35
    candidate: (v + sqrt(v^2 + r^2))/2, v = u - g
    amplitude: mean gap g [m], within the range of the deflection
    """
    spread, lean, closer = rng.uniform(0.3, 0.45), rng.uniform(1.3, 1.8), rng.uniform(0.2, 0.35)
    side = 1.0 if scale.high >= -scale.low else -1.0
    low, high = (scale.low, scale.high) if side > 0.0 else (-scale.high, -scale.low)
    if low < -LIFTED * high:
        raise NotFoundError("the interface pulls as well as it pushes")
    at = (np.arange(STRIPS) + 0.5) / STRIPS

    def hooks(gap: float) -> Hooks:
        heights = gap * (1.0 + spread * (2.0 * at**lean - 1.0))

        def closed(u: Values) -> Values:
            pressed = side * u
            overlap = np.maximum((pressed + closer * gap * seated(pressed, gap))[:, None] - heights, 0.0)
            return np.asarray(side * overlap.mean(axis=1))

        return Hooks(play=(closed,))

    least = max(low, 0.02 * high)
    most = max(least + 0.6 * (high - least), 0.9 * least)
    variant = ("positive" if side > 0.0 else "negative") if scale.numbers.either_way else ""
    return Draw(0.8 * least, most, hooks, lambda g: f"the pad opens strip by strip, by {g:.3g} m in the mean", variant)


def series_compliance(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Two springs in series, one of which bottoms out.

    planted:   w = s c F + (1 - s) c F1 tanh(F/F1): soft first, a share s of that later
    candidate: w = c F* (F/F*)^p
    amplitude: compliance c at small loads [rad/N] or [m/N]
    """
    spring = scale.numbers.series
    if spring is None:
        raise ValueError("this system has no place for a spring in series")
    share, limit = rng.uniform(0.16, 0.31), rng.uniform(0.2, 0.35) * scale.force
    share = spring.later(share, scale.departure)

    def hooks(soft: float) -> Hooks:
        def foot(_: Values) -> Values:
            return np.array([soft, share * soft, limit])

        def gives(load: Values) -> Values:
            return np.asarray(share * soft * load + (1.0 - share) * soft * limit * np.tanh(load / limit))

        return Hooks(series=(foot if scale.numbers.on_ground else gives,))

    most = spring.softest(scale)
    words = f"{spring.unit} at first"
    return Draw(1e-4 * most, most, hooks, lambda c: f"a spring in series gives way by {c:.3g} {words}")


SLIP = InjectionPlan("slip", "primary creep", "Bingham above a limit", slip, placed=True)
DEAD_ZONE = InjectionPlan("dead_zone", "softplus edges", "piecewise linear", dead_zone, placed=True)
CONTACT_LOSS = InjectionPlan("contact_loss", "strips, closer once pressed", "rounded corner", contact_loss, placed=True)
SERIES_COMPLIANCE = InjectionPlan(
    "series_compliance", "two springs, one bottoms out", "power of load", series_compliance, placed=True, together=True
)
