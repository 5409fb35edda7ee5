"""Changes between settings in sentences and in a table."""

from __future__ import annotations

from geocontact.analyses.prosthesis.compare.changes import change_words, changes_table
from geocontact.below_knee_prosthesis.setting_changes import StanceOutcome, setting_changes

PLACES = {"low": 0.066, "medium": 0.117, "high": 0.151}


def rows(name: str, *off: float) -> list[StanceOutcome]:
    """Two persons at three settings: measured 1.0, 1.2 and 1.5, predicted off by these."""
    found = []
    for person, more in (("A", 0.0), ("B", 0.1)):
        for (setting, place), seen, each in zip(PLACES.items(), (1.0, 1.2, 1.5), off, strict=True):
            found.append(StanceOutcome(name, person, setting, place, seen + more + each, seen))
    return found


def test_the_widest_pair_is_said_with_the_model_s_error() -> None:
    """A person's bias cancels: predicted +0.52 for +0.50; errors of 0.02 and less tell it from 0."""
    found = setting_changes(rows("largest ankle moment", 0.00, 0.01, 0.02))
    (line,) = change_words(found)
    assert line == (
        "low to high: largest ankle moment +0.52 N m/kg predicted, +0.50 measured (2 persons): 2 of 2 within the "
        "interval, 0 below the model's error"
    )
    table = changes_table(found)
    assert len(table) == 6 and set(table["verdict"]) == {"predicted"}


def test_a_model_that_errs_more_than_it_predicts_says_so() -> None:
    found = setting_changes(rows("largest vertical force", 0.9, -0.6, 0.4))
    (line,) = change_words(found)
    assert line.endswith("0 of 2 within the interval, 2 below the model's error")


def test_one_setting_has_no_change() -> None:
    assert changes_table(setting_changes(rows("stance time", 0.0, 0.0, 0.0)[:1])).empty and change_words([]) == []
