"""What known effects explain of a gap, where they do not explain all of it."""

from __future__ import annotations

from geocontact.data.gap.diagnosis import Partial
from geocontact.gap.attribute import Attribution
from geocontact.gap.levels import SURE, WORTH_NAMING
from geocontact.gap.reduction.error_reduction import error_reduction


def partial(found: Attribution) -> Partial | None:
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
    return Partial(best.names, gain, {name: (s.reduction, (s.low, s.high)) for name, s in shrunk.items()})


def nearest(found: Attribution) -> tuple[str, ...]:
    """In words what the model that gains most would do, where nothing was named although it gains something."""
    best = max(found.contenders, key=lambda one: one.nats, default=found.base)
    gain = best.nats - found.base.nats
    if gain < SURE:
        return ()
    shrunk = error_reduction(found.problem, found.clean, best.judged, True, found.data_error)
    parts = ", ".join(f"{100.0 * s.reduction:.0f} % of the error of {name}" for name, s in shrunk.items())
    only = ", with an amplitude on the bound of what is physical" if best.cut_short else ""
    return (f"nearest of the known effects: {best.label}, which gains {gain:.0f} nats and would remove {parts}{only}",)
