"""Changes between settings in a table and in sentences."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from geocontact.analyses.frame.words import counted
from geocontact.below_knee_prosthesis.evaluation import JudgedStance
from geocontact.below_knee_prosthesis.setting_changes import OUTCOMES, SettingChange, outcomes_of, setting_changes

SAID = {"largest vertical force": ("BW", 2), "largest ankle moment": ("N m/kg", 2)}
"""Outcomes of the sentences, their units and decimals."""
READ = (
    "Changes: the interval of a predicted change is the model's error about each person's mean, on the stances that "
    "are not compared. “predicted”: the interval is on one side of 0 and contains the measured change."
)


def changes_of(stances: Sequence[JudgedStance]) -> list[SettingChange]:
    """Every outcome, person and pair of settings."""
    return setting_changes(outcomes_of(stances))


def changes_table(changes: Sequence[SettingChange]) -> pd.DataFrame:
    """One row for each; empty where no person has two settings."""
    rows = [
        {
            "outcome": one.outcome,
            "unit": OUTCOMES[one.outcome],
            "person": one.person,
            "from": one.settings[0],
            "to": one.settings[1],
            "stances from": one.stances[0],
            "stances to": one.stances[1],
            "predicted": one.predicted,
            "lower": one.lower,
            "upper": one.upper,
            "measured": one.measured,
            "measured lower": one.measured_lower,
            "measured upper": one.measured_upper,
            "verdict": one.verdict,
        }
        for one in changes
    ]
    return pd.DataFrame(rows)


def change_words(changes: Sequence[SettingChange]) -> list[str]:
    """The widest pair of settings, mean over the persons, and on how many the change was predicted."""
    lines = []
    for name, (unit, digits) in SAID.items():
        own = [one for one in changes if one.outcome == name]
        widest = _widest(own)
        if not widest:
            continue
        first, last = widest[0].settings
        predicted, measured = (np.mean([getattr(one, kind) for one in widest]) for kind in ("predicted", "measured"))
        line = f"{first} to {last}: {name} {predicted:+.{digits}f} {unit} predicted, {measured:+.{digits}f} measured"
        lines.append(f"{line} ({counted(len(widest), 'person')}){_verdicts(widest)}")
    return lines


def _widest(own: Sequence[SettingChange]) -> list[SettingChange]:
    """Changes from the first setting to the last that any person has; the first pair listed of every person."""
    pairs = list(dict.fromkeys(one.settings for one in own))
    if not pairs:
        return []
    starts, ends = {pair[0] for pair in pairs}, {pair[1] for pair in pairs}
    wide = next((pair for pair in pairs if pair[0] not in ends and pair[1] not in starts), pairs[0])
    return [one for one in own if one.settings == wide]


def _verdicts(own: Sequence[SettingChange]) -> str:
    known = [one for one in own if one.verdict != "error not known"]
    if not known:
        return ""
    right = sum(one.verdict == "predicted" for one in known)
    small = sum(one.verdict == "within the model's error" for one in known)
    return f": {right} of {len(known)} within the interval, {small} below the model's error"
