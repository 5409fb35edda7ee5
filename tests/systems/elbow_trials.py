"""Synthetic trials of an elbow, and what is known of the law's numbers beforehand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from geocontact.axis_misalignment.law import NAMES, UNITS
from geocontact.axis_misalignment.synthetic import PAPER, Design, synthetic
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.parameter import Parameter

RANGE = {
    "k": (300.0, 10.0, 10e3), "x": (0.03, -0.15, 0.15), "y": (0.04, -0.15, 0.15), "l": (0.2, 0.05, 0.5),
    "z": (0.12, -0.3, 0.3), "b": (0.0, -500.0, 500.0), "s": (0.0, -1e-3, 1e-3),
    "c": (5e-4, 0.0, 0.02),
}  # fmt: skip
"""Start and bounds; the starts are the paper's."""
QUICK = Design(seconds=30.0, rate=100.0, noise=0.3, memory=0.1)


def parameters(known: Mapping[str, float], free: Sequence[str] = "kxylz") -> tuple[Parameter, ...]:
    """Numbers in the order of NAMES; b, s and c are absent unless free."""
    made = []
    for name in NAMES:
        if name in known or name not in free:
            value = known.get(name, 0.0)
            made.append(Parameter(name, UNITS[name], value, value, value, fixed=True))
        else:
            made.append(Parameter(name, UNITS[name], *RANGE[name]))
    return tuple(made)


def trials(
    numbers: Mapping[str, float] = PAPER,
    design: Design = QUICK,
    seed: int | Sequence[int] = 1,
    count: int = 6,
    stroke: tuple[float, float] | None = None,
    mean_pressure: float = 0.0,
) -> list[ElbowRecording]:
    """Synthetic trials, the compensation joint locked unless it has a stroke."""
    rng = np.random.default_rng(seed)
    return [synthetic(f"t{k + 1}", numbers, design, rng, stroke, mean_pressure).recording for k in range(count)]
