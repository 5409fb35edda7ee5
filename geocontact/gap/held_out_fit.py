"""Whether a diagnosis agrees with the trials that were held out, and what is left of it where it does not.

What is named was judged by evidence and rules before (`gap.selection`). Here the answer as it is reported stands beside
its own residual: errors of every channel before and after, the noise that is stated, and the interval of the reduction.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from geocontact.data.diagnosis import ChannelGap, Diagnosis
from geocontact.gap.levels import LEFT_OVER, WORTH_NAMING
from geocontact.identify.goodness_of_fit import FAR, LARGER, MUCH, Doubt, GoodnessOfFit

FEW = 2
"""Held-out trials of which the interval for a new one is wide whatever is named."""


def goodness_of_diagnosis(d: Diagnosis) -> GoodnessOfFit:
    """Errors on held-out trials of what is named; where nothing is, whether the base model leaves more than noise."""
    if not d.effects:
        return GoodnessOfFit(tuple(_unnamed(d)), tuple(d.gap))
    main = d.where[0].channel if d.where else max(d.gap, key=lambda name: _square(d.gap[name].rmse_before, d.gap[name]))
    doubts = [*_of_rest(d), *_of_main(main, d.gap[main])]
    for name, gap in d.gap.items():
        if name != main and gap.removed < -WORTH_NAMING:
            what = f"{name}: the error on held-out trials is {1.0 - gap.removed:.2f} times that without the effect"
            doubts.append(Doubt(what, False, -gap.removed))
    return GoodnessOfFit(tuple(doubts), tuple(d.gap))


def _square(size: float, gap: ChannelGap) -> float:
    """Squared error beyond noise, in units of the noise."""
    floor = gap.noise_floor
    return max((size / floor) ** 2 - 1.0, 0.0) if floor > 0.0 else 0.0


def _unnamed(d: Diagnosis) -> Iterable[Doubt]:
    """No effect is claimed that errors could contradict; but no model that was tried describes such a channel."""
    for name, gap in d.gap.items():
        if gap.rmse_after > LARGER * gap.noise_floor:
            times = gap.rmse_after / max(gap.noise_floor, 1e-300)
            yield Doubt(f"{name}: residual on held-out trials is {times:.3g} times the noise floor", False, times)


def _of_rest(d: Diagnosis) -> Iterable[Doubt]:
    """What stays of the squared error of all channels together, noise taken off.

    It contradicts nothing that is named as a part only.
    """
    before, after = (
        sum(_square(size, gap) for gap, size in ((g, getattr(g, of)) for g in d.gap.values()))
        for of in ("rmse_before", "rmse_after")
    )
    noisy = all(gap.rmse_after <= LARGER * gap.noise_floor for gap in d.gap.values())
    if before > 0.0 and not noisy and after > LEFT_OVER * before:
        rest = after / before
        far = any(gap.rmse_after > FAR * gap.noise_floor for gap in d.gap.values())
        yield Doubt(
            f"{rest:.0%} of the squared error on held-out trials stay",
            rest >= MUCH and far and d.verdict == "explained",
            rest,
        )


def _of_main(name: str, gap: ChannelGap) -> Iterable[Doubt]:
    low, high = gap.ci95
    if gap.removed <= 0.0:
        what = f"{name}: the error on held-out trials is not smaller with what is named"
        yield Doubt(what, True, 1.0 - gap.removed)
    if high < 0.0:
        yield Doubt(f"{name}: a new trial is expected to be predicted worse with what is named", True, -high)
    elif low <= 0.0 and gap.trials > FEW:
        yield Doubt(f"{name}: the interval of the reduction on a new trial reaches 0", False, -low)


def without_claims(d: Diagnosis, why: str) -> Diagnosis:
    """The diagnosis with nothing named: unknown, the effects among what is in question, `why` among its remarks.

    Errors are those of the base model; there is no budget, whose parts are of what was named.
    """
    moved = sum(d.probabilities.get(name, 0.0) for name in d.effects)
    odds = {name: value for name, value in d.probabilities.items() if name not in d.effects}
    odds["unknown"] = odds.get("unknown", 0.0) + moved
    rivals = tuple(name for name in d.ambiguity if name not in d.effects)
    remark = f"{' + '.join(d.effects)} is not named: {why}"
    return replace(
        d,
        verdict="unknown",
        effects=(),
        probabilities=dict(sorted(odds.items(), key=lambda each: -each[1])) | dict.fromkeys(d.effects, 0.0),
        ambiguity=rivals,
        remarks=(*d.remarks, remark),
        where=tuple(replace(one, stage="") for one in d.where),
        gap={name: _before(gap) for name, gap in d.gap.items()},
        behind={},
        one_law=(),
        apart={},
        budget={},
        detected=(),
        unmodelled=(),
    )


def _before(gap: ChannelGap) -> ChannelGap:
    return replace(gap, rmse_after=gap.rmse_before, reduction=0.0, ci95=(0.0, 0.0), unexplained=None)
