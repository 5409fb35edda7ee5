"""Who the people are, and how the axis of their joint drifts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.misalignment.drift import axis_drift
from geocontact.analyses.misalignment.law_numbers import NUMBERS
from geocontact.analyses.misalignment.population.options import PopulationOptions
from geocontact.analyses.run_record import Record
from geocontact.axis_misalignment.axis_drift import AxisDrift
from geocontact.axis_misalignment.population import QUANTITIES
from geocontact.data.errors import InputError
from geocontact.data.plausible import numbers_in
from geocontact.identify.intervals.sampling import Factor, Normal, People, Sampling, Uniform, root
from geocontact.io.recordings.population import PopulationFile, read_population

ENDS = {"value", "mean", "upper"}
"""Numbers of a description that say how large a quantity is."""
UNITS = {name: "N/m" if name == "k" else "m" for name in QUANTITIES}


@dataclass(frozen=True, eq=False)
class Population:
    """What differs from person to person, and what is the same for everybody."""

    sampling: Sampling
    drift: AxisDrift


def read(o: PopulationOptions, record: Record) -> Population:
    """Everything the options name."""
    drift = axis_drift(record, o.drift, o.range)
    return Population(_sampling(record, o.description), drift)


def _sampling(record: Record, description: Path) -> Sampling:
    told = read_population(description, UNITS)
    record.add_input("description", description)
    _check_sizes(record, description, told)
    for file in told.tables:
        record.add_input("table", file)
    drawn = {name: one for name, one in told.quantities.items() if one.kind in ("normal", "uniform")}
    factors: list[Factor] = [_factor(name, one.kind, one.numbers) for name, one in drawn.items()]
    factors += [People(tuple(columns), np.column_stack(list(columns.values()))) for columns in told.tables.values()]
    if not factors:
        raise InputError(description, "", "every quantity is the same for everybody", "let one differ")
    fixed = {name: one.numbers["value"] for name, one in told.quantities.items() if one.kind == "value"}
    return Sampling(factors, _correlation(description, told, factors), fixed)


def _check_sizes(record: Record, description: Path, told: PopulationFile) -> None:
    """Refuse numbers that a quantity cannot have, and warn of unusual ones; lower ends and deviations may be small."""
    ranges = dict(NUMBERS.ranges)
    stated = [
        (f"[{n}] {key}", n, one.numbers[key], one.numbers[key] / one.factor)
        for n, one in told.quantities.items()
        for key in ENDS & {*one.numbers}
    ]
    listed = [(f"[{n}] table", n, float(c.max()), None) for columns in told.tables.values() for n, c in columns.items()]
    for place, name, value, written in (*sorted(stated), *listed):
        for _, known, number in numbers_in(ranges[name], value):
            if refusal := known.refusal(number, written):
                raise InputError(description, place, *refusal)
            if doubt := known.doubt(number, written):
                record.warn(f"{description} {place}: {doubt}")


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
