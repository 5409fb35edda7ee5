"""No effect is named whose error on held-out trials, of all channels together, is larger than that of the base model.

A single channel that is surely predicted worse leaves it partly explained (`gap.budget_verdict`).

The rules for effects (`gap.selection.held_out_rules`) do not judge mistakes in the data: trials that have them are not
predicted. With a mistake undone they are, and the error of what was recorded shows whether it was one. Where it grows,
the case is taken as it came; where what is named then makes it grow, too, the gap is unknown.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from geocontact.chain.effect import Candidate
from geocontact.chain.system import System
from geocontact.data.gap_case import GapCase
from geocontact.effects.catalogue import candidates
from geocontact.gap.attribute import Attribution, Listener, Offer, attribute
from geocontact.gap.levels import WORTH_NAMING
from geocontact.gap.reduction.raw_input_errors import RawInputErrors, raw_input_errors
from geocontact.gap.selection.verdict import Answer


def confirmed(case: GapCase, found: Attribution, at: Listener) -> tuple[Attribution, RawInputErrors]:
    """An answer that holds on held-out trials, with the errors of its model: the one that was found, if it does.

    Parameters
    ----------
    case
        That was attributed.
    found
        The answer and what it rests on.
    at
        Is called in words with what is being done.
    """
    errors = errors_of(found)
    if not grows(found, errors):
        return found, errors
    offer: Offer = _without_mistakes
    if found.data_error is not None:
        at("the data as they came")
        found = attribute(case, found.problem.system, offer, at)
        errors = errors_of(found)
        if not grows(found, errors):
            return found, errors
    found = withdrawn(found, growth(found, errors))
    return found, errors_of(found)


def errors_of(found: Attribution) -> RawInputErrors:
    """Errors of the base model and of the model that an answer rests on."""
    return raw_input_errors(found.problem, found.clean, found.answer.chosen.judged, found.data_error)


def _without_mistakes(system: System) -> Sequence[Candidate]:
    return [one for one in candidates(system) if one.somewhere is None]


def growth(found: Attribution, errors: RawInputErrors) -> float:
    """Error on held-out trials with what is named over that of the base model, channels in units of their floors."""
    count, floor = len(found.problem.calibration.trials), found.clean.floor
    before, after = (
        sum(float(np.sum((part / floor) ** 2)) for part in parts[count:]) for parts in (errors.before, errors.after)
    )
    return (after / before) ** 0.5 if before > 0.0 else 1.0


def grows(found: Attribution, errors: RawInputErrors) -> bool:
    """Whether something is named with which the error on held-out trials is larger, by more than is worth a name.

    An effect of one channel may make that one four times as small and the others, whose floors differ, a little larger.
    """
    return bool(found.answer.effects) and growth(found, errors) > 1.0 + WORTH_NAMING


def withdrawn(found: Attribution, grown: float) -> Attribution:
    """The same without an effect: unknown, what was stated of the effect is stated of anything unknown."""
    said, why = found.answer, f"with it the error on held-out trials is {grown:.3g} times that of the base model"
    moved = sum(said.probabilities.get(name, 0.0) for name in said.effects)
    odds = {name: value for name, value in said.probabilities.items() if name not in said.effects}
    odds["unknown"] = odds.get("unknown", 0.0) + moved
    stated = dict(sorted(odds.items(), key=lambda each: -each[1])) | dict.fromkeys(said.effects, 0.0)
    rivals = tuple(name for name in said.ambiguity if name not in said.effects)
    answer = Answer("unknown", (), stated, rivals, found.base)
    return replace(found, answer=answer, objections={**found.objections, said.chosen.label: why})
