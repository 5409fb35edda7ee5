"""What is said of a stance whose simulation ends before toe-off: a number that there is none of is not printed."""

from __future__ import annotations

import numpy as np

from geocontact.analyses.json_file import plain
from geocontact.analyses.prosthesis.simulate.result import (
    beside_words,
    curves_table,
    doubt,
    errors_table,
    found_words,
    summary,
)
from geocontact.analyses.run_record import Record
from geocontact.below_knee_prosthesis.stance_errors import stance_errors
from tests.below_knee_prosthesis.stances import a_stance
from tests.below_knee_prosthesis.test_stance_errors import plate_of, walked


def test_a_simulation_that_ends_before_toe_off_says_so() -> None:
    own, seen = np.arange(0.0, 0.662, 0.002), np.arange(-0.2, 1.2, 0.002)
    found = a_stance(own, walked(own))
    errors, told, record = stance_errors(found, plate_of(seen)), summary(found), Record("prosthesis simulate", {})
    doubt(found, record)
    assert any("still on the floor" in line and "0.66 s" in line for line in record.warnings)
    words = [found_words(found, told), beside_words(errors), *record.warnings]
    assert not any("nan" in line for line in words), words
    assert "not over after 0.55 s" in words[0]
    assert "over the first 80% of the plate's stance" in words[1]
    assert plain(told)["stance_s"] is None
    table = errors_table(errors).set_index("quantity")
    assert np.isnan(table.loc["stance", "rmse"])
    assert curves_table(errors)["vertical [-]"].isna().sum() > 15


def test_a_whole_stance_has_its_length() -> None:
    own = np.arange(0.0, 0.95, 0.002)
    found, record = a_stance(own, walked(own)), Record("prosthesis simulate", {})
    doubt(found, record)
    assert not any("still on the floor" in line for line in record.warnings)
    assert found_words(found, summary(found)).startswith("stance of 0.69 s at the fulcrum of 117 mm")
    assert beside_words(stance_errors(found, plate_of(own))).endswith("stance +0 ms")
