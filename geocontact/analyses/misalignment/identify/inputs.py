"""What an identification starts from: the numbers that are free, and the recordings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from geocontact.analyses.misalignment.identify.options import IdentifyOptions
from geocontact.analyses.misalignment.law_numbers import MMHG, PER_SI, WRITTEN
from geocontact.analyses.misalignment.recordings import recordings
from geocontact.axis_misalignment.law import ABSENT, NAMES, UNITS
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.data.parameter import Parameter
from geocontact.io.recordings.elbow_recording import DISPLACEMENT, FORCE

WIDEST = {
    "k": (10.0, 10e3),
    "x": (-0.15, 0.15),
    "y": (-0.15, 0.15),
    "l": (0.05, 0.5),
    "z": (-0.3, 0.3),
    "b": (-500.0, 500.0),
    "s": (-1e-3, 1e-3),
    "c": (0.0, 0.02),
}
"""Bounds of free numbers unless given, in SI units."""
BEGIN = {"k": 300.0, "x": 0.03, "y": 0.04, "l": 0.2, "z": 0.12, "b": 0.0, "s": 0.0, "c": 1e-3}
"""Starts of the explicit model's paper; that of c, a fixation of 1 N/mm, is invented."""

Values = Mapping[str, float]
Pairs = Mapping[str, tuple[float, float]]


def unknowns(known: Values, prior: Pairs, bounds: Pairs, start: Values, free: Sequence[str]) -> tuple[Parameter, ...]:
    """The numbers in the order of NAMES, in SI; InputError where what is told of them contradicts itself."""
    _refuse_free(free)
    for option, given in (("`bounds`", bounds), ("`start`", start), ("`prior`", prior)):
        _refuse_not_free(option, given, known, free)
    _refuse_bounds_and_priors(bounds, prior)
    _refuse_values(known, prior, bounds, start)
    made = []
    for name in NAMES:
        if name in known or (name in ABSENT and name not in free):
            value = known.get(name, ABSENT.get(name, 0.0))
            made.append(Parameter(name, UNITS[name], value, value, value, fixed=True))
        else:
            low, high = bounds.get(name, WIDEST[name])
            made.append(_free(name, low, high, start, prior))
    if all(p.fixed for p in made):
        raise InputError("", "`known`", "leaves nothing to be found", "leave a number out, or compare instead")
    return tuple(made)


def _free(name: str, low: float, high: float, start: Values, prior: Pairs) -> Parameter:
    first = start.get(name, prior[name][0] if name in prior else BEGIN[name])
    if name in start and not low <= first <= high:
        what = f"{name} = {first * PER_SI[name]:g} {WRITTEN[name]} is not between its bounds"
        raise InputError("", "`start`", what, "give another, or `bounds`")
    return Parameter(name, UNITS[name], min(max(first, low), high), low, high)


def _refuse_free(free: Sequence[str]) -> None:
    for name in free:
        if name not in ABSENT:
            raise InputError(
                "", "`free`", f"{name!r} is not b, s or c", "give one or more of b, s, c; the others are free"
            )


def _refuse_not_free(option: str, given: Mapping[str, object], known: Values, free: Sequence[str]) -> None:
    for name in given:
        if name in known:
            raise InputError("", option, f"{name} is known already", "give one")
        if name in ABSENT and name not in free:
            raise InputError("", option, f"{name} is not free", f"give `free` {name}")


def _refuse_bounds_and_priors(bounds: Pairs, prior: Pairs) -> None:
    for name, (low, high) in bounds.items():
        if not low < high:
            raise InputError("", "`bounds`", f"{name} has no room between its bounds", "give the lower one first")
    for name, (_, sd) in prior.items():
        if not sd > 0.0:
            what = f"{name} has an SD that is not above 0"
            raise InputError("", "`prior`", what, "give mean and SD, such as 185 and 10 mm for l")


def _refuse_values(known: Values, prior: Pairs, bounds: Pairs, start: Values) -> None:
    """Stiffness and link whose bounds are not positive."""
    for name in ("k", "l"):
        if name in bounds and not bounds[name][0] > 0.0:
            raise InputError("", "`bounds`", f"{name} may not be 0 or less", "give a lower bound above 0")


SLID = 0.5e-3  # m; a locked joint does not move as far
SAME_PRESSURE = MMHG  # Pa; pressures that differ by less are one


@dataclass(frozen=True, eq=False)
class IdentifyInputs:
    """Numbers of the law as far as they are known, and recordings: joint locked, held out, joint free."""

    parameters: tuple[Parameter, ...]
    locked: Sequence[ElbowRecording]
    held_out: Sequence[ElbowRecording]
    unlocked: Sequence[ElbowRecording]


def read(o: IdentifyOptions) -> IdentifyInputs:
    """Everything the options name."""
    parameters = unknowns(o.known or {}, o.prior or {}, o.bounds or {}, o.start or {}, o.free or ())
    locked = _recordings("locked", o.recordings, o)
    _require_locked(o.recordings, locked)
    if not all(p.fixed for p in parameters if p.name == "s"):
        _require_pressures(o.recordings[0], locked)
    apart = _recordings("held out", o.held_out or (), o)
    _require_locked(o.held_out or (), apart)
    free = _recordings("unlocked", o.unlocked or (), o, (FORCE, DISPLACEMENT))
    _require_free(o.unlocked or (), free)
    return IdentifyInputs(parameters, locked, apart, free)


def _recordings(
    role: str, paths: Sequence[Path], o: IdentifyOptions, needed: tuple[str, ...] = (FORCE,)
) -> list[ElbowRecording]:
    return recordings(role, paths, o.map, o.angles, o.unit, o.cutoff, needed)


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
