"""Measured shear in a cuff beside the simulated one: friction limit, axes, and the sentences and rows of both."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import add_input, reserve, say
from geocontact.data.errors import InputError
from geocontact.identify.goodness_of_fit import MUCH, Doubt
from geocontact.io.text.side_table import read_side_table
from geocontact.loads.friction_limit import CAUSES, FrictionLimit, friction_limit, noise_of
from geocontact.shoulder_exoskeleton.beside_recording import ALONG, AROUND, NORMAL, SHEAR, TANGENTIAL, ComparedChannel

NUMBERS, STATIC = "numbers.csv", "mu_s"
"""File beside a simulated arm, and its row with the static friction."""
USUAL = 1.0
"""Static friction of the cuff in Yao et al. (2024), sec. 2.3."""
EXCHANGED = 0.2
"""By how much correlations must be better with exchanged axes before these are doubted."""


def friction_beside(simulated: Path, stated: float | None) -> float:
    """Static friction: as stated, else that of the simulation, else the paper's with a warning.

    Parameters
    ----------
    simulated
        right.csv or left.csv, in whose folder `shoulder simulate` also writes the numbers of its device.
    """
    if stated is not None:
        return stated
    file = simulated.parent / NUMBERS
    if file.is_file():
        table = read_side_table(file, ("number", "value"))
        own = table[table["number"] == STATIC]["value"] if {"number", "value"} <= set(table) else ()
        if len(own) == 1:
            add_input("numbers of the device", file)
            return _friction_of(file, str(next(iter(own))))
    reserve(f"{simulated.name}: no {NUMBERS} beside it, friction is taken as {USUAL:g} (the paper's): give `friction`")
    return USUAL


def _friction_of(file: Path, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError(file, STATIC, f"{text[:40]!r} is not a number", "give `friction`") from None


@dataclass(frozen=True, eq=False)
class MeasuredShear:
    """Shear beside friction times the normal force.

    Parameters
    ----------
    normal
        Whether the normal force was measured too; else it is the simulated one.
    limit
        Of the measured shear.
    simulated
        The same of the simulated shear and its own normal force.
    at
        Time of the first sample beyond the limit [s]; NaN without one.
    """

    normal: bool
    limit: FrictionLimit
    simulated: FrictionLimit
    at: float


def measured_shear(
    channels: Mapping[str, ComparedChannel],
    normal: np.ndarray | None,
    friction: float,
    recorded: Mapping[str, np.ndarray],
) -> MeasuredShear | None:
    """None where no shear was measured.

    Parameters
    ----------
    normal
        Simulated normal force at the times of the channels [N].
    recorded
        Channels at their own times, for their noise [N].
    """
    found = next((channels[name] for name in TANGENTIAL if name in channels), None)
    if found is None or normal is None:
        return None
    measured = channels[NORMAL].measured if NORMAL in channels else normal
    limit = friction_limit(found.measured, measured, friction, noise_of(recorded[found.channel]))
    at = float(found.time[limit.first]) if limit.first >= 0 else float("nan")
    return MeasuredShear(NORMAL in channels, limit, friction_limit(found.model, normal, friction), at)


def say_shear(found: MeasuredShear) -> None:
    """Say the ratio of shear to normal force; warn where the normal force is not measured."""
    own, other = found.limit, found.simulated
    say(
        f"shear over normal force: median {own.usual:.2f}, at most {own.largest:.2f} (simulated {other.usual:.2f} and "
        f"{other.largest:.2f}); friction {own.friction:g} is exceeded for {own.beyond:.1%} of the time"
    )
    if not found.normal:
        reserve("no `normal` is recorded: the friction limit of the measured shear is that of the simulated force")


def shear_doubts(found: MeasuredShear | None, channels: Mapping[str, ComparedChannel]) -> list[Doubt]:
    """Shear beyond the friction limit, and axes that are exchanged."""
    doubts = []
    if found is not None and not found.limit.kept:
        own = found.limit
        what = f"the measured shear exceeds friction {own.friction:g} times the normal force for {own.beyond:.0%}"
        what += f" of the time, first at {found.at:.2f} s: {CAUSES}"
        doubts.append(Doubt(what, found.normal and own.beyond >= MUCH, own.beyond))
    if ALONG in channels and AROUND in channels:
        along, around = channels[ALONG], channels[AROUND]
        straight = _alike(along.model, along.measured) + _alike(around.model, around.measured)
        crossed = _alike(along.model, around.measured) + _alike(around.model, along.measured)
        if crossed > straight + EXCHANGED:
            what = f"{ALONG} and {AROUND} agree better with each other's simulated course: are the axes exchanged?"
            doubts.append(Doubt(what, False, crossed))
    return doubts


def _alike(first: np.ndarray, second: np.ndarray) -> float:
    """Size of the correlation; 0 for a constant."""
    both = np.isfinite(first) & np.isfinite(second)
    a, b = first[both], second[both]
    return float(abs(np.corrcoef(a, b)[0, 1])) if len(a) > 1 and a.std() > 0.0 and b.std() > 0.0 else 0.0


def friction_table(found: MeasuredShear) -> pd.DataFrame:
    """One row for the measured shear, one for the simulated one."""
    rows = []
    for name, normal, own in (
        (SHEAR, "recorded" if found.normal else "simulated", found.limit),
        ("simulated shear", "simulated", found.simulated),
    ):
        rows.append(
            {
                "shear": name,
                "normal force": normal,
                "friction [-]": own.friction,
                "beyond [-]": own.beyond,
                "median ratio [-]": own.usual,
                "largest ratio [-]": own.largest,
                "noise [N]": own.noise,
                "samples": own.samples,
            }
        )
    return pd.DataFrame(rows)
