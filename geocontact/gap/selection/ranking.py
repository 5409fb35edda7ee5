"""Every model that was tried, by its gain."""

from __future__ import annotations

from collections.abc import Mapping

from geocontact.data.ranked import Ranked
from geocontact.gap.attribute import Attribution


def ranking(found: Attribution, probabilities: Mapping[str, float]) -> tuple[Ranked, ...]:
    """Every model that was tried, the base, and the surrogate of anything unknown; the largest gain first."""
    zero, unknown = found.base.judged, found.remaining["none"]
    rows = [
        Ranked("none", "none", 0.0, 0.0, probabilities.get("none", 0.0)),
        Ranked("unknown", "unknown", unknown.nats, unknown.calibration, probabilities.get("unknown", 0.0)),
    ]
    for one in sorted(found.contenders, key=lambda c: -c.nats):
        gain, calibration = one.nats - zero.nats, one.judged.calibration - zero.calibration
        first = len(one.names) == 1 and not any(row.effects == one.names[0] for row in rows)
        probability = probabilities.get(one.names[0], 0.0) if first else None
        rows.append(Ranked(one.label, " + ".join(one.names), gain, calibration, probability))
    return tuple(sorted(rows, key=lambda row: -row.gain))
