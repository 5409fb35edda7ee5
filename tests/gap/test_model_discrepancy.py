"""What an effect may do otherwise than its candidate: worth a set share of its energy, and only where it is needed."""

from __future__ import annotations

import pytest

from geocontact.gap.selection.model_comparison import BENT
from tests.elsewhere import Elsewhere
from tests.gap.cases import evidence_of_bends


def test_bends_are_worth_a_set_share_of_the_effect_and_a_mistake_has_none(elsewhere: Elsewhere) -> None:
    gain, share, of_a_mistake = elsewhere(evidence_of_bends, 0.0)
    assert share == pytest.approx(BENT**2, rel=1e-6)
    assert of_a_mistake == 0
    assert -20.0 < gain < 4.0


def test_an_effect_that_leans_is_still_that_effect(elsewhere: Elsewhere) -> None:
    gain, _, _ = elsewhere(evidence_of_bends, 0.4)
    assert gain > 10.0
