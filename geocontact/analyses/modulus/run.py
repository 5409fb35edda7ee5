"""The identification of E*: reads, computes, writes, says what it found."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from geocontact.analyses.modulus.inputs import (
    Inputs,
    inputs_given,
    model_of,
    poisson_ratios,
    refuse_idle,
    threshold_given,
)
from geocontact.analyses.modulus.prediction import Prediction, predictions
from geocontact.analyses.modulus.unknowns import unknowns
from geocontact.analyses.modulus.write import describe, write_results
from geocontact.analyses.results_folder import written_whole
from geocontact.analyses.run_record import Record
from geocontact.cli.modulus import ModulusOptions
from geocontact.contact.area_hertz import READINGS
from geocontact.data.errors import InputError
from geocontact.elastic_modulus.area_force import MODULUS, THRESHOLD, AreaForce
from geocontact.elastic_modulus.identify import STRONGEST, WEAKEST, Identification, agreement, identify
from geocontact.elastic_modulus.threshold_calibration import Calibration, calibrated
from geocontact.io.recordings.area_table import read_area_over_force

FEW_BLOCKS = 5
STRAYED = 0.3  # rms of the calibration's relative differences beyond which the table is not met


@dataclass(frozen=True)
class SensitivityRow:
    """E* of one side, reading and threshold, all else equal; infinite where the reading sees no contact."""

    side: str
    reading: str
    threshold: float
    modulus: float
    rmse: float
    r2: float


@dataclass(frozen=True, eq=False)
class Identified:
    """Everything found, by side; the first side is the headline."""

    inputs: Inputs
    sides: dict[str, Identification]
    sensitivity: list[SensitivityRow]
    calibration: Calibration | None
    predictions: list[Prediction]
    poisson: tuple[float, ...]


def analyse(o: ModulusOptions) -> int:
    """Run the whole analysis."""
    record = Record("modulus", asdict(o))
    refuse_idle(o)
    with record.catching_warnings(), written_whole(o.out) as draft:
        found = _identified(record, o)
        record.results["modulus"] = describe(found)
        write_results(record, found, o, draft)
        record.write(draft)
        written = sorted(file.name for file in draft.iterdir())
    _tell(record, found)
    record.say(f"results in {o.out}: {', '.join(written)}")
    record.speak()
    return 0


def _identified(record: Record, o: ModulusOptions) -> Identified:
    inputs = inputs_given(record, o)
    calibration = None if o.calibrate is None else _calibrated(record, inputs, o.calibrate)
    threshold = threshold_given(o, inputs.table) if calibration is None else calibration.threshold
    others = unknowns(o, inputs, threshold)
    sides = {}
    for side in inputs.sides:
        model, measured = model_of(inputs, side, threshold, others)
        if not model.per_modulus({}).any():
            what = f"{side}: reading '{o.reading}' sees no contact at {threshold * 1e3:g} mm in any frame"
            raise InputError(inputs.table.file, "", what, "give a larger --threshold or another --reading")
        sides[side] = identify(model, measured, others, o.bootstrap)
        _reserve(record, side, sides[side])
    rows = [row for side, each in sides.items() for row in _sensitivity(side, each)]
    told = predictions(record, o, inputs, sides)
    return Identified(inputs, sides, rows, calibration, told, poisson_ratios(o))


def _calibrated(record: Record, inputs: Inputs, path: Path) -> Calibration:
    """Threshold with which the areas of the whole are those of the table at the same force."""
    side = next(iter(inputs.evolutions))
    if len(inputs.table.thresholds) < 3:
        raise InputError(path, "", "calibrating needs areas at 3 thresholds or more", "see geocontact area --threshold")
    record.add_input("--calibrate", path)
    model, measured = model_of(inputs, side, float(inputs.table.thresholds[0]), ())
    measured_areas = read_area_over_force(path)
    try:
        found = calibrated(inputs.evolutions[side], model.frames, measured, *measured_areas)
    except ValueError as error:
        raise InputError(path, "", str(error), "give areas at forces of the trial") from error
    if found.on_end:
        record.warn(f"{path.name}: the best threshold is an end of those evaluated, {found.threshold * 1e3:g} mm")
    if found.rms > STRAYED:
        record.warn(f"{path.name}: areas differ by {found.rms:.0%} (rms) even at the best threshold")
    return found


def _sensitivity(side: str, each: Identification) -> list[SensitivityRow]:
    """Every reading at every threshold that was evaluated, and at the one used."""
    used = each.fit.values.get(THRESHOLD, each.model.threshold)
    levels = sorted({*map(float, each.model.evolution.thresholds), used})
    rows = []
    for reading in READINGS:
        if reading.name == "strip" and not np.isfinite(each.model.evolution.length):
            continue
        for level in levels:
            model = replace(each.model, reading=reading, threshold=level)
            rows.append(_row(side, model, each, level))
    return rows


def _row(side: str, model: AreaForce, each: Identification, level: float) -> SensitivityRow:
    held = {name: value for name, value in each.fit.values.items() if name not in (MODULUS, THRESHOLD)}
    if not model.per_modulus(held).any():
        return SensitivityRow(side, model.reading.name, level, np.inf, np.nan, np.nan)
    modulus = float(model.refit(each.measured[None, :], held, (WEAKEST, STRONGEST))[0, 0])
    rmse, r2 = agreement(each.measured, model.force({**held, MODULUS: modulus}))
    return SensitivityRow(side, model.reading.name, level, modulus, rmse, r2)


def _reserve(record: Record, side: str, each: Identification) -> None:
    """What has to be said about one side."""
    _, r2 = agreement(each.measured, each.predicted)
    if r2 < 0.0:
        record.warn(f"{side}: R² is {r2:.2f}, a constant force would do better than the law")
    for name in each.on_bound:
        record.warn(f"{side}: the data set no limit to {name} within its bounds on one side or both")
    drawn = each.replicates
    if drawn is not None and drawn.blocks < FEW_BLOCKS:
        record.warn(f"{side}: {drawn.blocks} blocks of {drawn.block:.2g} s are few for a bootstrap")
    if drawn is not None and drawn.block < each.memory.typical:
        what = f"the residual remembers for about {each.memory.typical:.2g} s of {len(each.measured)} frames"
        record.warn(f"{side}: {what}, longer than a block: the law misses something, and intervals are rough")
    free = each.told_apart.get("free")
    if free is not None and free.verdict != "told apart":
        record.warn(f"{side}: {', '.join(free.names)} are {free.verdict} (condition {free.condition:.3g})")


def _tell(record: Record, found: Identified) -> None:
    for side, each in found.sides.items():
        p = each.profiles[MODULUS]
        rmse, r2 = agreement(each.measured, each.predicted)
        span = f"{p.lower * 1e-6:.4g} … {p.upper * 1e-6:.4g}"
        record.say(f"{side}: E* {each.modulus * 1e-6:.4g} MPa (95 % {span}), RMSE {rmse:.0f} N, R² {r2:.2f}")
    record.say("E and ν are one number here: area and force tell E* = E/(1 - ν²), and E only for a stated ν")
    for told in found.predictions:
        if told.measured is not None:
            record.say(f"{told.side}, trial not used: RMSE {told.rmse:.0f} N, R² {told.r2:.2f}")
