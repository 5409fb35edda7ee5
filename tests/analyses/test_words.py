"""Words that pages share."""

from __future__ import annotations

from geocontact.analyses.frame.words import headline


def test_a_headline_begins_with_the_answer_and_not_with_the_note_on_sides() -> None:
    said = ["medial is -z (right side, z to the right) of a.stl", "radius 26.7 mm over 2 mm^2", "two\nlines", "third"]
    assert headline(said) == (
        "Radius 26.7 mm over 2 mm².",
        "Third.",
        "Medial is -z (right side, z to the right) of a.stl.",
    )
    assert headline(said, 1) == ("Radius 26.7 mm over 2 mm².",)
