"""How near candidates come to what was injected, and whether one reproduces an effect outside the table; from the
truth.

Every candidate is refitted together with the base to the calibration trials as they would be without noise and without
trial-to-trial variation, residuals weighed by the true covariance of both (that of the label's nats). The effect is
reproduced where the best candidate leaves less than a tenth of what the base alone leaves: nobody who knows the table
only could tell then that the effect is not in it. Mistakes in the data are not tried, being gross where they apply.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float

from geocontact.chain.candidate import Candidate
from geocontact.chain.system import System
from geocontact.gap.case.refit import Measured, refit
from geocontact.gap_benchmark.synthetic.ideal import IdealTrial

LEFT = 0.1
"""Of the visible energy."""
ROUNDS = 15


def confounding(
    system: System, trials: Sequence[IdealTrial], candidates: Sequence[Candidate], rough: Mapping[str, float]
) -> tuple[float, str]:
    """Share of the visible energy that the best candidate leaves, and its label; 1 and "" where none helps.

    Parameters
    ----------
    system
        Base model; what was injected is added to its own prediction, so that the two base models need not agree.
    trials
        Calibration trials without noise.
    candidates
        For this system.
    rough
        Noise of each channel, for samples where the model has no value.
    """
    before, left = what_each_leaves(system, trials, candidates, rough)
    left = {label: cost for label, cost in left.items() if np.isfinite(cost)}
    label = min(left, key=lambda one: left[one], default="")
    if not label or left[label] >= before or before <= 0.0:
        return 1.0, ""
    return left[label] / before, label


def what_each_leaves(
    system: System, trials: Sequence[IdealTrial], candidates: Sequence[Candidate], rough: Mapping[str, float]
) -> tuple[float, dict[str, float]]:
    """Visible energy [nats] that the refitted base leaves, and that each candidate leaves, by label; as above."""
    system = system.as_measured()
    measured = _measured(system, trials, np.array([rough[name] for name in system.outputs]))
    base = refit(system, measured, trials, [trials[0].nominal], ROUNDS)
    left = {}
    for one in candidates:
        if one.parameters:
            starts = [{**base.values, **start} for start in one.starts]
            left[one.label] = float(refit(one.apply(system), measured, trials, starts, ROUNDS).cost)
    return float(base.cost), left


def _measured(system: System, trials: Sequence[IdealTrial], rough: Float[np.ndarray, " c"]) -> Measured:
    predicted = tuple(system.simulate(one.trial, one.nominal) + one.effect.T for one in trials)
    return Measured(tuple(one.trial for one in trials), predicted, rough)
