"""`geocontact gap confuse`: what it writes and says of a damped elbow, and what it refuses."""

from __future__ import annotations

import json
from pathlib import Path
from unittest import mock

import numpy as np
import pytest

from tests.cli.calls import Call, call, done, inventory
from tests.cli.gap_cases import damped_elbow, diagnosed_elbow

ASKED = ("damping", "time_shift", "filter_lag", "sensor_gain", "unit_error", "sign_flip")
LABELS = ("time_shift", "filter_lag", "damping", "sensor_gain.force")
TABLES = {"confuse.json", "separability.csv", "detectability.csv", "run.json"}
FIGURES = {f"{name}.{ending}" for name in ("separability", "detectability") for ending in ("png", "svg")}


@pytest.fixture(scope="module")
def confused(tmp_path_factory: pytest.TempPathFactory) -> Call:
    folder = tmp_path_factory.mktemp("confuse")
    case = damped_elbow(folder / "elbow_7")
    with mock.patch(
        "geocontact.gap.identifiability.discriminability.attribute", return_value=diagnosed_elbow()[1].attribution
    ):
        return done(
            call("gap", "confuse", case, "--effects", ",".join(ASKED), "--out", folder / "out", folder=folder / "out")
        )


def test_everything_is_written_and_listed(confused: Call) -> None:
    expected = TABLES | FIGURES | {"report.html"}
    assert set(inventory(confused.folder)) == expected
    record = confused.record()
    assert record["command"] == "gap confuse" and set(record["files"]) == expected
    page = (confused.folder / "report.html").read_text(encoding="utf-8")
    assert "Who is told from whom" in page and "Smallest amplitudes" in page


def test_tables_agree_with_the_answer(confused: Call) -> None:
    answer = json.loads((confused.folder / "confuse.json").read_text(encoding="utf-8"))
    assert tuple(answer["separability"]) == LABELS == tuple(answer["detectability"])
    pairs = confused.table("separability.csv")
    assert len(pairs) == len(LABELS) * (len(LABELS) + 1)
    for _, row in pairs.iterrows():
        assert row["separation [nats]"] == pytest.approx(answer["separability"][row["effect"]][row["imitator"]])
    sizes = confused.table("detectability.csv").set_index("effect")
    for label, told in answer["detectability"].items():
        smallest = sizes.loc[label, "smallest"]
        assert np.isnan(smallest) if told["smallest"] is None else smallest == pytest.approx(told["smallest"])


def test_what_is_known_of_the_elbow_is_said(confused: Call) -> None:
    answer = json.loads((confused.folder / "confuse.json").read_text(encoding="utf-8"))
    assert answer["absorbed"] == ["sensor_gain", "unit_error"], "a mistake that is asked about has no row of its own"
    assert answer["mistakes"] == ["sign_flip"], "a wrong unit is swallowed in one variant"
    assert "mistakes in the data that would leave a gap, made in all trials: sign_flip" in confused.out
    assert answer["detectability"]["sensor_gain.force"]["smallest"] is None
    assert answer["detectability"]["damping"]["smallest"] < 25.0  # which was planted and found
    assert "not to be seen at any plausible size: sensor_gain.force" in confused.out
    amplitude = answer["detectability"]["damping"]["smallest"]
    assert f"damping from damping.b = {amplitude:.3g} N s/m on" in confused.out
    seen = sum(one["smallest"] is not None for one in answer["detectability"].values())
    assert f"of {len(answer['detectability'])} effects and variants these trials show {seen}, " in confused.out
    page = (confused.folder / "report.html").read_text(encoding="utf-8")
    assert "these trials show" in page.lower() and " of 100 repetitions" not in page, "sizes stand in the table"


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
