"""Noise of the channels of a case before any model is fitted: what is told, second differences, rounding."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.chain.system import System
from geocontact.data.gap.case import GapCase
from geocontact.gap.inputs.quantisation import resolution
from geocontact.gap.levels import FLAT
from geocontact.identify.noise.typical_noise import typical_noise


def with_rounding(case: GapCase) -> dict[str, float]:
    """Noise that the case tells, by channel, with that of the recorder's steps: q²/12 of variance, and nothing more."""
    return {name: float(np.hypot(sd, rounding(case, name))) for name, sd in case.noise.items()}


def rounding(case: GapCase, name: str) -> float:
    """Standard deviation of the noise that rounding makes of a channel."""
    columns = [trial.column(name) for trial in (*case.calibration, *case.evaluation)]
    return resolution([x[np.isfinite(x)] for x in columns]) / FLAT


def typical_step(case: GapCase) -> float:
    """Time between two samples of the calibration trials [s]."""
    return float(np.median(np.concatenate([np.diff(trial.time) for trial in case.calibration])))


def rough_noise(system: System, case: GapCase) -> Float[np.ndarray, " c"]:
    """Noise that the case tells, else what second differences of the measurement suggest; no less than its rounding."""
    stated = with_rounding(case)
    seen = (stated.get(name) or max(_jumpiness(case, name), rounding(case, name)) for name in system.outputs)
    return np.array(list(seen))


def _jumpiness(case: GapCase, name: str) -> float:
    steps = np.concatenate([np.diff(t.column(name)[np.isfinite(t.column(name))], 2) for t in case.calibration])
    spread = typical_noise(steps, 2)
    most = max(float(np.nanmax(np.abs(t.column(name)), initial=0.0)) for t in case.calibration)
    return max(spread, 1e-4 * most, 1e-12)
