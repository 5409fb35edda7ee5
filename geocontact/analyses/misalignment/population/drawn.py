"""People that are drawn, and everything found of their largest forces."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int

from geocontact.analyses.misalignment.population.options import PopulationOptions
from geocontact.axis_misalignment.axis_drift import AxisDrift
from geocontact.axis_misalignment.planar_joint import SOUND, STEP
from geocontact.axis_misalignment.population import QUANTITIES, Exposure, peak_forces
from geocontact.data.errors import InputError
from geocontact.identify.intervals.quantile_intervals import IntervalEstimate, probability, quantile
from geocontact.identify.intervals.sampling import Sampling
from geocontact.identify.intervals.sobol_indices import Indices, RankRegression, rank_regression, variance_shares

SHARES = (0.05, 0.25, 0.5, 0.75, 0.9, 0.95, 0.99)
LEVELS = 200
"""Forces at which the exceedance is told."""

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
