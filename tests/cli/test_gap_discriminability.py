"""`geocontact gap discriminability`, also `gap confuse`: what it writes, and what it refuses."""

from __future__ import annotations

import json
from pathlib import Path
from unittest import mock

import pytest

from tests.cli.calls import call, done, inventory
from tests.cli.gap_cases import damped_elbow, diagnosed_elbow
from tests.unchecked import unchecked

TABLES = {"confuse.json", "separability.csv", "detectability.csv", "protocol.md", "run.json"}
FIGURES = {f"{name}.{ending}" for name in ("separability", "detectability") for ending in ("png", "svg")}


def test_everything_is_written_and_listed_under_either_name(tmp_path: Path) -> None:
    case, found = damped_elbow(tmp_path / "elbow_7"), diagnosed_elbow().findings.attribution
    known = mock.patch("geocontact.gap.identifiability.discriminability.attribute", return_value=found)
    for name in ("discriminability", "confuse"):
        out = tmp_path / name
        with known, unchecked():
            words = ("--effects", "damping", *(() if name == "confuse" else ("--bare",)))
            said = done(call("gap", name, case, *words, "--out", out, folder=out))
        expected = TABLES | (FIGURES | {"report.html"} if name == "confuse" else set())
        assert set(inventory(out)) == expected
        record = said.record()
        assert record["command"] == "gap confuse" and set(record["files"]) == expected
        assert json.loads((out / "confuse.json").read_text("utf-8"))["visible_nats"] == 50.0
        assert "of 1 effects and variants these trials show 1" in said.out


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--effects", "magic"), "no effect 'magic'"),
        (("--effects", ","), "no effect ','"),
        (("--effects", "sign_flip,unit_error"), "no size to compare has sign_flip or unit_error"),
        (("--nats", "0"), "give a number above 0"),
        (("--nats", "nan"), "give a number above 0"),
    ],
)
def test_mistakes_are_one_line_and_leave_nothing(tmp_path: Path, options: tuple[str, ...], words: str) -> None:
    case = damped_elbow(tmp_path / "elbow_7")
    found = call("gap", "confuse", case, *options, "--out", tmp_path / "out")
    assert found.code == 2
    (line,) = found.err.splitlines()
    assert words in line and options[0] in line
    assert not (tmp_path / "out").exists()
