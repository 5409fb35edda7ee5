"""Whether an answer does harm: names an effect that predicts held-out trials worse.

From what diagnosis.json says itself. A channel is *significantly worse* where its held-out error grows by more than
half the width of the interval that is stated for its reduction, and by more than `LEAST`; an answer is *worse in the
sum* where the squared held-out errors of all channels, in units of their true floors, sum to more than before.
"""

from __future__ import annotations

from collections.abc import Iterator

from geocontact.gap_benchmark.answers import NONE, Plain

LEAST = 0.01
"""Growth of an error below which nobody cares."""
SURE = 0.9
"""Probability from which on a false claim is a certain one."""


def worse_channels(label: Plain, diagnosis: Plain) -> list[str]:
    """Channels that a named effect makes significantly worse; none where nothing is named."""
    found = []
    for channel, _, ratio in _named(label, diagnosis):
        low, high = diagnosis["gap"][channel].get("ci95") or (0.0, 0.0)
        if ratio - 1.0 > max(0.5 * (high - low), LEAST):
            found.append(channel)
    return found


def worse_in_sum(label: Plain, diagnosis: Plain) -> bool:
    """Whether a named effect makes the sum over channels worse."""
    squares = [(before / label["floor"][channel]) ** 2 for channel, before, _ in _named(label, diagnosis)]
    ratios = [ratio for *_, ratio in _named(label, diagnosis)]
    return bool(sum(s * r * r for s, r in zip(squares, ratios, strict=True)) > sum(squares))


def harmful(label: Plain, diagnosis: Plain) -> bool:
    """Either of them."""
    return bool(worse_channels(label, diagnosis)) or worse_in_sum(label, diagnosis)


def certainty(diagnosis: Plain) -> float:
    """Largest probability of anything but "none": of a single answer, or of what is named together."""
    stated = diagnosis["probabilities"]
    together = sum((float(stated.get(name, 0.0)) for name in diagnosis["effects"]), 0.0)
    return max([together, *(float(p) for name, p in stated.items() if name != NONE)])


def _named(label: Plain, diagnosis: Plain) -> Iterator[tuple[str, float, float]]:
    """Channel, error before, and after over before, where an effect is named; the true error where none is stated."""
    if not diagnosis["effects"]:
        return
    for channel, gap in diagnosis["gap"].items():
        before, after = gap.get("rmse_before"), gap.get("rmse_after")
        if before and after is not None:
            yield channel, float(before), float(after) / float(before)
        elif label["rmse_before"].get(channel):
            yield channel, float(label["rmse_before"][channel]), 1.0 - float(gap["reduction"])
