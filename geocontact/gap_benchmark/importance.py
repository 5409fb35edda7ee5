"""Figures of a diagnosis by the importance of what is withheld: what it makes of the error on fresh trials.

*Importance* is the largest true reduction of a channel's error; of what has no name, of the part of the error above the
true floor. From `LARGE` on an effect is what somebody gains by a diagnosis, from `SMALL` on it should be detected.
*Named*: the one effect that is there is named, or one that the diagnosis says these trials cannot distinguish from it;
*wrong*: something is named that is neither. *Both*, *one right* and *no wrong name* are of pairs. *Unknown or in part*:
of what has no name in the table; *strange wrong*: something is named where nothing is missing, or nothing that has a
name. *Inside*: the true share of the squared error that an effect takes lies in its
interval, channel by channel, where what is named is right; *closed*: shares add to 1 ± `CLOSED`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from geocontact.gap_benchmark.answers import Plain
from geocontact.gap_benchmark.score import GAPS, Rate

LARGE, SMALL = 0.05, 0.01
"""Share of the error."""
CLOSED = 0.02


def importance(label: Plain) -> float:
    """Largest share of a channel's error that what is withheld makes; 0 where nothing is."""
    if label["kind"] == "outside":
        pairs = ((label["floor"][name], before) for name, before in label["rmse_before"].items())
        return max((1.0 - floor / before for floor, before in pairs if before), default=0.0)
    return max((value for value in label["reduction"].values() if value is not None), default=0.0)


def taken_for(said: Plain) -> set[str]:
    """What is named, and what the diagnosis says these trials cannot distinguish from it."""
    classes = [set(one) for one in said.get("one_law") or () if set(one) & set(said["effects"])]
    return set(said["effects"]).union(*classes)


def named(label: Plain, said: Plain) -> bool:
    """Whether as many effects are named as there are, each of them or its class."""
    return len(said["effects"]) == len(label["effects"]) and set(label["effects"]) <= taken_for(said)


def wrong(label: Plain, said: Plain) -> bool:
    """Whether something is named that is not there, nor in one class with what is."""
    classes = [set(one) for one in said.get("one_law") or ()]
    true = set(label["effects"]) if label["kind"] != "outside" else set()
    alike = true.union(*(one for one in classes if one & true))
    return not set(said["effects"]) <= alike


def by_importance(pairs: Sequence[tuple[Plain, Plain]]) -> dict[str, Rate]:
    """Rates by name, of labels and diagnoses."""
    one = [(a, b, importance(a)) for a, b in pairs if a["kind"] in GAPS]
    large = [(a, b) for a, b, size in one if size >= LARGE]
    small = [(a, b) for a, b, size in one if SMALL <= size < LARGE]
    two = [(a, b) for a, b in pairs if a["kind"] == "pair" and importance(a) >= LARGE]
    strange = [b for a, b in pairs if a["kind"] == "outside" and not a.get("imitated") and importance(a) >= LARGE]
    unnamed = [(a, b) for a, b in pairs if a["kind"] == "none" or (a["kind"] == "outside" and not a.get("imitated"))]
    return {
        "large_named": Rate.of(named(a, b) for a, b in large),
        "large_wrong": Rate.of(wrong(a, b) for a, b in large),
        "small_detected": Rate.of(set(a["effects"]) <= _seen(b) for a, b in small),
        "pair_both": Rate.of(named(a, b) for a, b in two),
        "pair_one": Rate.of(bool(set(a["effects"]) & taken_for(b)) for a, b in two),
        "pair_no_wrong": Rate.of(not wrong(a, b) for a, b in two),
        "strange_unknown": Rate.of(b["verdict"] in ("unknown", "partly_explained") for b in strange),
        "strange_wrong": Rate.of(wrong(a, b) for a, b in unnamed),
        "budget_inside": Rate.of(held for a, b in pairs for held in _inside(a, b)),
        "budget_closed": Rate.of(closed for _, b in pairs for closed in _closed(b)),
    }


def _seen(said: Plain) -> set[str]:
    return taken_for(said) | {each["effect"] for each in said.get("detected") or ()}


def _inside(label: Plain, said: Plain) -> Iterator[bool]:
    if not label["effects"] or not named(label, said):
        return
    for channel, parts in (said.get("budget") or {}).items():
        before, after = label["rmse_before"].get(channel), label["rmse_after"].get(channel)
        if before and after is not None:
            low, high = parts["effects"]["ci95"]
            yield low <= 1.0 - (after / before) ** 2 <= high


def _closed(said: Plain) -> Iterator[bool]:
    for parts in (said.get("budget") or {}).values():
        yield abs(sum(part["share"] for part in parts.values()) - 1.0) <= CLOSED
