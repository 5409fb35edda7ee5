"""Words of the pages of a prosthesis: what the first screen answers, and tables that a reader understands."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from geocontact.analyses.prosthesis.calibrate.show import CalibratedFit, answer, numbers_in_words
from geocontact.analyses.prosthesis.compare.show import answer as compared
from geocontact.analyses.prosthesis.compare.show import in_words
from geocontact.analyses.prosthesis.design.show import answers_in_words, best_words, others_words
from geocontact.below_knee_prosthesis.design.choice import FootChoice, Side
from geocontact.below_knee_prosthesis.design.knob import RESPONSES, Knob
from geocontact.below_knee_prosthesis.design.sweep import AimAnswer, Sweep
from geocontact.identify.signals.agreement import Agreement

NAN = float("nan")
SWEEP = Sweep(Knob("fulcrum", np.array([0.066, 0.1, 0.151]), 0.117), np.ones((2, 3, 3, 5)), np.ones((2, 3, 3, 5)), 0.95)


def summary(others: float = 0.12) -> pd.DataFrame:
    """Three stances: force nearer than both on one, centre on all, moment on two."""
    rows = []
    for name, rmse, better in (("resultant", 0.107, 1), ("cop_ground", 0.016, 3), ("ankle_moment", 0.1, 2)):
        predictors = {"mean of the others rmse": others, "another rmse": others}
        rows.append({"setting": "all", "quantity": name, "r2 [-]": 0.9, "rmse": rmse, **predictors, "better": better})
    return pd.DataFrame(rows).assign(trials=3)


def choice(told: bool, best: float, verdict: str) -> FootChoice:
    """The same in all responses."""
    sides = {response: Side(best, best - 0.01, best, verdict) for response in RESPONSES}
    return FootChoice(sides, told, best, best - 0.01, best, {}, "with torque kept it has no effect")


def test_a_comparison_answers_on_how_many_stances_the_model_is_nearer() -> None:
    first, second = compared(summary())
    assert first == (
        "The model is nearer to the plate than both baseline predictors on 1 of 3 (resultant force), 3 of 3 (centre of "
        "pressure), 2 of 3 (ankle moment)."
    )
    assert "the resultant force by 10.7 % BW, the centre of pressure by 1.6 % of the foot" in second


def test_without_another_stance_there_is_no_predictor() -> None:
    first, second = compared(summary(NAN))
    assert first.startswith("The model misses the resultant force by 10.7 % BW") and "no other stance" in second


def test_tables_have_words_and_no_empty_columns() -> None:
    rows = pd.DataFrame(
        {"quantity": ["cop_ground", "fore_aft"], "r2 sd": [NAN, NAN], "better": [True, False], "what is seen": ["", ""]}
    )
    shown = in_words(rows)
    assert list(shown.columns) == ["quantity", "better"]
    assert shown.to_numpy().tolist() == [["centre of pressure", "yes"], ["fore-aft force", "no"]]


@pytest.mark.parametrize(("exponent", "unit"), [(1.0, "N/m"), (1.3, "N/m^1.3")])
def test_numbers_of_a_sole_have_their_exponent_and_no_powers_of_ten(exponent: float, unit: str) -> None:
    rows = pd.DataFrame(
        {"number": ["stiffness.heel_back", "foot.height"], "unit": ["N/m^n", "m"], "value": [16443.03, -8.24e-4]}
    ).assign(verdict=["known", "known"], lower=[NAN, NAN])
    shown = numbers_in_words(rows, exponent)
    assert shown["number"].tolist() == ["stiffness, heel back", "foot, height"]
    assert shown["unit"].tolist() == [unit, "m"] and shown["value"].tolist() == ["16400", "-0.000824"]
    fit = CalibratedFit(
        Agreement(0.0, 0.0573, 0.0, 0.97, 0.0, 1.0, 9),
        Agreement(0.0, 0.016, 0.0, 1.0, 0.0, 1.0, 9),
        "is met",
        "1 mm",
        1.0,
    )
    assert answer(fit, rows)[0].endswith("the stance identifies 1 of 1 of its numbers.")


def test_a_best_value_at_the_end_of_the_range_says_so() -> None:
    most = AimAnswer("ankle_moment", None, choice(True, 0.151, "identified"))
    middle = AimAnswer("energy", None, choice(True, 0.1, "identified"))
    none = AimAnswer("loading_rate", None, choice(False, NAN, "no effect"))
    assert best_words(most, SWEEP) == "151 mm (141 to 151 mm, the end of the range)"
    assert best_words(middle, SWEEP) == "100 mm (90 to 100 mm)"
    assert best_words(none, SWEEP) == "no effect"
    (line,) = others_words([most, middle, none], "radius", SWEEP)
    assert line.startswith("Identified for other aims: peak ankle moment, the least: 151 mm") and "loading" not in line
    shown = answers_in_words([most, none], SWEEP)
    assert list(shown.columns)[:5] == ["outcome", "wanted", "best fulcrum", "better than 117 mm", "why"]
    assert shown["better than 117 mm"].tolist() == ["not shown", ""]
