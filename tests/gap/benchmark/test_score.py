import copy

import numpy as np
import pytest
from scipy.stats import binom

from geocontact.gap_benchmark.answers import constant_answer, oracle_answer, true_distribution
from geocontact.gap_benchmark.score import Rate, confidently_wrong, figures, score


def a_label(kind, effects=(), nats=100.0, reduction=0.5, **more):
    named = list(effects) or (["outside"] if kind == "outside" else [])
    return {
        "kind": kind,
        "effects": list(effects),
        "nats": dict.fromkeys(named, nats),
        "rmse_before": {"force": 1.0},
        "rmse_after": {"force": 1.0 - (reduction or 0.0)},
        "reduction": {"force": reduction},
        "floor": {"force": 0.2},
        "imitated": None,
        **more,
    }


LABELS = {
    **{f"none{i}": a_label("none", reduction=0.0) for i in range(20)},
    **{f"damping{i}": a_label("single", ["damping"]) for i in range(15)},
    **{f"slip{i}": a_label("shift", ["slip"], reduction=0.3) for i in range(10)},
    **{f"sign{i}": a_label("fault", ["sign_flip"], reduction=0.9) for i in range(5)},
    **{f"pair{i}": a_label("pair", ["damping", "sensor_drift"]) for i in range(10)},
    **{f"strange{i}": a_label("outside", reduction=None) for i in range(10)},
    **{f"hidden{i}": a_label("absorbed", ["preload"], nats=0.5, reduction=0.0) for i in range(10)},
}
ORACLE = {name: oracle_answer(label) for name, label in LABELS.items()}
RATES = (
    *("first_right", "in_small_set", "named_right", "both_found", "one_of_two"),
    *("unknown_called", "absorbed_recognised", "coverage"),
)


def test_an_oracle_has_every_figure_right():
    found = score(LABELS, ORACLE)
    for name in RATES:
        assert getattr(found, name).value == 1.0, name
    assert found.false_alarms.hits == found.confidently_wrong.hits == found.missed.hits == 0
    assert found.reduction_error == found.brier == found.brier_oracle == found.calibration_error == 0.0


def test_a_constant_answer_scores_badly():
    same = constant_answer(LABELS.values())
    found = score(LABELS, dict.fromkeys(LABELS, same))
    assert same["verdict"] == "no_gap"
    assert found.first_right.value == found.both_found.value == found.absorbed_recognised.value == 0.0
    assert found.missed.value == 1.0 and found.reduction_error > 0.2
    assert found.brier == found.brier_constant > 0.5


def test_base_rates_are_the_best_constant():
    truths = [true_distribution(label) for label in LABELS.values()]
    best = score(LABELS, dict.fromkeys(LABELS, constant_answer(LABELS.values()))).brier
    rng = np.random.default_rng(0)
    names = sorted({name for truth in truths for name in truth})
    for _ in range(20):
        p = dict(zip(names, rng.dirichlet(np.ones(len(names))), strict=True))
        other = {**constant_answer(LABELS.values()), "probabilities": p}
        assert score(LABELS, dict.fromkeys(LABELS, other)).brier >= best


def test_a_broken_label_changes_the_score():
    broken = copy.deepcopy(LABELS)
    broken["damping0"]["effects"] = ["relaxation"]
    broken["slip0"]["reduction"]["force"] = 0.8
    found = score(broken, ORACLE)
    assert found.first_right.hits == 29 and found.confidently_wrong.hits == 1
    assert found.reduction_error == pytest.approx(0.5 / 70)
    assert found.coverage.hits == found.coverage.count - 1
    assert found.brier == pytest.approx(2.0 / len(LABELS))


def answer(effects, p, ambiguity=None, verdict="explained"):
    return {"verdict": verdict, "effects": effects, "probabilities": p, "ambiguity": ambiguity or effects}


@pytest.mark.parametrize(
    ("label", "diagnosis", "wrong"),
    [
        (a_label("none"), answer(["damping"], {"damping": 0.9}), True),
        (a_label("none"), answer(["damping"], {"damping": 0.4, "none": 0.6}), False),
        (a_label("none"), answer([], {"damping": 0.9}, verdict="unresolved"), False),
        (a_label("single", ["slip"]), answer(["damping"], {"damping": 0.6}), True),
        (a_label("single", ["slip"]), answer(["damping"], {"damping": 0.6}, ["damping", "slip"]), False),
        (a_label("single", ["slip"]), answer(["damping"], {"damping": 0.6}, ["damping", "slip", "a", "b"]), True),
        (a_label("single", ["slip"]), answer(["slip", "damping"], {"slip": 0.45, "damping": 0.45}, ["damping"]), True),
        (a_label("pair", ["slip", "damping"]), answer(["slip"], {"slip": 0.9}), False),
        (a_label("outside"), answer(["slip"], {"slip": 0.9}), True),
        (a_label("outside", imitated=True), answer(["slip"], {"slip": 0.9}), False),
        (a_label("absorbed", ["preload"]), answer(["gravity_load"], {"gravity_load": 0.7}), True),
    ],
)
def test_what_counts_as_confidently_wrong(label, diagnosis, wrong):
    if label["effects"] == ["slip"] and len(diagnosis["effects"]) == 2:
        diagnosis = {**diagnosis, "effects": ["slip", "damping"], "ambiguity": ["damping", "x", "y"]}
    assert confidently_wrong(label, diagnosis) is wrong


def test_ranked_first_is_not_yet_named():
    said = {**ORACLE["damping0"], "verdict": "no_gap", "effects": [], "ambiguity": ["damping"]}
    found = score({"damping0": LABELS["damping0"]}, {"damping0": said})
    assert (found.first_right.hits, found.named_right.hits, found.missed.hits) == (1, 0, 1)


def test_an_effect_within_what_trials_differ_by_is_counted_apart():
    labels = {"a": a_label("single", ["damping"]), "b": a_label("single", ["preload"])}
    labels = {name: {**one, "nats_anew": nats} for (name, one), nats in zip(labels.items(), (60.0, 2.0), strict=True)}
    silent = {"verdict": "no_gap", "effects": [], "ambiguity": []}
    found = score(labels, {"a": oracle_answer(labels["a"]), "b": {**oracle_answer(labels["b"]), **silent}})
    assert (found.first_right.hits, found.first_right.count) == (1, 2)
    assert (found.first_right_anew.hits, found.first_right_anew.count) == (1, 1)
    assert (found.named_right_anew.hits, found.named_right_anew.count) == (1, 1)


def test_faint_effects_count_neither_for_nor_against():
    faint = {"a": a_label("single", ["damping"], nats=4.0)}
    found = score(faint, {"a": {**oracle_answer(faint["a"]), "verdict": "no_gap", "effects": [], "ambiguity": []}})
    assert found.first_right.count == found.missed.count == 0


def test_intervals_are_those_of_clopper_and_pearson():
    low, high = Rate(7, 50).interval()
    assert binom.sf(6, 50, low) == pytest.approx(0.025, rel=1e-6)
    assert binom.cdf(7, 50, high) == pytest.approx(0.025, rel=1e-6)
    assert Rate(0, 50).interval()[0] == 0.0 and Rate(50, 50).interval()[1] == 1.0
    assert Rate(0, 50).interval()[1] == pytest.approx(1.0 - 0.025 ** (1 / 50))


def test_stated_probabilities_are_held_against_what_came_true():
    labels = {f"c{i}": a_label("single", ["damping" if i < 6 else "slip"]) for i in range(10)}
    said = {**oracle_answer(labels["c0"]), "probabilities": {"damping": 0.8, "slip": 0.2}}
    found = score(labels, dict.fromkeys(labels, said))
    assert [(round(one.stated, 3), round(one.came_true, 3), one.count) for one in found.reliability] == [
        (0.2, 0.4, 10),
        (0.8, 0.6, 10),
    ]
    assert found.calibration_error == pytest.approx(0.2)


def test_a_case_without_a_diagnosis_is_named():
    with pytest.raises(KeyError, match="damping3"):
        score(LABELS, {name: one for name, one in ORACLE.items() if name != "damping3"})


def test_figures_are_plain():
    plain = figures(score(LABELS, ORACLE))
    assert plain["first_right"] == {"hits": 30, "count": 30, "ci95": [pytest.approx(0.884, abs=1e-3), 1.0]}
