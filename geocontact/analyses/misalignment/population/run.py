"""A population: reads, draws, computes, writes, says what it found."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int

from geocontact.analyses import quantities
from geocontact.analyses.misalignment.device import above_zero, drift, stroke
from geocontact.analyses.misalignment.population.write import describe, write_results
from geocontact.analyses.results_folder import written_whole
from geocontact.analyses.run_record import Record
from geocontact.axis_misalignment.planar_joint import FATES, SOUND, STEP
from geocontact.axis_misalignment.population import QUANTITIES, Exposure, peak_forces
from geocontact.cli.elbow_population import PopulationOptions
from geocontact.data.errors import InputError
from geocontact.identify.intervals.quantile_intervals import IntervalEstimate, probability, quantile
from geocontact.identify.intervals.sampling import Factor, Normal, People, Sampling, Uniform, root
from geocontact.identify.intervals.sobol_indices import Indices, RankRegression, rank_regression, variance_shares
from geocontact.io.recordings.population import PopulationFile, read_population

UNITS = {name: "N/m" if name == "k" else "m" for name in QUANTITIES}
SHARES = (0.05, 0.25, 0.5, 0.75, 0.9, 0.95, 0.99)
FEWEST, MOST = 100, 20_000_000
LEVELS = 200
"""Forces at which the exceedance is told."""

REGRESSED = 20_000
"""Samples that the regression on ranks takes, from the first on."""

CHECKED = 2000
"""Samples whose largest force is found once more with a grid `FINER` times as fine."""

FINER = 8


@dataclass(frozen=True, eq=False)
class Drawn:
    """Everything found of one population; N, m, N/m."""

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


def analyse(description: Path, o: PopulationOptions) -> int:
    """Run the whole analysis."""
    record = Record("elbow population", {"description": description, **asdict(o)})
    with record.catching_warnings(), written_whole(o.out) as draft:
        found = _drawn(record, description, o)
        _reserve(record, found)
        record.results["population"] = describe(found)
        write_results(record, found, o, draft)
        record.write(draft)
        written = sorted(file.name for file in draft.iterdir())
    _tell(record, found)
    record.say(f"results in {o.out}: {', '.join(written)}")
    record.speak()
    return 0


def _drawn(record: Record, description: Path, o: PopulationOptions) -> Drawn:
    if not FEWEST <= o.samples <= MOST:
        raise InputError("", "--samples", f"{o.samples} is not between {FEWEST} and {MOST}", "e.g. 1000000")
    if o.seed < 0:
        raise InputError("", "--seed", f"{o.seed} is below 0", "e.g. 1")
    start, stop = quantities.angle_span(o.range, "--range")
    limit = above_zero(o.limit, "--limit", "N")
    exposure = Exposure(start, stop, *stroke(o.stroke_mm), drift(record, o.drift, (start, stop)))
    sampling = _sampling(record, description)
    people = sampling.quantities(sampling.shares(o.samples, o.seed), QUANTITIES)
    _refuse_impossible(description, people)
    peak_forces(people[:1], exposure)  # compiled or loaded before time is taken
    begun = time.process_time()
    peak, fate = peak_forces(people, exposure)
    record.results["samples_per_second_of_one_core"] = round(o.samples / max(time.process_time() - begun, 1e-9))
    ordered = np.sort(peak)
    levels = _levels(ordered, limit)
    above = len(ordered) - np.searchsorted(ordered, levels, side="right")
    checked = peak_forces(people[:CHECKED], exposure, STEP / FINER)[0]
    sound = fate[:CHECKED] == SOUND
    varying = tuple(name for factor in sampling.factors for name in factor.names)
    columns = people[:REGRESSED][:, [QUANTITIES.index(name) for name in varying]]
    return Drawn(
        sampling, exposure, limit, people, peak, fate,
        {share: quantile(ordered, share) for share in SHARES},
        probability(int((peak > limit).sum()), len(peak)),
        levels, [probability(int(count), len(peak)) for count in above],
        varying, rank_regression(columns, peak[:REGRESSED]), _indices(sampling, exposure, o.seed),
        float(np.abs(checked[sound] - peak[:CHECKED][sound]).max(initial=0.0)),
    )  # fmt: skip


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


def _sampling(record: Record, description: Path) -> Sampling:
    told = read_population(description, UNITS)
    record.add_input("description", description)
    for file in told.tables:
        record.add_input("table", file)
    factors: list[Factor] = [_factor(name, one.kind, one.numbers) for name, one in told.quantities.items()
                             if one.kind in ("normal", "uniform")]  # fmt: skip
    factors += [People(tuple(columns), np.column_stack(list(columns.values()))) for columns in told.tables.values()]
    if not factors:
        raise InputError(description, "", "every quantity is the same for everybody", "let one differ")
    fixed = {name: one.numbers["value"] for name, one in told.quantities.items() if one.kind == "value"}
    return Sampling(factors, _correlation(description, told, factors), fixed)


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


def _refuse_impossible(description: Path, people: Float[np.ndarray, "n 5"]) -> None:
    for name in ("k", "l"):
        bad = people[:, QUANTITIES.index(name)] <= 0.0
        if bad.any():
            what = f"{int(bad.sum())} of {len(bad)} samples of {name} are not above 0"
            raise InputError(description, f"[{name}]", what, "give it a lower end above 0")


def _reserve(record: Record, d: Drawn) -> None:
    for fate, words in FATES.items():
        hit = d.fate == fate
        if hit.any():
            first = d.people[int(np.argmax(hit))] * np.array([1.0, 1e3, 1e3, 1e3, 1e3])
            told = ", ".join(
                f"{n} = {v:.4g} {'N/m' if n == 'k' else 'mm'}" for n, v in zip(QUANTITIES, first, strict=True)
            )
            what = f"{int(hit.sum())} of {len(hit)} samples count as beyond every force: {words}"
            record.warn(f"{what} (the first: {told})")
    if d.indices is None:
        why = "some samples have no force, or all the same" if d.sampling.independent else "factors are correlated"
        record.warn(f"no shares of the variance, for {why}: the regression on ranks is all there is")


def _tell(record: Record, d: Drawn) -> None:
    middle, high = d.quantiles[0.5], d.quantiles[0.95]
    record.say(f"largest |F| of {len(d.peak)} synthetic people: median {_said(middle)}, 95 % below {_said(high)}")
    b = d.beyond
    record.say(f"above {d.limit:g} N: {b.value:.4%} ({b.lower:.4%} … {b.upper:.4%})")
    rate = record.results["samples_per_second_of_one_core"]
    record.say(f"{rate} samples per second of one core; grid of angles: error below {max(d.grid_error, 1e-9):.1e} N")


def _said(e: IntervalEstimate) -> str:
    return f"{e.value:.3f} N ({e.lower:.3f} … {e.upper:.3f})" if math.isfinite(e.value) else "infinite"
