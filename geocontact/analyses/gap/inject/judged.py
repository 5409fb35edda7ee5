"""Whether a diagnosis found what was injected, judged by its change against the diagnosis of the case before."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from geocontact.chain.candidate import Candidate
from geocontact.data.gap.diagnosis import Diagnosis, Estimate
from geocontact.gap.identifiability.signatures import rest_of
from geocontact.gap.inject import Injected
from geocontact.gap.levels import SURE

IMITATED = 0.05
"""Gap, in noise floors, up to which base parameters are said to imitate an effect."""
Status = Literal["found", "there_before", "too_small", "possible", "imitated", "not_found"]


@dataclass(frozen=True)
class Judgement:
    """Whether an injected effect was found.

    Parameters
    ----------
    status
        "found": named, and not before, or its parameter surely changed, and by what was injected. "there_before":
        named with and without it, and the parameter did not surely change, or not by what was injected. "too_small":
        all trials together cannot hold the evidence (`gap.levels.SURE`) from which an effect is named. "possible":
        among the effects in question only. "imitated": not found, base parameters reproduce it. "not_found": anything
        else.
    before
        Whether the case before was said to lack the effect.
    change, change_ci95
        Of the effect's first parameter, with the effect less without it, in the parameter's unit, with its 95 %
        interval; the effect counts as resting where it was not named before. None where it has no parameter, or is not
        named with it.
    holds
        Whether that interval holds what was injected; None where there is none.
    """

    status: Status
    before: bool
    change: float | None = None
    change_ci95: tuple[float, float] | None = None
    holds: bool | None = None

    def as_dict(self) -> dict[str, object]:
        """Keys of planted.json."""
        return {
            "status": self.status,
            "found": self.status == "found",
            "named_before": self.before,
            "change": self.change,
            "change_ci95": None if self.change_ci95 is None else list(self.change_ci95),
            "change_holds_planted": self.holds,
        }


def judged(one: Candidate, made: Injected, before: Diagnosis, after: Diagnosis) -> Judgement:
    """What came of an injected effect.

    Parameters
    ----------
    one, made
        The effect, and its parameters and gap.
    before, after
        Diagnoses of the same trials without it and with it.
    """
    was, is_named = one.name in before.effects, one.name in after.effects
    if not is_named and one.name not in after.ambiguity and imitated(one.name, made.size, after.absorbed):
        return Judgement("imitated", was)
    if made.nats < SURE:
        return Judgement("too_small", was)
    if not is_named:
        return Judgement("possible" if one.name in after.ambiguity else "not_found", was)
    moved = _change(one, before, after)
    if moved is None:
        return Judgement("there_before" if was else "found", was)
    change, low, high = moved
    holds = low <= made.values[one.parameters[0].name] - rest_of(one) <= high
    shown = holds and not low <= 0.0 <= high
    return Judgement("there_before" if was and not shown else "found", was, change, (low, high), holds)


def imitated(name: str, size: float, absorbed: tuple[str, ...]) -> bool:
    """Whether base parameters take what was injected: other variants of its name may be absorbed where it is not."""
    return name in absorbed and not size > IMITATED


def _change(one: Candidate, before: Diagnosis, after: Diagnosis) -> tuple[float, float, float] | None:
    """Change of the first parameter and its interval; None where the effect has none, or another variant is named.

    Variances of the two fits add, as if their noise were independent: it is the same noise, so the interval is wide.
    """
    if not one.parameters or one.parameters[0].name not in after.parameters:
        return None
    name = one.parameters[0].name
    new, old = after.parameters[name], before.parameters.get(name)
    first = old.value if old is not None else rest_of(one)
    change = new.value - first
    widths = [_sides(new), (0.0, 0.0) if old is None else _sides(old)]
    down = float(np.hypot(widths[0][0], widths[1][1]))
    up = float(np.hypot(widths[0][1], widths[1][0]))
    return change, change - down, change + up


def _sides(found: Estimate) -> tuple[float, float]:
    return found.value - found.ci95[0], found.ci95[1] - found.value
