"""What is identified: modulus of each side, what it depends on, and forces of a trial that was not used."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.analyses.modulus.inputs import BOTH, HALVES, ModulusInputs, OtherTrial
from geocontact.contact.area_hertz import READINGS
from geocontact.data.errors import InputError
from geocontact.elastic_modulus.area_force import ADDUCTION, LAG, MODULUS, SLOPE, THRESHOLD, AreaForce, ThresholdAreas
from geocontact.elastic_modulus.identify import STRONGEST, WEAKEST, Identification, agreement
from geocontact.elastic_modulus.threshold_calibration import Calibration
from geocontact.io.recordings.area_table import FEWEST, AreaTable


@dataclass(frozen=True)
class SensitivityRow:
    """E* [Pa] of one side, reading and threshold [m], all else equal; infinite where the reading sees no contact."""

    side: str
    reading: str
    threshold: float
    modulus: float
    rmse: float
    r2: float


def sensitivity(sides: Mapping[str, Identification]) -> list[SensitivityRow]:
    """Sensitivity of all sides, one after another."""
    return [row for side, each in sides.items() for row in _rows(side, each)]


def _rows(side: str, each: Identification) -> list[SensitivityRow]:
    """Every reading at every threshold that was evaluated, and at the one used."""
    used = each.fit.values.get(THRESHOLD, each.model.threshold)
    levels = sorted({*map(float, each.model.evolution.thresholds), used})
    rows = []
    for reading in READINGS:
        if reading.name == "strip" and not np.isfinite(each.model.evolution.length):
            continue
        sticks = each.model.adhesion if reading.name == each.model.reading.name else None
        for level in levels:
            model = replace(each.model, reading=reading, threshold=level, adhesion=sticks)
            rows.append(_row(side, model, each, level))
    return rows


def _row(side: str, model: AreaForce, each: Identification, level: float) -> SensitivityRow:
    held = {name: value for name, value in each.fit.values.items() if name not in (MODULUS, THRESHOLD)}
    if not model.per_modulus(held).any():
        return SensitivityRow(side, model.reading.name, level, np.inf, np.nan, np.nan)
    modulus = float(model.refit(each.measured[None, :], held, (WEAKEST, STRONGEST))[0, 0])
    rmse, r2 = agreement(each.measured, model.force({**held, MODULUS: modulus}))
    return SensitivityRow(side, model.reading.name, level, modulus, rmse, r2)


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
    """Predictions of every side that the other trial's areas have; threshold, radius and lag as identified or given."""
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


ONE_NUMBER = "E and nu are one number here: area and force tell E* = E/(1 - nu^2) only, and E for a stated nu"
RADIUS = "E* and a constant R are one number as well, E*/R: the radius is an input, not a result"
RADII = "of R the forces tell only how it changes with flexion (slope): its size at 0 degrees is one number with E*"
FLAT = 1e-6  # of a force by the law; one that varies less does not vary


@dataclass(frozen=True, eq=False)
class ForcePair:
    """Measured and predicted force [N] over time [s]."""

    time: Float[np.ndarray, " n"]
    measured: Float[np.ndarray, " n"]
    predicted: Float[np.ndarray, " n"]


@dataclass(frozen=True, eq=False)
class Identified:
    """What was found, by side; the first side is the headline.

    Parameters
    ----------
    sides
        "total", "medial", "lateral", as far as areas and forces have them, or "both" halves met at once.
    sensitivity
        E* by every reading at every threshold.
    calibration
        The threshold that measured areas ask for, where they were given.
    predictions
        Of a trial that was not used.
    poisson
        Ratios that E is told for.
    """

    sides: dict[str, Identification]
    sensitivity: list[SensitivityRow]
    calibration: Calibration | None
    predictions: list[Prediction]
    poisson: tuple[float, ...]

    @property
    def first(self) -> Identification:
        """The side of the headline."""
        return next(iter(self.sides.values()))

    def frames_once(self, side: str) -> int:
        """Frames of the motion that were used; both halves have the same."""
        return len(self.sides[side].model.frames) // (len(HALVES) if side == BOTH else 1)

    def curves(self) -> dict[str, ForcePair]:
        """Measured and predicted force by side; both halves, where they were met at once, each for itself."""
        shown = {}
        for side, each in self.sides.items():
            count = self.frames_once(side)
            time = each.model.frames[:count]
            for k, name in enumerate(HALVES if side == BOTH else (side,)):
                part = slice(k * count, (k + 1) * count)
                shown[name] = ForcePair(time, each.measured[part], each.predicted[part])
        return shown

    def not_identifiable(self) -> list[str]:
        """What the data cannot tell; (E*, R) depends on the reading, the free numbers on the data."""
        each = self.first
        lines = [f"E* and {name} are one number here: {name} is not identifiable" for name in confounded(each)]
        if each.told_apart["E*, R"].verdict != "one number":
            return [ONE_NUMBER, *lines]
        return [ONE_NUMBER, RADIUS, *([RADII] if SLOPE in each.fit.names else []), *lines]


def confounded(each: Identification) -> list[str]:
    """Free numbers that change nothing, or nothing that E* does not change alike."""
    groups = {name: each.told_apart.get(f"E*, {name}") for name in each.fit.names if name != MODULUS}
    return [name for name, group in groups.items() if group is None or group.verdict == "one number"]


def constant(each: Identification) -> bool:
    """Whether the force by the law is the same in every frame, as of a constant area."""
    return bool(np.ptp(each.predicted) <= FLAT * each.predicted.max())
