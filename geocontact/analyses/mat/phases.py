"""Phases of a recording as its user names them: name, from when to when; a name may come back in every cycle."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.identify.signals.agreement import FEWEST
from geocontact.io.text.side_table import read_side_table

COLUMNS = ("name", "start [s]", "end [s]")
ROUNDED = 1e-6
"""s; a frame that close to a start or an end belongs to the phase."""

Stretches = list[tuple[int, int]]
"""First frame of each and the one after its last."""


def read_phases(record: Record, path: Path, time: Float[np.ndarray, " t"]) -> dict[str, Stretches]:
    """Frames of each phase, in the order in which names first occur."""
    table = read_side_table(path)
    missing = [name for name in COLUMNS if name not in table.columns]
    if missing:
        raise InputError(path, "line 1", f"no column {', '.join(missing)}", f"write {', '.join(COLUMNS)}")
    record.add_input("--phases", path, rows=len(table))
    phases: dict[str, Stretches] = {}
    for k, (name, start, end) in enumerate(zip(*(table[each] for each in COLUMNS), strict=True), 1):
        first = int(np.searchsorted(time, start - ROUNDED))
        last = int(np.searchsorted(time, end + ROUNDED, side="right"))
        if not end > start or last - first < FEWEST or start < time[0] - ROUNDED or end > time[-1] + ROUNDED:
            what = f"phase '{name}' from {start:g} to {end:g} s holds {max(last - first, 0)} frames"
            remedy = f"at least {FEWEST} are needed, between {time[0]:g} and {time[-1]:g} s"
            raise InputError(path, f"row {k}", what, remedy)
        phases.setdefault(str(name), []).append((first, last))
    for name, stretches in phases.items():
        if name == "all" or any(before > start for (_, before), (start, _) in pairwise(sorted(stretches))):
            what = "is the name of the whole recording" if name == "all" else "overlaps itself"
            raise InputError(path, "", f"phase '{name}' {what}", "correct its name, or its start and end")
    return phases
