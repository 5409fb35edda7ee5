"""Movements of a knee: walking, stairs, squats, as flexion, adduction and the loads that make the two areas."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.course import Path, through
from geocontact.gap_benchmark.synthetic.motions import KNOTS, Rng, smoothed
from geocontact.gap_benchmark.synthetic.systems.knee.model import area_under

FLEXION: Mapping[str, tuple[tuple[float, float], ...]] = {
    "gait": ((0.0, 0.13), (0.15, 0.3), (0.3, 0.58), (0.45, 0.8), (0.6, 0.76), (0.75, 0.5), (0.9, 0.2), (1.0, 0.13)),
    "stairs": ((0.0, 0.9), (0.2, 0.75), (0.4, 0.35), (0.55, 0.15), (0.7, 0.3), (0.85, 0.8), (1.0, 0.9)),
    "squat": ((0.0, 0.1), (0.1, 0.12), (0.45, 1.2), (0.55, 1.2), (0.9, 0.12), (1.0, 0.1)),
}
"""Share of a trial and flexion [rad]."""
LOAD: Mapping[str, tuple[tuple[float, float], ...]] = {
    "gait": ((0.0, 0.5), (0.08, 0.75), (0.2, 1.0), (0.4, 0.8), (0.58, 0.92), (0.72, 0.65), (0.87, 0.1), (1.0, 0.42)),
    "stairs": ((0.0, 0.3), (0.15, 0.85), (0.3, 1.0), (0.5, 0.6), (0.65, 0.8), (0.8, 0.25), (1.0, 0.3)),
    "squat": ((0.0, 0.35), (0.2, 0.5), (0.45, 1.0), (0.55, 0.95), (0.8, 0.5), (1.0, 0.35)),
}
"""Share of a trial and of the largest load of both sides."""
MARGIN = 0.15
"""Shares of a trial before it and after it through which its path runs on."""


@dataclass(frozen=True)
class KneeStyle:
    """How one case moves: `kind`, duration [s], largest load of both sides [N], medial share, its swing, step [s].

    `bend` scales flexion; `modulus` [Pa] and `radius` [m] turn loads into areas.
    """

    kind: str
    duration: float
    load: float
    medial: float
    sway: float
    bend: float
    modulus: float
    radius: float
    step: float


def knee_path(rng: Rng, style: KneeStyle) -> Path:
    """One trial."""
    duration = style.duration * float(np.exp(rng.normal(0.0, 0.05)))
    late = rng.normal(0.0, 0.012)
    share = np.arange(-MARGIN, 1.0 + MARGIN, KNOTS / duration)
    bend = style.bend * float(np.exp(rng.normal(0.0, 0.02)))
    flexion = bend * periodic(FLEXION[style.kind], share + late)
    load = style.load * float(np.exp(rng.normal(0.0, 0.03))) * periodic(LOAD[style.kind], share + rng.normal(0.0, 0.01))
    turn = rng.normal(0.0, 0.15)
    adduction = 0.022 * np.exp(rng.normal(0.0, 0.08)) * np.sin(2.0 * np.pi * share + turn)
    middle = style.medial + rng.normal(0.0, 0.005)
    medial = middle + style.sway * np.sin(2.0 * np.pi * share + 0.6 + turn) + 0.3 * style.sway * np.cos(9.0 * share)
    areas = [area_under(part * load, style.modulus, style.radius) for part in (medial, 1.0 - medial)]
    time = share * duration
    return through(time, np.array([flexion, adduction, *areas]), duration, rng.uniform(0.0, 2.0 * np.pi))


def periodic(nodes: tuple[tuple[float, float], ...], share: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
    """Polyline through `nodes` that repeats itself, corners rounded."""
    at, value = (np.array(column) for column in zip(*nodes, strict=True))
    thrice = np.concatenate([at[:-1] - 1.0, at[:-1], at + 1.0])
    return smoothed(thrice, np.concatenate([value[:-1], value[:-1], value]), share, 0.035)
