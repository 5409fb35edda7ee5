"""The trials of a case side by side: the same channels in the same order and dimension, each measured somewhere."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from geocontact.data.errors import InputError
from geocontact.io.cases.trial_table import TrialTable
from geocontact.io.text.tables import listed

Trials = Mapping[str, TrialTable]
"""Tables by the trial's id, in the order of case.toml."""


def alike(trials: Trials) -> dict[str, TrialTable]:
    """The trials with their channels in the order of the first; refused when the channels themselves differ."""
    model, *_ = trials.values()
    found = {name: _ordered_like(model, table) for name, table in trials.items()}
    for channel in model.signals.channels:
        if all(np.all(np.isnan(table.signals.column(channel))) for table in found.values()):
            remedy = "strike the column from all trials, or add a trial that has it"
            raise InputError(Path(model.file).parent, "", f"column '{channel}' is empty in all trials", remedy)
    return found


def _ordered_like(model: TrialTable, table: TrialTable) -> TrialTable:
    channels, wanted = table.signals.channels, model.signals.channels
    first = Path(model.file).name
    lacking = tuple(name for name in wanted if name not in channels)
    surplus = tuple(name for name in channels if name not in wanted)
    if lacking or surplus:
        what = f"no column {listed(lacking)}" if lacking else f"column {listed(surplus)} more"
        raise InputError(table.file, "line 1", f"{what}, unlike {first}", "all trials need the same columns")
    for name in wanted:
        here, there = table.column(name), model.column(name)
        if here.si != there.si:
            what = f"'{name}' is in '{here.unit}', in {first} it is in '{there.unit}'"
            raise InputError(table.file, "line 1", what, "units of one column must be of one dimension")
    order = [channels.index(name) for name in wanted]
    values = np.ascontiguousarray(table.signals.values[:, order])
    signals = replace(table.signals, values=values, channels=wanted, units=model.signals.units)
    return replace(table, signals=signals, columns=tuple(table.columns[i] for i in order))


def noise_in_si(noise: Mapping[str, float], trials: Trials, file: Path) -> dict[str, float]:
    """Noise of channels, given in the unit that the trial files have them in, in SI units.

    Parameters
    ----------
    noise
        Standard deviation by channel.
    trials
        Alike (see `alike`).
    file
        Where the noise was written, for messages.
    """
    return {channel: sd * _factor(channel, trials, file) for channel, sd in noise.items()}


def _factor(channel: str, trials: Trials, file: Path) -> float:
    model, *_ = trials.values()
    if channel not in model.signals.channels:
        remedy = f"channels are: {listed(model.signals.channels)}"
        raise InputError(file, "[noise]", f"no trial has a channel {channel[:80]!r}", remedy)
    units = {table.column(channel).factor: (table.column(channel).unit, table.file) for table in trials.values()}
    if len(units) > 1:
        (one, here), (other, there), *_ = units.values()
        what = f"{channel} is in {one} in {Path(here).name} and in {other} in {Path(there).name}"
        raise InputError(
            file, "[noise]", f"{what}, so the unit of its noise is not clear", "use one unit in all trials"
        )
    return next(iter(units))
