"""The sole's numbers from recorded stances: `geocontact prosthesis calibrate`, `gc.prosthesis.calibrate`.

>>> import geocontact as gc
>>> trial = "meshes/gait_P1_medium_1/"
>>> given = {"static": trial + "standing.trc", "mass": 77.3, "plates": trial + "plates.mot", "plate": "own_force"}
>>> result = gc.prosthesis.calibrate(trial + "walking.trc", starts=0, **given)
>>> print(result.sentences[0])
vertical force within … % of body weight (R² …), centre of pressure within … % of the foot (R² …); …
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from os import fspath
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float
from numpy import ndarray

from geocontact.analyses.frame.collector import contradicted, judge, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.main_numbers import by_name
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.prosthesis.calibrate.foot_on_plate import (
    FootOnPlate,
    StanceFiles,
    along_poses,
    on_whole_model,
    read,
)
from geocontact.analyses.prosthesis.calibrate.options import ProsthesisCalibrateOptions
from geocontact.analyses.prosthesis.calibrate.show import CalibratedFit, calibration_page, stance_curves
from geocontact.below_knee_prosthesis.calibration.calibrate import SoleCalibration
from geocontact.below_knee_prosthesis.calibration.fit import (
    FittedStance,
    fore_aft_error,
    goodness_of,
    known_of,
    residual_over_noise,
    stance_fit,
)
from geocontact.below_knee_prosthesis.calibration.known_numbers import Verdict
from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance
from geocontact.below_knee_prosthesis.calibration.whole_calibration import WholeCalibration
from geocontact.below_knee_prosthesis.calibration.zone_parameters import PRIOR
from geocontact.below_knee_prosthesis.keel.foam import foam_numbers
from geocontact.below_knee_prosthesis.leg import FootOffset
from geocontact.identify.identifiability import Identifiability
from geocontact.identify.signals.agreement import Agreement

if TYPE_CHECKING:
    from geocontact.view.curves.declared import CurveSheet
    from geocontact.view.page.content import Page

HEAD = """\
# Force law of the sole, calibrated on recorded stances; SI units. Numbers marked unknown were never loaded; those
# marked not identified are determined by the prior, not by the stances.
"""
FOOT = """
[foot]  # offset from its standing trial, identified with the law; `sd` are standard deviations
height = {height!r}  # m, its middle raised
height_sd = {height_sd!r}  # m
pitch = {pitch!r}  # rad, the toes up
pitch_sd = {pitch_sd!r}  # rad
standing = "{standing}"  # SHA-256 of that trial: [foot] holds for no other"""


def law_toml(found: SoleCalibration | WholeCalibration, standing: str) -> str:
    """Text of the file.

    Parameters
    ----------
    standing
        SHA-256 of the standing trial.
    """
    law = found.law
    lines = [HEAD, f"n = {law.exponent!r}", f"delta_full = {law.full_depth!r}", f"v_th = {law.threshold_speed!r}"]
    verdicts = {each.name: each.verdict for each in found.knowledge.numbers}
    count = len(law.stiffness)
    sole = found.residuals.zones.sole
    foam = {} if sole.foam is None else foam_numbers(sole, law)
    if foam:
        lines.append(f"columns = {count}  # of foam; k and b are of one of them, and hold for no other cut")
    for zone, chosen in sole.spheres.zones.items():
        k = int(np.flatnonzero(chosen)[0])
        static, kinetic = (float(np.broadcast_to(each, count)[k]) for each in (law.static, law.kinetic))
        lines += ["", f"[zone.{zone}]"]
        modulus = f"; E {1e-6 * foam[zone].modulus:.4g} MPa" if foam else ""
        lines.append(f"k = {float(law.stiffness[k])!r}  # {verdicts[f'stiffness.{zone}']}{modulus}")
        lines.append(f"b = {float(law.damping[k])!r}  # {verdicts[f'damping.{zone}']}")
        lines.append(f"mu_s = {static!r}  # its ratio to mu_k is kept")
        lines.append(f"mu_k = {kinetic!r}  # {verdicts[f'friction.{zone}']}")
    lines += [_foot(each, standing) for each in found.offsets[:1]]
    return "\n".join(lines) + "\n"


def _foot(offset: FootOffset, standing: str) -> str:
    names = ("height", "height_sd", "pitch", "pitch_sd")
    return FOOT.format(standing=standing, **{name: float(getattr(offset, name)) for name in names})


LAW = "law.toml"


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ProsthesisCalibrateResult(Result):
    """Numbers of the zones, and the stance with them.

    Parameters
    ----------
    calibration
        What was found along the recorded poses.
    whole
        What was found from there on the whole model, where that was asked for.
    fitted
        Each stance as it was recorded, and with the numbers found last, by the model that found them; the one that the
        options name first.
    settings
        Setting of the foot in each of them.
    """

    options: ProsthesisCalibrateOptions
    calibration: SoleCalibration
    whole: WholeCalibration | None
    fitted: tuple[FittedStance, ...]
    settings: tuple[str, ...]

    @property
    def stance(self) -> RecordedStance:
        """The first stance as it was recorded."""
        return self.fitted[0].stance

    @property
    def predicted(self) -> Float[ndarray, "t 4"]:
        """Force in the ground's frame [N] and centre of pressure from the heel (share of the foot) in that stance."""
        return self.fitted[0].fit.predicted

    @property
    def slip(self) -> Float[ndarray, "t 2"]:
        """Slip along the floor in that stance, beside the recorded speed [m/s]."""
        return self.fitted[0].fit.slip

    @property
    def vertical(self) -> Agreement:
        """Agreement of the vertical force of that stance over body weight with the plate's."""
        return self.fitted[0].fit.vertical

    @property
    def centre(self) -> Agreement:
        """Agreement of the centre of pressure of that stance with the plate's."""
        return self.fitted[0].fit.centre

    @property
    def residual(self) -> float:
        """Residual of the data at the last numbers, over their noise, root mean square."""
        return residual_over_noise(self.last)

    @property
    def last(self) -> SoleCalibration | WholeCalibration:
        """The last calibration."""
        return self.calibration if self.whole is None else self.whole

    @property
    def time(self) -> Float[np.ndarray, " t"]:
        """Time of the frames of the stance [s]."""
        return self.stance.time

    @property
    def force(self) -> Float[np.ndarray, "t 3"]:
        """Force of the ground on the foot over time by the calibrated model [N]."""
        return self.predicted[:, :3]

    @property
    def plate_force(self) -> Float[np.ndarray, "t 3"]:
        """The same on the plate [N]."""
        return self.stance.force

    @property
    def parameters(self) -> dict[str, float]:
        """Value of each number that was calibrated, by its name [N/m^n, N s/m, m, rad, -]."""
        return by_name(self.table("numbers"), ("number",), "value")

    def tables(self) -> dict[str, pd.DataFrame]:
        """`numbers`, `stance`, and `stances` where there are several."""
        rows = [
            {
                "number": each.name,
                "unit": each.unit,
                "value": each.value,
                "lower": each.lower,
                "upper": each.upper,
                "verdict": each.verdict,
                "prior lower": each.prior[0],
                "prior upper": each.prior[1],
            }
            for each in known_of(self.last)
        ]
        if self.whole is not None:
            for row, before in zip(rows, known_of(self.calibration), strict=True):
                row |= {"along poses": before.value, "along poses verdict": before.verdict}
        found = {"numbers": pd.DataFrame(rows), "stance": pd.concat(map(_curves, self.fitted), ignore_index=True)}
        return found if len(self.fitted) == 1 else found | {"stances": self._stances()}

    def _stances(self) -> pd.DataFrame:
        """How near each stance comes to its plate, and the foot beside its standing trial in it."""
        rows = []
        for place, (one, setting) in enumerate(zip(self.fitted, self.settings, strict=True)):
            offset = self.last.offsets[self.last.residuals.standing[place]]
            rows.append(
                {
                    "stance": one.name,
                    "setting": setting,
                    "fulcrum [mm]": 1e3 * one.stance.fulcrum,
                    "vertical rmse [-]": one.fit.vertical.rmsd,
                    "vertical r2 [-]": one.fit.vertical.r2,
                    "centre rmse [-]": one.fit.centre.rmsd,
                    "centre r2 [-]": one.fit.centre.r2,
                    "foot height [mm]": 1e3 * offset.height,
                    "foot pitch [deg]": float(np.degrees(offset.pitch)),
                }
            )
        return pd.DataFrame(rows)

    def curves(self) -> dict[str, CurveSheet]:
        """`stance`: measured and modelled force and centre of pressure."""
        return {"stance": stance_curves(self.stance, self.predicted)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Curves, numbers, and what they mean."""
        numbers, walked = self.tables()["numbers"], self.whole is not None
        law = self.last.law
        fit = CalibratedFit(
            self.vertical,
            self.centre,
            _along(self, NO_TEST),
            self.last.offsets[0].words,
            float(np.ravel(law.exponent)[0]),
        )
        several = self._stances() if len(self.fitted) > 1 else None
        return {REPORT: calibration_page(self.stance, self.curves()["stance"], numbers, fit, walked, several)}

    def write_files(self, folder: Path) -> None:
        """law.toml besides, unless the stance contradicts it."""
        if self.fits:
            self._write_law(folder)
        super().write_files(folder)

    def _write_law(self, folder: Path) -> None:
        named = fspath(self.options.static)
        standing = next(str(each["sha256"]) for each in self.record.inputs if each["file"] == named)
        (folder / LAW).write_text(law_toml(self.last, standing), encoding="utf-8", newline="\n")


def _curves(one: FittedStance) -> pd.DataFrame:
    """Force and centre of one stance over time, by model and plate; with its name where it has one."""
    s, predicted = one.stance, one.fit.predicted
    columns: dict[str, object] = {"stance": one.name} if one.name else {}
    columns["time [s]"] = s.time
    for k, axis in enumerate("xyz"):
        columns |= {f"force_{axis} [N]": predicted[:, k], f"plate_force_{axis} [N]": s.force[:, k]}
    columns |= {"centre in the foot [-]": predicted[:, 3], "plate centre in the foot [-]": s.centre}
    return pd.DataFrame(columns)


def run(given: FootOnPlate, o: ProsthesisCalibrateOptions) -> ProsthesisCalibrateResult:
    """Numbers of the zones, their intervals, and the stances with them."""
    found = along_poses(given, o)
    whole = on_whole_model(given, found, o)
    fitted = tuple(
        FittedStance(one.asked.name, one.stance, stance_fit(found, whole, place))
        for place, one in enumerate(given.stances)
    )
    settings = tuple(_setting(one.asked) for one in given.stances)
    result = ProsthesisCalibrateResult(options=o, calibration=found, whole=whole, fitted=fitted, settings=settings)
    judge(goodness_of(result.last, fitted))
    if contradicted():
        reserve(f"{LAW} is not written, because no simulation should use a law that its stance contradicts")
    _summarise(result)
    return result


def _setting(asked: StanceFiles) -> str:
    return asked.setting if asked.fulcrum is None else f"{1e3 * asked.fulcrum:g} mm"


def _summarise_fit(r: ProsthesisCalibrateResult) -> None:
    """How the foot stood; nothing where the stance contradicts that as well."""
    if contradicted():
        return
    e = r.stance.errors
    offset = r.last.offsets[0]
    say(
        f"the foot is {offset.words} off its standing trial; prior {1e3 * e.standing:.1f} mm and "
        f"{np.degrees(e.pitch):.2f} degrees"
    )


NO_TEST = ", which makes it no test of the sole"


def _along(r: ProsthesisCalibrateResult, met: str = "") -> str:
    """What is said of the force along the floor; `met` follows where the foot's slips were chosen to meet it."""
    if r.whole is None:
        slip = 1e3 * float(np.sqrt(np.mean(r.slip**2)))
        return f"is met by slips of {slip:.0f} mm/s relative to the recorded speed{met}"
    return f"fore and aft within {100.0 * fore_aft_error(r.predicted, r.stance):.1f} % of body weight"


def _summarise(r: ProsthesisCalibrateResult) -> None:
    """Sentences, reservations and results of a calibration."""
    found = r.last
    verdicts = Counter(number.verdict for number in found.knowledge.numbers)
    unknown = [number.name for number in found.knowledge.numbers if number.verdict == "unknown"]
    if unknown:
        reserve(f"never loaded, so the data do not inform their values: {', '.join(unknown)}")
    if not found.converged:
        reserve("the search stopped before convergence; give more `starts`")
    apart = found.knowledge.told_apart
    if len(r.fitted) > 1:
        say(f"one sole fitted to {len(r.fitted)} stances together; the first of them:")
    say(
        f"vertical force within {100.0 * r.vertical.rmsd:.1f} % of body weight (R² {r.vertical.r2:.3f}), centre of "
        f"pressure within {100.0 * r.centre.rmsd:.1f} % of the foot (R² {r.centre.r2:.2f}); the force along the floor "
        f"{_along(r)}"
    )
    for one, setting in zip(r.fitted[1:], r.settings[1:], strict=True):
        say(
            f"{one.name} ({setting}): vertical force within {one.fit.vertical.rmsd:.1%} of body weight, centre of "
            f"pressure within {one.fit.centre.rmsd:.1%} of the foot"
        )
    _summarise_fit(r)
    if r.whole is not None:
        say(
            f"on the whole model the cost falls from {r.whole.begun:.0f}, at the numbers along the recorded poses, to "
            f"{r.whole.cost:.0f}"
        )
    if not contradicted():
        say(_known_words(verdicts, len(found.knowledge.numbers), apart))
    factors = ", ".join(f"{kind} a factor {sd:g}" for kind, (sd, _) in PRIOR.items())
    say(f"prior (invented), as one standard deviation about the usual number: {factors}")
    offset = found.offsets[0]
    note(
        "calibrate",
        {
            "height_m": offset.height,
            "height_sd_m": None if contradicted() else offset.height_sd,
            "pitch_rad": offset.pitch,
            "pitch_sd_rad": None if contradicted() else offset.pitch_sd,
            "residual_over_noise": r.residual,
            **({"stances": [one.name for one in r.fitted]} if len(r.fitted) > 1 else {}),
            "vertical_rmse_of_body_weight": r.vertical.rmsd,
            "vertical_r2": r.vertical.r2,
            "centre_rmse_of_foot": r.centre.rmsd,
            "centre_r2": r.centre.r2,
            "condition": apart.condition,
            "solved": found.residuals.solved,
            "numbers": {number.name: number.value for number in found.knowledge.numbers},
        },
    )


def _known_words(verdicts: Counter[Verdict], count: int, apart: Identifiability) -> str:
    return (
        f"{verdicts['known']} of {count} numbers are known, {verdicts['not identified']} not identified, "
        f"{verdicts['unknown']} unknown; {apart.verdict} (condition {apart.condition:.3g})"
    )


calibrate = Job("prosthesis calibrate", ProsthesisCalibrateOptions, read, run)
