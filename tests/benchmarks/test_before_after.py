"""Whole commands of two commits: seconds of a process, and a page that has the figures of the results."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from benchmarks.before_after import KEPT, ROOT, cpu_seconds, lines
from tests.cli.calls import FEMUR


def test_seconds_are_those_of_the_whole_command(tmp_path: Path) -> None:
    words = ["fit", str(FEMUR), "--shape", "sphere", "--unit", "mm", "--out", str(tmp_path / "out")]
    assert 0.3 < cpu_seconds(ROOT, words, tmp_path) < 60.0
    assert (tmp_path / "out" / "report.html").is_file()
    with pytest.raises(RuntimeError, match=r"missing\.stl"):
        cpu_seconds(ROOT, ["fit", "missing.stl", "--shape", "sphere", "--unit", "mm", "--out", "o"], tmp_path)


def test_rows_are_medians_and_their_ratio() -> None:
    found = {"area": {"before": [9.0, 2.0, 4.0], "after": [1.0, 3.0, 2.0]}}
    assert lines(found)[2:] == ["| `area` | 4.0 | 2.0 | 2.0 |"]


def test_the_page_has_the_rows_of_the_results() -> None:
    page = (ROOT / "docs" / "reference" / "peers.md").read_text(encoding="utf-8").splitlines()
    kept = json.loads(KEPT.read_text(encoding="utf-8"))
    assert kept["asked"]["before"] == "4c8c161" and set(lines(kept["figures"])[2:]) <= set(page)
