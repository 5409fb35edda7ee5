"""The Makefile names folders of tests that are there; a renamed one is told here, not by the last step of CI."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")

ELSEWHERE = {"not oracle", "not real"}
TOGETHER = {"shapes": {"not slow"} | ELSEWHERE, "rest": {"not shapes", "not long"} | ELSEWHERE}
"""What `make shapes` and `make rest` leave out; together nothing but what is long or needs what is not here."""


def test_rooms_whose_shapes_are_checked_are_there() -> None:
    listed = re.search(r"^SHAPES := ((?:.*\\\n)*.*)$", MAKEFILE, re.MULTILINE)
    assert listed is not None
    rooms = listed[1].replace("\\\n", " ").split()
    assert len(rooms) > 10
    assert [room for room in rooms if not (ROOT / "tests" / room).exists()] == []


def test_what_ci_leaves_out_was_run_before_with_checks() -> None:
    """`make rest` leaves out the quick tests of the rooms of `make shapes`, and .ci/run runs both, in this order."""
    recipes = re.findall(r"^(\w+): .*\n((?:\t.*\n)+)", MAKEFILE, re.MULTILINE)
    marks = {name: re.findall(r'-m "([^"]*)"', lines)[0].split(" and ") for name, lines in recipes if name in TOGETHER}
    assert {name: set(words) for name, words in marks.items()} == TOGETHER
    assert 'GEOCONTACT_CHECKED="$(SHAPES)"' in MAKEFILE and "$(addprefix tests/,$(SHAPES))" in MAKEFILE
    steps = re.findall(r"^make (\w+)", (ROOT / ".ci" / "run").read_text(encoding="utf-8"), re.MULTILINE)
    assert steps[:2] == ["shapes", "rest"]
