"""Free parameters besides E*, with bounds: as typed, or as far as the inputs reach."""

from __future__ import annotations

import numpy as np

from geocontact.analyses import quantities
from geocontact.analyses.modulus.free_parameters import freed
from geocontact.analyses.modulus.inputs import Inputs
from geocontact.cli.modulus import ModulusOptions
from geocontact.data.errors import InputError
from geocontact.data.parameter import Parameter
from geocontact.elastic_modulus.area_force import ADDUCTION, LAG, SLOPE, THRESHOLD
from geocontact.io.recordings.area_table import AreaTable

LAGS = 0.1  # s, how far a lag is searched unless told
BENDS = 0.5  # share by which R may change at the largest flexion, unless told
STRAIGHT = np.radians(1.0)  # a motion that flexes by less tells nothing of a radius that follows flexion


def unknowns(o: ModulusOptions, inputs: Inputs, threshold: float) -> tuple[Parameter, ...]:
    """Free parameters besides E*, with their bounds."""
    typed = freed(o)
    if THRESHOLD in typed and o.calibrate is not None:
        raise InputError("", "--free", "threshold beside --calibrate says it twice", "give one")
    makers = {
        THRESHOLD: lambda bounds: _threshold(bounds, inputs.table, threshold),
        LAG: lambda bounds: _lag(bounds, inputs.lag),
        ADDUCTION: lambda bounds: _adduction(bounds, inputs.table),
        SLOPE: lambda bounds: _slope(bounds, inputs),
    }
    return tuple(makers[name](bounds) for name, bounds in typed.items())


def _threshold(bounds: str, table: AreaTable, start: float) -> Parameter:
    levels = table.thresholds
    if len(levels) < 3:
        what = f"threshold needs areas at 3 thresholds or more; {table.file} has {len(levels)}"
        raise InputError("", "--free", what, "compute them: geocontact area --threshold 1,2,3,4,5")
    low, high = (float(levels[0]), float(levels[-1])) if not bounds else (v * 1e-3 for v in _pair(bounds))
    if low < levels[0] - 1e-12 or high > levels[-1] + 1e-12:
        what = f"threshold={bounds} reaches beyond the areas, {levels[0] * 1e3:g} to {levels[-1] * 1e3:g} mm"
        raise InputError("", "--free", what, "compute areas at more thresholds")
    return Parameter(THRESHOLD, "m", float(np.clip(start, low, high)), low, high)


def _lag(bounds: str, start: float) -> Parameter:
    low, high = (start - LAGS, start + LAGS) if not bounds else _pair(bounds)
    return Parameter(LAG, "s", float(np.clip(start, low, high)), low, high)


def _adduction(bounds: str, table: AreaTable) -> Parameter:
    """A table of areas alone does not say what another pose would give: areas at other poses do."""
    known = next(iter(table.tilted.values())).offsets if table.tilted else np.zeros(1)
    if len(known) < 3:
        what = f"adduction needs areas at 3 offsets of it or more; {table.file} has {len(known)}"
        raise InputError("", "--free", what, "compute them: geocontact area --adduction x=-2, and x=2, besides none")
    low, high = (float(known[0]), float(known[-1])) if not bounds else (float(np.radians(v)) for v in _pair(bounds))
    if low < known[0] - 1e-9 or high > known[-1] + 1e-9:
        reach = f"{np.degrees(known[0]):g} to {np.degrees(known[-1]):g} degrees"
        what = f"adduction={bounds} reaches beyond the areas, {reach}"
        raise InputError("", "--free", what, "compute areas at more offsets")
    return Parameter(ADDUCTION, "rad", float(np.clip(0.0, low, high)), low, high)


def _slope(bounds: str, inputs: Inputs) -> Parameter:
    flexion = next(iter(inputs.evolutions.values())).flexion
    if flexion is None:
        raise InputError("", "--free", "slope needs --flexion", "give the motion of the areas")
    largest = float(np.abs(flexion).max())
    if largest < STRAIGHT:
        raise InputError("", "--free", "slope: flexion stays below 1 degree", "leave it out; see --map flexion=…")
    low, high = (-BENDS / largest, BENDS / largest) if not bounds else _pair(bounds)
    if min((1.0 + end * flexion).min() for end in (low, high)) <= 0.0:
        what = f"slope={bounds}: the radius would vanish at {np.degrees(largest):.0f} degrees of flexion"
        raise InputError("", "--free", what, f"stay within {1.0 / largest:.3g} per rad")
    return Parameter(SLOPE, "1/rad", float(np.clip(0.0, low, high)), low, high)


def _pair(text: str) -> tuple[float, float]:
    low, colon, high = text.partition(":")
    if not colon:
        raise InputError("", "--free", f"{text!r} is not lower:upper", "write threshold=1:6")
    values = (quantities.number(low, "--free", "lag=-0.05:0.05"), quantities.number(high, "--free", "lag=-0.05:0.05"))
    if not values[0] < values[1]:
        raise InputError("", "--free", f"{text!r} has no room between its bounds", "write lower:upper")
    return values
