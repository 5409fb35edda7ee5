"""Effects that are sure, with their share of the squared error, whether that is worth a name or not.

An effect is detected where its evidence over the model without it is `SURE` after the tolerance that forms have, and
no rule speaks against it but that it takes too little (`gap.selection.held_out_rules`). Those that are named come
first, each beside the other of a pair; where nothing is named, the effect that gains most; then a second one beside it.
These two are sure where they gain as much more than every other effect in their place.
"""

from __future__ import annotations

from dataclasses import dataclass

from geocontact.data.diagnosis import Detected
from geocontact.gap.attribute import Attribution
from geocontact.gap.budget_verdict import leads
from geocontact.gap.case.plain_fit import measured_fit
from geocontact.gap.data_errors import put_back
from geocontact.gap.levels import SLIGHT, SURE
from geocontact.gap.reduction.error_budget import share_taken
from geocontact.gap.selection.held_out_rules import ONLY_NOISE, TOO_LITTLE, with_one
from geocontact.gap.selection.model_comparison import Contender


@dataclass(frozen=True)
class EffectGain:
    """An effect of a model, and the model without it."""

    name: str
    having: Contender
    lacking: Contender

    @property
    def nats(self) -> float:
        """What it gains there."""
        return self.having.nats - self.lacking.nats


def detected(found: Attribution) -> tuple[Detected, ...]:
    """What is sure, the most nats first; none beside a mistake in the data that is undone, which is named as such."""
    rows = []
    for one in _sure(found):
        shares = _shares(found, one)
        if shares:
            channel = max(shares, key=lambda name: shares[name][0])
            share, low, high = shares[channel]
            rows.append(Detected(one.name, one.nats, channel, share, (low, high)))
    return tuple(sorted(rows, key=lambda row: -row.nats))


def _sure(found: Attribution) -> list[EffectGain]:
    said, base = found.answer, found.base
    named = said.chosen if said.effects else base
    if not named.candidates:
        singles = [c for c in found.contenders if len(c.candidates) == 1 and _allowed(found, c)]
        best = max(singles, key=lambda c: c.nats, default=base)
        if best is base or not leads(found, best):
            return []
        named = best
    if any(one.somewhere is not None for one in named.candidates):
        return []
    if len(named.candidates) == 2:
        first, second = named.candidates
        lone = {one.label: _alone(found, named, one) for one in named.candidates}
        return [EffectGain(first.name, named, lone[second.label]), EffectGain(second.name, named, lone[first.label])]
    rows = [EffectGain(named.candidates[0].name, named, base)]
    pairs = [c for c in found.contenders if len(c.candidates) == 2 and named.candidates[0] in c.candidates]
    both = max((c for c in pairs if _allowed(found, c)), key=lambda c: c.nats, default=named)
    other = next((one for one in both.candidates if one != named.candidates[0]), None)
    rivals = [c.nats for c in pairs if other is not None and all(one.name != other.name for one in c.candidates)]
    if other is not None and both.nats - max([named.nats, *rivals]) > SURE * (1.0 + SLIGHT * (both.nats - base.nats)):
        rows.append(EffectGain(other.name, both, named))
    return rows


def _allowed(found: Attribution, one: Contender) -> bool:
    why = found.objections.get(one.label, "")
    return not one.cut_short and not one.mistaken and (not why or why.endswith((TOO_LITTLE, ONLY_NOISE)))


def _alone(found: Attribution, pair: Contender, one: object) -> Contender:
    known = next((c for c in found.contenders if c.candidates == (one,)), None)
    return known or with_one(found.clean, pair, next(each for each in pair.candidates if each == one))


def _shares(found: Attribution, one: EffectGain) -> dict[str, tuple[float, float, float]]:
    """Share of the base model's squared error on held-out trials that an effect takes, by channel, and its interval."""
    problem, clean = found.problem, found.clean
    count, names = len(problem.calibration.trials), [trial.name for trial in problem.recorded.trials]
    base, lacking, having = (
        [
            put_back(found.data_error, name, problem.system.outputs, part)
            for name, part in zip(names, measured_fit(clean, each.judged.model, clean.floor)[1], strict=True)
        ][count:]
        for each in (found.base, one.lacking, one.having)
    )
    taken = {}
    for c, channel in enumerate(problem.system.outputs):
        present = [there[:, c] for there in problem.recorded.present[count:]]
        columns = ([part[at, c] for part, at in zip(parts, present, strict=True)] for parts in (base, lacking, having))
        share = share_taken(*columns)
        if share is not None:
            taken[channel] = share
    return taken
