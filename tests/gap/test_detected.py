"""Which effects are sure where nothing is named, by hand."""

from __future__ import annotations

from types import SimpleNamespace
from unittest.mock import Mock

import pytest

from geocontact.gap.attribute import Attribution
from geocontact.gap.detected import _sure
from geocontact.gap.levels import SURE
from geocontact.gap.selection.model_comparison import Contender
from tests.gap.test_verdict import contender


def sure(*contenders: Contender) -> list[str]:
    """Names of what is sure."""
    found = Mock(spec=Attribution)
    found.answer, found.base = SimpleNamespace(effects=()), contender(0.0)
    found.contenders, found.objections = contenders, {}
    return [one.name for one in _sure(found)]


@pytest.mark.parametrize(("rival", "names"), [(50.0 - 0.9 * SURE, []), (50.0 - 2.1 * SURE, ["damping"])])
def test_an_effect_with_a_rival_is_not_sure(rival: float, names: list[str]) -> None:
    """Gains of 50 nats ask for a lead of two times `SURE`."""
    assert sure(contender(50.0, "damping"), contender(rival, "slip")) == names


@pytest.mark.parametrize(("rival", "names"), [(95.0, ["damping"]), (60.0, ["damping", "slip"])])
def test_a_second_effect_leads_over_others_in_its_place(rival: float, names: list[str]) -> None:
    pairs = contender(100.0, "damping", "slip"), contender(rival, "damping", "stiffening")
    assert sure(contender(50.0, "damping"), *pairs) == names
