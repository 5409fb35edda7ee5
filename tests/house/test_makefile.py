"""The Makefile names folders of tests that are there; a renamed one is told here, not by the last step of CI."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")
TEXT: dict[str, Any] = {"check": True, "capture_output": True, "text": True}


def test_rooms_whose_shapes_are_checked_are_there() -> None:
    listed = re.search(r"^SHAPES := ((?:.*\\\n)*.*)$", MAKEFILE, re.MULTILINE)
    assert listed is not None
    rooms = listed[1].replace("\\\n", " ").split()
    assert len(rooms) > 10
    assert [room for room in rooms if not (ROOT / "tests" / room).exists()] == []


def recipe(target: str, *settings: str) -> str:
    """What make would run, called by nobody who has settings of its own, as .ci/run has."""
    alone = {
        name: value
        for name, value in os.environ.items()
        if name not in ("MAKEFLAGS", "MAKEOVERRIDES", "SLOW", "SHAPED")
    }
    made = subprocess.run(
        ["make", "-n", "-B", "-o", ".venv/full.stamp", target, *settings], cwd=ROOT, env=alone, **TEXT
    )
    return made.stdout


def test_what_ci_leaves_out_was_run_before_with_checks() -> None:
    """.ci/run calls `make shapes`, then `make test` without the quick tests of these rooms, and with slow ones."""
    steps = re.findall(r"^make (.*)", (ROOT / ".ci" / "run").read_text(encoding="utf-8"), re.MULTILINE)
    own = "test SLOW=too SHAPED=before"
    assert steps.index("shapes") < steps.index(own)
    rooms = re.findall(r"tests/(\S+)", recipe("shapes"))
    everything, alone = recipe(*own.split()), recipe("test")
    assert f'GEOCONTACT_CHECKED="{" ".join(rooms)}"' in " ".join(everything.split())
    assert '-m "not shapes and not long and not oracle and not real"' in everything
    assert 'GEOCONTACT_CHECKED=""' in alone
    assert '-m "not shapes and not slow and not oracle and not real"' in alone
