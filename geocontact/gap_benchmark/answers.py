"""What the truth looks like as an answer, the two answerers that bound a score, and how near the truth can be
identified at all.

Every candidate is refitted together with the base to the calibration trials as they would be without noise and without
trial-to-trial variation, residuals weighed by the true covariance of both (that of the label's nats). The effect is
reproduced where the best candidate leaves less than a tenth of what the base alone leaves: nobody who knows the table
only could tell then that the effect is not in it. Mistakes in the data are not tried, being gross where they apply.

Of the nats that the best candidate of every effect leaves: an effect is *ahead* where every other leaves `CLEAR` nats
more than its own; else the effects that leave no more than `CLEAR` above it are its *class*, one law on these trials as
far as anybody can say.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from jaxtyping import Float

from geocontact.chain.effect import Candidate
from geocontact.chain.system import System
from geocontact.gap.case.refit import Measured, refit
from geocontact.gap_benchmark.synthetic.label import IdealTrial

Plain = Mapping[str, Any]
"""A label (`Label.as_dict`) or a diagnosis (diagnosis.json) as JSON has it."""
NONE, UNKNOWN = "none", "unknown"


def true_distribution(label: Plain) -> dict[str, float]:
    """Truth over single answers: a pair split equally, "none" also for what base parameters reproduce."""
    if label["kind"] == "outside":
        return {UNKNOWN: 1.0}
    if label["kind"] in ("none", "absorbed"):
        return {NONE: 1.0}
    return {name: 1.0 / len(label["effects"]) for name in label["effects"]}


def true_verdict(label: Plain) -> str:
    """Verdict that would be right."""
    return {"none": "no_gap", "absorbed": "no_gap", "outside": "unknown"}.get(label["kind"], "explained")


def oracle_answer(label: Plain) -> dict[str, Any]:
    """Diagnosis of somebody who reads the label."""
    verdict = true_verdict(label)
    named = list(label["effects"]) if verdict == "explained" else []
    gap = {}
    for channel, before in label["rmse_before"].items():
        gains = label["reduction"][channel] if named else 0.0
        gap[channel] = {
            "rmse_before": before,
            "rmse_after": label["rmse_after"][channel] if named else before,
            "noise_floor": label["floor"].get(channel),
            "reduction": gains,
            "ci95": [gains - 0.02, gains + 0.02],
            "unexplained": None,
        }
    return {
        "verdict": verdict,
        "effects": named,
        "probabilities": true_distribution(label),
        "ambiguity": named,
        "absorbed": list(label["effects"]) if label["kind"] == "absorbed" else [],
        "gap": gap,
        "seconds": 0.0,
    }


def constant_answer(labels: Iterable[Plain]) -> dict[str, Any]:
    """The same diagnosis for every case: base rates as probabilities, the commonest answer as verdict.

    It knows the mixture of cases, which is more than anyone does; so it is the best of those that do not look.
    """
    mixture: Counter[str] = Counter()
    known = list(labels)
    for label in known:
        mixture.update(true_distribution(label))
    total = sum(mixture.values()) or 1.0
    first = min(mixture, key=lambda name: (-mixture[name], name))
    named = [] if first in (NONE, UNKNOWN) else [first]
    channels = {channel for label in known for channel in label["rmse_before"]}
    return {
        "verdict": "explained" if named else {NONE: "no_gap", UNKNOWN: "unknown"}[first],
        "effects": named,
        "probabilities": {name: value / total for name, value in mixture.items()},
        "ambiguity": named,
        "absorbed": [],
        "gap": {channel: {"reduction": 0.0, "ci95": [0.0, 0.0]} for channel in sorted(channels)},
        "seconds": 0.0,
    }


LEFT = 0.1
"""Share of the visible energy."""
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
    """Effects that are not separable from the planted one on these trials, or are nearer; itself among them."""
    planted = label["effects"][0]
    return {name for name, cost in label["left"].items() if cost <= label["left"][planted] + CLEAR}
