"""Keel of a prosthetic foot from static compressions: `geocontact prosthesis keel`, `gc.prosthesis.keel`.

>>> import geocontact as gc
>>> print(gc.prosthesis.keel())
EI 22.7 N m² (95 % 20.9 … 24.7) with the plate on the keel, 92.3 N/mm (78 … 109) in series
EI 19.7 N m² (95 % 18.4 … 21.2) and 38.5 N/mm a sphere of forefoot with the plate on the sole: compressions are met to
0.7%
fulcrum of medium at 117.4 mm (95 % 114.2 … 120.6)
warning: as many numbers as compressions: nothing is over to test beam theory with
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import judge, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.json_file import plain
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.frame.words import rounded
from geocontact.analyses.prosthesis.foot_writer import write_foot
from geocontact.analyses.prosthesis.keel.compressions import CompressedFoot, lines_of, read
from geocontact.analyses.prosthesis.keel.options import ProsthesisKeelOptions
from geocontact.analyses.prosthesis.keel.show import keel_curves, keel_page
from geocontact.below_knee_prosthesis.keel.compression import pressed_sole
from geocontact.below_knee_prosthesis.keel.foam import foam_numbers
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.identification import (
    SERIES,
    IdentifiedKeel,
    IdentifiedNumber,
    identified_keel,
)
from geocontact.below_knee_prosthesis.keel.sole_identification import IdentifiedSole, identified_sole
from geocontact.data.errors import InputError
from geocontact.data.parameter import Number
from geocontact.data.plausible import Plausible
from geocontact.data.units import GPa
from geocontact.identify.goodness_of_fit import Doubt, GoodnessOfFit, of_bounds, of_each, of_residual, of_size

if TYPE_CHECKING:
    from geocontact.view.curves.declared import CurveSheet
    from geocontact.view.page.content import Page

PLACES = 35
"""Fulcrums at which the stiffness is shown."""
PER_MM = 1e-3
"""N/mm of a stiffness of 1 N/m."""
MODULI = (
    (1450.0, Plausible("Young's modulus of a polymer", GPa, (0.01, 100.0), (0.5, 12.0))),
    (2200.0, Plausible("Young's modulus of a laminate of glass or carbon fibre", GPa, (0.1, 600.0), (7.0, 160.0))),
    (np.inf, Plausible("Young's modulus of a metal", GPa, (1.0, 600.0), (40.0, 230.0))),
)
"""By densities below [kg/m³]: acetal and nylon have 1 to 4 GPa, with short fibres up to 12; laminates 8 to 150; light
alloys and steels 45 to 210."""
STATED_OFF = 1.5
"""Times that an EI of the file may be off the one that its compressions have."""


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ProsthesisKeelResult(Result):
    """A keel, identified from compressions.

    Parameters
    ----------
    beam
        By beam theory.
    sole
        On its sole.
    """

    options: ProsthesisKeelOptions
    given: CompressedFoot
    beam: IdentifiedKeel
    sole: IdentifiedSole

    @property
    def foot(self) -> VariableStiffnessFoot:
        """The foot with the numbers that were identified on its sole."""
        return self.sole.foot

    @property
    def bending(self) -> float:
        """EI by beam theory, the plate on the keel [N m²]."""
        return self.beam.keel.bending

    @property
    def series(self) -> float:
        """Stiffness of all that gives besides the keel [N/m]."""
        return self.beam.series

    @property
    def intervals(self) -> dict[str, tuple[float, float]]:
        """95 % interval of each number by its name, in SI."""
        return {one.name: (one.lower, one.upper) for one in (*self.beam.numbers, *self.sole.numbers)}

    def tables(self) -> dict[str, pd.DataFrame]:
        """`keel`: numbers; `compressions`; `stiffness` over the fulcrum; `curves` where any were given."""
        numbers = (*self.beam.numbers, *self.sole.numbers)
        columns = ("name", "unit", "value", "lower", "upper")
        rows = [[getattr(one, column) for column in columns] for one in numbers]
        keel = pd.DataFrame(rows, columns=["number", *columns[1:]]).replace(np.inf, np.nan)
        found = {"keel": keel, "compressions": self._compressions(), "stiffness": self._stiffness()}
        curves = self._curves()
        return found if curves is None else found | {"curves": curves}

    def _compressions(self) -> pd.DataFrame:
        """Every compression: measured, by beam theory and on the sole."""
        rows = []
        for k, one in enumerate(self.given.measured):
            stiffness, sd = one.slope()
            off = self.beam.residuals[k]
            rows.append(
                {
                    "compression": one.name,
                    "setting": self.given.settings[one.name],
                    "fulcrum [mm]": 1e3 * self.beam.fulcrums[k],
                    "fulcrum sought": one.sought,
                    "measured [N/m]": stiffness,
                    "sd [N/m]": sd,
                    "beam [N/m]": self.beam.stiffness(self.beam.fulcrums[k]),
                    "sole [N/m]": self.sole.stiffnesses[k],
                    "residual rms [mm]": 1e3 * one.sd * float(np.sqrt(np.mean(off**2))) if one.curve else np.nan,
                }
            )
        return pd.DataFrame(rows)

    def _stiffness(self) -> pd.DataFrame:
        """Over the range of the fulcrum."""
        foot, given = self.foot, self.given
        at = np.linspace(*foot.keel.range, PLACES)
        travel = np.array([given.travel])
        forces = [pressed_sole(foot.keel, each, foot.sole, foot.law, travel, tilt=given.tilt)[0] for each in at]
        beam = [self.beam.stiffness(float(each)) for each in at]
        sole = np.array(forces) / given.travel
        return pd.DataFrame({"fulcrum [mm]": 1e3 * at, "beam [N/m]": beam, "sole [N/m]": sole})

    def _curves(self) -> pd.DataFrame | None:
        frames = [
            pd.DataFrame(
                {
                    "compression": one.name,
                    "force [N]": one.force,
                    "deflection [mm]": 1e3 * one.deflection,
                    "beam [mm]": 1e3 * self.beam.deflection(k, one.force),
                }
            )
            for k, one in enumerate(self.given.measured)
            if one.curve
        ]
        return pd.concat(frames, ignore_index=True) if frames else None

    def curves(self) -> dict[str, CurveSheet]:
        """`keel`: stiffness over the fulcrum, and every curve beside beam theory."""
        return {"keel": keel_curves(self.beam, self.given.measured, self._stiffness())}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Curves, numbers, compressions."""
        tables = self.tables()
        facts = [(one.name, _with_interval(one)) for one in (*self.beam.numbers[:2], *self.sole.numbers)]
        name = self.foot.record.name
        return {REPORT: keel_page(name, self.curves()["keel"], tables, self.sentences, facts)}

    def write_files(self, folder: Path) -> None:
        """The identified foot besides, as a description that all commands take."""
        write_foot(folder, self.foot, lines_of(self.given, {one.name: one.slope() for one in self.given.measured}))
        super().write_files(folder)


def run(given: CompressedFoot, o: ProsthesisKeelOptions) -> ProsthesisKeelResult:
    """Beam theory, then the sole; InputError where the compressions cannot identify the keel."""
    foot = given.given.foot
    try:
        beam = identified_keel(foot.keel, given.measured, at=given.at, series=given.series)
    except ValueError as error:
        remedy = "add compressions at another fulcrum, or write [bench] series"
        raise InputError(given.file, "[[compressions]]", str(error), remedy) from error
    try:
        sole = identified_sole(foot, beam, given.measured, tilt=given.tilt, travel=given.travel)
    except ArithmeticError as error:
        raise InputError(given.file, "[sole]", str(error), "check [bench] tilt and travel, and the sole") from error
    sole = replaced_settings(given, beam, sole)
    _say(beam, sole, given)
    if beam.freedom == 0:
        reserve("as many numbers as compressions: nothing is over to test beam theory with")
    if beam.separated.verdict == "one number":
        reserve("EI and the stiffness in series act as one number: compress at fulcrums farther apart")
    judge(fit_of(given, beam, sole))
    numbers = {one.name: [one.value, one.lower, one.upper] for one in (*beam.numbers, *sole.numbers)}
    note("keel", plain(numbers))
    return ProsthesisKeelResult(options=o, given=given, beam=beam, sole=sole)


def replaced_settings(given: CompressedFoot, beam: IdentifiedKeel, sole: IdentifiedSole) -> IdentifiedSole:
    """The foot with the places of settings that were sought, and with where its numbers are from."""
    record = sole.foot.record
    note_of = f"identified from {len(given.measured)} compressions of the sole; {sole.foot.keel.support} end"
    ei, pressed = sole.numbers
    origin = dict(record.origin)
    origin["keel bending"] = Number(ei.value, "derived", f"EI, {note_of}")
    if sole.foot.sole.foam is None:
        origin[f"sole {sole.zone}_stiffness"] = Number(pressed.value, "derived", f"of a sphere, {note_of}")
    else:
        own = foam_numbers(sole.foot.sole, sole.foot.law)[sole.zone]
        origin[f"sole {sole.zone}_modulus"] = Number(pressed.value, "derived", f"of the foam, {note_of}")
        origin[f"sole {sole.zone}_retardation"] = Number(own.retardation, "derived", "damping kept beside the modulus")
    settings = dict(record.settings)
    for one, fulcrum in zip(given.measured, beam.fulcrums, strict=True):
        setting = given.settings[one.name]
        if one.sought and setting:
            settings[setting] = fulcrum
            origin[f"setting {setting}"] = Number(fulcrum, "derived", "identified with the keel")
    return replace(sole, foot=replace(sole.foot, record=replace(record, settings=settings, origin=origin)))


def fit_of(given: CompressedFoot, beam: IdentifiedKeel, sole: IdentifiedSole) -> GoodnessOfFit:
    """Curves beside their noise, stiffnesses beside their deviations, bounds of the search, the sole beside all."""
    doubts: list[Doubt] = []
    tested = []
    for one, off in zip(given.measured, beam.residuals, strict=True):
        if one.curve:
            tested.append(f"compression {one.name}")
            doubts += of_residual(tested[-1], "mm", 1e3 * one.sd * off, 1e3 * one.sd)
    single = {one.name: float(off[0]) for one, off in zip(given.measured, beam.residuals, strict=True) if not one.curve}
    if single and beam.freedom > 0:
        tested.append("stiffnesses")
        if len(single) > 1:
            doubts += of_residual("stiffnesses", "standard deviations", np.array([*single.values()]), 1.0)
        off_by = {
            f"the stiffness of {one.name}": (PER_MM * (beam.stiffness(at) - one.slope()[0]), PER_MM * one.sd)
            for one, at in zip(given.measured, beam.fulcrums, strict=True)
            if one.name in single
        }
        doubts += of_each("beam theory", off_by, "N/mm")
    stated = given.given.foot.keel.bending
    if given.given.known and not 1.0 / STATED_OFF < beam.keel.bending / stated < STATED_OFF:
        what = f"EI of the file, {stated:.3g} N m², is not that of its compressions, {beam.keel.bending:.3g} N m²"
        doubts.append(Doubt(f"{what}: check bending, or modulus, width and thickness", False))
    if given.given.described.keel.thickness is not None:
        tested.append("modulus of the keel")
        kind = next(each for densest, each in MODULI if given.given.foot.keel.density < densest)
        keel = given.given.foot.keel
        moduli = [12.0 * ei / (keel.width * keel.thickness**3) for ei in (beam.numbers[0].lower, beam.numbers[0].upper)]
        for doubt in of_size("EI of the keel over its width and thickness³/12", (moduli[0], moduli[1]), kind):
            doubts.append(replace(doubt, what=f"{doubt.what}; are forces in N, deflections and section in mm?"))
    low, high = given.given.foot.keel.range
    ends = {one.name: (one.value, low, high) for one in beam.numbers if one.unit == "m"}
    if given.series is None:
        logs = np.log([beam.series, *SERIES])
        ends["in series"] = (float(logs[0]), float(logs[1]), float(logs[2]))
    doubts += of_bounds(ends, ["in series"] if beam.series > np.sqrt(SERIES[0] * SERIES[1]) else [])
    tested.append("sole")
    off_by = {
        f"the stiffness of {one.name}": (PER_MM * (found - one.slope()[0]), PER_MM * sd)
        for one, found, sd in zip(given.measured, sole.stiffnesses, sole.deviations, strict=True)
    }
    doubts += of_each("the sole", off_by, "N/mm")
    return GoodnessOfFit(tuple(doubts), tuple(tested))


def _say(beam: IdentifiedKeel, sole: IdentifiedSole, given: CompressedFoot) -> None:
    """What was identified, in sentences."""
    ei, *others = beam.numbers
    line = f"EI {_with_interval(ei)} with the plate on the keel"
    if given.series is None:
        line += f", {_with_interval(others[0], '')} in series"
    say(line)
    bent, pressed = sole.numbers
    stiffness = np.array([one.slope()[0] for one in given.measured])
    worst = float(np.abs(np.array(sole.stiffnesses) / stiffness - 1.0).max())
    say(
        f"EI {_with_interval(bent)} and {_pressed(sole, pressed)} with the plate on the sole: compressions are met to "
        f"{worst:.1%}"
    )
    for one in others:
        if one.unit == "m":
            say(f"{one.name} at {_with_interval(one)}")


def _pressed(sole: IdentifiedSole, number: IdentifiedNumber) -> str:
    """What was identified of the foremost zone, in words."""
    unit, factor, digits = SHOWN[number.unit]
    of = "a sphere of" if sole.foot.sole.foam is None else "in the foam of"
    return f"{rounded(factor * number.value, digits)} {unit} {of} {sole.zone}"


SHOWN = {"N m^2": ("N m²", 1.0, 3), "N/m": ("N/mm", 1e-3, 3), "m": ("mm", 1e3, 4), "Pa": ("MPa", 1e-6, 3)}
"""Unit, factor and digits in which numbers are said."""


def _with_interval(one: IdentifiedNumber, level: str = "95 % ") -> str:
    unit, factor, digits = SHOWN[one.unit]
    low, high = (rounded(factor * end, digits) if np.isfinite(end) else "rigid" for end in (one.lower, one.upper))
    return f"{rounded(factor * one.value, digits)} {unit} ({level}{low} … {high})"


keel = Job("prosthesis keel", ProsthesisKeelOptions, read, run)
