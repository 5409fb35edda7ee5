"""What trials of a damped elbow can tell, called from Python."""

from __future__ import annotations

from pathlib import Path
from unittest import mock

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.frame.json_file import plain
from geocontact.analyses.gap.discriminability.answer import answer
from geocontact.analyses.gap.discriminability.result import DiscriminabilityResult
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
    assert "these trials show" in page.lower() and " of 100 repetitions" not in page


@pytest.mark.slow
def test_python_and_command_write_the_same_tables(confused: DiscriminabilityResult, tmp_path: Path) -> None:
    case, asked = damped_elbow(tmp_path / "elbow_7"), ",".join(EFFECTS)
    with mock.patch("geocontact.analyses.gap.discriminability.result.compared", return_value=confused.found):
        typed = call("gap", "discriminability", case, "--effects", asked, "--bare", "--out", tmp_path / "typed")
        called = gc.discriminability(case, effects=asked, bare=True).write(tmp_path / "called")
    done(typed)
    names = {file.name for file in called.iterdir()} - {"run.json"}
    assert names == {"confuse.json", "separability.csv", "detectability.csv"}
    for name in names:
        assert (tmp_path / "typed" / name).read_bytes() == (called / name).read_bytes(), name
