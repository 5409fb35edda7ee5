"""A stance whose numbers are planted."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from benchmarks.prosthesis.keel_stance import WEIGHT, stance
from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance
from geocontact.below_knee_prosthesis.calibration.zone_parameters import ZoneParameters
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_foot

FACTORS = np.array([1.2, 1.5, 0.7, 0.6, 1.1, 1.3, 0.7, 1.4, 1.2, 0.8, 0.9, 1.1, 1.2, 0.8, 0.95])
"""Planted numbers over the usual ones."""
PLATE_GATE = 30.0


def planted() -> tuple[ZoneParameters, np.ndarray]:
    """Zones and the planted numbers."""
    foot = vsf_foot()
    zones = ZoneParameters(foot.sole, foot.law)
    return zones, FACTORS * zones.values_of(foot.law)


@lru_cache(maxsize=2)
def recorded(noise: float = 1.0) -> RecordedStance:
    """On the planted sole, the plate's errors `noise` times their size; poses are exact."""
    foot, fulcrum = vsf_foot(), fulcrum_of("medium")
    moved = stance(foot, fulcrum)
    frames = len(moved.time)
    blank = RecordedStance(
        moved.time, moved.poses, moved.rate, fulcrum, np.zeros((frames, 3)), np.zeros(frames), WEIGHT
    )
    zones, values = planted()
    true = replace(foot, law=zones.law(values)).at(fulcrum)
    shown = blank.predicted(true, blank.solved(true))
    rng, e = np.random.default_rng(1), blank.errors
    force = shown[:, :3] + noise * e.force * rng.standard_normal((frames, 3))
    off = noise * e.couple / np.maximum(force[:, 1], 1.0) / foot.keel.length * rng.standard_normal(frames)
    return replace(blank, force=force, centre=np.where(force[:, 1] > PLATE_GATE, shown[:, 3] + off, np.nan))
