"""The opponent: the base is fitted once and what is left is regressed on what each effect would add.

Discrepancy modelling as in Ebers, Steele & Kutz (2024) SIAM J. Appl. Dyn. Syst. 23:1, with the effects of the table as
library. It gets all that the diagnosis has but the joint refit: base fit, smoothed inputs, noise levels, candidates,
their starts as shapes, their physical signs. A signature is what an effect at its start adds to the prediction of
the base (secant from nothing to the start; a tangent where the effect is linear). Residual and signatures are whitened
by noise and input noise; with `aware`, by trial-to-trial variation too, which takes off what slightly other base
parameters would explain in each trial. A mistake in the data is either there or not, trial by trial.

Models are ranked by BIC = n log(rss/n) + k log n, plus 2 log m for a choice among m (extended BIC, Chen & Chen 2008
Biometrika 95:759): nothing; one effect; one with the best second; and, for what has no name, a library of monomials
in inputs, rates and time. Probabilities are the softmax of -BIC/2. An answer needs an advantage of 10 over nothing
("very strong", Kass & Raftery 1995 J. Am. Stat. Assoc. 90:773).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement
from typing import Any

import numpy as np
from jaxtyping import Float

from geocontact.chain.differentiated_inputs import recorded
from geocontact.chain.effect import Candidate
from geocontact.gap.case.problem import Problem
from geocontact.gap.case.refit import Measured, Whiten, at

VERY_STRONG = 10.0
"""Advantage of BIC that an answer needs over nothing, and a second effect over the first alone."""
ALIVE = 0.03
MOST = 4
FIRSTS = 5
"""Effects that a second one is tried on."""
WORTH = 0.1
"""Share of what the first explains, that a second must explain more."""
DEGREES = {1: 4, 2: 3, 3: 2}
"""Degrees of the monomials, by number of inputs; 2 for more."""
ROUNDS = 20
"""Rounds of the search for two coefficients within their bounds, one after the other."""
DRAWS, BLOCKS = 200, 10
NONE, UNKNOWN = "none", "unknown"


@dataclass(frozen=True)
class Signature:
    """What an effect adds to the prediction of each trial, calibration trials first.

    Parameters
    ----------
    name, label
        Of the vocabulary; with variant and shape.
    count
        Numbers that were chosen: amplitude and shapes.
    low, high
        Bounds of the coefficient: the physical ones of the amplitude, in units of the step to the start.
    parts
        Per trial, in the channels' units.
    white
        Of the calibration trials.
    """

    name: str
    label: str
    count: int
    low: float
    high: float
    parts: tuple[Float[np.ndarray, "_ c"], ...]
    white: Float[np.ndarray, " n"]


@dataclass(frozen=True)
class SignatureModel:
    """A regression: names, BIC, coefficients and what they belong to."""

    names: tuple[str, ...]
    bic: float
    coefficients: tuple[float, ...] = ()
    signatures: tuple[Signature, ...] = ()


def residual_regression(problem: Problem, candidates: Sequence[Candidate], *, aware: bool) -> dict[str, Any]:
    """Answer of the opponent, with the keys of diagnosis.json that are scored.

    Parameters
    ----------
    problem
        Base model fitted, as the diagnosis has it.
    candidates
        Of the same table.
    aware
        Whether it knows of trial-to-trial variation.
    """
    noise = problem.weighed(problem.plain)
    count = len(problem.calibration.trials)
    weighings: Sequence[Whiten] = problem.fitting(noise, problem.plain) if aware else noise.whiteners[:count]
    base = at(problem.system, problem.calibration, None, problem.plain.values).residuals
    held_out = at(problem.system, problem.evaluation, None, problem.plain.values).residuals
    left = np.concatenate([w(r[..., None])[:, 0] for w, r in zip(weighings, base, strict=True)])
    found = signatures(problem, candidates, weighings, base, held_out)
    models = _models(left, found, _library(problem, weighings))
    return _answer(problem, models, [*base, *held_out])


def signatures(
    problem: Problem,
    candidates: Sequence[Candidate],
    weighings: Sequence[Whiten],
    base: Sequence[np.ndarray],
    held_out: Sequence[np.ndarray],
) -> list[Signature]:
    """Signatures of every candidate at every start; of mistakes in the data as they are."""
    found = []
    for one in candidates:
        system = one.apply(problem.system)
        for start in one.starts or ({},):
            values = {**problem.plain.values, **start}
            parts = [*_steps(problem.calibration, system, values, base)]
            parts += _steps(problem.evaluation, system, values, held_out)
            if not one.parameters:
                parts = [np.where(_better(r, r - p), p, 0.0) for r, p in zip([*base, *held_out], parts, strict=True)]
            columns = [w(p[..., None])[:, 0] for w, p in zip(weighings, parts, strict=False)]
            white = np.concatenate(columns)
            if not np.isfinite(white).all() or not white.any():
                continue
            low, high = _range(one, start)
            label = f"{one.label} {start}"
            found.append(Signature(one.name, label, max(len(one.parameters), 1), low, high, tuple(parts), white))
    return found


def _steps(measured: Measured, system: Any, values: Mapping[str, float], before: Sequence[np.ndarray]) -> list[Any]:
    return [b - a for a, b in zip(measured.residuals(system, values), before, strict=True)]


def _better(without: Float[np.ndarray, "t c"], having: Float[np.ndarray, "t c"]) -> bool:
    """Whether undoing a mistake brings a trial closer to the base, channels in units of what they miss without."""
    size = np.maximum(np.sqrt(np.mean(without**2, axis=0)), 1e-300)
    return bool(np.mean((having / size) ** 2) < 0.5 * np.mean((without / size) ** 2))


def _range(one: Candidate, start: Mapping[str, float]) -> tuple[float, float]:
    """Bounds of the coefficient."""
    if not one.parameters:
        return 1.0, 1.0
    p = one.parameters[0]
    none, there = one.neutral.get(p.name), start.get(p.name, p.start)
    if none is None or there == none or not np.isfinite(none):
        return 0.0, np.inf
    ends = sorted(((p.lower - none) / (there - none), (p.upper - none) / (there - none)))
    return min(ends[0], 0.0), max(ends[1], 0.0)


def _library(problem: Problem, weighings: Sequence[Whiten]) -> Float[np.ndarray, "n f"]:
    """Orthonormal columns that span monomials of inputs, rates and time, in every channel, whitened."""
    inputs, channels = problem.system.inputs, len(problem.system.outputs)
    movements = [recorded(trial.signals, inputs) for trial in problem.calibration.trials]
    states = [
        np.column_stack([*m.position, *m.rate, t.time - t.time[0]])
        for m, t in zip(movements, problem.calibration.trials, strict=True)
    ]
    whole = np.concatenate(states)
    middle, spread = whole.mean(axis=0), np.maximum(whole.std(axis=0), 1e-12)
    degree = DEGREES.get(len(inputs), 2)
    powers = [p for d in range(degree + 1) for p in combinations_with_replacement(range(whole.shape[1]), d)]
    white = []
    for w, state in zip(weighings, states, strict=True):
        z = (state - middle) / spread
        monomials = np.column_stack([np.prod(z[:, list(p)], axis=1) for p in powers])
        white.append(w(np.concatenate([_in_channel(monomials, c, channels) for c in range(channels)], axis=2)))
    u, s, _ = np.linalg.svd(np.concatenate(white), full_matrices=False)
    return np.asarray(u[:, s > 1e-8 * s[0]])


def _in_channel(columns: Float[np.ndarray, "t f"], c: int, channels: int) -> Float[np.ndarray, "t c f"]:
    placed = np.zeros((len(columns), channels, columns.shape[1]))
    placed[:, c] = columns
    return placed


def _models(
    left: Float[np.ndarray, " n"], found: Sequence[Signature], library: Float[np.ndarray, "n f"]
) -> list[SignatureModel]:
    """Nothing, the unnamed, every effect at its best start, and the leading ones with a second."""
    n = len(left)
    names = float(len({one.name for one in found}))

    def bic(rss: float, k: int, choices: float) -> float:
        return n * float(np.log(max(rss, 1e-300) / n)) + k * float(np.log(n)) + 2.0 * float(np.log(choices))

    whole = float(left @ left)
    along = library.T @ left
    nothing = SignatureModel((NONE,), bic(whole, 0, 1.0))
    unnamed = SignatureModel((UNKNOWN,), bic(whole - float(along @ along), library.shape[1], 1.0))
    best: dict[frozenset[str], SignatureModel] = {}

    def offer(model: SignatureModel) -> None:
        key = frozenset(model.names)
        if key not in best or model.bic < best[key].bic:
            best[key] = model

    for one in found:
        c = _clipped(one, left)
        offer(SignatureModel((one.name,), bic(_rss(left, (one, c)), one.count, names), (c,), (one,)))
    for first in sorted(best.values(), key=lambda model: model.bic)[:FIRSTS]:
        own, c = first.signatures[0], first.coefficients[0]
        alone = _rss(left, (own, c))
        for second in found:
            if second.name == own.name:
                continue
            a, b = c, 0.0
            for _ in range(ROUNDS):
                b = _clipped(second, left - a * own.white)
                a = _clipped(own, left - b * second.white)
            rss = _rss(left, (own, a), (second, b))
            both = bic(rss, own.count + second.count, names * (names - 1) / 2.0)
            if both < first.bic - VERY_STRONG and alone - rss > WORTH * (whole - alone):
                offer(SignatureModel((own.name, second.name), both, (a, b), (own, second)))
    return [nothing, unnamed, *best.values()]


def _rss(left: Float[np.ndarray, " n"], *terms: tuple[Signature, float]) -> float:
    rest = left - sum((c * one.white for one, c in terms), np.zeros(len(left)))
    return float(rest @ rest)


def _clipped(one: Signature, left: Float[np.ndarray, " n"]) -> float:
    """Least-squares coefficient within its bounds."""
    power = float(one.white @ one.white)
    return float(np.clip(float(one.white @ left) / power, one.low, one.high)) if power > 0.0 else 0.0


def _answer(problem: Problem, models: Sequence[SignatureModel], residuals: Sequence[np.ndarray]) -> dict[str, Any]:
    least = min(model.bic for model in models)
    weights = {model.names: float(np.exp(-0.5 * (model.bic - least))) for model in models}
    total = sum(weights.values())
    probabilities: dict[str, float] = {}
    for names, weight in weights.items():
        for name in names:
            probabilities[name] = probabilities.get(name, 0.0) + weight / total / len(names)
    probabilities = dict(sorted(probabilities.items(), key=lambda each: -each[1]))
    named = [model for model in models if model.signatures]
    first = min(named, key=lambda model: model.bic)
    best = min(models, key=lambda model: model.bic)
    verdict = "explained" if best.signatures else UNKNOWN
    if best.bic > models[0].bic - VERY_STRONG:
        verdict = "no_gap"
    alive = [name for name, p in probabilities.items() if p >= ALIVE and name not in (NONE, UNKNOWN)]
    if verdict == "explained" and len(alive) > MOST:
        verdict = "unresolved"
    if verdict == UNKNOWN and not alive:
        alive = list(first.names)
    effects = list(first.names) if verdict == "explained" else []
    chosen = first if verdict in ("explained", "unresolved") else models[0]
    return {
        "verdict": verdict,
        "effects": effects,
        "probabilities": probabilities,
        "ambiguity": [] if verdict == "no_gap" else [*effects, *(name for name in alive if name not in effects)],
        "absorbed": [],
        "gap": _reductions(problem, chosen, residuals),
    }


def _reductions(problem: Problem, chosen: SignatureModel, residuals: Sequence[np.ndarray]) -> dict[str, Any]:
    """On the held-out trials: what is left once the signatures are taken off; interval by a bootstrap of blocks.

    Nobody claims a reduction below 0.
    """
    count = len(problem.calibration.trials)
    rng = np.random.default_rng(0)
    gap = {}
    for c, channel in enumerate(problem.system.outputs):
        before, after = [], []
        for i in range(count, len(residuals)):
            there = problem.evaluation.present[i - count][:, c]
            off = residuals[i][there, c]
            parts = zip(chosen.coefficients, chosen.signatures, strict=True)
            rest = off - sum((a * s.parts[i][there, c] for a, s in parts), np.zeros(len(off)))
            before += [float(block @ block) for block in np.array_split(off, BLOCKS)]
            after += [float(block @ block) for block in np.array_split(rest, BLOCKS)]
        squares = np.array([before, after])
        drawn = squares[:, rng.integers(0, squares.shape[1], (DRAWS, squares.shape[1]))].sum(axis=2)
        first, second = squares.sum(axis=1)
        reductions = 1.0 - np.sqrt(drawn[1] / np.maximum(drawn[0], 1e-300))
        low, high = np.quantile(reductions, [0.025, 0.975])
        gap[channel] = {
            "reduction": max(float(1.0 - np.sqrt(second / first)), 0.0) if first > 0.0 else 0.0,
            "ci95": [max(float(low), 0.0), max(float(high), 0.0)],
        }
    return gap
