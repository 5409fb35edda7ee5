"""Synthetic recordings for the analyses of a misaligned joint, and calls whose reservations stand in the result."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd

import geocontact as gc

QUICK = {"seconds": 20.0, "rate": 50.0, "noise": 0.2, "memory": 0.1, "trials": 3}
STROKE = gc.mm(-10, 60)
KNOWN = {"known": {"l": gc.mm(169), "z": gc.mm(127)}, "bootstrap": 0}
PAPER = {"k": 222.43, "x": 0.048, "y": 0.059}


def quietly(job: Callable[..., Any], *recordings: Path, **options: Any) -> Any:
    """The result of a call along recordings whose reservations are not shown."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        return job(recordings, **options)


def recorded(folder: Path, **options: Any) -> Path:
    """Folder with a table for each trial of a simulation."""
    result = gc.misalignment.simulate(**QUICK | options)
    for each in result.trials:
        result.table(each.name).to_csv(folder / f"{each.name}.csv", index=False)
    return folder


def locked(folder: Path) -> tuple[Path, ...]:
    """Recordings with a locked joint."""
    return tuple(sorted(folder.glob("locked_*.csv")))


def free(folder: Path) -> tuple[Path, ...]:
    """Recordings with a free joint."""
    return tuple(sorted(folder.glob("free_*.csv")))


def changed(file: Path, folder: Path, name: str = "", **columns: Callable[[pd.DataFrame], Any]) -> Path:
    """A copy of a recording with other force, displacement or pressure."""
    units = {"force": "force [N]", "displacement": "displacement [mm]", "pressure": "pressure [mmHg]"}
    table = pd.read_csv(file)
    table = table.assign(**{units[column]: function(table) for column, function in columns.items()})
    copy = folder / (name or file.name)
    table.to_csv(copy, index=False)
    return copy
