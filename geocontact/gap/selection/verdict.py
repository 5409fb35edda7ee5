"""From evidence to a verdict that can be trusted either way: explained, no gap, unknown, unresolved.

Real effects never have exactly the form of a candidate, so differences of evidence are not taken at face value: they
are divided by a tolerance that grows with what there is to explain. What the best model leaves over speaks for an
effect outside the table, and so does an amplitude that wants to be more than is physical.

The evidence takes the models, the noise and the rules as given. Where one of these is wrong it is sure of what is not
so, and an effect that is too small to be seen leaves no evidence at all. Both happen at a rate that is counted, not
computed, on cases whose truth is known: the lapse rate of an observer (Wichmann & Hill 2001, Perception &
Psychophysics 63: 1293-1313). What is stated is (1 - rate) of what was computed and `rate` of a guess: one half in equal
parts to the effects in question, and to none of them where the verdict is no gap, or to all where none is in question,
the other half in equal parts to every answer there is. The verdict, its effects and their order stay as they are.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from geocontact.gap.levels import LEFT_OVER, SLIGHT, SURE, WORTH_NAMING
from geocontact.gap.selection.model_comparison import Contender

Verdict = Literal["explained", "partly_explained", "no_gap", "unknown", "unresolved"]

BEYOND = 0.3  # part of what a gain exceeds that by that counts
MOST = 4  # candidates still in question beyond which nothing is named


@dataclass(frozen=True)
class Answer:
    """What is said, and how sure it is."""

    verdict: Verdict
    effects: tuple[str, ...]
    probabilities: dict[str, float]
    ambiguity: tuple[str, ...]
    chosen: Contender


def borne_out(total: float, calibration: float, share: float) -> float:
    """Gain over all trials, as far as the calibration trials bear it out.

    An effect that is there shows in the trials that it was fitted to as much as in the others, in proportion to what it
    changes there. `share` is the calibration trials' part of that. What is lost there is a price, and stays as it is.
    """
    expected = max(calibration, 0.0) / max(share, SLIGHT) + min(calibration, 0.0) + SURE
    return total if total <= expected else expected + BEYOND * (total - expected)


def gain_of(one: Contender, over: Contender, share: float) -> float:
    """What a model gains over another [nats]."""
    gain = borne_out(one.judged.nats - over.judged.nats, one.judged.calibration - over.judged.calibration, share)
    return gain + one.beside - over.beside


@dataclass(frozen=True)
class Ranking:
    """Who is weighed, and what each gains over the base, its choice paid for [nats], by label.

    `best` gains most, less than nothing perhaps; the base where nobody is weighed.
    """

    base: Contender
    living: tuple[Contender, ...]
    gains: Mapping[str, float]

    @property
    def best(self) -> Contender:
        """Who gains most."""
        return max(self.living, key=lambda c: self.gains[c.label], default=self.base)

    @property
    def leader(self) -> Contender:
        """The same, the base where nobody gains anything."""
        return self.best if self.gains.get(self.best.label, 0.0) > 0.0 else self.base


def ranking(
    base: Contender,
    contenders: Sequence[Contender],
    shares: Mapping[str, float],
    variants: Mapping[str, int],
    refused: Collection[str] = (),
) -> Ranking:
    """What the contenders gain; a pair is weighed where it adds enough to the best single, weighed or not.

    Who has no evidence that is a number is not weighed.

    Parameters
    ----------
    base
        The base model.
    contenders
        Models with one candidate or two.
    refused
        Labels of those that are not weighed.
    shares
        Calibration trials' part of what each changes, by label.
    variants
        How many candidates each effect has: they share its prior.
    """
    contenders = [c for c in contenders if np.isfinite(c.nats)]
    single = [c for c in contenders if len(c.candidates) == 1]
    chosen_from = {
        c.label: float(np.log([variants[one.name] * one.ways for one in c.candidates]).sum()) for c in contenders
    }
    over_base = {c.label: gain_of(c, base, shares[c.label]) - chosen_from[c.label] for c in contenders}
    best_single = max((over_base[c.label] for c in single), default=0.0)
    needed = SURE + WORTH_NAMING * max(best_single, 0.0)
    pairs = [c for c in contenders if len(c.candidates) == 2 and over_base[c.label] - best_single > needed]
    living = tuple(c for c in (*single, *pairs) if c.label not in refused)
    gains = {c.label: over_base[c.label] - (needed if len(c.candidates) == 2 else 0.0) for c in living}
    return Ranking(base, living, gains)


def answer(held: Ranking, unnamed: float, odd: float, rest: float, little: float = 0.0) -> Answer:
    """The verdict; FloatingPointError where what is given is not a number.

    Parameters
    ----------
    held
        Who is weighed.
    unnamed
        What a surrogate for anything unknown gains over the base [nats].
    odd
        Part of the squared error that is something odd for sure, 0 … 1. Its odds, over those of the part that may be
        unexplained (LEFT_OVER), are the weight of something unknown over all other weights together.
    rest
        What the surrogate gains on top of the best contender [nats]. What is there beside an effect is there without
        it as well: no more of it counts than what it gains over the base.
    little
        What a known effect gains that is too small to be named [nats]. What it explains is nothing unknown.
    """
    base, living, gains = held.base, held.living, held.gains
    unnamed = unnamed - little
    rest = min(rest, max(unnamed, 0.0))
    unnamed = (1.0 - WORTH_NAMING) * max(unnamed - 0.5 * SURE, 0.0)
    named = max([*gains.values(), 0.0])
    most = max(named, unnamed)
    tolerance = 1.0 + SLIGHT * most
    weights: dict[tuple[str, ...], float] = {("none",): np.exp((SURE - most) / tolerance)}
    for c in living:
        names = ("unknown",) if c.cut_short else c.names
        weights[names] = max(weights.get(names, 0.0), np.exp((gains[c.label] - most) / tolerance))
    excess = rest - SURE - LEFT_OVER * most
    doubt = 1.0 / (1.0 + np.exp(-excess / (1.0 + 0.5 * SLIGHT * most + 0.1 * abs(rest))))
    doubted = sum(weights.values()) * doubt / max(1.0 - doubt, 1e-9)
    weights[("unknown",)] = weights.get(("unknown",), 0.0) + np.exp((unnamed - most) / tolerance) + doubted
    weights[("unknown",)] += sum(weights.values()) * _odds(odd) / _odds(LEFT_OVER)
    total = sum(weights.values())
    if not np.isfinite(total):
        raise FloatingPointError("probabilities cannot be computed: what is left unexplained is not a number")
    shared: dict[str, float] = {}
    for names, weight in weights.items():
        for name in names:
            shared[name] = shared.get(name, 0.0) + weight / total / len(names)
    return _answer(base, living, gains, {names: w / total for names, w in weights.items()}, shared)


def _odds(part: float) -> float:
    return part / max(1.0 - part, 1e-9)


def most_of(held: Ranking, little: Collection[str]) -> float:
    """The most that any of these gains, by label; 0 where none does [nats]."""
    return max([0.0, *(held.gains[one.label] for one in held.living if one.label in little)])


def with_refused(said: Answer, held: Ranking) -> Answer:
    """The answer with what gains and may not be named among what is in question, where nothing is named.

    A rule may keep an effect from being named; the order of the ranking is not its matter. `held` weighs everyone who
    is not ruled out.
    """
    if said.effects or said.verdict == "unresolved":
        return said
    order = sorted(held.living, key=lambda one: -held.gains[one.label])
    gaining = (name for one in order if held.gains[one.label] > SURE and not one.cut_short for name in one.names)
    return replace(said, ambiguity=tuple(dict.fromkeys([*gaining, *said.ambiguity]))[:MOST])


def contradicted(said: Answer, held: Ranking, harmful: Ranking) -> Answer:
    """The answer, unknown where a single effect that harms a channel gains more than twice what is named gains.

    The evidence speaks for that effect, a channel of the held-out trials against it: that does not make another effect
    the likely one. All of them are in question, and the probability of what was named is that of something unknown.

    Parameters
    ----------
    held
        Who may be named.
    harmful
        Who gains and surely predicts a channel of the held-out trials worse.
    """
    alone = [one for one in harmful.living if len(one.candidates) == 1 and not one.cut_short]
    best = max(alone, key=lambda one: harmful.gains[one.label], default=None)
    if best is None or not said.effects or said.chosen.mistaken:
        return said
    if harmful.gains[best.label] <= 2.0 * held.gains[said.chosen.label] + SURE:
        return said
    odds = said.probabilities | dict.fromkeys(said.effects, 0.0)
    odds["unknown"] = odds.get("unknown", 0.0) + sum(said.probabilities[name] for name in said.effects)
    return Answer("unknown", (), _normal(odds), tuple(dict.fromkeys([*best.names, *said.ambiguity]))[:MOST], held.base)


def with_mistake(said: Answer, mistake: str) -> Answer:
    """The answer once a mistake in the data was undone first: the mistake is named, and what else was found with it.

    Where nothing else is wrong the mistake is the whole answer. With an effect beside it the two share the effect's
    probability; with something unknown beside it the case stays unknown, and the mistake is what is still in question.
    """
    odds = said.probabilities
    beside = {name: value for name, value in odds.items() if name not in ("none", "unknown", mistake)}
    alone = odds.get("none", 0.0) + odds.get(mistake, 0.0)
    probabilities = {mistake: alone + sum(beside.values()) / 2.0, "unknown": odds.get("unknown", 0.0)}
    probabilities = _normal(probabilities | {name: value / 2.0 for name, value in beside.items()})
    if said.verdict == "no_gap":
        return Answer("explained", (mistake,), probabilities, (mistake,), said.chosen)
    if said.verdict == "explained":
        named = (mistake, *(name for name in said.effects if name != mistake))[:2]
        ambiguity = (*named, *(name for name in said.ambiguity if name not in named))
        return Answer("explained", named, probabilities, ambiguity, said.chosen)
    ambiguity = (mistake, *(name for name in said.ambiguity if name != mistake))
    return Answer(said.verdict, (), probabilities, ambiguity, said.chosen)


def _normal(probabilities: Mapping[str, float]) -> dict[str, float]:
    total = sum(probabilities.values())
    return {k: v / total for k, v in sorted(probabilities.items(), key=lambda each: -each[1])}


def _answer(
    base: Contender,
    living: Sequence[Contender],
    gains: Mapping[str, float],
    joint: Mapping[tuple[str, ...], float],
    shared: dict[str, float],
) -> Answer:
    order = sorted(shared, key=lambda name: -shared[name])
    probabilities = {name: shared[name] for name in order}
    alive = tuple(name for name in order if name not in ("none", "unknown") and shared[name] >= SLIGHT)
    effects_odds = 1.0 - joint[("none",)] - joint[("unknown",)]
    top = max(joint, key=lambda names: joint[names])
    if joint[("none",)] >= max(effects_odds, joint[("unknown",)]):
        return Answer("no_gap", (), probabilities, (), base)
    if joint[("unknown",)] >= effects_odds:
        return Answer("unknown", (), probabilities, alive, base)
    named = (
        top
        if top[0] not in ("none", "unknown")
        else max((names for names in joint if names[0] not in ("none", "unknown")), key=lambda names: joint[names])
    )
    chosen = max((c for c in living if c.names == named and not c.cut_short), key=lambda c: gains[c.label])
    named = tuple(sorted(named, key=lambda name: -shared[name]))
    if len(alive) > MOST:
        return Answer("unresolved", (), probabilities, alive, chosen)
    ambiguity = (*named, *(name for name in alive if name not in named))
    return Answer("explained", named, probabilities, ambiguity if len(ambiguity) > len(named) else named, chosen)


NAMED = 0.1  # rate where an effect is named
QUESTIONED = 0.65  # of "no gap" where effects are in question: at home nothing was missing in 6 of 17 such cases
SILENT = 0.3  # of every other answer that names nothing


def with_lapses(said: Answer, offered: Iterable[str]) -> Answer:
    """The answer with its probabilities as they are stated.

    Parameters
    ----------
    said
        Its probabilities are computed from evidence, and sum to 1.
    offered
        Effects that the system has candidates for, each once or more.
    """
    questioned = said.verdict == "no_gap" and bool(said.ambiguity)
    rate = NAMED if said.effects else QUESTIONED if questioned else SILENT
    every = dict.fromkeys(["none", "unknown", *offered, *said.probabilities])
    likely = (("none", *said.ambiguity) if questioned else said.ambiguity) or tuple(every)
    blind = {name: 0.5 / len(every) + (0.5 / len(likely) if name in likely else 0.0) for name in every}
    stated = {name: (1.0 - rate) * said.probabilities.get(name, 0.0) + rate * blind[name] for name in every}
    return replace(said, probabilities=dict(sorted(stated.items(), key=lambda each: -each[1])))
