"""The table of what the five papers do: every command, option and file that a row names is there."""

from __future__ import annotations

from collections import Counter

import pytest

from geocontact.cli.main import app
from geocontact.cli.suggestions import commands
from tests.house.first_screens import ROOT
from tests.house.test_command_lines import names
from website.limits import STATES, papers

ITEMS = {"000": 34, "001": 34, "002": 44, "003": 21, "004": 27}
"""How many things a paper does, says or leaves for later."""
ROWS = papers()


def test_every_item_of_every_paper_has_one_row() -> None:
    wanted = [f"{paper}.{k}" for paper, count in ITEMS.items() for k in range(1, count + 1)]
    assert [row["item"] for row in ROWS] == wanted
    assert {row["state"] for row in ROWS} <= set(STATES)
    assert all(row["what"] for row in ROWS)


@pytest.mark.parametrize("paper", ITEMS)
def test_commands_options_and_files_of_a_paper_are_there(paper: str) -> None:
    for row in (one for one in ROWS if one["item"].startswith(paper)):
        assert (ROOT / row["file"]).is_file(), row
        if row["command"]:
            of, left = app, row["command"].split()
            while left and left[0] in commands(of):
                of = of[left.pop(0)]
            assert of is not app and set(left) <= names(of), row


def test_what_is_done_is_a_command_with_its_test_and_what_is_not_says_why() -> None:
    """Nothing that is done stands in benchmarks alone."""
    for row in ROWS:
        if row["state"] == "done":
            assert row["command"] and not row["file"].startswith("benchmarks/"), row
            named = row["file"].startswith("tests/") and row["file"].endswith(".py")
            assert named or row["file"] == "docs/reference/speed.md", row
        elif row["state"] == "partly":
            assert row["note"], row


def test_so_many_are_done_or_otherwise_on_purpose() -> None:
    """May only rise."""
    counts = Counter(row["state"] for row in ROWS)
    assert counts["done"] + counts["other"] >= 140
