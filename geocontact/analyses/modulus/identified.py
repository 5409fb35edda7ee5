"""What is identified: modulus of each side, forces of a trial that was not used, tables and modulus.json."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.json_file import finite, plain
from geocontact.analyses.modulus.inputs import BOTH, HALVES, ModulusInputs, OtherTrial
from geocontact.data.errors import InputError
from geocontact.elastic_modulus.area_force import ADDUCTION, LAG, MODULUS, SLOPE, THRESHOLD, WORK, ThresholdAreas
from geocontact.elastic_modulus.identify import Identification, agreement, moduli_of_poses
from geocontact.elastic_modulus.prediction import Prediction, predicted_force
from geocontact.elastic_modulus.sensitivity import SensitivityRow, confounded
from geocontact.elastic_modulus.surface_energy import SurfaceEnergy, surface_energy
from geocontact.elastic_modulus.threshold_calibration import Calibration
from geocontact.identify.identifiability import Identifiability
from geocontact.io.recordings.area_table import FEWEST, AreaTable
from geocontact.io.recordings.pose_draws import PoseDraws


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
    table, values = other.table, each.fit.values  # noqa: PD011
    level = _level(table, each)
    predicted = predicted_force(_evolution(table, side, each), each, level)
    if other.forces is None or side not in other.forces.forces:
        return Prediction(side, table.time, predicted, None)
    clock, at = other.forces.time, table.time + values.get(LAG, given_lag)
    measured = np.interp(at, clock, other.forces.forces[side], left=np.nan, right=np.nan)
    if np.isfinite(measured).sum() < FEWEST:
        what = f"fewer than {FEWEST} frames of {table.file} lie in its time ({clock[0]:g} to {clock[-1]:g} s)"
        raise InputError(other.forces.file, "", what, "are the clocks the same? see `lag`")
    return Prediction(side, table.time, predicted, measured)


def _level(table: AreaTable, each: Identification) -> float:
    """The threshold used, exactly as the table has it where it does."""
    known, threshold = table.thresholds, each.fit.values.get(THRESHOLD, each.model.threshold)  # noqa: PD011
    near = np.flatnonzero(np.isclose(known, threshold, rtol=1e-9))
    if not len(near) and not known[0] <= threshold <= known[-1]:
        what = f"has no areas at {threshold * 1e3:g} mm"
        raise InputError(table.file, "", what, "compute them with the `threshold` used here")
    return float(known[near[0]]) if len(near) else threshold


def _evolution(table: AreaTable, side: str, each: Identification) -> ThresholdAreas:
    """Areas of one side at the offset that was identified."""
    radius = np.full(len(table.time), float(each.model.evolution.radius[0]))
    tilts = table.tilted.get(side)
    turned = {name: value for name, value in each.fit.values.items() if name == ADDUCTION}  # noqa: PD011
    if turned and (tilts is None or not tilts.offsets[0] <= turned[ADDUCTION] <= tilts.offsets[-1]):
        what = f"has no areas around the adduction offset of {np.degrees(turned[ADDUCTION]):.2f} degrees"
        raise InputError(table.file, "", what, "compute them with `adduction` as for the trial used")
    evolution = ThresholdAreas(
        table.time, table.thresholds, table.areas[side], radius, each.model.evolution.length, tilts
    )
    return evolution.with_offsets(turned)


ONE_NUMBER = "E and nu are one number here: area and force identify E* = E/(1 - nu^2) only, and E for a stated nu"
RADIUS = "E* and a constant R are one number as well, E*/R: the radius is an input, not a result"
RADII = "of R the forces identify only how it changes with flexion (slope): its size at 0 degrees is one number with E*"


@dataclass(frozen=True, eq=False)
class PoseModuli:
    """E* of the total [Pa] with the area of each drawn pose; those without contact are left out.

    The interval of both adds that of the forces, as far as each end is from E*, in squares: the two are independent.
    """

    modulus: float
    forces: tuple[float, float]
    drawn: Float[np.ndarray, " n"]

    @classmethod
    def of(cls, each: Identification, draws: PoseDraws) -> PoseModuli:
        """Those of one side."""
        drawn = moduli_of_poses(each, draws.area)
        star = each.profiles[MODULUS]
        return cls(each.modulus, (star.lower, star.upper), drawn[np.isfinite(drawn)])

    @property
    def interval(self) -> tuple[float, float]:
        """95 % of the draws [Pa]."""
        from geocontact.geometry.contact_area.pose_error import ENDS  # late: with its kernels

        low, high = np.quantile(self.drawn, ENDS)
        return float(low), float(high)

    @property
    def both(self) -> tuple[float, float]:
        """95 % with the error of the poses and of the forces [Pa]."""
        low, high = (
            math.hypot(self.modulus - drawn, self.modulus - given)
            for drawn, given in zip(self.interval, self.forces, strict=True)
        )
        return max(self.modulus - low, 0.0), self.modulus + high


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
        Ratios that E is given for.
    poses
        E* of the total with drawn poses; None without draws.
    """

    sides: dict[str, Identification]
    sensitivity: list[SensitivityRow]
    calibration: Calibration | None
    predictions: list[Prediction]
    poisson: tuple[float, ...]
    poses: PoseModuli | None = None

    @property
    def first(self) -> Identification:
        """The side of the headline."""
        return next(iter(self.sides.values()))

    @property
    def surfaces(self) -> dict[str, SurfaceEnergy]:
        """Work of adhesion by side, where it was free."""
        found = {side: surface_energy(each) for side, each in self.sides.items()}
        return {side: each for side, each in found.items() if each is not None}

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
        """What the data cannot identify; (E*, R) depends on the reading, the free numbers on the data."""
        each = self.first
        lines = [f"E* and {name} are one number here: {name} is not identifiable" for name in confounded(each)]
        lines += [
            f"{side}: the work of adhesion {energy.why}"
            for side, energy in self.surfaces.items()
            if not energy.separable
        ]
        if each.told_apart["E*, R"].verdict != "one number":
            return [ONE_NUMBER, *lines]
        return [ONE_NUMBER, RADIUS, *([RADII] if SLOPE in each.fit.names else []), *lines]


def modulus_table(found: Identified) -> pd.DataFrame:
    """E* of each side with its 95 % interval by profile likelihood, E for each stated Poisson's ratio, and the fit."""
    rows: list[dict[str, object]] = []
    for side, each in found.sides.items():
        profile = each.profiles[MODULUS]
        rmse, r2 = agreement(each.measured, each.predicted)
        rows.append(
            {
                "side": side,
                "E_star [Pa]": each.modulus,
                "E_star_lower [Pa]": profile.lower,
                "E_star_upper [Pa]": profile.upper,
                **{f"E at nu {nu:g} [Pa]": each.modulus * (1.0 - nu**2) for nu in found.poisson},
                "rmse [N]": rmse,
                "r2 [-]": r2,
            }
        )
    return pd.DataFrame(rows)


def curve_table(found: Identified) -> pd.DataFrame:
    """Measured and predicted force at each frame that was used, sides one after another."""
    parts = []
    for side, pair in found.curves().items():
        columns = {"measured [N]": pair.measured, "predicted [N]": pair.predicted}
        parts.append(pd.DataFrame({"time [s]": pair.time, "side": side, **columns}))
    return pd.concat(parts, ignore_index=True)


def prediction_table(found: Identified) -> pd.DataFrame:
    """The trial that was not used; empty where its force is not known."""
    parts = []
    for p in found.predictions:
        columns = {"predicted [N]": p.predicted, "measured [N]": np.nan if p.measured is None else p.measured}
        parts.append(pd.DataFrame({"time [s]": p.time, "side": p.side, **columns}))
    return pd.concat(parts, ignore_index=True)


def sensitivity_table(found: Identified) -> pd.DataFrame:
    """E* by side, reading and threshold; empty where the reading sees no contact."""
    rows = [
        {
            "side": row.side,
            "reading": row.reading,
            "threshold [mm]": row.threshold * 1e3,
            "E_star [Pa]": row.modulus if math.isfinite(row.modulus) else np.nan,
            "rmse [N]": row.rmse,
            "r2 [-]": row.r2,
        }
        for row in found.sensitivity
    ]
    return pd.DataFrame(rows)


PER_SI = {MODULUS: 1.0, THRESHOLD: 1e3, LAG: 1.0, ADDUCTION: math.degrees(1.0), SLOPE: 1.0, WORK: 1.0}
UNITS = {MODULUS: "Pa", THRESHOLD: "mm", LAG: "s", ADDUCTION: "deg", SLOPE: "1/rad", WORK: "J/m^2"}


def describe(found: Identified) -> dict[str, Any]:
    """The first side's numbers at the top, every side's under `compartments`."""
    sides = {side: _numbers(side, each, found) for side, each in found.sides.items()}
    first, head = next(iter(sides)), found.first
    surface = found.surfaces.get(first)
    unseen = {MODULUS, *confounded(head), *([] if surface is None or surface.separable else [WORK])}
    content: dict[str, Any] = {
        "side": first,
        **sides[first],
        "identifiable": ["E*", *(n for n in head.fit.names if n not in unseen)],
        "not_identifiable": found.not_identifiable(),
        "compartments": {side: numbers for side, numbers in sides.items() if side not in ("total", BOTH)},
        "threshold_sensitivity": [
            {key: plain(value) for key, value in row.items()}
            for row in sensitivity_table(found).to_dict(orient="records")
        ],
    }
    if found.poses is not None:
        p = found.poses
        content["pose_error"] = {
            "side": "total",
            "draws": len(p.drawn),
            "E_star_sd_Pa": float(p.drawn.std(ddof=1)),
            "E_star_ci95_Pa": list(p.interval),
            "E_star_ci95_with_forces_Pa": list(p.both),
        }
    if found.calibration is not None:
        c = found.calibration
        content["calibration"] = {
            "threshold_mm": c.threshold * 1e3,
            "rms_relative": c.rms,
            "frames": c.frames,
            "on_end": c.on_end,
        }
    if found.predictions:
        content["prediction"] = {p.side: {"rmse_N": finite(p.rmse), "r2": finite(p.r2)} for p in found.predictions}
    return content


def _numbers(side: str, each: Identification, found: Identified) -> dict[str, Any]:
    model, star, values = each.model, each.profiles[MODULUS], dict(each.fit.values)
    rmse, r2 = agreement(each.measured, each.predicted)
    radius, count, sticks = model.evolution.radius, found.frames_once(side), model.sticking(values)
    return {
        "E_star_Pa": each.modulus,
        "E_star_ci95_Pa": [star.lower, star.upper],
        "E_Pa": {f"{nu:g}": each.modulus * (1.0 - nu**2) for nu in found.poisson},
        "E_ci95_Pa": {f"{nu:g}": [end * (1.0 - nu**2) for end in (star.lower, star.upper)] for nu in found.poisson},
        "reading": model.reading.name,
        "reading_words": model.reading.words,
        **({} if sticks is None else {"adhesion": sticks.law, "work_of_adhesion_J_per_m2": sticks.work}),
        **({"surface_energy": _surface(found.surfaces[side])} if side in found.surfaces else {}),
        "threshold_mm": values.get(THRESHOLD, model.threshold) * 1e3,
        "radius_mm": [float(radius.min()) * 1e3, float(radius.max()) * 1e3],
        "lag_s": values.get(LAG, model.taken),
        **({"adduction_deg": math.degrees(values[ADDUCTION])} if ADDUCTION in values else {}),
        **({"slope_per_rad": values[SLOPE]} if SLOPE in values else {}),
        "rmse_N": rmse,
        "r2": finite(r2),
        "frames": count,
        "window_s": [float(model.frames[0]), float(model.frames[count - 1])],
        "intervals": _intervals(each),
        "residual_correlation_time_s": each.memory.typical,
        "bootstrap": _bootstrap(each),
        "starts": {"count": len(each.fit.costs), "costs": list(each.fit.costs)},
        "searches": [
            {"iterations": len(one.calls) - 1, "calls": list(one.calls), "costs": list(one.costs), "end": one.message}
            for one in each.fit.record
        ],
        "identifiability": {name: _group(group) for name, group in each.told_apart.items()},
    }


def _surface(energy: SurfaceEnergy) -> dict[str, Any]:
    """Work of adhesion and pull-off force with their intervals, and what acts alike."""
    return {
        "verdict": "separable" if energy.separable else "not separable",
        "work_J_per_m2": energy.work,
        "work_ci95_J_per_m2": [energy.lower, energy.upper],
        "pull_off_N": energy.pull_off,
        "pull_off_ci95_N": [energy.strongest, energy.weakest],
        "radius_mm": energy.radius * 1e3,
        "cosine_with_an_error_of_zero": finite(energy.as_zero),
        "mean_pull_N": energy.zero,
    }


def _intervals(each: Identification) -> dict[str, Any]:
    """Intervals of every free number, by profile likelihood and by block bootstrap."""
    drawn, found = each.replicates, {}
    for k, (name, p) in enumerate(each.profiles.items()):
        ends = None if drawn is None else [float(end[k]) * PER_SI[name] for end in (drawn.lower, drawn.upper)]
        found[name] = {
            "unit": UNITS[name],
            "value": p.best * PER_SI[name],
            "profile_likelihood": [p.lower * PER_SI[name], p.upper * PER_SI[name]],
            "open": [p.lower_open, p.upper_open],
            "block_bootstrap": ends,
        }
    return found


def _bootstrap(each: Identification) -> dict[str, Any] | None:
    drawn = each.replicates
    if drawn is None:
        return None
    return {"replicates": len(drawn.estimates), "block_s": drawn.block, "blocks": drawn.blocks}


def _group(group: Identifiability) -> dict[str, Any]:
    return {
        "numbers": list(group.names),
        "singular_values": group.singular_values.tolist(),
        "condition": finite(group.condition),
        "correlation": group.correlation.tolist(),
        "verdict": group.verdict,
    }
