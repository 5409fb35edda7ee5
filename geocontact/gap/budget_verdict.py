"""The verdict follows from the budget of the squared error on held-out trials (`gap.reduction.error_budget`).

Evidence says which effect, the budget whether there is anything to explain and how much of it is explained. With the
shares of all channels in units of their floors:

    explained          stays so where what is surely missed beside it is at most `LEFT_OVER` of both together
    partly_explained   an effect is sure, and more than that is surely missed beside it, or a channel is surely
                       predicted worse with it, by `WORTH_NAMING` of its squared error
    unknown            at least `WORTH_NAMING` of a channel's squared error is surely missed, or its error is more than
                       twice its floor, and nothing is sure
    no_gap             neither; an unknown gap, too, where stated noise and variation leave less than `WORTH_NAMING` of
                       every channel unexplained

What is named and surely takes less than `WORTH_NAMING` of every channel is not named: it is
detected (`gap.detected`). Something *surely missed* repeats from trial to
trial, or is shared by neighbours in time far beyond stated noise. Between sure and nothing the evidence decides, with
shares as estimated: levels of noise are known to a factor, so that the interval of what is unexplained reaches beyond
`WORTH_NAMING` even where all error is noise as stated.

An effect beside which something remains is *sure* where no rule speaks against it, its gain is `SURE` beyond that of
every other effect by the tolerance that forms have, it takes more than what is missed then, and its amplitude scatters
between trials no more than chance has it. That scatter is not compared with rates: a law that depends on the rate where
it should not shows in trials of different rates only.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from scipy.special import chdtri

from geocontact.data.diagnosis import Partial
from geocontact.gap.attribute import Attribution
from geocontact.gap.case.change_amplitude import block_edges
from geocontact.gap.case.problem import Problem
from geocontact.gap.levels import LEFT_OVER, SLIGHT, SURE, TWOFOLD, WORTH_NAMING
from geocontact.gap.reduction.error_budget import ChannelBudget
from geocontact.gap.reduction.error_reduction import error_reduction
from geocontact.gap.reduction.raw_input_errors import RawInputErrors
from geocontact.gap.selection.held_out_rules import TrialWeight, changes
from geocontact.gap.selection.model_comparison import Contender
from geocontact.gap.selection.verdict import Answer

Budget = Mapping[str, ChannelBudget]


def totals(budget: Budget, errors: RawInputErrors, problem: Problem) -> tuple[float, float, float]:
    """What is named takes, what is surely missed beside it, and what is unexplained, missed or not.

    Of all channels, in squares of their floors.
    """
    count = len(problem.calibration.trials)
    takes = missed = unexplained = 0.0
    for c, name in enumerate(problem.system.outputs):
        if name in budget:
            size = sum(float((part[:, c] ** 2).sum()) for part in errors.before[count:]) / float(problem.floor[c]) ** 2
            one = budget[name]
            takes += size * one.parts["effects"].share
            missed += size * one.missed
            unexplained += size * max(one.parts["unexplained"].share, one.missed)
    return takes, missed, unexplained


def by_budget(found: Attribution, budget: Budget, errors: RawInputErrors) -> Answer:
    """The answer as the budget of its own model has it; see the module."""
    said = found.answer
    sure = any(one.missed >= WORTH_NAMING for one in budget.values())
    gap = sure or any(one.floor < np.exp(-2.0 * TWOFOLD) for one in budget.values())
    if said.effects and found.data_error is None and takes_little(budget):
        return _unnamed(found, gap)
    if said.effects:
        takes, missed, _ = totals(budget, errors, found.problem)
        much = sure and missed > LEFT_OVER * (takes + missed)
        return replace(said, verdict="partly_explained") if much or grows(budget) else said
    if said.verdict == "no_gap" and gap:
        return _moved(said, "none", "unknown", "unknown")
    if said.verdict == "unknown" and not gap and closed(found, budget):
        return _moved(said, "unknown", "none", "no_gap")
    return said


def takes_little(budget: Budget) -> bool:
    """Whether what is named surely takes less than `WORTH_NAMING` of the squared error of every channel."""
    return all(one.parts["effects"].ci95[1] < WORTH_NAMING for one in budget.values())


def grows(budget: Budget) -> bool:
    """Whether the squared error of a channel is surely larger with what is named, by `WORTH_NAMING`."""
    return any(e.ci95[1] < 0.0 and e.share <= -WORTH_NAMING for e in (one.parts["effects"] for one in budget.values()))


def withdrawn(found: Attribution) -> Attribution:
    """Without what is named, which may only imitate something else; its verdict is unknown."""
    label, why = found.answer.chosen.label, "it takes less than what is described without a model, and may imitate it"
    return replace(found, answer=_unnamed(found, True), objections={**found.objections, label: why})


def _unnamed(found: Attribution, gap: bool) -> Answer:
    """Nothing named: no gap, or unknown where there is one; it has the effects' probability."""
    said, instead = found.answer, "unknown" if gap else "none"
    moved = sum(said.probabilities.get(name, 0.0) for name in said.effects)
    odds = {**said.probabilities, **dict.fromkeys(said.effects, 0.0)}
    odds[instead] = odds.get(instead, 0.0) + moved
    odds = dict(sorted(odds.items(), key=lambda each: -each[1]))
    return Answer("unknown" if gap else "no_gap", (), odds, said.ambiguity, found.base)


def closed(found: Attribution, budget: Budget) -> bool:
    """Whether stated noise of every channel, and what trials vary by, leave next to nothing of its squared error.

    As estimated; not where no channel has a budget.
    """
    return (
        bool(budget)
        and set(budget) <= set(found.stated)
        and all(one.parts["unexplained"].share < WORTH_NAMING for one in budget.values())
    )


def with_gap(said: Answer) -> Answer:
    """The answer where something surely is missing that no effect is: no gap is unknown, others stay."""
    return _moved(said, "none", "unknown", "unknown") if said.verdict == "no_gap" else said


def _moved(said: Answer, source: str, target: str, verdict: str) -> Answer:
    """Another verdict, with the probability of what it was."""
    odds = {**said.probabilities, source: 0.0}
    odds[target] = odds.get(target, 0.0) + said.probabilities.get(source, 0.0)
    odds = dict(sorted(odds.items(), key=lambda each: -each[1]))
    return replace(said, verdict=verdict, probabilities=odds)  # type: ignore[arg-type]


def partial(found: Attribution) -> tuple[Contender, Partial] | None:
    """What the effect that gains most explains of a gap that is not all explained by it; two, where a second one adds
    as much as it must to be named.

    Not one that a rule speaks against, nor one whose amplitude is on the bound of what is physical, nor a mistake in
    the data, which is there or not but is no part of a gap. None where nobody gains more than luck may, and where no
    channel loses `WORTH_NAMING` of its squared error on held-out trials, what an effect must take to be named.
    """
    able = [one for one in found.contenders if not one.cut_short and not one.mistaken]
    free = [one for one in able if one.label not in found.objections]
    alone = max((one for one in free if len(one.names) == 1), key=lambda one: one.nats, default=found.base)
    both = max(free, key=lambda one: one.nats, default=found.base)
    needed = SURE + WORTH_NAMING * max(alone.nats - found.base.nats, 0.0)
    best = both if both.nats - alone.nats > needed else alone
    gain = best.nats - found.base.nats
    if gain < SURE:
        return None
    shrunk = error_reduction(found.problem, found.clean, best.judged, True, found.data_error)
    if all(1.0 - (1.0 - s.reduction) ** 2 < WORTH_NAMING for s in shrunk.values()):
        return None
    return best, Partial(best.names, gain, {name: (s.reduction, (s.low, s.high)) for name, s in shrunk.items()})


def sure_beside(found: Attribution, one: Contender) -> bool:
    """Whether a model is the only one of its kind, and all trials have its effects to the same amplitude."""
    return leads(found, one) and steady(found, one)


def leads(found: Attribution, one: Contender) -> bool:
    """Whether a model gains surely more than the base and every model of other effects."""
    others = [each.nats for each in found.contenders if not set(each.names) & set(one.names)]
    ahead = one.nats - max([found.base.nats, *others])
    return ahead > SURE * (1.0 + SLIGHT * (one.nats - found.base.nats))


def named_beside(said: Answer, one: Contender, remains: bool) -> Answer:
    """A model named where the evidence has the gap unknown, partly explained where something remains.

    Its effects share half of what was stated of anything unknown then, else all of it.
    """
    moved = (0.5 if remains else 1.0) * said.probabilities.get("unknown", 0.0)
    odds = {**said.probabilities, "unknown": said.probabilities.get("unknown", 0.0) - moved}
    for name in one.names:
        odds[name] = odds.get(name, 0.0) + moved / len(one.names)
    odds = dict(sorted(odds.items(), key=lambda each: -each[1]))
    return Answer("partly_explained" if remains else "explained", one.names, odds, one.names, one)


def steady(found: Attribution, one: Contender) -> bool:
    """Whether the amplitude of what a model changes does not differ between trials, beyond `LEFT_OVER` of it and
    beyond chance.
    """
    problem, base = found.clean, found.base
    change = changes(problem, base, one)
    varied = problem.varied(base.judged.model.jacobian)
    sizes, errors = [], []
    rows = zip(one.judged.model.residuals, change, varied, problem.recorded.present, strict=True)
    for residual, moved, spread, there in rows:
        weight = TrialWeight.of(there, problem.floor, spread * base.judged.noise.varies)
        rest, own = weight(residual), weight(moved)
        power = float((own**2).sum())
        if power > 0.0:
            off, error = amplitude_left(rest, own, power)
            sizes.append(off)
            errors.append(error)
    return not differ(sizes, errors)


def amplitude_left(rest: np.ndarray, own: np.ndarray, power: float) -> tuple[float, float]:
    """How much more of a change a trial has than a model gives it, as a share, and its standard error by blocks."""
    work = (rest * own).sum(axis=1)
    off = float(work.sum()) / power
    left = np.add.reduceat(work - off * (own**2).sum(axis=1), block_edges(len(own)))
    alone = float(((own * (rest - off * own)).sum(axis=1) ** 2).sum())
    return off, float(np.sqrt(max(float(left @ left), alone))) / power


def differ(sizes: Sequence[float], errors: Sequence[float]) -> bool:
    """Whether amplitudes differ by more than `LEFT_OVER` of them and by more than their errors make (Cochran 1954)."""
    if len(sizes) < 2:
        return False
    a, weights = np.asarray(sizes), 1.0 / np.maximum(np.asarray(errors), 1e-12) ** 2
    middle = float((weights * a).sum() / weights.sum())
    scatter = float((weights * (a - middle) ** 2).sum())
    return bool(np.std(a, ddof=1) > LEFT_OVER and scatter > chdtri(len(a) - 1, np.exp(-SURE)))
