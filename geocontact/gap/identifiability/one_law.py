"""Which effects are one law on these trials: each, and the base refitted, predicts what another in question predicts.

Two models with effects, both fitted to the trials, are held against each other: what one leaves of the other's
prediction (`gap.experiment.competing_models`), either way round, are the nats by which trials of this kind tell them
apart. Effects that all leave less than `APART` of each other are an equivalence class: the trials answer with the
class, and which of its members is there is not for them to say. Others that are still in question can mostly be told
apart by these trials, yet the evidence does not: the form of no candidate is exact, so that a lead counts for less than
it is. A model with fewer effects than what is named is in no class.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from geocontact.gap.attribute import Attribution
from geocontact.gap.experiment.competing_models import ModelPair, competing_models, fitted, on_trials
from geocontact.gap.identifiability.separability import Separation, classes


@dataclass(frozen=True)
class OneLaw:
    """What is said of the effects in question beside what is named.

    Parameters
    ----------
    classes
        Of each effect that is named and is one law with others: itself first, then these, the likeliest first.
    apart
        By how many nats, all trials together, these trials tell each effect in question from what is named: the larger
        of both ways round.
    """

    classes: tuple[tuple[str, ...], ...] = ()
    apart: Mapping[str, float] = field(default_factory=dict)


def one_law(found: Attribution) -> OneLaw:
    """The classes of what is named, or of what is likeliest where too many remain; none of no gap and of unknown.

    Of two effects each has a class of its own: those that may stand in its place beside the other.
    """
    said = found.answer
    if not said.chosen.candidates or said.verdict == "unknown":
        return OneLaw()
    models = {frozenset(one.names): fitted(one) for one in competing_models(found)}
    lead, first = said.chosen.judged, frozenset(said.chosen.names)
    if first not in models:  # a mistake in the data
        return OneLaw()
    whitenings = found.clean.whitenings(lead.noise, lead.model)
    apart = {
        (a, b): 0.0 if a == b else on_trials(whitenings, ModelPair(models[a], models[b])).nats
        for a in models
        for b in models
    }
    table = [Separation(models[a].name, models[b].name, nats, "linearised") for (a, b), nats in apart.items()]
    alike = next((group for group in classes(table) if models[first].name in group), ())
    told: dict[str, float] = {}
    places: dict[str, list[str]] = {name: [name] for name in said.effects or said.chosen.names}
    for names, model in models.items():
        told |= {name: max(apart[first, names], apart[names, first]) for name in sorted(names - first)}
        if model.name in alike and len(names - first) == len(first - names) == 1:
            (own,), (other,) = first - names, names - first
            places[own].append(other)
    return OneLaw(tuple(tuple(each) for each in places.values() if len(each) > 1), told)
