"""How far the gap of a case shrinks, over many fresh trials."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs
from geocontact.gap_benchmark.synthetic.scene import SyntheticScene
from geocontact.gap_benchmark.synthetic.trials import SyntheticTrial, as_measured, predicted

BINS = 100
"""Of the phase of a trial."""
MOST = 0.7
"""Share of the squared gap that a window holds."""


@dataclass(frozen=True)
class Reach:
    """Per channel: rmse of the refitted base and of the truth on fresh trials, and where the gap sits."""

    before: dict[str, float]
    after: dict[str, float]
    window: dict[str, tuple[float, float]]
    shares: dict[str, float]


def reach(
    scene: SyntheticScene,
    fresh: Sequence[SyntheticTrial],
    theta: Float[np.ndarray, " p"],
    hooks: Hooks,
    fine: int,
    floor: Float[np.ndarray, " c"],
) -> Reach:
    """Base at `theta` against the true simulator at nominal parameters, both on measured inputs."""
    count = len(scene.outputs)
    before, after, number = np.zeros(count), np.zeros(count), np.zeros(count)
    along = np.zeros((count, BINS))
    for one in fresh:
        base = scene.base_model(as_measured(one))(theta)
        true = predicted(scene, one, hooks, fine)
        there = np.isfinite(one.outputs) & np.isfinite(base) & np.isfinite(true)
        before += np.where(there, one.outputs - base, 0.0).__pow__(2).sum(axis=1)
        after += np.where(there, one.outputs - true, 0.0).__pow__(2).sum(axis=1)
        number += there.sum(axis=1)
        gap: Outputs = np.where(there, true - base, 0.0) ** 2
        phase = np.clip((one.time / one.duration * BINS).astype(int), 0, BINS - 1)
        for c in range(count):
            along[c] += np.bincount(phase, gap[c], BINS)
    number = np.maximum(number, 1.0)
    whole = along.sum(axis=1) / number / floor**2
    names = scene.outputs
    return Reach(
        dict(zip(names, np.sqrt(before / number).tolist(), strict=True)),
        dict(zip(names, np.sqrt(after / number).tolist(), strict=True)),
        {name: shortest(along[c]) for c, name in enumerate(names)},
        dict(zip(names, (whole / max(float(whole.sum()), 1e-300)).tolist(), strict=True)),
    )


def shortest(squares: Float[np.ndarray, " b"]) -> tuple[float, float]:
    """Shortest window that holds `MOST` of the sum, as phases."""
    total = np.concatenate([[0.0], np.cumsum(squares)])
    need = MOST * total[-1]
    ends = np.searchsorted(total, total + need - 1e-12 * max(need, 1e-300))
    widths = np.where(ends < len(total), ends - np.arange(len(total)), len(total))
    begin = int(np.argmin(widths))
    return begin / BINS, min(int(ends[begin]), BINS) / BINS
