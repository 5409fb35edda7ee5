"""What an identification starts from: recordings of three kinds, and what is known beforehand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from geocontact.analyses.misalignment.identify.options import IdentifyOptions
from geocontact.analyses.misalignment.identify.unknowns import unknowns
from geocontact.analyses.misalignment.law_numbers import MMHG
from geocontact.analyses.misalignment.recordings import recordings
from geocontact.analyses.run_record import Record
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.data.parameter import Parameter
from geocontact.io.recordings.elbow_recording import DISPLACEMENT, FORCE

SLID = 0.5e-3  # m; a locked joint does not move as far
SAME_PRESSURE = MMHG  # Pa; pressures that differ by less are one


@dataclass(frozen=True, eq=False)
class IdentifyInputs:
    """Numbers of the law as far as they are known, and recordings: joint locked, held out, joint free."""

    parameters: tuple[Parameter, ...]
    locked: Sequence[ElbowRecording]
    held_out: Sequence[ElbowRecording]
    unlocked: Sequence[ElbowRecording]


def read(o: IdentifyOptions, record: Record) -> IdentifyInputs:
    """Everything the options name."""
    parameters = unknowns(o.known or {}, o.prior or {}, o.bounds or {}, o.start or {}, o.free or ())
    locked = _recordings(record, "locked", o.recordings, o)
    _require_locked(o.recordings, locked)
    if not all(p.fixed for p in parameters if p.name == "s"):
        _require_pressures(o.recordings[0], locked)
    apart = _recordings(record, "held out", o.held_out or (), o)
    _require_locked(o.held_out or (), apart)
    free = _recordings(record, "unlocked", o.unlocked or (), o, (FORCE, DISPLACEMENT))
    _require_free(o.unlocked or (), free)
    return IdentifyInputs(parameters, locked, apart, free)


def _recordings(
    record: Record, role: str, paths: Sequence[Path], o: IdentifyOptions, needed: tuple[str, ...] = (FORCE,)
) -> list[ElbowRecording]:
    return recordings(record, role, paths, o.map, o.angles, o.unit, o.cutoff, needed)


def _require_locked(paths: Sequence[Path], found: Sequence[ElbowRecording]) -> None:
    """Refuse recordings whose compensation joint slides among the locked ones."""
    for path, r in zip(paths, found, strict=True):
        moved = 0.0 if r.displacement is None else float(np.ptp(r.displacement))
        if moved > SLID:
            what = f"the compensation joint slides by {moved * 1e3:.1f} mm in it"
            raise InputError(path, "", what, "give it with `unlocked`, or map another column: `map` displacement=…")


def _require_free(paths: Sequence[Path], found: Sequence[ElbowRecording]) -> None:
    """Refuse recordings whose compensation joint does not slide: locked ones, or metres called millimetres."""
    for path, r in zip(paths, found, strict=True):
        moved = 0.0 if r.displacement is None else float(np.ptp(r.displacement))
        if moved < SLID:
            what = f"the compensation joint slides by {moved * 1e3:.3g} mm in it, less than a locked one may"
            remedy = "is its column in m, and not in mm? write displacement [m]; or was it locked?"
            raise InputError(path, "", what, remedy)


def _require_pressures(path: Path, locked: Sequence[ElbowRecording]) -> None:
    """Refuse to look for s where no pressure was recorded or none differs from the others."""
    known = [r.pressure for r in locked if r.pressure is not None]
    if len(known) < len(locked):
        raise InputError(path, "", "`free` s needs a column pressure in every trial", "name it: `map` pressure=…")
    reached = float(np.ptp(np.concatenate(known)))
    if reached < SAME_PRESSURE:
        what = f"`free` s: the cuff's pressure varies by {reached / MMHG:.2g} mmHg only, which tells no s"
        raise InputError(path, "", what, "leave `free` s out, or record trials at other pressures")
