"""Phases of a recording as its user names them: name, from when to when; a name may come back in every cycle."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.identify.signals.agreement import FEWEST
from geocontact.io.text.side_table import read_side_table

COLUMNS = ("name", "start [s]", "end [s]")
ROUNDED = 1e-6
"""s; a frame that close to a start or an end belongs to the phase."""

Stretches = list[tuple[int, int]]
"""First frame of each and the one after its last."""


@dataclass(frozen=True)
class Phase:
    """A phase once: its name, and from when to when [s]."""

    name: str
    start: float
    end: float


def read_phases(record: Record, o: MatOptions) -> tuple[Phase, ...] | None:
    """Phases in the order of the file; None where nobody names any."""
    if o.phases is None:
        return None
    table = read_side_table(o.phases, COLUMNS)
    missing = [name for name in COLUMNS if name not in table.columns]
    if missing:
        raise InputError(o.phases, "line 1", f"no column {', '.join(missing)}", f"write {', '.join(COLUMNS)}")
    record.add_input("`phases`", o.phases, rows=len(table))
    return tuple(Phase(str(name), start, end) for name, start, end in zip(*(table[c] for c in COLUMNS), strict=True))


def frames_of(phases: tuple[Phase, ...], time: Float[np.ndarray, " t"], o: MatOptions) -> dict[str, Stretches]:
    """Frames of each phase, in the order in which names first occur."""
    file = o.phases or Path()
    found: dict[str, Stretches] = {}
    for k, phase in enumerate(phases, 1):
        first = int(np.searchsorted(time, phase.start - ROUNDED))
        last = int(np.searchsorted(time, phase.end + ROUNDED, side="right"))
        within = phase.start >= time[0] - ROUNDED and phase.end <= time[-1] + ROUNDED
        if not phase.end > phase.start or last - first < FEWEST or not within:
            what = f"phase '{phase.name}' from {phase.start:g} to {phase.end:g} s holds {max(last - first, 0)} frames"
            remedy = f"at least {FEWEST} are needed, between {time[0]:g} and {time[-1]:g} s"
            raise InputError(file, f"row {k}", what, remedy)
        found.setdefault(phase.name, []).append((first, last))
    for name, stretches in found.items():
        if name == "all" or any(before > start for (_, before), (start, _) in pairwise(sorted(stretches))):
            what = "is the name of the whole recording" if name == "all" else "overlaps itself"
            raise InputError(file, "", f"phase '{name}' {what}", "correct its name, or its start and end")
    return found
