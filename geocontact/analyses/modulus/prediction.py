"""Force of a trial that was not used, by what was identified on another."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.analyses.modulus.read import BOTH, HALVES, ModulusInputs, OtherTrial
from geocontact.data.errors import InputError
from geocontact.elastic_modulus.area_force import ADDUCTION, LAG, THRESHOLD, ThresholdAreas
from geocontact.elastic_modulus.identify import Identification, agreement
from geocontact.io.recordings.area_table import FEWEST, AreaTable


@dataclass(frozen=True, eq=False)
class Prediction:
    """Predicted and, where it is known, measured force of one side [N]; `measured` is NaN outside its recording."""

    side: str
    time: Float[np.ndarray, " t"]
    predicted: Float[np.ndarray, " t"]
    measured: Float[np.ndarray, " t"] | None

    @property
    def rmse(self) -> float:
        """Root mean square error [N] where both are known."""
        return self._agreement()[0]

    @property
    def r2(self) -> float:
        """R^2 about the mean of what was measured."""
        return self._agreement()[1]

    def _agreement(self) -> tuple[float, float]:
        if self.measured is None:
            return float("nan"), float("nan")
        there = np.isfinite(self.measured)
        return agreement(self.measured[there], self.predicted[there])


def predictions(inputs: ModulusInputs, sides: Mapping[str, Identification]) -> list[Prediction]:
    """Of every side that the other trial's areas have; threshold, radius and lag as identified or given."""
    if inputs.other is None:
        return []
    table, found = inputs.other.table, []
    for side, each in sides.items():
        parts = [part for part in (HALVES if side == BOTH else (side,)) if part in table.areas]
        found += [_predicted(inputs.other, inputs.lag, part, each) for part in parts]
    if not found:
        raise InputError(table.file, "", f"areas of {', '.join(table.areas)}, identified: {', '.join(sides)}", "")
    return found


def _predicted(other: OtherTrial, given_lag: float, side: str, each: Identification) -> Prediction:
    table, values = other.table, each.fit.values
    level = _level(table, each)
    predicted = _force(_evolution(table, side, each), each, level)
    if other.forces is None or side not in other.forces.forces:
        return Prediction(side, table.time, predicted, None)
    clock, at = other.forces.time, table.time + values.get(LAG, given_lag)
    measured = np.interp(at, clock, other.forces.forces[side], left=np.nan, right=np.nan)
    if np.isfinite(measured).sum() < FEWEST:
        what = f"fewer than {FEWEST} frames of {table.file} lie in its time ({clock[0]:g} to {clock[-1]:g} s)"
        raise InputError(other.forces.file, "", what, "are the clocks the same? see `lag`")
    return Prediction(side, table.time, predicted, measured)


def _force(evolution: ThresholdAreas, each: Identification, level: float) -> Float[np.ndarray, " t"]:
    unit, sticks = evolution.per_modulus(each.model.reading, level), each.model.adhesion
    if sticks is None:
        return np.asarray(each.modulus * unit)
    return sticks.force(unit, sticks.pull(evolution.within(level), evolution.radius), each.modulus)


def _level(table: AreaTable, each: Identification) -> float:
    """The threshold used, exactly as the table has it where it does."""
    known, threshold = table.thresholds, each.fit.values.get(THRESHOLD, each.model.threshold)
    near = np.flatnonzero(np.isclose(known, threshold, rtol=1e-9))
    if not len(near) and not known[0] <= threshold <= known[-1]:
        what = f"has no areas at {threshold * 1e3:g} mm"
        raise InputError(table.file, "", what, "compute them with the `threshold` used here")
    return float(known[near[0]]) if len(near) else threshold


def _evolution(table: AreaTable, side: str, each: Identification) -> ThresholdAreas:
    """Areas of one side at the offset that was identified."""
    radius = np.full(len(table.time), float(each.model.evolution.radius[0]))
    tilts = table.tilted.get(side)
    turned = {name: value for name, value in each.fit.values.items() if name == ADDUCTION}
    if turned and (tilts is None or not tilts.offsets[0] <= turned[ADDUCTION] <= tilts.offsets[-1]):
        what = f"has no areas around the adduction offset of {np.degrees(turned[ADDUCTION]):.2f} degrees"
        raise InputError(table.file, "", what, "compute them with `adduction` as for the trial used")
    evolution = ThresholdAreas(
        table.time, table.thresholds, table.areas[side], radius, each.model.evolution.length, tilts
    )
    return evolution.with_offsets(turned)
