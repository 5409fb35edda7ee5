"""What was measured beside the force of an elbow: what it adds, whether it agrees, table, curves, sentences."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from geocontact.analyses.misalignment.law_numbers import PER_SI, WRITTEN
from geocontact.axis_misalignment.beside_force import BesideForce
from geocontact.axis_misalignment.bins import BETA, MOMENT, Binned
from geocontact.axis_misalignment.known_by_sensor import KnownBy, cost_with_moment_turned, known_by, over_noise
from geocontact.axis_misalignment.least_squares import ElbowFit, r_squared
from geocontact.data.motion import Course
from geocontact.identify.goodness_of_fit import FAR, Doubt, of_r2
from geocontact.view.curves.declared import INK, Curve, Curves, CurveSheet, Points, stroke

TWICE = 2.0  # times the noise, from which a residual beside the force is doubtful
HALF = 0.5  # of the sum of squares: a moment with its sign turned that leaves less is named
CAUSES = {
    "moment of the cuff": "is it about the link's end, and is its zero right?",
    "angle of the arm": "does it turn about another axis, or is its sensor on soft tissue?",
}


@dataclass(frozen=True, eq=False)
class SensorFit:
    """How the fitted law agrees with one sensor.

    Parameters
    ----------
    measured
        Means of its cells, weights, model.
    r2
        Of the moment, or of the angle less that of the exoskeleton.
    rmse
        [N m] or [rad].
    times
        Root mean square of the residual over its noise.
    noise
        Standard deviation of a sample [N m] or [rad].
    nuisance, error
        κ [N m/rad] with its standard error where it is identified, or the zeros of the angle [rad].
    """

    measured: BesideForce
    r2: float
    rmse: float
    times: float
    noise: float
    nuisance: np.ndarray
    error: np.ndarray


@dataclass(frozen=True, eq=False)
class Beside:
    """Sensors beside the force, and what each set of sensors identifies; both empty with the force alone.

    `turned_better` says that the moment with its sign turned leaves less than half of the sum of squares.
    """

    sensors: tuple[SensorFit, ...]
    known: Sequence[KnownBy]
    turned_better: bool


def beside_of(data: Binned, e: ElbowFit) -> Beside:
    """All of it for a fit."""
    turned = cost_with_moment_turned(e)
    return Beside(
        tuple(_sensor(data, e, each) for each in e.problem.beside),
        known_by(e),
        turned is not None and turned < HALF * e.cost,
    )


def _sensor(data: Binned, e: ElbowFit, one: BesideForce) -> SensorFit:
    fitted, nuisance = one.fitted(e.theta), one.nuisance(e.theta)
    base = 0.0 if one.channel == MOMENT else one.cells[:, BETA]
    return SensorFit(
        measured=one,
        r2=r_squared(one.means - base, fitted - base),
        rmse=float(np.sqrt(np.mean((one.means - fitted) ** 2))),
        times=over_noise(one.residual(e.theta), len(nuisance)),
        noise=float(data.beside[one.channel].sd[0]),
        nuisance=nuisance,
        error=one.nuisance_error(e.theta),
    )


def doubts_of(found: Beside) -> Iterator[Doubt]:
    """The law against what was measured beside the force."""
    for each in found.sensors:
        name = each.measured.name
        yield from of_r2(f"the measured {name}", each.r2)
        if each.times > TWICE:
            what = f"the measured {name} is off by {each.times:.2g} times its noise: {CAUSES[name]}"
            yield Doubt(what, each.times > FAR, each.times)
    if found.turned_better:
        yield Doubt("the moment of the cuff fits better with its sign turned: see `map` moment=-…", True)


def known_table(found: Beside) -> pd.DataFrame:
    """One row for each set of sensors and number."""
    rows = [
        {
            "measured": " + ".join(each.sensors),
            "number": name,
            "unit": _unit(name),
            "value": value * _per(name),
            "standard error": error * _per(name),
            "of the value [-]": error / abs(value) if value else np.nan,
            "identified": "no" if np.isnan(error) else "yes",
        }
        for each in found.known
        for name, value, error in zip(each.names, map(float, each.values), map(float, each.errors), strict=True)
    ]
    return pd.DataFrame(rows)


def _unit(name: str) -> str:
    if name in WRITTEN:
        return WRITTEN[name]
    return {"k l": "N", "b l": "N s", "c/l": "1/N"}.get(name, "")


def _per(name: str) -> float:
    return PER_SI.get(name, 1.0)


def sentences_of(found: Beside) -> list[str]:
    """What each set of sensors identifies, then what else the sensors say."""
    return [*_known_sentences(found.known), *(_sensor_sentence(each) for each in found.sensors)]


def _known_sentences(known: Sequence[KnownBy]) -> Iterator[str]:
    for each in known:
        told = dict(zip(each.names, map(float, each.errors), strict=True))
        open_to = [name for name, error in told.items() if np.isnan(error)]
        shown = [name for name in told if name not in open_to and (open_to or name in WRITTEN)]
        errors = [
            f"{name} ± {' '.join(filter(None, (f'{told[name] * _per(name):.2g}', _unit(name))))}" for name in shown
        ]
        line = f"{' + '.join(each.sensors)}: {', '.join(errors)} (SE by noise)"
        yield f"{line}; {', '.join(open_to)} up to one factor only" if open_to else line


def _sensor_sentence(one: SensorFit) -> str:
    agrees = f"{one.times:.2g} times its noise"
    if one.measured.channel != MOMENT:
        zeros = ", ".join(f"{np.degrees(zero):+.2g}" for zero in one.nuisance)
        level = f"; its zero is off by {zeros}°" if len(one.nuisance) else ""
        return f"angle of the arm: RMSE {np.degrees(one.rmse):.2g}°, {agrees}{level}"
    turning = f"; cuff against turning {one.nuisance[0]:.2g} ± {one.error[0]:.1g} N m/rad" if len(one.nuisance) else ""
    return f"moment of the cuff: RMSE {one.rmse:.2g} N m, {agrees}{turning}"


def described_beside(found: Beside) -> dict[str, Any]:
    """For elbow.json: each sensor, and standard errors by set of sensors; None where a number is not identified."""
    return {
        "sensors": [_described(each) for each in found.sensors],
        "identified_by": [
            {
                "measured": list(each.sensors),
                "least_over_largest_singular_value": each.ratio,
                "standard_errors": {
                    name: None if np.isnan(error) else float(error) * _per(name)
                    for name, error in zip(each.names, each.errors, strict=True)
                },
            }
            for each in found.known
        ],
        "moment_fits_better_turned": found.turned_better,
    }


def _described(one: SensorFit) -> dict[str, Any]:
    if one.measured.channel != MOMENT:
        return {
            "name": one.measured.name,
            "r2": one.r2,
            "rmse_deg": float(np.degrees(one.rmse)),
            "over_noise": one.times,
            "noise_sd_deg": float(np.degrees(one.noise)),
            "zeros_deg": np.degrees(one.nuisance).tolist(),
        }
    turning = {"value": float(one.nuisance[0]), "se": float(one.error[0])} if len(one.nuisance) else None
    return {
        "name": one.measured.name,
        "r2": one.r2,
        "rmse_N_m": one.rmse,
        "over_noise": one.times,
        "noise_sd_N_m": one.noise,
        "turning_N_m_per_rad": turning,
    }


def beside_curves(found: Beside, e: ElbowFit) -> CurveSheet:
    """Bin means of each sensor and the fitted law over the angle."""
    return CurveSheet([_panel(each, e) for each in found.sensors])


def _panel(one: SensorFit, e: ElbowFit) -> Curves:
    cells, fitted, values = one.measured.cells, one.measured.fitted(e.theta), one.measured.means
    order = np.argsort(cells[:, BETA], kind="stable")
    beta, middle = cells[order, BETA], np.degrees(cells[order, BETA])
    over = Course("exoskeleton angle β", "°", middle)
    if one.measured.channel == MOMENT:
        dots = Points("bin means of the trials", middle, values[order])
        line = [Curve("explicit model at the measured force", fitted[order], stroke=stroke(0))]
        return Curves("Moment of the cuff over the angle", "N m", line, over=over, points=[dots])
    dots = Points("bin means of the trials", middle, np.degrees(values[order] - beta))
    line = [Curve("explicit model", np.degrees(fitted[order] - beta), stroke=INK)]
    return Curves("Angle of the arm less that of the exoskeleton", "°", line, over=over, points=[dots])
