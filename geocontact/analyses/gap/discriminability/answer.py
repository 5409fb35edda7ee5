"""What trials can tell, in sentences, in confuse.json and in tables."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from geocontact.analyses.gap.case import names, percent, proposal_words
from geocontact.data.gap_case import GapCase
from geocontact.data.version import VERSION
from geocontact.gap.identifiability.detectability import POWER, Detectability
from geocontact.gap.identifiability.discriminability import Discriminability
from geocontact.gap.identifiability.separability import table
from geocontact.gap.identifiability.signatures import rest_of
from geocontact.gap.levels import APART


def confusion_sentences(c: Discriminability) -> list[str]:
    """One sentence each, without a full stop: how many are seen, which never, swallowed, confused; what to record."""
    never = [one.candidate.label for one in c.detectabilities if one.smallest is None]
    count = len(c.detectabilities)
    said = [f"of {count} effects and variants these trials show {count - len(never)}, if they are large enough"]
    if never:
        said.append(f"not to be seen at any plausible size: {names(never)}")
    if c.absorbed:
        said.append(
            f"base parameters imitate nearly all of {names(c.absorbed)}: they leave wrong parameters, hardly a gap"
        )
    if c.mistakes:
        said.append(f"mistakes in the data that would leave a gap, made in all trials: {names(c.mistakes)}")
    if c.classes:
        alike = "; ".join(names(one) for one in c.classes)
        said.append(f"not separable (less than {APART:g} nats between any two): {alike}")
    if not c.classes and len(c.effects) > 1:
        said.append(f"any two of these effects would be separated by {APART:g} nats or more, one way round at least")
    if c.proposal is not None:
        said.append(proposal_words(c.proposal, c.found.answer.verdict))
    return said


def sizes_sentence(c: Discriminability) -> str:
    """How large every effect that is seen must be; empty where none is."""
    seen = [amplitude_words(one) for one in c.detectabilities if one.smallest is not None]
    return f"predicted to be seen in {percent(POWER)} of 100 repetitions: {'; '.join(seen)}" if seen else ""


def amplitude_words(one: Detectability) -> str:
    """ "damping from damping.b = 0.83 N s/m on"; an amplitude that shrinks as the effect grows is an upper limit."""
    p, rest = one.candidate.parameters[0], rest_of(one.candidate)
    on = "down" if one.at.amplitude < rest and p.lower >= 0.0 else "on"
    return f"{one.candidate.label} from {p.name} = {size_words(one)} {on}"


def size_words(one: Detectability) -> str:
    """ "0.83 N s/m": the amplitude with its unit, if it has one."""
    unit = one.candidate.parameters[0].unit
    return f"{one.at.amplitude:.3g}".replace("-", "−") + ("" if unit == "-" else f" {unit}")


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
        "detectability": {one.candidate.label: _visible(one) for one in found.detectabilities},
        "next_experiment": None if found.proposal is None else found.proposal.as_dict(),
        "version": VERSION,
    }


def _visible(one: Detectability) -> dict[str, Any]:
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


def separability_table(found: Discriminability) -> pd.DataFrame:
    """A row per pair: who is there, at which amplitude, who is fitted instead, what that leaves, how it was found."""
    own = {one.candidate.label: one for one in found.effects}
    rows = [
        {
            "effect": each.true,
            "parameter": own[each.true].candidate.parameters[0].name,
            "amplitude": own[each.true].amplitude,
            "unit": own[each.true].candidate.parameters[0].unit,
            "visible [nats]": own[each.true].visible,
            "imitator": each.confounder,
            "separation [nats]": each.nats,
            "way": each.way,
        }
        for each in found.separations
    ]
    return pd.DataFrame(rows)


def detectability_table(found: Discriminability) -> pd.DataFrame:
    """A row per effect: the smallest amplitude that is seen, empty where none is, and what is visible of it there."""
    rows = [
        {
            "effect": one.candidate.label,
            "parameter": one.candidate.parameters[0].name,
            "smallest": np.nan if one.smallest is None else one.smallest,
            "unit": one.candidate.parameters[0].unit,
            "power [-]": one.power,
            "visible [nats]": one.at.visible,
            "absorbed [nats]": one.at.absorbed,
        }
        for one in found.detectabilities
    ]
    return pd.DataFrame(rows)
