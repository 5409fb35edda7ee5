"""What is warned of a phase: one term that is all of the cost, a better minimum elsewhere, numbers not told."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from geocontact.analyses.run_record import Record
from geocontact.analyses.sit_to_stand.calibrate.run import _doubt
from geocontact.standing_up.other_minima import Ended
from tests.unchecked import unchecked

BEST, SAME, WORSE = Ended(1.0, True, True), Ended(1.0005, True, True), Ended(3.0, True, False)


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
        "ends": (BEST,),
        "misfit": 0.8,
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
        ({"ends": (WORSE, BEST)}, "ends in a minimum that another start beats"),
        ({"ends": (Ended(2.0, False, False), BEST)}, "ends in a minimum that another start beats"),
        ({"ends": (Ended(1.0005, True, False), BEST)}, "ends in a minimum that another start beats"),
        ({"misfit": 1.74}, "phase A leaves 1.7 times the squares that the noise makes"),
        ({"verdict": "not separable"}, "not separable, with intervals that cover both: heel"),
        ({"verdict": "on its bound"}, "on its bound, so that the value says where the bound is: heel"),
        ({"verdict": "believed"}, "tell little more than what was believed of heel"),
        ({"doubt": "it is singular"}, "phase A has no intervals: it is singular"),
    ],
)
def test_what_changes_how_numbers_are_read_is_warned_of(other: dict[str, object], words: str) -> None:
    assert any(words in line for line in doubts(**other)[1])


def test_nothing_to_doubt_is_not_warned_of() -> None:
    said, warned = doubts(ends=(BEST, SAME, WORSE))
    assert not warned and said == ["phase A: 2 of 3 starts end in the best minimum, 3 in one"]
