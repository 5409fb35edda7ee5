"""What was put in and whether it was found, in sentences."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from geocontact.analyses.gap.words import names
from geocontact.chain.candidate import Candidate
from geocontact.data.gap.diagnosis import Diagnosis
from geocontact.gap.inject import Injected

IMITATED = 0.05  # times the noise floor that a gap of what base parameters imitate may have


def imitated(name: str, size: float, absorbed: Sequence[str]) -> bool:
    """Whether base parameters take what was planted: other variants of its name may be absorbed where it is not."""
    return name in absorbed and not size > IMITATED


def sentences(one: Candidate, made: Injected, d: Diagnosis) -> Iterator[str]:
    """The effect with its parameters, then whether the diagnosis found it."""
    values = ", ".join(f"{p.name} = {made.values[p.name]:.4g} {p.unit}" for p in one.parameters)
    gap = "" if np.isnan(made.size) else f"; it makes a gap of {made.size:.2g} times the noise floor"
    yield f"injected {one.label}{f' ({values})' if values else ''}{gap}"
    if one.name in d.effects:
        told = [(p.name, d.parameters[p.name]) for p in one.parameters if p.name in d.parameters]
        sizes = ", ".join(f"{name} = {e.value:.4g} [{e.ci95[0]:.4g}, {e.ci95[1]:.4g}] {e.unit}" for name, e in told)
        yield f"found: {names(d.effects)}{f'; {sizes}' if sizes else ''}"
    elif one.name in d.ambiguity:
        yield f"among what is possible: {names(d.ambiguity, 'or')}"
    else:
        yield f"not found{', base parameters imitate it' if imitated(one.name, made.size, d.absorbed) else ''}"
