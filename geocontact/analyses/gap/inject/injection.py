"""An effect that is put in: which, where, in which trials, and whether the diagnosis finds it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np
from threadpoolctl import threadpool_limits

from geocontact.analyses.gap.case import CaseWithModel, names
from geocontact.analyses.gap.inject.options import InjectOptions
from geocontact.chain.effect import Candidate
from geocontact.data.diagnosis import Diagnosis
from geocontact.data.errors import InputError
from geocontact.data.gap_case import GapCase
from geocontact.effects.catalogue import candidates
from geocontact.gap.case.admission import admitted
from geocontact.gap.case.preparation import problem_of
from geocontact.gap.inject import Injected, Judgement, chosen, imitated, inject
from geocontact.gap.levels import SURE


def planted(given: CaseWithModel, o: InjectOptions) -> tuple[Candidate, Injected]:
    """The case with the effect in it; InputError where the system has no such effect, parameter or trial."""
    with threadpool_limits(limits=1):
        case = admitted(given.case, given.system)
        problem = problem_of(case, given.system)
        try:
            one = chosen(candidates(problem.system), o.effect)
        except ValueError as error:
            raise InputError("", "`effect`", str(error), "see docs/reference/gap_effects.md") from error
        trials = _trials(case, one, o)
        return one, inject(case, problem, one, _values(one, o), o.size, trials)


def _values(one: Candidate, o: InjectOptions) -> Mapping[str, float]:
    known = {p.name: p for p in one.parameters}
    for name, value in o.value.items():
        if name not in known:
            there = ", ".join(known) or "it has none"
            raise InputError("", "`value`", f"{name!r} is not a parameter of {one.label}", f"parameters: {there}")
        p = known[name]
        if not p.lower <= value <= p.upper:
            what = f"{name} = {value:g} {p.unit} is outside of {p.lower:.4g} … {p.upper:.4g}"
            raise InputError("", "`value`", what, "its bounds are physical")
    return o.value


def _trials(case: GapCase, one: Candidate, o: InjectOptions) -> frozenset[str] | None:
    if not o.trial:
        return None
    if one.somewhere is None:
        raise InputError("", "`trial`", f"{one.label} is in every trial or in none", "leave it out")
    there = [trial.name for trial in (*case.calibration, *case.evaluation)]
    for name in o.trial:
        if name not in there:
            raise InputError("", "`trial`", f"there is no trial {name!r}", f"trials are {', '.join(there)}")
    return frozenset(o.trial)


def answer(one: Candidate, made: Injected, d: Diagnosis, found: Judgement) -> dict[str, object]:
    """planted.json, SI units."""
    return {
        "effect": one.name,
        "variant": one.variant,
        "parameters": {p.name: {"value": made.values[p.name], "unit": p.unit} for p in one.parameters},
        "gap_over_floor": made.size,
        "evidence_at_most_nats": made.nats,
        "verdict": d.verdict,
        "effects": list(d.effects),
        "named": one.name in d.effects,
        "among_possible": one.name in d.ambiguity,
        "absorbed": imitated(one.name, made.size, d.absorbed),
        **found.as_dict(),
    }


def parameter_rows(one: Candidate, made: Injected, d: Diagnosis) -> list[tuple[object, ...]]:
    """Name, unit, value put in, value identified with its interval; NaN where the diagnosis has no such parameter."""
    rows: list[tuple[object, ...]] = []
    for p in one.parameters:
        found = d.parameters.get(p.name)
        told = (math.nan, math.nan, math.nan) if found is None else (found.value, *found.ci95)
        rows.append((p.name, p.unit, made.values[p.name], *told))
    return rows


def sentences(one: Candidate, made: Injected, d: Diagnosis, found: Judgement) -> Iterator[str]:
    """The effect with its parameters, then whether the diagnosis identifies it."""
    values = ", ".join(f"{p.name} = {_shown(made.values[p.name], p.unit)}" for p in one.parameters)
    gap = "" if np.isnan(made.size) else f"; it makes a gap of {made.size:.2g} times the noise floor"
    yield f"injected {one.label}{f' ({values})' if values else ''}{gap}"
    yield _outcome(one, made, d, found)


def _outcome(one: Candidate, made: Injected, d: Diagnosis, found: Judgement) -> str:
    estimates = [(p, d.parameters[p.name]) for p in one.parameters if p.name in d.parameters]
    each = []
    for p, e in estimates:
        low, high = e.ci95
        interval = f"95 % {low:.4g} … {high:.4g}, injected {made.values[p.name]:.4g}"
        each.append(f"{p.name} = {_shown(e.value, e.unit)} ({interval})")
    sizes = ", ".join(each)
    if found.status == "too_small":
        also = f"; {one.name} is missing from the base model without it, too" if found.before else ""
        most = f"all trials together hold {made.nats:.2g} nats of evidence for it at most"
        return f"not identified: {most}, {SURE:g} are needed{also}"
    if found.status == "there_before":
        return f"not identified: {one.name} was missing before{_change_words(one, made, found)}"
    if found.status == "found":
        what = f"identified: {names(d.effects)}{f'; {sizes}' if sizes else ''}"
        if found.before:
            return f"{what}; it was missing before{_change_words(one, made, found)}"
        return what if found.holds is not False else f"{what}{_change_words(one, made, found)}"
    if found.status == "possible":
        return f"among what is possible: {names(d.ambiguity, 'or')}"
    return f"not identified{', base parameters imitate it' if found.status == 'imitated' else ''}"


def _shown(value: float, unit: str) -> str:
    """A number with its unit, where it has one."""
    return f"{value:.4g}" if unit == "-" else f"{value:.4g} {unit}"


def _change_words(one: Candidate, made: Injected, found: Judgement) -> str:
    """By how much the first parameter changed, beside what was injected."""
    if found.change is None or found.change_ci95 is None:
        return ""
    p, (low, high) = one.parameters[0], found.change_ci95
    there = "which holds" if found.holds else "which excludes"
    none = ", and 0 as well" if found.before and found.holds and low <= 0.0 <= high else ""
    by = f"{_shown(found.change, p.unit)} (95 % {low:.4g} … {high:.4g})"
    return f", and {p.name} changes by {by}, {there} the {made.values[p.name]:.4g} injected{none}"
