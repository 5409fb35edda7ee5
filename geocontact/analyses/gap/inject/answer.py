"""What was put in and what was found, as planted.json and a table hold it."""

from __future__ import annotations

import math

from geocontact.analyses.gap.inject.judged import Judgement, imitated
from geocontact.chain.candidate import Candidate
from geocontact.data.gap.diagnosis import Diagnosis
from geocontact.gap.inject import Injected


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
    """Name, unit, value put in, value found with its interval; NaN where the diagnosis has no such parameter."""
    rows: list[tuple[object, ...]] = []
    for p in one.parameters:
        found = d.parameters.get(p.name)
        told = (math.nan, math.nan, math.nan) if found is None else (found.value, *found.ci95)
        rows.append((p.name, p.unit, made.values[p.name], *told))
    return rows
