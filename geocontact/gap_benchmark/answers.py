"""What the truth looks like as an answer, and the two answerers that bound every score: constant and oracle."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Any

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
