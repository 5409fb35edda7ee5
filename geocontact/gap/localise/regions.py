"""Regions of phase, state and rate in which the base model misses what all trials have.

Of all cells of all channels (`gap.localise.structure`) those are found whose false-discovery rate, whatever their
dependence, is below one in twenty. Found cells of a channel that touch, in the phase, in the state or at the turn of
its direction, are one region. It says where something is missing and how much of the error lies there; it names no
effect and moves no verdict.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from jaxtyping import Bool, Float

from geocontact.chain.differentiated_inputs import recorded
from geocontact.data.gap_cells import Region
from geocontact.gap.case.problem import Problem
from geocontact.gap.localise.structure import SHAPE, Cells, Structure
from geocontact.gap.selection.evidence import Judged
from geocontact.identify.intervals.quantile_intervals import CONFIDENCE


def regions(problem: Problem, base: Judged) -> tuple[Region, ...]:
    """Where the base model misses something; the largest share first."""
    left = Structure.of(problem, base.model)
    found = left.q_values <= 1.0 - CONFIDENCE
    each = (region_of(problem, left, c, cells) for c in range(len(found)) for cells in touching(found[c]))
    return tuple(sorted(each, key=lambda one: -one.share))


def touching(cells: Bool[np.ndarray, " k"]) -> Iterator[Bool[np.ndarray, " k"]]:
    """Cells of a channel that touch, part by part."""
    from scipy.ndimage import label

    numbers, count = label(cells.reshape(SHAPE))
    for k in range(1, count + 1):
        yield (numbers == k).ravel()


def region_of(problem: Problem, left: Structure, c: int, cells: Bool[np.ndarray, " k"]) -> Region:
    """What is missed of channel `c` in some cells."""
    name, followed = problem.system.outputs[c], left.grid.inputs[c]
    only: Cells = np.zeros(left.p_values.shape, bool)
    only[c] = cells
    inside = [there[:, c] for there in left.grid.inside(only)]
    residuals = [r[:, c] for r in left.model.residuals]
    own = np.concatenate([r[there] for r, there in zip(residuals, inside, strict=True)])
    whole = sum(float((r**2).sum()) for r in residuals)
    parts, _, ways = np.nonzero(cells.reshape(SHAPE))
    state = _state(problem, followed, inside) if followed else (0.0, 0.0)
    way = "" if not followed or len(set(ways)) == 2 else ("falling", "rising")[ways[0]]
    return Region(
        channel=name,
        phase=(float(parts.min()) / SHAPE[0], float(parts.max() + 1) / SHAPE[0]),
        input=followed,
        state=state,
        way=way,
        mean=float(own.mean()),
        share=float((own**2).sum()) / max(whole, 1e-300),
        q_value=float(left.q_values[c][cells].min()),
        units=(problem.system.unit(name), problem.system.unit(followed) if followed else ""),
    )


def _state(problem: Problem, name: str, inside: list[Bool[np.ndarray, " _"]]) -> tuple[float, float]:
    """Range of an input over some samples of all trials, as it was measured."""
    row, system = problem.system.inputs.index(name), problem.system
    moved: list[Float[np.ndarray, " _"]] = [
        recorded(trial.signals, system.inputs, system.motion.reach).position[row] for trial in problem.recorded.trials
    ]
    values = np.concatenate([own[there] for own, there in zip(moved, inside, strict=True)])
    return float(values.min()), float(values.max())
