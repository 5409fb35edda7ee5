"""Support profiles as `geocontact shoulder optimise` writes them: a factor for each work phase, by task and hand."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from geocontact.data.errors import InputError
from geocontact.io.text.side_table import read_side_table
from geocontact.shoulder_exoskeleton.support.outcome import Factors
from geocontact.shoulder_exoskeleton.support.phases import SUPPORTED
from geocontact.shoulder_exoskeleton.support.support_case import FactorKey, Hand
from geocontact.shoulder_exoskeleton.work_phases import PHASES

WORKING = tuple(PHASES[k] for k in SUPPORTED)
"""Phases that every profile has a factor for; that of rest is 0 unless there is a column."""
HANDS: tuple[Hand, ...] = ("dominant", "other")
NAMES = ("profile", "task", "hand")
WRITTEN = "give factors.csv of `geocontact shoulder optimise`, or a table like it"


def read_profiles(file: Path) -> dict[str, Factors]:
    """Profiles by their names, in the file's order; InputError for what is none."""
    table = read_side_table(file, (*NAMES, *PHASES))
    missing = [name for name in (*NAMES, *WORKING) if name not in table]
    if missing:
        raise InputError(file, "", f"no column {missing[0]}", WRITTEN)
    found: dict[str, Factors] = {}
    for row, told in table.iterrows():
        profile, task, word = (str(told[name]) for name in NAMES)
        hand = next((each for each in HANDS if each == word), None)
        place = f"row {int(str(row)) + 1}"
        if hand is None:
            raise InputError(file, place, f"hand {word!r} is not known", f"write {' or '.join(HANDS)}")
        factors = found.setdefault(profile, {})
        for phase in (name for name in PHASES if name in table):
            key = FactorKey(task, hand, phase)
            if key in factors:
                raise InputError(file, place, f"{profile}, {task}, {hand} is there twice", "leave one")
            factors[key] = _factor(file, place, phase, told[phase])
    return found


def factors_written(profiles: dict[str, Factors]) -> pd.DataFrame:
    """The table that `read_profiles` reads."""
    rows = []
    for name, factors in profiles.items():
        for task, hand in dict.fromkeys((key.task, key.hand) for key in factors):
            own = {phase: factors[FactorKey(task, hand, phase)] for phase in WORKING}
            rows.append({"profile": name, "task": task, "hand": hand, **own})
    return pd.DataFrame(rows)


def _factor(file: Path, place: str, phase: str, text: object) -> float:
    try:
        value = float(str(text))
    except ValueError:
        value = -1.0
    if not 0.0 <= value <= 1.0:
        raise InputError(file, place, f"factor {text!r} of {phase} is not 0 to 1", "write a number from 0 to 1")
    return value
