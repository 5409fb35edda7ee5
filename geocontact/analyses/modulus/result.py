"""E* of a contact from its area and its force: `geocontact modulus`, `gc.modulus`.

>>> import geocontact as gc, numpy as np, pandas as pd
>>> time, area = np.linspace(0.0, 1.0, 11), np.linspace(100.0, 200.0, 11)
>>> areas = {"time [s]": time, "threshold [mm]": 1.0, "area_fixed [mm^2]": area}
>>> pd.DataFrame(areas).to_csv("area.csv", index=False)
>>> force = 4 / 3 * gc.MPa(2) * (area * 1e-6 / np.pi) ** 1.5 / gc.mm(34)
>>> pd.DataFrame({"time [s]": time, "total [N]": force}).to_csv("forces.csv", index=False)
>>> print(gc.modulus("area.csv", "forces.csv", radius=gc.mm(34)))
total: E* 2 MPa (95 % 2 … 2), RMSE 0 N, R² 1.00
E and ν are one number here: area and force identify E* = E/(1 - ν²), and E only for a stated ν
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from geocontact.analyses.frame.collector import as_it_fits, contradicted, if_it_fits, judge, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.modulus.goodness import goodness_of
from geocontact.analyses.modulus.identified import (
    Identified,
    PoseModuli,
    curve_table,
    describe,
    modulus_table,
    prediction_table,
    predictions,
    sensitivity_table,
)
from geocontact.analyses.modulus.inputs import ModulusInputs, model_of, read, threshold_given, unknowns
from geocontact.analyses.modulus.options import ModulusOptions
from geocontact.analyses.modulus.recommended import reason
from geocontact.analyses.modulus.show import moduli, modulus_curves, modulus_page, told_apart
from geocontact.data.errors import InputError
from geocontact.data.parameter import Parameter
from geocontact.data.text import seconds
from geocontact.elastic_modulus.area_force import MODULUS
from geocontact.elastic_modulus.identify import Identification, agreement, identify
from geocontact.elastic_modulus.sensitivity import sensitivity
from geocontact.elastic_modulus.surface_energy import ALIKE
from geocontact.elastic_modulus.threshold_calibration import Calibration, calibrated
from geocontact.identify.signals.filters import gaps
from geocontact.view.page.tables import frame_table

if TYPE_CHECKING:
    from geocontact.view.curves.declared import CurveSheet
    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ModulusResult(Result):
    """Elastic modulus of a contact.

    Parameters
    ----------
    found
        Identification of each side, sensitivity, calibration, predictions.
    """

    elsewhere: ClassVar[frozenset[str]] = frozenset({"modulus"})

    options: ModulusOptions
    found: Identified

    @property
    def modulus(self) -> float:
        """E* of the first side [Pa]: of the total force, where there is one."""
        return self.found.first.modulus

    @property
    def interval(self) -> tuple[float, float]:
        """95 % interval of the same by profile likelihood [Pa]; NaN where the law contradicts the forces."""
        profile = self.found.first.profiles[MODULUS]
        return (profile.lower, profile.upper) if self.fits else (math.nan, math.nan)

    @property
    def sides(self) -> Mapping[str, Identification]:
        """Model, measured force, estimates and intervals of each side."""
        return self.found.sides

    @property
    def not_identifiable(self) -> list[str]:
        """What the data cannot identify, a sentence each."""
        return self.found.not_identifiable()

    def tables(self) -> dict[str, pd.DataFrame]:
        """`modulus`, `curves`, `sensitivity`, and `prediction` of a trial that was not used."""
        f = self.found
        found = {"modulus": modulus_table(f), "curves": curve_table(f), "sensitivity": sensitivity_table(f)}
        return {**found, "prediction": prediction_table(f)} if f.predictions else found

    def curves(self) -> dict[str, CurveSheet]:
        """`modulus`: force measured and by the law, and how well E* is known."""
        return {"modulus": modulus_curves(self.found)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """How well the law meets the forces, what it tells, and what it cannot tell."""
        sensitivity = frame_table("Threshold and reading: what E* depends on", self.table("sensitivity"))
        tables = [moduli(self.found), told_apart(self.found), sensitivity, INPUTS, OPTIONS]
        title = f"E* from {self.options.area[0].name} and {self.options.force.name}"
        return {REPORT: modulus_page(title, self.found, self.curves()["modulus"], tables)}

    def write_files(self, folder: Path) -> None:
        """modulus.json besides."""
        text = json.dumps(as_it_fits(describe(self.found)), indent=2, ensure_ascii=False, allow_nan=False)
        (folder / "modulus.json").write_text(text + "\n", encoding="utf-8")
        super().write_files(folder)


FEW_BLOCKS = 5
STRAYED = 0.3  # rms of the calibration's relative differences beyond which the table is not met


def run(inputs: ModulusInputs, o: ModulusOptions) -> ModulusResult:
    """E* of every side, with what it depends on, and the forces of a trial that was not used."""
    calibration = _calibrated(inputs, o.calibrate)
    threshold = threshold_given(o, inputs.table) if calibration is None else calibration.threshold
    others = unknowns(o, inputs, threshold)
    _doubt(inputs)
    sides = _sides(inputs, threshold, others, o)
    poses = None if inputs.draws is None else PoseModuli.of(sides["total"], inputs.draws)
    found = Identified(sides, sensitivity(sides), calibration, predictions(inputs, sides), o.poisson, poses)
    judge(goodness_of(found))
    note("modulus", describe(found))
    _report(found)
    return ModulusResult(options=o, found=found)


def _identified(
    inputs: ModulusInputs, side: str, threshold: float, others: tuple[Parameter, ...], o: ModulusOptions
) -> Identification:
    model, measured = model_of(inputs, side, threshold, others)
    if not model.per_modulus({}).any():
        what = f"{side}: reading '{o.reading}' sees no contact at {threshold * 1e3:g} mm in any frame"
        raise InputError(inputs.table.file, "", what, "give a larger `threshold` or another `reading`")
    if not (measured > 0.0).any():
        what = f"{side}: the force is never above 0 N in the frames that are used"
        raise InputError(inputs.forces.file, "", what, "is the right column named? see `map`; compression is positive")
    try:
        found = identify(model, measured, others, o.bootstrap)
    except ValueError as error:
        remedy = "leave it out of `free`" if others else "check that areas and forces belong together"
        raise InputError(inputs.table.file, "", f"{side}: {error}", remedy) from error
    _reserve(side, found)
    return found


def _sides(
    inputs: ModulusInputs, threshold: float, others: tuple[Parameter, ...], o: ModulusOptions
) -> dict[str, Identification]:
    """Every side that identifies something; the others are named. InputError where none does."""
    found, untold = {}, []
    for side in inputs.sides:
        try:
            found[side] = _identified(inputs, side, threshold, others, o)
        except InputError as error:
            untold.append(error)
    if not found:
        raise untold[0]
    for each in untold:
        reserve(f"{each.what}: this side is left out")
    return found


def _doubt(inputs: ModulusInputs) -> None:
    """What is odd about the inputs before anything is fitted."""
    for each in gaps(inputs.forces.time):
        span = f"{seconds(each.start)} to {seconds(each.end)} s"
        reserve(f"{inputs.forces.file}: no samples from {span}: frames of the area in there are not used")
    areas = next(iter(inputs.table.areas.values()))
    if areas.shape[1] > 1 and (areas == areas[:, :1]).all():
        reserve(f"{inputs.table.file}: areas are the same at every threshold: nothing depends on it here")


def _calibrated(inputs: ModulusInputs, path: Path | None) -> Calibration | None:
    """Threshold with which the areas of the whole are those of the table at the same force."""
    if path is None or inputs.measured_areas is None:
        return None
    side = next(iter(inputs.evolutions))
    model, measured = model_of(inputs, side, float(inputs.table.thresholds[0]), ())
    try:
        found = calibrated(inputs.evolutions[side], model.frames, measured, *inputs.measured_areas)
    except ValueError as error:
        raise InputError(path, "", str(error), "give areas at forces of the trial") from error
    if found.on_end:
        reserve(f"{path.name}: the best threshold is at an end of the evaluated range, {found.threshold * 1e3:g} mm")
    if found.rms > STRAYED:
        reserve(f"{path.name}: areas differ by {found.rms:.0%} (rms) even at the best threshold")
    return found


def _reserve(side: str, each: Identification) -> None:
    """What has to be said about one side."""
    drawn = each.replicates
    if drawn is not None and drawn.blocks < FEW_BLOCKS:
        reserve(f"{side}: {drawn.blocks} blocks of {drawn.block:.2g} s are few for a bootstrap")
    if drawn is not None and drawn.block < each.memory.typical:
        what = f"the residual is correlated over about {each.memory.typical:.2g} s of {len(each.measured)} frames"
        reserve(f"{side}: {what}, longer than a block: the law is incomplete, and intervals are approximate")
    free = each.told_apart.get("free")
    if free is not None and free.verdict != "separable":
        reserve(f"{side}: {', '.join(free.names)} are {free.verdict} (condition {free.condition:.3g})")


def _report(found: Identified) -> None:
    for side, each in found.sides.items():
        p = each.profiles[MODULUS]
        rmse, r2 = agreement(each.measured, each.predicted)
        span = f"{p.lower * 1e-6:.4g} … {p.upper * 1e-6:.4g}"
        held = each.model.sticking(each.fit.values)
        sticks = "" if held is None else f", {held.words}"
        interval = if_it_fits(f" (95 % {span})")
        say(f"{side}: E* {each.modulus * 1e-6:.4g} MPa{interval}, RMSE {rmse:.0f} N, R² {r2:.2f}{sticks}")
    if not contradicted():
        _report_surfaces(found)
    if found.poses is not None and not contradicted():
        alone, both = (
            " … ".join(f"{end * 1e-6:.4g}" for end in ends) for ends in (found.poses.interval, found.poses.both)
        )
        say(f"error of the pose: E* {alone} MPa (95 % of {len(found.poses.drawn)} draws), with the forces' {both} MPa")
    if (why := reason(found)) and not contradicted():
        say(why)
    say("E and ν are one number here: area and force identify E* = E/(1 - ν²), and E only for a stated ν")
    for told in found.predictions:
        if told.measured is not None:
            say(f"{told.side}, trial not used: RMSE {told.rmse:.0f} N, R² {told.r2:.2f}")


def _report_surfaces(found: Identified) -> None:
    """The work of adhesion and the pull-off force of each side, or that there is none to be seen."""
    for side, e in found.surfaces.items():
        span, pull = f"{e.lower:.3g} … {e.upper:.3g} J/m²", f"{-e.weakest:.3g} … {-e.strongest:.3g} N"
        if not e.separable:
            say(f"{side}: the work of adhesion {e.why}")
            continue
        say(
            f"{side}: work of adhesion {e.work:.3g} J/m² (95 % {span}), they come apart at {-e.pull_off:.3g} N ({pull})"
        )
        if e.as_zero > ALIKE:
            alike = f"an error of the force's zero acts as the work of adhesion does (cosine {e.as_zero:.2f})"
            reserve(f"{side}: {alike}: {e.zero:.3g} N of it would be taken for all of w; record it unloaded")


modulus = Job("modulus", ModulusOptions, read, run)
