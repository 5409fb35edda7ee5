"""What is odd about a diagnosis, in words: recorders, what is missed, why something is not named, numbers on bounds."""

from __future__ import annotations

from collections.abc import Mapping

from geocontact.gap.attribute import Attribution
from geocontact.gap.case.noise_sources import coarse_rates
from geocontact.gap.case.refit import free
from geocontact.gap.levels import SURE, WORTH_NAMING
from geocontact.gap.reduction.error_budget import ChannelBudget
from geocontact.gap.reduction.error_reduction import error_reduction
from geocontact.gap.reduction.raw_input_errors import RawInputErrors
from geocontact.gap.selection.evidence import prior_spread
from geocontact.gap.selection.model_comparison import Contender


def remarks(
    found: Attribution, unexplained: bool, errors: RawInputErrors, budget: Mapping[str, ChannelBudget]
) -> tuple[str, ...]:
    """What is odd, in words; `unexplained` where nothing known explains a part of an unknown gap."""
    said = found.answer
    return (
        *(each.told for each in (*found.odd, *found.recorder)),
        *(f"{each.words} {found.problem.system.unit(each.channel)}, in {each.channel}" for each in found.flat),
        *(f"{each.words} in {channel}" for channel, each in found.heavy.items()),
        *missed_words(budget, said.verdict),
        *coarse_rates(found.problem),
        *objection(found),
        *(nearest(found) if said.verdict == "unknown" and unexplained else ()),
        *(on_bounds(said.chosen, found.base, errors.fitted, errors.values) if said.effects else ()),
    )


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


def missed_words(budget: Mapping[str, ChannelBudget], verdict: str) -> tuple[str, ...]:
    """How much of a channel's squared error is surely missed, where that is why nothing, or not all, is named."""
    if verdict not in ("unknown", "partly_explained"):
        return ()
    found = ((name, one.missed) for name, one in budget.items() if one.missed >= WORTH_NAMING)
    return tuple(
        f"at least {share:.0%} of the squared error of {name} is neither noise nor variation from trial to trial"
        for name, share in found
    )


def objection(found: Attribution) -> tuple[str, ...]:
    """In words why the model that gains most is not named, where it gains surely."""
    best = max(found.contenders, key=lambda one: one.nats, default=found.base)
    why, gain = found.objections.get(best.label, ""), best.nats - found.base.nats
    return (f"{best.label} gains {gain:.0f} nats and is not named: {why}",) if why and gain > SURE else ()


def on_bounds(chosen: Contender, base: Contender, values: dict[str, float], alone: dict[str, float]) -> tuple[str, ...]:
    """In words which shapes of named effects, and which base parameters only beside them, end on a bound.

    `values` are the parameters of what is named, `alone` those of the base model.
    """
    system, bare = chosen.judged.model.system, base.judged.model.system
    ended, stays = prior_spread(system, values) == 0.0, prior_spread(bare, alone) == 0.0
    shapes = {p.name for one in chosen.candidates for p in one.parameters[1:]}
    driven = {p.name for p, on_it in zip(free(bare), stays, strict=True) if not on_it}
    names = " + ".join(chosen.names)
    told = []
    for p, on_it in zip(free(system), ended, strict=True):
        if on_it and p.name in shapes:
            told.append(f"the shape {p.name} ends on its bound, {values[p.name]:.3g} {p.unit}")
        elif on_it and p.name in driven:
            told.append(f"with {names} the base parameter {p.name} ends on its bound, {values[p.name]:.3g} {p.unit}")
    return tuple(told)
