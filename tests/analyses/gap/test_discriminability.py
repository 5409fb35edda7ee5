"""What trials of a damped elbow can tell, called from Python."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from unittest import mock

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.frame.json_file import plain
from geocontact.analyses.gap.discriminability.answer import answer, confusion_sentences
from geocontact.analyses.gap.discriminability.result import DiscriminabilityResult
from geocontact.analyses.gap.discriminability.show import confusion_page, separation_matrix
from geocontact.view.page.content import Table
from tests.cli.calls import call, done
from tests.cli.gap_cases import EFFECTS, confused_elbow, damped_elbow

LABELS = ("time_shift", "filter_lag", "damping", "sensor_gain.force")


@pytest.fixture(scope="module")
def confused() -> DiscriminabilityResult:
    return confused_elbow()


@pytest.fixture(scope="module")
def told(confused: DiscriminabilityResult) -> dict:
    """confuse.json."""
    return plain(answer(confused.case, confused.found, confused.options.nats))


@pytest.mark.slow
def test_tables_agree_with_the_answer(confused: DiscriminabilityResult, told: dict) -> None:
    assert tuple(told["separability"]) == LABELS == tuple(told["detectability"])
    pairs = confused.table("separability")
    assert len(pairs) == len(LABELS) * (len(LABELS) + 1)
    for _, row in pairs.iterrows():
        assert row["separation [nats]"] == pytest.approx(told["separability"][row["effect"]][row["imitator"]])
    sizes = confused.table("detectability").set_index("effect")
    for label, said in told["detectability"].items():
        smallest = sizes.loc[label, "smallest"]
        assert np.isnan(smallest) if said["smallest"] is None else smallest == pytest.approx(said["smallest"])


@pytest.mark.slow
def test_what_is_known_of_the_elbow_is_said(confused: DiscriminabilityResult, told: dict) -> None:
    assert told["absorbed"] == ["sensor_gain", "unit_error"], "a mistake that is asked about has no row of its own"
    assert told["mistakes"] == ["sign_flip"], "a wrong unit is swallowed in one variant"
    assert told["detectability"]["sensor_gain.force"]["smallest"] is None
    amplitude = told["detectability"]["damping"]["smallest"]
    assert amplitude < 25.0  # which was planted and found
    words = str(confused)
    assert "mistakes in the data that would leave a gap, made in all trials: sign_flip" in words
    assert "not to be seen at any plausible size: sensor_gain.force" in words
    assert f"damping from damping.b = {amplitude:.3g} N s/m on" in words
    seen = sum(one["smallest"] is not None for one in told["detectability"].values())
    assert f"of {len(told['detectability'])} effects and variants these trials show {seen}, " in words


@pytest.mark.slow
def test_the_page_has_sizes_in_a_table(confused: DiscriminabilityResult, tmp_path: Path) -> None:
    page = confused.page(tmp_path / "page.html").read_text(encoding="utf-8")
    assert "Separation of effects, by pairs" in page and "Smallest amplitudes" in page
    assert "<h1><bdi>Effects that the trials of elbow_7 show</bdi></h1>" in page and "<img" not in page
    assert "these trials show" in page.lower() and " of 100 repetitions" not in page


@pytest.mark.slow
def test_the_matrix_has_the_nats_of_every_pair(confused: DiscriminabilityResult, told: dict) -> None:
    matrix = separation_matrix(confused.found)
    assert tuple(matrix.rows) == LABELS and tuple(matrix.columns) == ("none", *LABELS)
    for r, true in enumerate(matrix.rows):
        for c, imitator in enumerate(matrix.columns):
            nats = max(told["separability"][true][imitator] or 0.0, 0.0)
            assert matrix.values[r, c] == pytest.approx(min(nats, 20.0) / 20.0) or np.isnan(matrix.values[r, c])
            assert matrix.texts[r][c] in ("", ">99", f"{nats:.0f}")
    assert matrix.texts[0][0] == "50", "as visible as asked for"


@pytest.mark.slow
def test_amplitudes_stand_in_units_beside_their_share(confused: DiscriminabilityResult, told: dict) -> None:
    page = confusion_page("title", confused.found)
    (table,) = [s for s in page.sections if isinstance(s, Table) and s.title.startswith("Smallest")]
    rows = {row[0]: dict(zip(table.header, row, strict=True)) for row in table.rows}
    assert rows["damping"]["smallest"] == f"{told['detectability']['damping']['smallest']:.3g} N s/m"
    assert rows["damping"]["of its plausible range"].endswith(" %")
    assert (rows["sensor_gain.force"]["smallest"], rows["sensor_gain.force"]["of its plausible range"]) == (
        "not to be seen",
        "–",
    )
    assert table.rows[-1][0] == "sensor_gain.force", "the most easily seen first"


def test_groups_that_look_alike_are_one_sentence() -> None:
    """Three groups made three sentences of the same words."""
    groups = (("a", "b"), ("c", "d", "e"), ("f", "g"))
    found = SimpleNamespace(
        detectabilities=(), absorbed=(), mistakes=(), classes=groups, effects=(), proposal=None, found=None
    )
    said = [line for line in confusion_sentences(found) if "not separable" in line]  # type: ignore[arg-type]
    assert said == ["not separable (less than 5 nats between any two): a and b; c, d and e; f and g"]


@pytest.mark.slow
def test_python_and_command_write_the_same_tables(confused: DiscriminabilityResult, tmp_path: Path) -> None:
    case, asked = damped_elbow(tmp_path / "elbow_7"), ",".join(EFFECTS)
    with mock.patch("geocontact.analyses.gap.discriminability.result.compared", return_value=confused.found):
        typed = call("gap", "discriminability", case, "--effects", asked, "--bare", "--out", tmp_path / "typed")
        called = gc.discriminability(case, effects=asked, bare=True).write(tmp_path / "called")
    done(typed)
    names = {file.name for file in called.iterdir()} - {"run.json"}
    assert names == {"confuse.json", "separability.csv", "detectability.csv", "protocol.md"}
    for name in names:
        assert (tmp_path / "typed" / name).read_bytes() == (called / name).read_bytes(), name
