"""What trials can tell, as confuse.json holds it."""

from __future__ import annotations

from typing import Any

from geocontact.data.gap.case import GapCase
from geocontact.data.version import VERSION
from geocontact.gap.identifiability.detectability import POWER, Detectability
from geocontact.gap.identifiability.discriminability import Discriminability
from geocontact.gap.identifiability.separability import table
from geocontact.gap.identifiability.signatures import rest_of
from geocontact.gap.levels import APART


def answer(case: GapCase, found: Discriminability, nats: float) -> dict[str, Any]:
    """confuse.json, SI units."""
    labels, matrix = table(found.separations)
    said = found.found.answer
    return {
        "case": case.name,
        "system": case.system,
        "verdict": said.verdict,
        "effects": said.effects,
        "visible_nats": nats,
        "power": POWER,
        "apart_nats": APART,
        "absorbed": found.absorbed,
        "mistakes": found.mistakes,
        "classes": found.classes,
        "separability": {
            label: dict(zip(["none", *labels], row, strict=True)) for label, row in zip(labels, matrix, strict=True)
        },
        "detectability": {one.candidate.label: _seen(one) for one in found.detectabilities},
        "next_experiment": None if found.proposal is None else found.proposal.as_dict(),
        "version": VERSION,
    }


def _seen(one: Detectability) -> dict[str, Any]:
    p = one.candidate.parameters[0]
    return {
        "parameter": p.name,
        "smallest": one.smallest,
        "unit": p.unit,
        "rest": rest_of(one.candidate),
        "power": one.power,
        "visible_nats": one.at.visible,
        "absorbed_nats": one.at.absorbed,
    }
