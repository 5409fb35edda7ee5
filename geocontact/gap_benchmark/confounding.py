"""What somebody who knows the truth and the noise can tell: how near candidates come to what was injected.

Every candidate is refitted together with the base to the calibration trials as they would be without noise and without
trial-to-trial variation, residuals weighed by the true covariance of both (that of the label's nats). The effect is
reproduced where the best candidate leaves less than a tenth of what the base alone leaves: nobody who knows the table
only could tell then that the effect is not in it. Mistakes in the data are not tried, being gross where they apply.

Of the nats that the best candidate of every effect leaves: an effect is *ahead* where every other leaves `CLEAR` nats
more than its own; else the effects that leave no more than `CLEAR` above it are its *class*, one law on these trials as
far as anybody can say.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float

from geocontact.chain.candidate import Candidate
from geocontact.chain.system import System
from geocontact.gap.case.refit import Measured, refit
from geocontact.gap_benchmark.answers import Plain
from geocontact.gap_benchmark.synthetic.label import IdealTrial

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


CLEAR = 3.0
"""Nats: noise turns a lead of so much round in one case of nine."""


def left_by_effect(
    system: System, trials: Sequence[IdealTrial], candidates: Sequence[Candidate], rough: Mapping[str, float]
) -> dict[str, float]:
    """What the best candidate of every effect leaves of the visible energy [nats], by the effect's name."""
    name_of = {one.label: one.name for one in candidates}
    _, left = what_each_leaves(system, trials, candidates, rough)
    found: dict[str, float] = {}
    for label, cost in left.items():
        name = name_of[label]
        found[name] = min(cost, found.get(name, cost))
    return found


def ahead_by(label: Plain) -> float | None:
    """Lead [nats] of the one planted effect over the best other; None where it was not asked, or has no candidate."""
    left, planted = label.get("left"), label["effects"]
    if not left or len(planted) != 1 or planted[0] not in left:
        return None
    others = [cost for name, cost in left.items() if name != planted[0]]
    return float(min(others, default=float("inf")) - left[planted[0]])


def clearly_ahead(label: Plain) -> bool:
    """Whether somebody who knows the noise ranks it first."""
    lead = ahead_by(label)
    return lead is not None and lead >= CLEAR


def one_law(label: Plain) -> set[str]:
    """Effects that cannot be told from the planted one on these trials, or are nearer; itself among them."""
    planted = label["effects"][0]
    return {name for name, cost in label["left"].items() if cost <= label["left"][planted] + CLEAR}
