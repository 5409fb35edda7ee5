"""Where on the surface the gap lies, for a channel that the cells of a pressure mat add up to.

The base model says nothing of cells. What it expects of them is its force ŷ(t), spread as the cells carry it in the
calibration trials: sᵢ = Σ fᵢŷ / Σ ŷ² over their samples, fᵢ the force of cell i. In the held-out trials cell i is off
by rᵢ = fᵢ - sᵢŷ, and its part of the gap g(t) of the channel is

    cᵢ = Σ rᵢ g / Σ r g,    r = Σ rᵢ,

a covariance: parts add up to 1, noise of single cells averages out, and a load that moves from cell to cell counts only
as far as it does so when the gap is there. A part may be negative: that cell is off the other way. As g serves what the
named effect adds, which is free of noise, or the smoothed residual where nothing was named.

A gap that is spread as the load is has cᵢ⁰ = sᵢ/Σ sᵢ. Whether another spread can be identified is tested on dᵢ = rᵢ -
cᵢ⁰ r in two ways, the largest over all cells one family, the smaller p-value doubled: by flipping the signs of dᵢg over
blocks inside trials, as on the map over phase, which tells a gap that comes again and again; and by turning g round in
time within its trials, all by the same part, which tells a gap that comes once.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from geocontact.data.gap_cells import CellChannels, SurfaceGap
from geocontact.data.trial import Trial
from geocontact.gap.case.change_amplitude import BLOCKS
from geocontact.gap.case.problem import Problem
from geocontact.gap.data_errors import DataError
from geocontact.gap.levels import DRAWS
from geocontact.gap.localise.gap_map import FEW_DRAWS, HOLDS, missed, smoothed
from geocontact.gap.selection.evidence import Judged

SHOWN = 0.5  # of the gap that the cells together must show: less, and most of it was made behind the mat


Seen = list[tuple[Float[np.ndarray, "_ n"], Float[np.ndarray, " _"]]]
"""What each trial shows: forces of the cells, or what they are off by, and the model's force, or the gap."""


def on_surface(
    problem: Problem, after: Judged | None, data_error: DataError | None, cells: Mapping[str, CellChannels]
) -> tuple[SurfaceGap, ...]:
    """Every site whose cells show the gap of its channel, where trials on both sides have cells.

    Parameters
    ----------
    problem
        The case as it came.
    after, data_error
        As for `locate.windows`.
    cells
        By site.
    """
    gaps = missed(problem, after, data_error)
    found = []
    for site, own in cells.items():
        one = _site(problem, site, own, gaps, after is not None)
        if one is not None:
            found.append(one)
    return tuple(found)


def _site(
    problem: Problem, site: str, cells: CellChannels, gaps: list[Float[np.ndarray, "_ c"]], named: bool
) -> SurfaceGap | None:
    column = problem.system.outputs.index(cells.channel)
    fitted = [
        (cells.forces(trial.name, trial.time), _base(problem, trial, column))
        for trial in problem.calibration.trials
        if trial.name in cells.trials
    ]
    if not fitted:
        return None
    spread = _spread(fitted)
    seen = []
    for trial, gap in zip(problem.evaluation.trials, gaps, strict=True):
        if trial.name in cells.trials:
            off = cells.forces(trial.name, trial.time) - np.outer(_base(problem, trial, column), spread)
            own = gap[:, column] if named else smoothed(gap[:, column])
            seen.append((np.where(np.isfinite(off), off, 0.0), own))
    if not seen or spread.sum() <= 0.0:
        return None
    parts = np.sum([off.T @ g for off, g in seen], axis=0)
    if parts.sum() <= SHOWN * sum(float(g @ g) for _, g in seen):
        return None
    load, gap = spread / spread.sum(), parts / parts.sum()
    order = np.argsort(-gap, kind="stable")
    count = int(np.searchsorted(np.cumsum(gap[order]), HOLDS)) + 1
    holding = tuple(cells.ids[k] for k in order[:count])
    elsewhere = [(off - np.outer(off.sum(axis=1), load), g) for off, g in seen]
    p_value = min(1.0, 2.0 * min(_flipped(elsewhere), _turned(elsewhere)))
    return SurfaceGap(site, cells.channel, cells.ids, cells.place, load, gap, holding, p_value)


def _base(problem: Problem, trial: Trial, column: int) -> Float[np.ndarray, " t"]:
    return np.asarray(problem.system.simulate(trial, problem.plain.values)[:, column])


def _spread(fitted: Seen) -> Float[np.ndarray, " n"]:
    """Least squares of each cell's force on the model's; 0 for a cell that was never measured."""
    forces = np.concatenate([force for force, _ in fitted])
    model = np.concatenate([base for _, base in fitted])
    there = np.isfinite(forces) & np.isfinite(model)[:, None]
    model = np.nan_to_num(model)
    products = (np.where(there, forces, 0.0) * model[:, None]).sum(axis=0)
    squares = (there * model[:, None] ** 2).sum(axis=0)
    return np.asarray(products / np.where(squares > 0.0, squares, np.inf))


def _flipped(seen: Seen) -> float:
    """How often blocks with random signs give a cell that stands out as much."""
    blocks = []
    for off, g in seen:
        block = np.arange(len(g)) * BLOCKS // len(g)
        products = off * g[:, None]
        blocks += [products[block == b].sum(axis=0) for b in range(BLOCKS)]
    table = np.array(blocks)
    size = np.sqrt((table**2).sum(axis=0))
    table = table / np.where(size > 0.0, size, np.inf)
    signs = np.random.default_rng(0).choice([-1.0, 1.0], (DRAWS, len(table)))
    largest = np.abs(signs @ table).max(axis=1)
    return float((1.0 + (largest >= np.abs(table.sum(axis=0)).max()).sum()) / (1.0 + DRAWS))


def _turned(seen: Seen) -> float:
    """How often the gap at another time gives a cell that stands out as much."""
    turns = np.arange(FEW_DRAWS) / FEW_DRAWS
    sums = np.zeros((FEW_DRAWS, seen[0][0].shape[1]))
    for off, g in seen:
        for k, turn in enumerate(turns):
            sums[k] += np.roll(g, round(turn * len(g))) @ off
    size = np.sqrt(np.mean((sums - sums.mean(axis=0)) ** 2, axis=0))
    largest = np.abs(sums / np.where(size > 0.0, size, np.inf)).max(axis=1)
    return float((largest >= largest[0]).mean())
