"""From evidence to a verdict that can be trusted either way: explained, no gap, unknown, unresolved.

Real effects never have exactly the form of a candidate, so differences of evidence are not taken at face value: they
are divided by a tolerance that grows with what there is to explain. What the best model leaves over speaks for an
effect outside the table.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from geocontact.gap.contest import Contender

Verdict = Literal["explained", "no_gap", "unknown", "unresolved"]

SURE = 6.0  # nats below which a gain may be luck
FORM = 0.02  # tolerance of form, as a share of what is explained
LEFT_OVER = 0.12  # of all there is to explain may be left by the effect that is named
PAIR = 0.05  # of what is explained that a second effect must add
ALIVE = 0.03  # least probability of a candidate that is still in question
MOST = 4  # candidates still in question beyond which nothing is named


@dataclass(frozen=True)
class Answer:
    """What is said, and how sure it is."""

    verdict: Verdict
    effects: tuple[str, ...]
    probabilities: dict[str, float]
    ambiguity: tuple[str, ...]
    chosen: Contender


def answer(
    base: Contender,
    contenders: Sequence[Contender],
    unnamed: float,
    left: Mapping[str, float],
) -> Answer:
    """The verdict.

    Parameters
    ----------
    base
        The base model.
    contenders
        Models with one candidate or two.
    unnamed
        What a stand-in for anything unknown gains over the base [nats].
    left
        What it gains on top of a contender, by label, where that was asked [nats].
    """
    zero = base.judged.nats
    ranked = sorted(contenders, key=lambda c: -c.judged.nats)
    single = [c for c in ranked if len(c.names) == 1]
    pairs = [c for c in ranked if len(c.names) == 2]
    best_single = single[0].judged.nats - zero if single else 0.0
    needed = SURE + PAIR * max(best_single, 0.0)
    pairs = [c for c in pairs if c.judged.nats - zero - best_single > needed]
    living = [*single, *pairs]
    gains = {c.label: c.judged.nats - zero - (needed if len(c.names) == 2 else 0.0) for c in living}
    most = max([*gains.values(), unnamed, 0.0])
    tolerance = 1.0 + FORM * most
    weights: dict[tuple[str, ...], float] = {("none",): np.exp((SURE - most) / tolerance)}
    for c in living:
        weights[c.names] = max(weights.get(c.names, 0.0), np.exp((gains[c.label] - most) / tolerance))
    best = max(living, key=lambda c: gains[c.label], default=base)
    rest = left.get(best.label, 0.0)
    excess = rest - SURE - LEFT_OVER * most
    doubt = 1.0 / (1.0 + np.exp(-excess / (1.0 + 0.5 * FORM * most + 0.1 * abs(rest))))
    explained = sum(weights.values())
    weights[("unknown",)] = np.exp((unnamed - most) / tolerance) + explained * doubt / max(1.0 - doubt, 1e-9)
    total = sum(weights.values())
    shared: dict[str, float] = {}
    for names, weight in weights.items():
        for name in names:
            shared[name] = shared.get(name, 0.0) + weight / total / len(names)
    return _said(base, living, gains, {names: w / total for names, w in weights.items()}, shared)


def _said(
    base: Contender,
    living: Sequence[Contender],
    gains: Mapping[str, float],
    joint: Mapping[tuple[str, ...], float],
    shared: dict[str, float],
) -> Answer:
    order = sorted(shared, key=lambda name: -shared[name])
    probabilities = {name: shared[name] for name in order}
    alive = tuple(name for name in order if name not in ("none", "unknown") and shared[name] >= ALIVE)
    effects_odds = 1.0 - joint[("none",)] - joint[("unknown",)]
    top = max(joint, key=lambda names: joint[names])
    if joint[("none",)] >= max(effects_odds, joint[("unknown",)]):
        return Answer("no_gap", (), probabilities, (), base)
    if joint[("unknown",)] >= effects_odds:
        return Answer("unknown", (), probabilities, alive, base)
    named = top if top[0] not in ("none", "unknown") else max(
        (names for names in joint if names[0] not in ("none", "unknown")), key=lambda names: joint[names]
    )
    chosen = max((c for c in living if c.names == named), key=lambda c: gains[c.label])
    if len(alive) > MOST:
        return Answer("unresolved", (), probabilities, alive, chosen)
    ambiguity = (*named, *(name for name in alive if name not in named))
    return Answer("explained", named, probabilities, ambiguity if len(ambiguity) > len(named) else named, chosen)
