"""What somebody who knows the noise can tell: how far ahead the planted effect's own candidate is, and its class.

From the truth (`confounding.what_each_leaves`): nats that the best candidate of every effect leaves. An effect is
*ahead* where every other leaves `CLEAR` nats more than its own; else the effects that leave no more than `CLEAR` above
it are its *class*, one law on these trials as far as anybody can say.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from geocontact.chain.candidate import Candidate
from geocontact.chain.system import System
from geocontact.gap_benchmark.answers import Plain
from geocontact.gap_benchmark.confounding import what_each_leaves
from geocontact.gap_benchmark.synthetic.ideal import IdealTrial

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
