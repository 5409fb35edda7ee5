"""Free parameters besides E*, with bounds: as given, or as far as the inputs reach."""

from __future__ import annotations

import numpy as np

from geocontact.analyses.modulus.options import ModulusOptions
from geocontact.analyses.modulus.read import ModulusInputs
from geocontact.data.errors import InputError
from geocontact.data.parameter import Parameter
from geocontact.elastic_modulus.area_force import ADDUCTION, LAG, SLOPE, THRESHOLD
from geocontact.io.recordings.area_table import AreaTable

Bounds = tuple[float, float] | None

LAGS = 0.1  # s, how far a lag is searched unless told
BENDS = 0.5  # share by which R may change at the largest flexion, unless told
STRAIGHT = np.radians(1.0)  # a motion that flexes by less tells nothing of a radius that follows flexion


def unknowns(o: ModulusOptions, inputs: ModulusInputs, threshold: float) -> tuple[Parameter, ...]:
    """Free parameters besides E*, with their bounds."""
    makers = {
        THRESHOLD: lambda bounds: _threshold(bounds, inputs.table, threshold),
        LAG: lambda bounds: _lag(bounds, inputs.lag),
        ADDUCTION: lambda bounds: _adduction(bounds, inputs.table),
        SLOPE: lambda bounds: _slope(bounds, inputs),
    }
    return tuple(makers[name](bounds) for name, bounds in (o.free or {}).items())


def _threshold(bounds: Bounds, table: AreaTable, start: float) -> Parameter:
    levels = table.thresholds
    if len(levels) < 3:
        what = f"threshold needs areas at 3 thresholds or more; {table.file} has {len(levels)}"
        raise InputError("", "`free`", what, "compute them: `threshold` 1,2,3,4,5 of geocontact area")
    low, high = bounds or (float(levels[0]), float(levels[-1]))
    if low < levels[0] - 1e-12 or high > levels[-1] + 1e-12:
        reach = f"{levels[0] * 1e3:g} to {levels[-1] * 1e3:g} mm"
        what = f"a threshold of {low * 1e3:g} to {high * 1e3:g} mm reaches beyond the areas, {reach}"
        raise InputError("", "`free`", what, "compute areas at more thresholds")
    return Parameter(THRESHOLD, "m", float(np.clip(start, low, high)), low, high)


def _lag(bounds: Bounds, start: float) -> Parameter:
    low, high = bounds or (start - LAGS, start + LAGS)
    return Parameter(LAG, "s", float(np.clip(start, low, high)), low, high)


def _adduction(bounds: Bounds, table: AreaTable) -> Parameter:
    """A table of areas alone does not say what another pose would give: areas at other poses do."""
    known = next(iter(table.tilted.values())).offsets if table.tilted else np.zeros(1)
    if len(known) < 3:
        what = f"adduction needs areas at 3 offsets of it or more; {table.file} has {len(known)}"
        raise InputError("", "`free`", what, "compute them: `adduction` x=-2 and x=2 of geocontact area, besides none")
    low, high = bounds or (float(known[0]), float(known[-1]))
    if low < known[0] - 1e-9 or high > known[-1] + 1e-9:
        asked, reach = (f"{np.degrees(a):g} to {np.degrees(b):g} degrees" for a, b in ((low, high), known[[0, -1]]))
        what = f"an adduction of {asked} reaches beyond the areas, {reach}"
        raise InputError("", "`free`", what, "compute areas at more offsets")
    return Parameter(ADDUCTION, "rad", float(np.clip(0.0, low, high)), low, high)


def _slope(bounds: Bounds, inputs: ModulusInputs) -> Parameter:
    flexion = next(iter(inputs.evolutions.values())).flexion
    if flexion is None:
        raise InputError("", "`free`", "slope needs `flexion`", "give the motion of the areas")
    largest = float(np.abs(flexion).max())
    if largest < STRAIGHT:
        raise InputError("", "`free`", "slope: flexion stays below 1 degree", "leave it out; see `map` flexion=…")
    low, high = bounds or (-BENDS / largest, BENDS / largest)
    if min((1.0 + end * flexion).min() for end in (low, high)) <= 0.0:
        what = f"a slope of {low:g} to {high:g} per rad: the radius would vanish at"
        what += f" {np.degrees(largest):.0f} degrees of flexion"
        raise InputError("", "`free`", what, f"stay within {1.0 / largest:.3g} per rad")
    return Parameter(SLOPE, "1/rad", float(np.clip(0.0, low, high)), low, high)
