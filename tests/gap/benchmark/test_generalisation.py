"""Figures at home and abroad on labels and diagnoses made up here."""

from __future__ import annotations

import math
from typing import Any

import pytest

from geocontact.gap_benchmark.answers import ahead_by, clearly_ahead, one_law
from geocontact.gap_benchmark.generalisation import Loss, figures_of, log_score, losses
from geocontact.gap_benchmark.score import Rate


def label(effect: str, left: dict[str, float]) -> dict[str, Any]:
    kind = "single" if effect else "none"
    return {
        "kind": kind,
        "effects": [effect] if effect else [],
        "nats": {effect: 50.0} if effect else {},
        "reduction": {"force": 0.5 if effect else 0.0},
        "rmse_before": {"force": 2.0},
        "rmse_after": {"force": 1.0},
        "floor": {"force": 1.0},
        "left": left,
    }


def said(probabilities: dict[str, float], verdict: str, *named: str, ci: tuple[float, float] = (0.4, 0.6)) -> Any:
    gap = {"force": {"rmse_before": 2.0, "rmse_after": 1.0, "reduction": 0.5 if named else 0.0, "ci95": list(ci)}}
    return {
        "verdict": verdict,
        "effects": list(named),
        "ambiguity": list(named),
        "probabilities": probabilities,
        "gap": gap,
        "seconds": 3.0,
    }


AHEAD = label("damping", {"damping": 2.0, "filter_lag": 9.0, "slip": 40.0})
BESIDE = label("damping", {"damping": 2.0, "filter_lag": 3.0, "slip": 40.0})


def test_an_effect_is_ahead_or_one_of_a_class() -> None:
    assert ahead_by(AHEAD) == 7.0 and clearly_ahead(AHEAD) and one_law(AHEAD) == {"damping"}
    assert ahead_by(BESIDE) == 1.0 and not clearly_ahead(BESIDE) and one_law(BESIDE) == {"damping", "filter_lag"}
    assert ahead_by(label("", {})) is None and ahead_by({**AHEAD, "left": None}) is None


def test_a_class_named_right_counts_where_two_effects_are_one_law() -> None:
    right = said({"damping": 1.0}, "explained", "damping")
    other = said({"filter_lag": 1.0}, "explained", "filter_lag")
    far = said({"slip": 1.0}, "explained", "slip")
    found = figures_of([(AHEAD, right), (AHEAD, other), (BESIDE, other), (BESIDE, far)])
    assert found.shares["ahead"] == Rate(2, 4)
    assert found.shares["first_ahead"] == found.shares["set_ahead"] == Rate(1, 2)
    assert found.shares["class_elsewhere"] == Rate(1, 2)
    assert found.numbers["seconds_median"] == 3.0 and found.shares["coverage"] == Rate(4, 4)


def test_a_class_that_is_stated_holds_the_truth_or_not() -> None:
    """Named: of singles that nobody can tell apart; right: of all that state classes, whatever was planted."""
    one_name = {**said({"filter_lag": 1.0}, "explained", "filter_lag"), "one_law": [["filter_lag", "damping"]]}
    no_class = said({"filter_lag": 1.0}, "explained", "filter_lag")  # as before there were classes
    truth = {**said({"damping": 1.0}, "explained", "damping"), "one_law": []}
    two_names = {**said({"damping": 1.0}, "explained", "filter_lag", "slip"), "one_law": [["filter_lag", "damping"]]}
    wrong = {**said({"slip": 1.0}, "explained", "slip"), "one_law": [["slip", "filter_lag", "play"]]}
    found = figures_of([(BESIDE, each) for each in (one_name, no_class, truth, two_names, wrong)])
    assert found.shares["class_named"] == Rate(2, 5)  # one_name and truth
    assert found.shares["class_right"] == Rate(2, 3)  # one_name and two_names
    assert found.numbers["class_size"] == pytest.approx((2 + 2 + 3) / 3)
    assert math.isnan(figures_of([(BESIDE, truth)]).numbers["class_size"])


def test_every_class_that_is_stated_must_hold_something_planted() -> None:
    both = {
        **label("damping", {}),
        "kind": "pair",
        "effects": ["damping", "slip"],
        "nats": {"damping": 9.0, "slip": 9.0},
    }
    one = {**said({}, "explained", "filter_lag"), "one_law": [["filter_lag", "damping"]]}
    two = {**said({}, "explained", "filter_lag", "play"), "one_law": [["filter_lag", "damping"], ["play", "slip"]]}
    half = {**two, "one_law": [["filter_lag", "damping"], ["play", "end_stop"]]}
    found = figures_of([(both, one), (both, two), (both, half), (label("", {}), one), (AHEAD, one)])
    assert found.shares["class_right"] == Rate(3, 5), "in a case that lacks nothing no class is right"
    assert found.shares["class_named"] == Rate(0, 0), "ahead is not asked, nor what is no single effect"
    assert found.numbers["class_size"] == 2.0


def test_the_log_score_is_nothing_for_the_constant_answer_and_one_for_certainty() -> None:
    pairs = [label("damping", {}), label("", {})]
    certain = [said({"damping": 1.0}, "explained", "damping"), said({"none": 1.0}, "no_gap")]
    constant = said({"damping": 0.5, "none": 0.5}, "no_gap")
    assert log_score(list(zip(pairs, certain, strict=True))) == pytest.approx(1.0)
    assert log_score([(one, constant) for one in pairs]) == pytest.approx(0.0)
    assert log_score([(one, said({"slip": 1.0}, "explained", "slip")) for one in pairs]) < -5.0


def test_the_loss_is_home_less_abroad_with_an_interval_that_holds_it() -> None:
    one = Loss.of(Rate(45, 50), Rate(30, 50))
    assert one.points == pytest.approx(0.3) and 0.0 < one.low < 0.3 < one.high
    few = Loss.of(Rate(4, 5), Rate(3, 5))
    assert few.low < 0.0 < few.high
    home, abroad = (figures_of([(label("", {}), said({}, verdict))]) for verdict in ("no_gap", "unknown"))
    assert losses(home, abroad)["false_alarms"].points == -1.0
