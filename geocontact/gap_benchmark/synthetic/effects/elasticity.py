"""What an interface holds by its deflection: stiffening, sides that differ, relaxation, a stop, tension."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geocontact.gap_benchmark.synthetic.effects.kernels import settled
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Pull, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes

BRANCHES = 4
"""Branches of the second family's relaxation."""


def stiffening(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Tissue that stiffens exponentially (elbow, straps); foam whose cells are taken up one after the other (foot).

    planted:   elbow, straps: k u (1 + x (1 + e v/hypot(v, V))), x = (exp(a s) - 1)/(a s) - 1, s = |u|/D, with a little
               hysteresis, e = 0.015..0.026 (straps 0.06..0.1, shoulder 0.14..0.23)
               foot: k d^n (1 + a r(s)/r(1)), r(s) = s^m/(s^m + w^m), m = 3..4.5, w = 0.4..0.6
    candidate: k u (1 + g (|u|/D)^p)
    amplitude: share a of stiffness gained, about, at the largest deflection [-]
    """
    m, middle = rng.uniform(3.0, 4.5), rng.uniform(0.4, 0.6)
    lag = rng.uniform(0.015, 0.026) * scale.numbers.lagging

    def hooks(a: float) -> Hooks:
        def tissue(_: Values, u: Values, rate: Values) -> Values:
            grown = np.minimum(np.maximum(a * np.abs(u) / scale.stroke, 1e-9), 30.0)
            way = np.sign(u) * rate / np.hypot(rate, scale.rate)  # loading +, unloading -
            return np.asarray(1.0 + (np.expm1(grown) / grown - 1.0) * (1.0 + lag * way))

        def foam(_: Values, depth: Values, __: Values) -> Values:
            power = (np.maximum(depth, 0.0) / scale.stroke) ** m
            return np.asarray(1.0 + a * power / (power + middle**m) * (1.0 + middle**m))

        return Hooks(spring=(foam if scale.numbers.on_ground else tissue,))

    return Draw(0.001, 3.0, hooks, lambda a: f"stiffens with deflection, by {a:.3g} times or so at the largest")


def locking(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Stiffening of the second family: tissue that locks at some deflection.

    planted:   k u (1 + a (e - 1) s/(e - s)), s = |u|/D, e = 1.3..1.6
    amplitude: share a of stiffness gained at the largest deflection [-]
    """
    end = rng.uniform(1.3, 1.6)

    def hooks(a: float) -> Hooks:
        def factor(_: Values, u: Values, __: Values) -> Values:
            share = np.minimum(np.maximum(u, 0.0) if scale.numbers.on_ground else np.abs(u), 1.2 * scale.stroke)
            share = share / scale.stroke
            return np.asarray(1.0 + a * (end - 1.0) * share / (end - share))

        return Hooks(spring=(factor,))

    return Draw(0.001, 3.0, hooks, lambda a: f"locks towards {end:.2g} of the deflection, stiffer by {a:.3g} at 1")


def asymmetry(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Loading is stiffer than unloading, and the change from one to the other takes time; a knee's sides differ.

    planted:   foot: k (1 + a m), tau m' = r/sqrt(1 + r^2) - m, r = d'/v: a blend that remembers; weighted by 1 + s d/D
               knee: medial k (1 + a (1 + e (u/D - 1/2))), lateral k (1 - f a (1 + e (u/D - 1/2))): bone below the
               insert gives way, e = 1.0..1.4, f = 0.8..1.2
    candidate: foot: k (1 + a tanh(d'/v)); knee: k (1 + a), k (1 - a)
    amplitude: excess a [-]; of one side at the knee
    """
    return _sides(rng, scale) if scale.numbers.sides else _directions(rng, scale)


def _sides(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    sign, bend, less = rng.choice([-1.0, 1.0]), rng.uniform(1.0, 1.4), rng.uniform(0.8, 1.2)

    def differing(share: float) -> Hooks:
        def factor(_: Values, u: Values, __: Values) -> Values:
            return np.asarray(1.0 + share * (1.0 + bend * (u / scale.stroke - 0.5)))

        return Hooks(spring=(factor,))

    def hooks(a: float) -> Hooks:
        return Hooks(places={"medial": differing(sign * a), "lateral": differing(-sign * less * a)})

    return Draw(1e-3, 0.35, hooks, lambda a: f"medial side {sign * a:+.2%} stiffer, lateral {-sign * less * a:+.2%}")


def _directions(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    tau, turning = rng.uniform(0.004, 0.009), rng.uniform(0.1, 0.4) * scale.rate
    lean = rng.uniform(0.15, 0.25)

    def hooks(a: float) -> Hooks:
        def blend(time: Values, depth: Values, closing: Values) -> Values:
            r = closing / turning
            memory = settled(r / np.sqrt(1.0 + r * r), float(time[1] - time[0]), tau)
            return np.asarray(1.0 + a * memory * (1.0 + lean * (np.maximum(depth, 0.0) / scale.stroke - 0.5)))

        return Hooks(spring=(blend,))

    return Draw(2e-4, 0.35, hooks, lambda a: f"{a:.2%} stiffer while loading, softer while unloading, with a memory")


def relaxation(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """A viscoelastic solid with two times.

    planted:   F += sum g_j (F_el - z_j), z_j' = (F_el - z_j)/tau_j, two branches a factor 7..14 apart in time (knee,
               shoulder, straps 15..30)
               knee, shoulder, straps: of F_el (1 + e (|F_el|/F - 1/2)), e = 0.5..0.8
    candidate: one Maxwell branch
    amplitude: the share g that relaxes [-]
    """
    numbers = scale.numbers
    apart = rng.uniform(*numbers.apart)
    quick = rng.uniform(*numbers.quick)
    first = rng.uniform(0.4, 0.65)
    bend = rng.uniform(*numbers.uneven) if numbers.uneven else 0.0

    def hooks(g: float) -> Hooks:
        def branches(p: Pull) -> Values:
            h = float(p.time[1] - p.time[0])
            elastic = p.elastic.reshape(len(p.time), -1)
            elastic = elastic * (1.0 + bend * (np.abs(elastic) / scale.force - 0.5))
            total = g * first * (elastic - settled(elastic, h, quick))
            total = total + g * (1.0 - first) * (elastic - settled(elastic, h, apart * quick))
            return np.asarray(total.reshape(p.elastic.shape))

        return Hooks(beside=(branches,))

    def words(g: float) -> str:
        return f"{g:.3g} of the elastic force relaxes, with {quick:.2g} s and {apart * quick:.2g} s"

    return Draw(1e-4, 1.2, hooks, words)


def creeping(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Relaxation of the second family: over several decades of time.

    planted:   four Prony branches a factor of 3..6 apart in time
    amplitude: the share g that relaxes [-]
    """
    quick, apart = rng.uniform(*scale.numbers.quick), rng.uniform(3.0, 6.0)
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


def end_stop(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """A stop with a rubber buffer.

    planted:   P (0.6 v + 0.4 v^2)/(that at D) (1 + e u'/hypot(u', V)), v = b log(1 + exp((u - u1)/(b (D - u1)))),
               b = 0.12..0.2; rubber gives back less than it took, e = 0.12..0.2, straps 2.5, shoulder 4 times that
    candidate: K max(u - u1, 0), or K D (max(u - u1, 0)/D)^1.5
    amplitude: force of the stop at the largest deflection [N]
    """
    side = 1.0 if rng.random() < 0.7 else -1.0
    beyond = rng.uniform(0.1, 0.28) * (scale.high - scale.low)
    limit = scale.high - beyond if side > 0.0 else scale.low + beyond
    buffer, loss = rng.uniform(0.12, 0.2), scale.numbers.lossy * rng.uniform(0.12, 0.2)

    def swell(depth: Values) -> Values:
        v = buffer * np.logaddexp(0.0, depth / beyond / buffer)
        return np.asarray(0.6 * v + 0.4 * v * v)

    whole = float(swell(np.array([beyond]))[0])

    def hooks(most: float) -> Hooks:
        def stop(p: Pull) -> Values:
            way = side * p.rate / np.hypot(p.rate, scale.rate)
            return np.asarray(side * most * swell(side * (p.deflection - limit)) / whole * (1.0 + loss * way))

        return Hooks(beside=(stop,))

    def words(most: float) -> str:
        return f"a buffered end stop from {limit:.3g} m on, {most:.3g} N at the end"

    return Draw(1e-3 * scale.force, 1.2 * scale.force, hooks, words, "upper" if side > 0.0 else "lower")


def preload(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Strap tension that relaxes a little and falls as the strap is let out.

    planted:   T (1 - r (1 - exp(-t/tau))) (1 + s tanh(2 u/D)), r = 0.05..0.12, s = 0.05..0.1; straps twice that,
               shoulder 4 times
    candidate: T min(max(1 + c u, 0), 1)
    amplitude: tension at rest T [N]
    """
    more = scale.numbers.relaxing
    lost, tau = more * scale.departure * rng.uniform(0.05, 0.12), scale.duration * rng.uniform(0.1, 0.3)
    pull = more * scale.departure * rng.uniform(0.05, 0.1)
    sign = rng.choice([-1.0, 1.0])

    def hooks(tension: float) -> Hooks:
        def strap(p: Pull) -> Values:
            relaxed = 1.0 + lost * np.expm1(-p.time / tau)
            return np.asarray(sign * tension * relaxed * (1.0 + pull * np.tanh(2.0 * p.deflection / scale.stroke)))

        return Hooks(beside=(strap,))

    return Draw(1e-3 * scale.force, 0.5 * scale.force, hooks, lambda t: f"strap tension of {sign * t:.3g} N at rest")


STIFFENING = InjectionPlan(
    "stiffening",
    "exponential with hysteresis; or levelling off",
    "power of deflection",
    stiffening,
    placed=True,
    together=True,
)
LOCKING = replace(STIFFENING, planted="k u (1 + a (e - 1) s/(e - s)), s = |u|/D, e = 1.3..1.6", draw=locking)
ASYMMETRY = InjectionPlan(
    "asymmetry", "blend with memory; sides that differ more under load", "tanh of rate; constant", asymmetry
)
RELAXATION = InjectionPlan(
    "relaxation", "two Prony branches", "one Maxwell branch", relaxation, placed=True, together=True
)
CREEPING = replace(RELAXATION, planted="four Prony branches a factor of 3..6 apart in time", draw=creeping)
END_STOP = InjectionPlan(
    "end_stop", "soft corner, hardening, lossy", "linear or a power beyond a corner", end_stop, placed=True
)
PRELOAD = InjectionPlan(
    "preload",
    "relaxing, deflection-dependent tension",
    "tension with slackening",
    preload,
    placed=True,
    together=True,
)
