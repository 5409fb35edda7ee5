"""Which effects these trials would tell apart, and which are one law on them.

Suppose effect e is there at some amplitude and somebody fits effect f instead, base parameters with it. What f cannot
reproduce of e, ½ min |s_e - (s_f(φ) + base)|² in whitened units, are the nats by which e beats f on such trials.
To first order that is what the directions of f's parameters at one of its starts leave of s_e; the point that this step
leads to is simulated, and where it does not keep what it promises a short bounded refit takes its place. Where even a
first-order fit leaves more than `FAR` nats nothing is simulated; the figure then tells that the two differ, and
roughly how much.

Two models with effects, both fitted to the trials, are held against each other: what one leaves of the other's
prediction (`gap.experiment.proposal`), either way round, are the nats by which trials of this kind tell them
apart. Effects that all leave less than `APART` of each other are an equivalence class: the trials answer with the
class, and which of its members is there is not for them to say. Others that are still in question are mostly
separable by these trials, yet the evidence does not separate them: the form of no candidate is exact, so that a lead
counts for less than it is. A model with fewer effects than what is named is in no class.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
from jaxtyping import Float

from geocontact.chain.effect import Candidate
from geocontact.chain.system import System
from geocontact.gap.attribute import Attribution
from geocontact.gap.case.refit import free, refit
from geocontact.gap.experiment.proposal import ModelPair, competing_models, fitted, on_trials
from geocontact.gap.identifiability.signatures import BaseState, Sized, orthonormal, own_slopes
from geocontact.gap.levels import APART
from geocontact.gap.selection.model_comparison import Contender


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
    models = {frozenset(one.names): fitted(one) for one in (*competing_models(found), *class_mates(found))}
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
        for name in sorted(names - first):  # of several models with an effect that counts which is closest
            told[name] = min(max(apart[first, names], apart[names, first]), told.get(name, np.inf))
        if model.name in alike and len(names - first) == len(first - names) == 1:
            (own,), (other,) = first - names, names - first
            places[own].append(other)
    return OneLaw(tuple(tuple(each) for each in places.values() if len(each) > 1), told)


def class_mates(found: Attribution) -> list[Contender]:
    """The models in which, where two effects are named, one that is in question stands in place of either.

    Beside a third effect it may be more probable; what it is one law with shows beside the effect that stays.
    """
    said = found.answer
    first = frozenset(said.effects or said.chosen.names)
    if len(first) != 2:
        return []
    best: dict[frozenset[str], Contender] = {}
    for one in sorted(found.contenders, key=lambda each: each.judged.nats):
        others = frozenset(one.names) - first
        if len(one.names) == 2 and len(others) == 1 and others <= set(said.ambiguity) and not one.mistaken:
            best[frozenset(one.names)] = one
    return list(best.values())


FAR = 25.0  # nats from which a first-order figure is not checked
KEPT = 0.5  # nats by which the simulated end of a straight step may lie beside what it promises, and a tenth of that
NONE = "none"
Way = Literal["itself", "linearised", "refitted"]


@dataclass(frozen=True)
class Separation:
    """By how much one effect beats another on trials that have it.

    Parameters
    ----------
    true, confounder
        Labels of the candidates; "none" for the base model alone as confounder.
    nats
        What the confounder leaves.
    way
        How that was found.
    """

    true: str
    confounder: str
    nats: float
    way: Way


@dataclass(frozen=True)
class Confounder:
    """A model that tries to look like others: where it may start from, and the directions that it has there.

    `slopes` and `directions` are those of all its parameters, the base's first.
    """

    label: str
    system: System
    starts: tuple[Mapping[str, float], ...]
    slopes: tuple[Float[np.ndarray, "n p"], ...]
    directions: tuple[Float[np.ndarray, "n k"], ...]


def base_alone(ground: BaseState) -> Confounder:
    """The base model, which can only be refitted."""
    return Confounder(NONE, ground.system, (ground.values,), (ground.slopes,), (ground.base,))


def confounder_of(ground: BaseState, candidate: Candidate) -> Confounder:
    """The base model with a candidate, at every start that this offers."""
    system = candidate.apply(ground.system)
    starts = tuple({**ground.values, **start} for start in candidate.starts)
    slopes = tuple(
        np.hstack([ground.slopes, own_slopes(ground, candidate, start, ground.moved(system, start))])
        for start in starts
    )
    return Confounder(candidate.label, system, starts, slopes, tuple(orthonormal(each) for each in slopes))


def separations(
    ground: BaseState, effects: Sequence[Sized], step: Callable[[], None] = lambda: None
) -> tuple[Separation, ...]:
    """Every effect against the base model and against every other; `step` is called after each effect."""
    confounders = [base_alone(ground), *(confounder_of(ground, one.candidate) for one in effects)]
    found = []
    for one in effects:
        target = ground.moved(one.candidate.apply(ground.system), {**ground.values, **one.values})
        found += [separation(ground, one, target, other) for other in confounders]
        step()
    return tuple(found)


def separation(ground: BaseState, one: Sized, target: Float[np.ndarray, " n"], other: Confounder) -> Separation:
    """What `other` leaves of `target`, which is what the effect does, `BaseState.moved`."""
    names = one.candidate.label, other.label
    if names[0] == names[1]:
        return Separation(*names, 0.0, "itself")
    costs = [0.5 * float(target @ target - (d.T @ target) @ (d.T @ target)) for d in other.directions]
    best = int(np.argmin(costs))
    promised = max(costs[best], 0.0)
    if promised > FAR:
        return Separation(*names, promised, "linearised")
    point, kept = _straight(ground, target, other, best)
    if abs(kept - promised) <= KEPT + 0.1 * promised:
        return Separation(*names, kept, "linearised")
    return Separation(*names, min(kept, refitted(ground, one, other, point)), "refitted")


def _straight(
    ground: BaseState, target: Float[np.ndarray, " n"], other: Confounder, which: int
) -> tuple[dict[str, float], float]:
    """Where one straight step to the target leads, within bounds, and what it leaves of the target there [nats]."""
    start, columns = other.starts[which], other.slopes[which]
    moved = ground.moved(other.system, start)
    size = np.maximum(np.linalg.norm(columns, axis=0), 1e-300)
    shift = np.linalg.lstsq(columns / size, target - moved, rcond=1e-9)[0] / size
    values = dict(start)
    for p, by in zip(free(other.system), shift, strict=True):
        values[p.name] = float(np.clip(values[p.name] + by, p.lower, p.upper))
    off = target - ground.moved(other.system, values)
    return values, 0.5 * float(off @ off)


def refitted(ground: BaseState, one: Sized, other: Confounder, start: Mapping[str, float]) -> float:
    """What a bounded least-squares fit of `other` leaves of trials that have the effect and no noise [nats]."""
    there = one.candidate.apply(ground.system)
    full = {**ground.values, **one.values}
    outputs = [
        np.where(np.isfinite(o), there.simulate(t, full), np.nan)
        for t, o in zip(ground.measured.trials, ground.measured.outputs, strict=True)
    ]
    measured = replace(ground.measured, outputs=tuple(outputs))
    return refit(other.system, measured, ground.whitenings, [start, *other.starts]).cost


def classes(found: Sequence[Separation], least: float = APART) -> tuple[tuple[str, ...], ...]:
    """Effects that these trials cannot tell apart: within a class each reproduces every other to less than `least`
    nats.

    Complete linkage; classes of one are left out. The base model is none of them.
    """
    from scipy.cluster.hierarchy import fcluster, linkage
    from scipy.spatial.distance import squareform

    labels, matrix = table(found)
    if len(labels) < 2:
        return ()
    apart = np.maximum(matrix[:, 1:], matrix[:, 1:].T)
    np.fill_diagonal(apart, 0.0)
    which = fcluster(linkage(squareform(apart, checks=False), "complete"), np.nextafter(least, 0.0), "distance")
    groups = [tuple(labels[i] for i in np.flatnonzero(which == k)) for k in dict.fromkeys(which)]
    return tuple(group for group in groups if len(group) > 1)


def table(found: Sequence[Separation]) -> tuple[list[str], Float[np.ndarray, "e f"]]:
    """Labels, and nats: a row per true effect, a column per confounder, the base model's first."""
    labels = list(dict.fromkeys(each.true for each in found))
    columns = [NONE, *labels]
    matrix = np.full((len(labels), len(columns)), np.nan)
    for each in found:
        matrix[labels.index(each.true), columns.index(each.confounder)] = each.nats
    return labels, matrix
