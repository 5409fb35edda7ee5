"""Short form of `benchmarks/prosthesis/design.py`."""

from __future__ import annotations

import pytest

from benchmarks.prosthesis.design import planted


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize("person", [0, 1])
def test_a_planted_fulcrum_is_within_its_interval_and_no_effect_is_not_told(person: int) -> None:
    """Both persons go the same way; the second one differs in the numbers that are drawn."""
    found = planted((person, "known", 3, 3))
    assert found.found("radius"), found.choices["radius"]
    assert not found.choices["loading_rate"].told
