"""Regions of a diagnosis on its page and in its JSON; classes of a pair in its words."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from geocontact.analyses.gap.diagnose.answer import with_classes
from geocontact.analyses.gap.diagnose.page_answers import region_block, region_caption, region_words
from geocontact.analyses.gap.diagnose.show import regions_table
from geocontact.data.gap_cells import Region

UNITS = ("N", "rad")
EARLY = Region("force", (0.0, 0.5), "beta", (0.1, 0.42), "rising", 0.31, 0.2, 0.004, UNITS)
LATE = Region("force", (0.25, 0.5), "beta", (-0.4, -0.1), "", -0.2, 0.1, 0.03, UNITS)


def test_a_region_says_where_it_is() -> None:
    assert EARLY.place == "phase 0–50 %, beta 0.1 to 0.42 rad, rising"
    assert LATE.place == "phase 25–50 %, beta -0.4 to -0.1 rad"
    assert region_words(EARLY) == f"{EARLY.place}: 20 % of the squared error, false-discovery rate 0.004"
    without = Region("force", (0.75, 1.0), "", (0.0, 0.0), "", 0.31, 0.2, 0.004, ("N", ""))
    assert without.place == "phase 75–100 %"
    assert EARLY.as_dict()["phase"] == [0.0, 0.5]
    assert "units" not in EARLY.as_dict()


def test_the_map_has_the_shares_of_all_regions_of_a_part_of_the_trial() -> None:
    """A shade is full at half of the squared error: 20 % is 0.4 of it, 20 and 10 % together are 0.6."""
    block = region_block([EARLY, LATE], ["cop_x", "force"])
    assert block.values[1] == pytest.approx([0.4, 0.6, 0.0, 0.0])
    assert not block.values[0].any()
    assert block.marks[1] == ["+", "+", "", ""]
    assert block.texts[1][1] == f"{region_words(EARLY)}; {region_words(LATE)}"
    assert block.texts[1][2] == block.texts[0][0] == "no region"
    assert len(block.edges) == 5


def test_a_member_of_a_pair_is_named_as_its_class() -> None:
    d = SimpleNamespace(one_law=(("filter_lag", "time_shift"),))
    assert with_classes(d, ("dead_zone", "filter_lag")) == (  # type: ignore[arg-type]
        "dead_zone, and filter_lag or time_shift (one law on these trials)"
    )
    assert with_classes(SimpleNamespace(one_law=()), ("damping", "slip")) == "damping and slip"  # type: ignore[arg-type]


def test_no_gap_beside_a_region_says_first_that_it_has_no_share_worth_a_name() -> None:
    first = " `no_gap` beside regions: what is surely missed there is less than 10 % of a channel's squared error"
    for verdict, missing in (("no_gap", "no share worth a name"), ("unknown", "something")):
        d = SimpleNamespace(verdict=verdict, regions=(EARLY,))
        words = region_caption(d)  # type: ignore[arg-type]
        assert words.startswith(first) == (verdict == "no_gap")
        assert "one in twenty" in words
        system = SimpleNamespace(unit=lambda _: "N")
        findings = SimpleNamespace(diagnosis=d, attribution=SimpleNamespace(problem=SimpleNamespace(system=system)))
        table = regions_table(findings)  # type: ignore[arg-type]
        assert table.title == f"Regions in which the base model misses {missing}"
    assert region_caption(SimpleNamespace(verdict="no_gap", regions=())) == ""  # type: ignore[arg-type]
