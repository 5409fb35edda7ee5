"""From gains to an answer, on gains made up here."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.effects.catalogue import candidates
from geocontact.gap.contest import Contender
from geocontact.gap.evidence import Judged
from geocontact.gap.problem import Noise
from geocontact.gap.refit import Refit
from geocontact.gap.verdict import FORM, SURE, answer
from geocontact.identify.covariance import Levels
from geocontact.systems.catalogue import system_of
from tests.gap.cases import elbow_case

SYSTEM = system_of(elbow_case(duration=2.0))
OFFERED = {one.label: one for one in candidates(SYSTEM)}
SHARE = 0.6


def contender(nats: float, *labels: str) -> Contender:
    """A model that gains so much, on calibration trials as much as on the others."""
    one = np.ones(1)
    noise = Noise(Levels(one, one, one, one), one, 0.0, ())
    model = Refit(SYSTEM, dict(SYSTEM.start), [], [], np.zeros(10), np.zeros((10, 3)))
    judged = Judged(model, noise, nats, SHARE * nats, 6, [], np.zeros((10, 0)))
    return Contender(tuple(OFFERED[label] for label in labels), judged)


def said(*contenders: Contender, variants: dict[str, int] | None = None, unnamed: float = 0.0, strange: float = 0.0):
    counts = {one.name: 1 for one in OFFERED.values()} | (variants or {})
    return answer(contender(0.0), contenders, SHARE, unnamed, strange, {}, counts)


def test_a_gain_that_may_be_luck_is_no_gap() -> None:
    assert said(contender(SURE - 2.0, "damping")).verdict == "no_gap"
    assert said(contender(SURE + 6.0, "damping")).effects == ("damping",)


def test_variants_share_what_is_believed_of_their_effect() -> None:
    rivals = contender(30.0, "damping"), contender(30.0, "dry_friction.rate")
    even = said(*rivals).probabilities
    assert even["damping"] == pytest.approx(even["dry_friction"])
    odds = said(*rivals, variants={"dry_friction": 2}).probabilities
    assert odds["damping"] / odds["dry_friction"] == pytest.approx(2.0 ** (1.0 / (1.0 + 30.0 * FORM)), rel=0.01)


def test_a_second_effect_must_add_its_share() -> None:
    single, little = contender(200.0, "damping"), contender(216.0, "damping", "sensor_drift.force")
    assert said(single, little).effects == ("damping",)
    much = contender(300.0, "damping", "sensor_drift.force")
    assert set(said(single, much).effects) == {"damping", "sensor_drift"}


def test_of_two_that_are_named_the_likelier_comes_first() -> None:
    both = contender(120.0, "damping", "sensor_drift.force")
    found = said(contender(100.0, "sensor_drift.force"), both)
    assert found.probabilities["sensor_drift"] > found.probabilities["damping"]
    assert found.effects == found.ambiguity == ("sensor_drift", "damping")


def test_something_without_a_name_wins_where_it_gains_more() -> None:
    assert said(contender(20.0, "damping"), unnamed=90.0).verdict == "unknown"
    assert said(contender(90.0, "damping"), unnamed=20.0).effects == ("damping",)
    assert said(strange=40.0).verdict == "unknown"
