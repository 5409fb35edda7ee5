"""What is stated of what was computed."""

from __future__ import annotations

from dataclasses import replace

import pytest

from geocontact.gap.selection.verdict import (
    NAMED,
    QUESTIONED,
    SILENT,
    Answer,
    answer,
    ranking,
    with_lapses,
    with_refused,
)
from tests.gap.test_verdict import OFFERED, contender, shares

EFFECTS = {one.name for one in OFFERED.values()}


def said(nats: float, refused: tuple[str, ...] = ()) -> Answer:
    """With a damper that gains so much, and may not be named."""
    damper = contender(nats, "damping")
    counts = {one.name: 1 for one in OFFERED.values()}
    weighed = [ranking(contender(0.0), [damper], shares(damper), counts, names) for names in (refused, ())]
    return with_refused(answer(weighed[0], 0.0, 0.0, 0.0), weighed[1])


@pytest.mark.parametrize(("nats", "rate"), [(-4.0, SILENT), (500.0, NAMED)])
def test_the_rate_is_shared_by_all_answers_that_there_are(nats: float, rate: float) -> None:
    before = said(nats)
    found = with_lapses(before, EFFECTS)
    assert (found.verdict, found.effects, found.ambiguity) == (before.verdict, before.effects, before.ambiguity)
    assert set(found.probabilities) == {"none", "unknown"} | EFFECTS
    assert sum(found.probabilities.values()) == pytest.approx(1.0)
    every = len(found.probabilities)
    assert found.probabilities["slip"] == pytest.approx(rate * (0.5 if before.effects else 1.0) / every, rel=1e-3)
    assert max(found.probabilities, key=lambda name: found.probabilities[name]) == ("damping" if nats > 0 else "none")


def test_what_gains_and_may_not_be_named_is_not_impossible() -> None:
    before = said(500.0, ("damping",))
    assert before.verdict == "no_gap" and before.ambiguity == ("damping",)
    assert before.probabilities.get("damping", 0.0) < 1e-3
    stated = with_lapses(before, EFFECTS).probabilities
    """The guess is shared by it and none, so that no gap stays the likeliest."""
    assert stated["none"] > stated["damping"] > QUESTIONED / 4.0
    assert stated["none"] == pytest.approx(1.0 - 0.75 * QUESTIONED, abs=QUESTIONED / len(stated))
    unknown = replace(before, verdict="unknown", probabilities={"unknown": 1.0})
    assert with_lapses(unknown, EFFECTS).probabilities["unknown"] > 1.0 - SILENT
