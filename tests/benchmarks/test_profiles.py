"""Profiles of slow commands: parts that do not overlap, and a page that has the figures of the results."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from benchmarks.profiles import COMMANDS, PARTS, lines, seconds_of
from tests.cli.calls import FEMUR

ROOT = Path(__file__).resolve().parents[2]


def test_parts_add_up_to_the_whole(tmp_path: Path) -> None:
    """A small fit: something is imported, read, computed, drawn and written, and nothing counts twice."""
    found = seconds_of(["fit", str(FEMUR), "--shape", "sphere", "--unit", "mm", "--out", "out"], tmp_path)
    assert sum(found[part] for part in PARTS) == pytest.approx(found["whole"], abs=1e-9)
    assert min(found[part] for part in PARTS) >= 0.0
    for part in ("start", "reading", "computing", "figures", "page"):
        assert found[part] > 1e-3, part
    assert found["start"] > found["reading"]
    with pytest.raises(RuntimeError, match=r"missing\.stl"):
        seconds_of(["fit", "missing.stl", "--shape", "sphere", "--unit", "mm", "--out", "out"], tmp_path)


def test_the_page_has_the_rows_of_the_results() -> None:
    kept = json.loads((ROOT / "benchmarks" / "results" / "profiles.json").read_text(encoding="utf-8"))["figures"]
    page = (ROOT / "docs" / "reference" / "peers.md").read_text(encoding="utf-8")
    assert set(kept) <= set(COMMANDS)
    for row in lines(kept):
        assert re.sub(r"^\|---.*", "|---", row) in page
    whole = [each["cpu_s"]["whole"] for each in kept.values()]
    assert whole and all(
        abs(sum(each["cpu_s"][part] for part in PARTS) - each["cpu_s"]["whole"]) < 0.01 for each in kept.values()
    )
