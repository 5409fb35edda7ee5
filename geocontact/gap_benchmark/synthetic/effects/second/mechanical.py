"""Laws of an interface in the second family."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geocontact.gap_benchmark.synthetic.effects.mechanical.damping import DAMPING
from geocontact.gap_benchmark.synthetic.effects.mechanical.dry_friction import DRY_FRICTION, LEVER, hysteresis
from geocontact.gap_benchmark.synthetic.effects.mechanical.relaxation import QUICK, RELAXATION, settled
from geocontact.gap_benchmark.synthetic.effects.mechanical.stiffening import STIFFENING
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Pull, Swing, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, Rng, SyntheticMagnitudes

BRANCHES = 4


def locking(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: share a of stiffness gained at the largest deflection [-]."""
    end = rng.uniform(1.3, 1.6)

    def hooks(a: float) -> Hooks:
        def factor(_: Values, u: Values, __: Values) -> Values:
            share = np.minimum(np.maximum(u, 0.0) if scale.system == "foot" else np.abs(u), 1.2 * scale.stroke)
            share = share / scale.stroke
            return np.asarray(1.0 + a * (end - 1.0) * share / (end - share))

        return Hooks(spring=(factor,))

    return Draw(0.001, 3.0, hooks, lambda a: f"locks towards {end:.2g} of the deflection, stiffer by {a:.3g} at 1")


def thinning(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: b at small rates [N s/m]."""
    rate = rng.uniform(1.0, 2.5) * scale.rate
    lean, reach = rng.uniform(0.3, 0.5) * scale.departure, rng.uniform(0.25, 0.5) * scale.stroke

    def hooks(b: float) -> Hooks:
        def drag(p: Pull) -> Values:
            flow = b * rate * np.arcsinh(p.rate / rate)
            if scale.system == "foot":
                return np.asarray(flow * np.tanh(np.maximum(p.deflection, 0.0) / reach))
            return np.asarray(flow * (1.0 + lean * p.deflection / scale.stroke))

        return Hooks(beside=(drag,))

    most = 3000.0 if scale.system == "foot" else 0.5 * scale.force / scale.rate
    return Draw(1e-4 * most, most, hooks, lambda b: f"viscous flow of {b:.3g} N s/m at small rates")


def sticking(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: friction F_c in motion [N]."""
    hinged = scale.system == "shoulder"
    reach = rng.uniform(0.01, 0.05) * (2.0 * scale.span if hinged else scale.high - scale.low)
    n, beta, more, slow = rng.uniform(1.2, 1.5), rng.uniform(0.55, 0.7), rng.uniform(0.3, 0.6), rng.uniform(0.1, 0.4)

    def hooks(limit: float) -> Hooks:
        def rubbed(place: Values, rate: Values, size: float) -> Values:
            usual = float(np.sqrt(np.mean(rate**2))) + 1e-12
            return np.asarray(
                size * (1.0 + more * np.exp(-np.abs(rate) / (slow * usual))) * hysteresis(place, reach, n, beta)
            )

        def strap(p: Pull) -> Values:
            return rubbed(p.deflection, p.rate, limit)

        def hinge(p: Swing) -> Values:
            return rubbed(p.angle, p.rate, limit * LEVER)

        return Hooks(hinge=(hinge,)) if hinged else Hooks(beside=(strap,))

    return Draw(1e-4 * scale.force, 0.4 * scale.force, hooks, lambda limit: f"friction of {limit:.3g} N that sticks")


def creeping(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: the share g that relaxes [-]."""
    quick, apart = rng.uniform(*QUICK[scale.system]), rng.uniform(3.0, 6.0)
    power = rng.uniform(0.7, 1.0)
    weight = power ** np.arange(BRANCHES)
    weight = weight / weight.sum()

    def hooks(g: float) -> Hooks:
        def branches(p: Pull) -> Values:
            elastic, h = p.elastic.reshape(len(p.time), -1), float(p.time[1] - p.time[0])
            parts = [w * (elastic - settled(elastic, h, quick * apart**i)) for i, w in enumerate(weight)]
            return np.asarray(g * np.sum(parts, axis=0).reshape(p.elastic.shape))

        return Hooks(beside=(branches,))

    return Draw(1e-4, 1.2, hooks, lambda g: f"{g:.3g} of the elastic force relaxes over four decades of e")


LOCKING = replace(STIFFENING, planted="k u (1 + a (e - 1) s/(e - s)), s = |u|/D, e = 1.3..1.6", draw=locking)
THINNING = replace(
    DAMPING, planted="b V asinh(v/V) (1 + s u/D); foot: b V asinh(d'/V) tanh(d/d1) (Eyring)", draw=thinning
)
STICKING = replace(DRY_FRICTION, planted="Bouc-Wen times 1 + s exp(-|v|/V), s = 0.3..0.6 (Stribeck)", draw=sticking)
CREEPING = replace(RELAXATION, planted="four Prony branches a factor of 3..6 apart in time", draw=creeping)
