"""How the largest force spreads over people whose offsets differ."""

from __future__ import annotations

import math

import numpy as np

from geocontact.analyses.misalignment.population.description import described
from geocontact.analyses.misalignment.population.drawn import Drawn, drawn
from geocontact.analyses.misalignment.population.options import PopulationOptions
from geocontact.analyses.misalignment.population.read import Population
from geocontact.analyses.misalignment.population.result import PopulationResult
from geocontact.analyses.misalignment.population.tables import SHOWN
from geocontact.analyses.run_record import Record
from geocontact.axis_misalignment.planar_joint import FATES
from geocontact.identify.intervals.quantile_intervals import IntervalEstimate


def run(population: Population, o: PopulationOptions, record: Record) -> PopulationResult:
    """Quantiles of the largest force, how often it is above the limit, and what that depends on."""
    found = drawn(population.sampling, population.drift, o)
    _reserve(record, found)
    _say(record, found)
    summary = described(found)
    record.results["samples_per_second_of_one_core"] = found.rate
    record.results["population"] = summary
    return PopulationResult(record=record, options=o, drawn=found, summary=summary)


def _reserve(record: Record, d: Drawn) -> None:
    for fate, words in FATES.items():
        hit = d.fate == fate
        if hit.any():
            first = zip(SHOWN.items(), d.people[int(np.argmax(hit))], strict=True)
            told = ", ".join(f"{name} = {value * per_si:.4g} {unit}" for (name, (unit, per_si)), value in first)
            what = f"{int(hit.sum())} of {len(hit)} samples count as beyond every force: {words}"
            record.warn(f"{what} (the first: {told})")
    if d.indices is None:
        why = "some samples have no force, or all the same" if d.sampling.independent else "factors are correlated"
        record.warn(f"no shares of the variance, for {why}: the regression on ranks is all there is")


def _say(record: Record, d: Drawn) -> None:
    middle, high = d.quantiles[0.5], d.quantiles[0.95]
    record.say(f"largest |F| of {len(d.peak)} synthetic people: median {_said(middle)}, 95 % below {_said(high)}")
    b = d.beyond
    record.say(f"above {d.limit:g} N: {b.value:.4%} ({b.lower:.4%} … {b.upper:.4%})")
    record.say(f"{d.rate} samples per second of one core; grid of angles: error below {max(d.grid_error, 1e-9):.1e} N")


def _said(e: IntervalEstimate) -> str:
    return f"{e.value:.3f} N ({e.lower:.3f} … {e.upper:.3f})" if math.isfinite(e.value) else "infinite"
