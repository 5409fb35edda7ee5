"""What is warned of a phase: one term that is all of the cost, a better minimum elsewhere, numbers not told."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from geocontact.analyses.run_record import Record
from geocontact.analyses.sit_to_stand.calibrate.run import _doubt
from tests.unchecked import unchecked


def doubts(**other: object) -> tuple[list[str], list[str]]:
    """Sentences and warnings of a phase without anything to doubt but what is given."""
    numbers = SimpleNamespace(numbers=(SimpleNamespace(name="heel", verdict=other.pop("verdict", "known")),))
    one = {
        "name": "A",
        "found": SimpleNamespace(solved=True, ending="solved", motions=()),
        "doubt": "",
        "motions": (),
        "numbers": numbers,
        "shares": {"force": 0.5, "rates": 0.5},
        "ends": ((1.0, True),),
    }
    record = Record("sit-to-stand calibrate", {})
    with unchecked():
        _doubt(record, SimpleNamespace(**(one | other)))  # type: ignore[arg-type]
    return list(record.sentences), list(record.warnings)


@pytest.mark.filterwarnings("ignore::geocontact.InputWarning")
@pytest.mark.parametrize(
    ("other", "words"),
    [
        ({"shares": {"force": 0.995, "rates": 0.005}}, "99.5 % of the cost are force"),
        ({"ends": ((2.0, True), (1.0, True))}, "ends in a minimum that another start beats"),
        ({"ends": ((2.0, False), (1.0, True))}, "ends in a minimum that another start beats"),
        ({"verdict": "on its bound"}, "on its bound, so that the value says where the bound is: heel"),
        ({"verdict": "believed"}, "tell little more than what was believed of heel"),
        ({"doubt": "it is singular"}, "phase A has no intervals: it is singular"),
    ],
)
def test_what_changes_how_numbers_are_read_is_warned_of(other: dict[str, object], words: str) -> None:
    assert any(words in line for line in doubts(**other)[1])


def test_nothing_to_doubt_is_not_warned_of() -> None:
    said, warned = doubts(ends=((1.0, True), (1.0005, True), (3.0, True)))
    assert not warned and said == ["phase A: 2 of 3 starts end in the best minimum, 3 in one"]
