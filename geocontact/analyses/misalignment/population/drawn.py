"""People that are drawn and their largest forces: what is read, found, tables, population.json."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from jaxtyping import Float, Int

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.misalignment.law_numbers import NUMBERS
from geocontact.analyses.misalignment.planar import STATES, WITHOUT_FORCE, axis_drift, rounded
from geocontact.analyses.misalignment.population.options import PopulationOptions
from geocontact.axis_misalignment.axis_drift import AxisDrift
from geocontact.axis_misalignment.design import QUANTITIES, Exposure, peak_forces
from geocontact.axis_misalignment.law import LENGTHS
from geocontact.axis_misalignment.planar_joint import SOUND, STEP
from geocontact.data.errors import InputError
from geocontact.data.plausible import numbers_in
from geocontact.identify.intervals.quantile_intervals import IntervalEstimate, probability, quantile
from geocontact.identify.intervals.sampling import (
    Factor,
    Indices,
    Normal,
    People,
    RankRegression,
    Sampling,
    Uniform,
    rank_regression,
    root,
    variance_shares,
)
from geocontact.io.recordings.population import PopulationFile, read_population

ENDS = {"value", "mean", "upper"}
"""Numbers of a description that say how large a quantity is."""
UNITS = {name: "N/m" if name == "k" else "m" for name in QUANTITIES}


@dataclass(frozen=True, eq=False)
class Population:
    """What differs from person to person, and what is the same for everybody."""

    sampling: Sampling
    drift: AxisDrift


def read(o: PopulationOptions) -> Population:
    """Everything the options name."""
    drift = axis_drift(o.drift, o.range)
    return Population(_sampling(o.description), drift)


def _sampling(description: Path) -> Sampling:
    told = read_population(description, UNITS)
    add_input("description", description)
    _check_sizes(description, told)
    for file in told.tables:
        add_input("table", file)
    drawn = {name: one for name, one in told.quantities.items() if one.kind in ("normal", "uniform")}
    factors: list[Factor] = [_factor(name, one.kind, one.numbers) for name, one in drawn.items()]
    factors += [People(tuple(columns), np.column_stack(list(columns.values()))) for columns in told.tables.values()]
    if not factors:
        raise InputError(description, "", "every quantity is the same for everybody", "let one differ")
    fixed = {name: one.numbers["value"] for name, one in told.quantities.items() if one.kind == "value"}
    return Sampling(factors, _correlation(description, told, factors), fixed)


def _check_sizes(description: Path, told: PopulationFile) -> None:
    """Refuse numbers that a quantity cannot have, and warn of unusual ones; lower ends and deviations may be small."""
    ranges = dict(NUMBERS.ranges)
    stated = [
        (f"[{n}] {key}", n, one.numbers[key], one.numbers[key] / one.factor)
        for n, one in told.quantities.items()
        for key in (ENDS | _wide(one.numbers)) & {*one.numbers}
    ]
    listed = [(f"[{n}] table", n, float(c.max()), None) for columns in told.tables.values() for n, c in columns.items()]
    for place, name, value, written in (*sorted(stated), *listed):
        for _, known, number in numbers_in(ranges[name], value):
            if refusal := known.refusal(number, written):
                raise InputError(description, place, *refusal)
            if doubt := known.doubt(number, written):
                reserve(f"{description} {place}: {doubt}")
    for name, one in told.quantities.items():
        for line in _doubtful_spread(name, one.kind, one.numbers):
            reserve(f"{description} [{name}] {line}")
    for columns in told.tables.values():
        for line in _doubtful_people(columns):
            reserve(f"{description} {line}")


LEAST_SD = 1e-4
"""m; nobody measures lengths of people and devices better."""
CUT = 0.1
"""Share of a normal distribution beyond its bounds, from which it is another one than its mean and deviation say."""
REPEATED, OTHER_UNIT, PEOPLE = 0.5, 20.0, 5
"""Share of a table's rows that are alike, times the median that a positive number is off, and rows, from which it is
said: no two people are alike to the last digit."""


def _doubtful_spread(name: str, kind: str, numbers: Mapping[str, float]) -> Iterator[str]:
    """A deviation that is a variance, or in another unit."""
    if kind != "normal":
        return
    mean, sd = numbers["mean"], numbers["sd"]
    if name in LENGTHS and sd < LEAST_SD and not _wide(numbers):
        yield f"sd: {1e3 * sd:.3g} mm is less than lengths are measured to; is it in m?"
    lower = max(numbers.get("lower", -math.inf), 0.0 if name == "k" else -math.inf)
    inside = _below((numbers.get("upper", math.inf) - mean) / sd) - _below((lower - mean) / sd)
    if 1.0 - inside > CUT:
        what = f"{1.0 - inside:.0%} of the normal distribution lie beyond what {name} can be or its bounds"
        yield f"sd: {what}; is it a standard deviation, and not a variance, and are the bounds in the same unit?"


def _below(z: float) -> float:
    """Share of a normal distribution below z standard deviations."""
    return 0.5 * (1.0 + math.erf(z / math.sqrt(2.0)))


def _doubtful_people(columns: Mapping[str, Float[np.ndarray, " m"]]) -> Iterator[str]:
    """Rows of a table that repeat one person, and a number of another unit than the others."""
    rows = np.column_stack(list(columns.values()))
    if len(rows) < PEOPLE:
        return
    several = len(rows) - len(np.unique(rows, axis=0)) + 1
    if several > REPEATED * len(rows):
        yield f"table: {several} of {len(rows)} people are alike in {', '.join(columns)}; is a row repeated?"
    for name, values in columns.items():
        middle = float(np.median(values))
        if middle > 0.0 and name in ("k", "l"):
            off = np.flatnonzero((values < middle / OTHER_UNIT) | (values > middle * OTHER_UNIT))
            for row in off[:1]:
                what = f"{name} of person {row + 1} is {values[row] / middle:.2g} times the median of all"
                yield f"table: {what}; is it in the column's unit?"


def _wide(numbers: Mapping[str, float]) -> set[str]:
    """The standard deviation where it says more than the mean how large a quantity is, as of offsets about 0."""
    return {"sd"} if numbers.get("sd", 0.0) > abs(numbers.get("mean", 0.0)) else set()


def _factor(name: str, kind: str, numbers: Mapping[str, float]) -> Factor:
    return Normal(name, **numbers) if kind == "normal" else Uniform(name, **numbers)


def _correlation(description: Path, told: PopulationFile, factors: list[Factor]) -> Float[np.ndarray, "f f"]:
    names = [factor.names[0] for factor in factors]
    matrix = np.eye(len(names))
    for (first, second), value in told.correlations.items():
        i, j = names.index(first), names.index(second)
        matrix[i, j] = matrix[j, i] = value
    try:
        root(matrix)
    except ValueError as error:
        raise InputError(description, "[correlation]", str(error), "make them smaller") from error
    return matrix


SHARES = (0.05, 0.25, 0.5, 0.75, 0.9, 0.95, 0.99)
LEVELS = 200
"""Forces at which the exceedance is given."""

REGRESSED = 20_000
"""Samples that the regression on ranks takes, from the first on."""

CHECKED = 2000
"""Samples whose largest force is found once more with a grid `FINER` times as fine."""

FINER = 8


@dataclass(frozen=True, eq=False)
class Drawn:
    """Everything found of one population; N, m, N/m.

    Parameters
    ----------
    people, peak, fate
        The quantities of every one, the largest force, and whether there is a force at all.
    quantiles, beyond
        Of the largest force, by share; and the share above the limit.
    levels, exceedance
        Forces, and the shares above them.
    varying
        Quantities that differ from person to person.
    regression, indices
        Where the spread comes from; no shares of the variance where factors are correlated.
    grid_error
        Largest error of those that were found once more on a finer grid.
    rate
        Samples per second of one core.
    """

    sampling: Sampling
    exposure: Exposure
    limit: float
    people: Float[np.ndarray, "n 5"]
    peak: Float[np.ndarray, " n"]
    fate: Int[np.ndarray, " n"]
    quantiles: dict[float, IntervalEstimate]
    beyond: IntervalEstimate
    levels: Float[np.ndarray, " k"]
    exceedance: list[IntervalEstimate]
    varying: tuple[str, ...]
    regression: RankRegression
    indices: Indices | None
    grid_error: float
    rate: int


def drawn(sampling: Sampling, drift: AxisDrift, o: PopulationOptions) -> Drawn:
    """Draw the people and find the largest force of every one."""
    exposure = Exposure(*o.range, *(o.stroke or (0.0, 0.0)), drift)
    people = sampling.quantities(sampling.shares(o.samples, o.seed), QUANTITIES)
    _refuse_impossible(o.description, people)
    peak_forces(people[:1], exposure)  # compiled or loaded before time is taken
    begun = time.process_time()
    peak, fate = peak_forces(people, exposure)
    rate = round(o.samples / max(time.process_time() - begun, 1e-9))
    ordered = np.sort(peak)
    levels = _levels(ordered, o.limit)
    above = len(ordered) - np.searchsorted(ordered, levels, side="right")
    varying = tuple(name for factor in sampling.factors for name in factor.names)
    columns = people[:REGRESSED][:, [QUANTITIES.index(name) for name in varying]]
    return Drawn(
        sampling=sampling,
        exposure=exposure,
        limit=o.limit,
        people=people,
        peak=peak,
        fate=fate,
        quantiles={share: quantile(ordered, share) for share in SHARES},
        beyond=probability(int((peak > o.limit).sum()), len(peak)),
        levels=levels,
        exceedance=[probability(int(count), len(peak)) for count in above],
        varying=varying,
        regression=rank_regression(columns, peak[:REGRESSED]),
        indices=_indices(sampling, exposure, o.seed),
        grid_error=_grid_error(people[:CHECKED], peak[:CHECKED], fate[:CHECKED], exposure),
        rate=rate,
    )


def _levels(ordered: Float[np.ndarray, " n"], limit: float) -> Float[np.ndarray, " k"]:
    """Forces from 0 to somewhat above the limit, or above nearly all finite ones."""
    finite = ordered[np.isfinite(ordered)]
    most = float(finite[int(0.999 * (len(finite) - 1))]) if len(finite) else 0.0
    return np.linspace(0.0, max(most, 1.2 * limit), LEVELS + 1)


def _indices(sampling: Sampling, exposure: Exposure, seed: int) -> Indices | None:
    """Shares of the variance, where factors are independent."""
    if not sampling.independent:
        return None
    return variance_shares(
        lambda shares: peak_forces(sampling.quantities(shares, QUANTITIES), exposure)[0], len(sampling.factors), seed
    )


def _grid_error(
    people: Float[np.ndarray, "n 5"], peak: Float[np.ndarray, " n"], fate: Int[np.ndarray, " n"], exposure: Exposure
) -> float:
    finer = peak_forces(people, exposure, STEP / FINER)[0]
    sound = fate == SOUND
    return float(np.abs(finer[sound] - peak[sound]).max(initial=0.0))


def _refuse_impossible(description: Path, people: Float[np.ndarray, "n 5"]) -> None:
    for name in ("k", "l"):
        bad = people[:, QUANTITIES.index(name)] <= 0.0
        if bad.any():
            what = f"{int(bad.sum())} of {len(bad)} samples of {name} are not above 0"
            raise InputError(description, f"[{name}]", what, "give it a lower end above 0")


SHOWN = {name: ("N/m", 1.0) if name == "k" else ("mm", 1e3) for name in QUANTITIES}
"""Unit of each quantity, and how many of it one SI unit is."""


def quantile_table(d: Drawn) -> pd.DataFrame:
    """Quantiles with their Monte Carlo interval of 95 %; `inf` where samples without a force reach that far."""
    rows = [
        {"share [-]": share, "peak_force [N]": one.value, "lower [N]": one.lower, "upper [N]": one.upper}
        for share, one in d.quantiles.items()
    ]
    return pd.DataFrame(rows)


def exceedance_table(d: Drawn) -> pd.DataFrame:
    """Probability that the largest |F| is above a force, with exact intervals of 95 %."""
    columns = {
        "force [N]": d.levels,
        "probability [-]": [one.value for one in d.exceedance],
        "lower [-]": [one.lower for one in d.exceedance],
        "upper [-]": [one.upper for one in d.exceedance],
    }
    return pd.DataFrame(columns)


def influence_table(d: Drawn) -> pd.DataFrame:
    """Coefficient of each quantity's rank, and the shares of the variance of the factor that it belongs to."""
    rows = []
    factors = [k for k, factor in enumerate(d.sampling.factors) for _ in factor.names]
    r = d.regression
    for name, k, own, far in zip(d.varying, factors, r.coefficients, r.of_distance, strict=True):
        row: dict[str, object] = {
            "quantity": name,
            "factor": " and ".join(d.sampling.factors[k].names),
            "rank_coefficient": float(own),
            "distance_rank_coefficient": float(far),
        }
        rows.append(row | _shares(d.indices, k))
    return pd.DataFrame(rows)


def _shares(indices: Indices | None, k: int) -> dict[str, float]:
    """First-order and total share of one factor with their intervals; NaN where there are none."""
    told: dict[str, float] = {}
    for kind in ("first", "total"):
        values = (np.nan, np.nan, np.nan)
        if indices is not None:
            lower, upper = getattr(indices, f"{kind}_interval")[k]
            values = (float(getattr(indices, kind)[k]), float(lower), float(upper))
        told |= dict(zip((f"sobol_{kind}", f"sobol_{kind}_lower", f"sobol_{kind}_upper"), values, strict=True))
    return told


def sample_table(d: Drawn) -> pd.DataFrame:
    """Every sample."""
    columns: dict[str, object] = {
        f"{name} [{unit}]": d.people[:, k] * per_si for k, (name, (unit, per_si)) in enumerate(SHOWN.items())
    }
    return pd.DataFrame({**columns, "peak_force [N]": d.peak, "state": [STATES[int(fate)] for fate in d.fate]})


def described(d: Drawn) -> dict[str, Any]:
    """What was asked for and found, with units in the keys; None stands for infinite and for what is not known."""
    content: dict[str, Any] = {
        "samples": len(d.peak),
        "synthetic": True,
        "limit_N": d.limit,
        "range_deg": [math.degrees(d.exposure.start), math.degrees(d.exposure.stop)],
        "stroke_mm": [d.exposure.lower * 1e3, d.exposure.upper * 1e3],
        "above_limit": _estimate(d.beyond),
        "without_a_force": {STATES[fate]: int((d.fate == fate).sum()) for fate in WITHOUT_FORCE},
        "quantiles_N": {f"{share:g}": _estimate(one) for share, one in d.quantiles.items()},
        "grid_error_N": d.grid_error,
        "influence": influence_table(d).to_dict(orient="records"),
        "rank_regression_explains": d.regression.explained,
    }
    told: dict[str, Any] = rounded(content)
    return told


def _estimate(one: IntervalEstimate) -> dict[str, float]:
    return {"value": one.value, "lower": one.lower, "upper": one.upper}
