"""What was injected and whether it was found, in sentences."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from geocontact.analyses.gap.inject.judged import Judgement
from geocontact.analyses.gap.words import names
from geocontact.chain.candidate import Candidate
from geocontact.data.gap.diagnosis import Diagnosis
from geocontact.gap.inject import Injected
from geocontact.gap.levels import SURE


def sentences(one: Candidate, made: Injected, d: Diagnosis, found: Judgement) -> Iterator[str]:
    """The effect with its parameters, then whether the diagnosis found it."""
    values = ", ".join(f"{p.name} = {made.values[p.name]:.4g} {p.unit}" for p in one.parameters)
    gap = "" if np.isnan(made.size) else f"; it makes a gap of {made.size:.2g} times the noise floor"
    yield f"injected {one.label}{f' ({values})' if values else ''}{gap}"
    yield _outcome(one, made, d, found)


def _outcome(one: Candidate, made: Injected, d: Diagnosis, found: Judgement) -> str:
    told = [(p.name, d.parameters[p.name]) for p in one.parameters if p.name in d.parameters]
    sizes = ", ".join(f"{name} = {e.value:.4g} [{e.ci95[0]:.4g}, {e.ci95[1]:.4g}] {e.unit}" for name, e in told)
    if found.status == "too_small":
        also = f"; {one.name} is missing from the base model without it, too" if found.before else ""
        most = f"all trials together hold {made.nats:.2g} nats of evidence for it at most"
        return f"not found: {most}, {SURE:g} are needed{also}"
    if found.status == "there_before":
        return f"not found: {one.name} was missing before{_change(one, made, found)}"
    if found.status == "found":
        what = f"found: {names(d.effects)}{f'; {sizes}' if sizes else ''}"
        if found.before:
            return f"{what}; it was missing before{_change(one, made, found)}"
        return what if found.holds is not False else f"{what}{_change(one, made, found)}"
    if found.status == "possible":
        return f"among what is possible: {names(d.ambiguity, 'or')}"
    return f"not found{', base parameters imitate it' if found.status == 'imitated' else ''}"


def _change(one: Candidate, made: Injected, found: Judgement) -> str:
    """By how much the first parameter changed, beside what was injected."""
    if found.change is None or found.change_ci95 is None:
        return ""
    p, (low, high) = one.parameters[0], found.change_ci95
    there = "which holds" if found.holds else "which excludes"
    none = ", and 0 as well" if found.before and found.holds and low <= 0.0 <= high else ""
    by = f"{found.change:.4g} [{low:.4g}, {high:.4g}] {p.unit}"
    return f", and {p.name} changes by {by}, {there} the {made.values[p.name]:.4g} injected{none}"
