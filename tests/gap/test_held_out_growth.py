"""Nothing is named that predicts held-out trials worse than the base model does."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.data.gap_case import GapCase
from geocontact.gap import held_out_growth
from geocontact.gap.attribute import Attribution
from geocontact.gap.data_errors import DataError
from geocontact.gap.held_out_growth import confirmed, growth
from geocontact.gap.reduction.raw_input_errors import RawInputErrors
from geocontact.gap.remarks import objection
from tests.cli.gap_cases import diagnosed_elbow

pytestmark = pytest.mark.slow

Found = tuple[GapCase, Attribution, RawInputErrors]


@pytest.fixture(scope="module")
def found() -> Found:
    """Damping of an elbow, named, and the errors of base model and answer."""
    result = diagnosed_elbow()
    attribution = result.findings.attribution
    return result.case, attribution, held_out_growth.errors_of(attribution)


def made_worse(errors: RawInputErrors, times: float) -> RawInputErrors:
    """Errors of the base model, with what is named so many times those."""
    return replace(errors, after=[times * part for part in errors.before])


def quiet(_: str) -> None:
    """Nobody listens."""


def test_growth_is_the_ratio_of_the_errors_on_held_out_trials(found: Found) -> None:
    """One channel: its unit does not matter, and trials that were fitted to do not count."""
    _, attribution, errors = found
    held = len(attribution.problem.calibration.trials)
    rms = [np.sqrt(sum(np.sum(p**2) for p in parts[held:])) for parts in (errors.before, errors.after)]
    assert growth(attribution, errors) == pytest.approx(rms[1] / rms[0]) and rms[1] < rms[0]
    assert growth(attribution, made_worse(errors, 36.0)) == pytest.approx(36.0)


def test_an_answer_that_shrinks_the_error_stays(found: Found) -> None:
    case, attribution, _ = found
    assert confirmed(case, attribution, quiet)[0] is attribution


def test_an_effect_with_which_the_error_grows_is_not_named(found: Found, monkeypatch: pytest.MonkeyPatch) -> None:
    case, attribution, errors = found
    monkeypatch.setattr(held_out_growth, "raw_input_errors", lambda *_: made_worse(errors, 36.0))
    kept, _ = confirmed(case, attribution, quiet)
    said, before = kept.answer, attribution.answer
    assert before.verdict == "explained" and said.verdict == "unknown" and said.effects == ()
    assert "damping" not in said.ambiguity and said.probabilities["damping"] == 0.0
    assert sum(said.probabilities.values()) == pytest.approx(1.0)
    assert said.probabilities["unknown"] > 0.9
    assert said.chosen is kept.base
    (why,) = objection(kept)
    assert why.startswith("damping gains ") and "held-out trials is 36 times that of the base model" in why


def test_a_mistake_with_which_the_error_grows_is_not_undone(found: Found, monkeypatch: pytest.MonkeyPatch) -> None:
    """The contest is held again with the data as they came, and without mistakes to choose from."""
    case, attribution, errors = found
    wrong = replace(attribution, data_error=DataError(attribution.contenders[0].candidates[0], ("t01",), 0.5))
    asked = []

    def again(given: GapCase, system: object, offer: held_out_growth.Offer, at: object) -> Attribution:
        asked.append([one for one in offer(attribution.problem.system) if one.somewhere is not None])
        return attribution

    monkeypatch.setattr(held_out_growth, "attribute", again)
    answers = iter([made_worse(errors, 1.5), errors])
    monkeypatch.setattr(held_out_growth, "raw_input_errors", lambda *_: next(answers))
    assert confirmed(case, wrong, quiet)[0] is attribution
    assert asked == [[]]
