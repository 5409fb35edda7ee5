"""Figures that any program can read: JSON has no NaN and no Infinity."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import pytest

from benchmarks.machine import as_json

RESULTS = Path(__file__).resolve().parents[2] / "benchmarks" / "results"


@pytest.mark.parametrize("file", sorted(RESULTS.rglob("*.json")), ids=lambda file: file.name)
def test_results_of_benchmarks_are_strict_json(file: Path) -> None:
    def refused(word: str) -> None:
        pytest.fail(f"{word} is not JSON; write with benchmarks.machine.as_json")

    text = file.read_text(encoding="utf-8")
    json.loads(text, parse_constant=refused)
    assert re.findall(r'["\s](?:/(?!proc/|dev/|tmp/)[\w.-]+/|[A-Z]:\\\\)[^"\n]*', text) == [], "a path of some machine"


def test_what_is_not_finite_is_null() -> None:
    text = as_json({"a": [1.5, math.nan], "b": -math.inf, "c": Path("x")})
    assert json.loads(text) == {"a": [1.5, None], "b": None, "c": "x"}
