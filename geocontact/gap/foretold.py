"""How much of what an effect changes lies in the calibration trials.

Held-out trials may be faster, larger or longer: an effect that calibration trials hardly show may show there. Its gain
is to be borne out in proportion to what it changes, not to the number of samples.
"""

from __future__ import annotations

import numpy as np

from geocontact.gap.contest import Contender
from geocontact.gap.problem import Problem


def calibration_share(problem: Problem, base: Contender, one: Contender) -> float:
    """Part of a model's changes of the prediction, squared, in units of the noise floor, in the calibration trials.

    That part of all samples where it changes nothing that is a number.
    """
    models = zip(base.judged.model.residuals, one.judged.model.residuals, strict=True)
    changed = np.array([float(np.sum(((a - b) / problem.floor) ** 2)) for a, b in models])
    whole = float(changed.sum())
    if not 0.0 < whole < np.inf:
        return base.judged.fitted_rows / len(base.judged.model.whitened)
    return float(changed[: len(problem.calibration.trials)].sum()) / whole
