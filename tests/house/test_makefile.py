"""The Makefile names folders of tests that are there; a renamed one is told here, not by the last step of CI."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")


def test_rooms_whose_shapes_are_checked_are_there() -> None:
    listed = re.search(r"^SHAPES := ((?:.*\\\n)*.*)$", MAKEFILE, re.MULTILINE)
    assert listed is not None
    rooms = listed[1].replace("\\\n", " ").split()
    assert len(rooms) > 10
    assert [room for room in rooms if not (ROOT / "tests" / room).exists()] == []
