"""Force of a trial that was not used, by what was identified on another."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.analyses.modulus.inputs import BOTH, FLEXION, HALVES, Inputs
from geocontact.analyses.run_record import Record
from geocontact.cli.modulus import ModulusOptions
from geocontact.data.errors import InputError
from geocontact.elastic_modulus.area_force import ADDUCTION, LAG, THRESHOLD, ThresholdAreas
from geocontact.elastic_modulus.identify import Identification, agreement
from geocontact.io.recordings.area_table import FEWEST, AreaTable, read_area_table
from geocontact.io.recordings.force_curves import SIDES, ForceCurves, read_force_curves
from geocontact.io.text.columns import parse_map


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


def predictions(
    record: Record, o: ModulusOptions, inputs: Inputs, sides: Mapping[str, Identification]
) -> list[Prediction]:
    """Of every side that the other trial's areas have; threshold, radius and lag as identified or given."""
    if not o.predict_area:
        return []
    table = read_area_table(o.predict_area)
    for path in o.predict_area:
        record.add_input("--predict-area", path)
    forces = _forces(record, o)
    found = []
    for side, each in sides.items():
        parts = [part for part in (HALVES if side == BOTH else (side,)) if part in table.areas]
        found += [_predicted(table, forces, inputs, part, each) for part in parts]
    if not found:
        raise InputError(table.file, "", f"areas of {', '.join(table.areas)}, identified: {', '.join(sides)}", "")
    return found


def _forces(record: Record, o: ModulusOptions) -> ForceCurves | None:
    if o.predict_force is None:
        return None
    mapping = {} if o.map is None else parse_map(o.map, (*SIDES, FLEXION))
    forces = read_force_curves(o.predict_force, o.unit, {side: mapping[side] for side in SIDES if side in mapping})
    record.add_input("--predict-force", o.predict_force, unit=forces.unit)
    return forces


def _predicted(
    table: AreaTable, forces: ForceCurves | None, inputs: Inputs, side: str, each: Identification
) -> Prediction:
    values = each.fit.values
    threshold, lag = values.get(THRESHOLD, each.model.threshold), values.get(LAG, inputs.lag)
    known = table.thresholds
    if not np.isclose(known, threshold, rtol=1e-9).any() and not known[0] <= threshold <= known[-1]:
        what = f"has no areas at {threshold * 1e3:g} mm"
        raise InputError(table.file, "", what, "compute them with the --threshold used here")
    near = np.flatnonzero(np.isclose(known, threshold, rtol=1e-9))
    radius = np.full(len(table.time), float(each.model.evolution.radius[0]))
    tilts = table.tilted.get(side)
    turned = {name: value for name, value in values.items() if name == ADDUCTION}
    if turned and (tilts is None or not tilts.offsets[0] <= values[ADDUCTION] <= tilts.offsets[-1]):
        what = f"has no areas around the adduction offset of {np.degrees(values[ADDUCTION]):.2f} degrees"
        raise InputError(table.file, "", what, "compute them with --adduction as for the trial used")
    evolution = ThresholdAreas(table.time, known, table.areas[side], radius, each.model.evolution.length, tilts)
    evolution = evolution.with_offsets(turned)
    level = float(known[near[0]]) if len(near) else threshold
    predicted = each.modulus * evolution.per_modulus(each.model.reading, level)
    if forces is None or side not in forces.forces:
        return Prediction(side, table.time, predicted, None)
    at = table.time + lag
    measured = np.interp(at, forces.time, forces.forces[side], left=np.nan, right=np.nan)
    if np.isfinite(measured).sum() < FEWEST:
        what = (
            f"fewer than {FEWEST} frames of {table.file} lie in its time ({forces.time[0]:g} to {forces.time[-1]:g} s)"
        )
        raise InputError(forces.file, "", what, "are the clocks the same? see --lag")
    return Prediction(side, table.time, predicted, measured)
