"""What an interface or a hinge takes away by its rate or by rubbing: damping and dry friction."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geocontact.gap_benchmark.synthetic.effects.kernels import hysteresis
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Pull, Swing, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes


def damping(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """A damper that thins with rate and grips harder as it is pressed.

    planted:   b v / (1 + |v|/v1) (1 + s u/D); foot: per sphere b d' (1 - exp(-(d/d1)^2)) / (1 + |d'|/v1)
               (1 + e d'/hypot(d', V)), e = 0.18..0.28: held harder while pressed
    candidate: b v |v/V|^(q - 1); foot: b d' s(d/d_full) (d/D)^q, or b d' |d'/V|^(p - 1) s(d/d_full) (d/D)^n
    amplitude: b at small rates [N s/m]
    """
    numbers = scale.numbers
    thinning = (rng.uniform(*numbers.thinning)) * scale.rate
    if numbers.thinning_departs:  # where base parameters take a plain damper away
        thinning /= scale.departure
    lean = rng.uniform(0.45, 0.65) * (scale.departure if numbers.leaning is None else numbers.leaning)
    reach = rng.uniform(0.25, 0.5) * scale.stroke
    harder = rng.uniform(0.18, 0.28) if numbers.on_ground else 0.0

    def hooks(b: float) -> Hooks:
        def strap(p: Pull) -> Values:
            return np.asarray(
                b * p.rate / (1.0 + np.abs(p.rate) / thinning) * (1.0 + lean * p.deflection / scale.stroke)
            )

        def foot(p: Pull) -> Values:
            inside = np.maximum(p.deflection, 0.0) / reach
            way = p.rate / np.hypot(p.rate, scale.rate)
            drag = b * p.rate * -np.expm1(-inside * inside) / (1.0 + np.abs(p.rate) / thinning)
            return np.asarray(drag * (1.0 + harder * way))

        return Hooks(beside=(foot if numbers.on_ground else strap,))

    most = _most_damping(scale)
    return Draw(1e-4 * most, most, hooks, lambda b: f"viscous damping of {b:.3g} N s/m that thins with rate")


def thinning(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Damping of the second family: flow by Eyring's law.

    planted:   b V asinh(v/V) (1 + s u/D); foot: b V asinh(d'/V) tanh(d/d1)
    amplitude: b at small rates [N s/m]
    """
    rate = rng.uniform(1.0, 2.5) * scale.rate
    lean, reach = rng.uniform(0.3, 0.5) * scale.departure, rng.uniform(0.25, 0.5) * scale.stroke

    def hooks(b: float) -> Hooks:
        def drag(p: Pull) -> Values:
            flow = b * rate * np.arcsinh(p.rate / rate)
            if scale.numbers.on_ground:
                return np.asarray(flow * np.tanh(np.maximum(p.deflection, 0.0) / reach))
            return np.asarray(flow * (1.0 + lean * p.deflection / scale.stroke))

        return Hooks(beside=(drag,))

    most = _most_damping(scale)
    return Draw(1e-4 * most, most, hooks, lambda b: f"viscous flow of {b:.3g} N s/m at small rates")


def _most_damping(scale: SyntheticMagnitudes) -> float:
    """Largest damping of each sphere, or of an interface [N s/m]."""
    return 3000.0 if scale.numbers.on_ground else 0.5 * scale.force / scale.rate


def dry_friction(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """A strap that rubs, harder where it is pulled tighter; at the shoulder the hinge, harder where it carries more.

    planted:   F += F_c (1 + s |u|/D) z, z' = u'/r (1 - |z|^n (g + b sign(u' z))) (Bouc and Wen), n = 1.6..2.5;
               shoulder: T_c (1 + s (|F|/F_most - 0.4)) z at the hinge, z along its angle e
    candidate: F_c z, dz/du = (sign(u') - z)/r, or F_c tanh(u'/v); or so at the hinge
    amplitude: friction F_c at rest [N]
    """
    lever = scale.numbers.hinge
    reach = _reach(rng, scale)
    n, beta, grip = rng.uniform(1.6, 2.5), rng.uniform(0.5, 0.7), rng.uniform(0.35, 0.6)

    def hooks(limit: float) -> Hooks:
        def rub(p: Pull) -> Values:
            z = hysteresis(p.deflection, reach, n, beta)
            return np.asarray(limit * (1.0 + grip * (np.abs(p.deflection) / scale.stroke - 0.4)) * z)

        def grind(p: Swing) -> Values:
            z = hysteresis(p.angle, reach, n, beta)
            return np.asarray(limit * lever * (1.0 + grip * (np.abs(p.load) / scale.force - 0.4)) * z)

        return Hooks(hinge=(grind,)) if lever else Hooks(beside=(rub,))

    def words(limit: float) -> str:
        size = f"{limit * lever:.3g} N m at the hinge" if lever else f"{limit:.3g} N in the strap"
        return f"dry friction of {size}"

    return Draw(1e-4 * scale.force, 0.4 * scale.force, hooks, words)


def sticking(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Dry friction of the second family: larger at rest than in motion, by Stribeck.

    planted:   Bouc-Wen times 1 + s exp(-|v|/V), s = 0.3..0.6
    amplitude: friction F_c in motion [N]
    """
    lever = scale.numbers.hinge
    reach = _reach(rng, scale)
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
            return rubbed(p.angle, p.rate, limit * lever)

        return Hooks(hinge=(hinge,)) if lever else Hooks(beside=(strap,))

    return Draw(1e-4 * scale.force, 0.4 * scale.force, hooks, lambda limit: f"friction of {limit:.3g} N that sticks")


def _reach(rng: Rng, scale: SyntheticMagnitudes) -> float:
    """Way on which friction builds up: of the hinge's angle [rad], or of the deflection [m]."""
    return rng.uniform(0.01, 0.05) * (2.0 * scale.span if scale.numbers.hinge else scale.high - scale.low)


DAMPING = InjectionPlan(
    "damping",
    "rate-thinning, deflection-dependent, uneven",
    "power of rate or depth",
    damping,
    placed=True,
    together=True,
)
THINNING = replace(
    DAMPING, planted="b V asinh(v/V) (1 + s u/D); foot: b V asinh(d'/V) tanh(d/d1) (Eyring)", draw=thinning
)
DRY_FRICTION = InjectionPlan(
    "dry_friction",
    "Bouc-Wen, limit grows with deflection",
    "Dahl, or tanh of rate",
    dry_friction,
    placed=True,
    together=True,
)
STICKING = replace(DRY_FRICTION, planted="Bouc-Wen times 1 + s exp(-|v|/V), s = 0.3..0.6 (Stribeck)", draw=sticking)
