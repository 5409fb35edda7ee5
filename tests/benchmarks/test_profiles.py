"""Profiles of slow commands: parts that do not overlap, and a page that has the figures of the results."""

from __future__ import annotations

import json
import re
import resource
from pathlib import Path

import pytest

from benchmarks.profiles import COMMANDS, PARTS, lines, seconds_of
from tests.cli.calls import FEMUR

ROOT = Path(__file__).resolve().parents[2]


def test_parts_add_up_to_the_whole(tmp_path: Path) -> None:
    """A small fit: something is imported, read, computed, drawn and written, and nothing counts twice."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    found = seconds_of(["fit", str(FEMUR), "--shape", "sphere", "--unit", "mm", "--out", "out"], tmp_path)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    took = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime  # with begin and end of the process
    assert 0.6 * took < found["whole"] <= took
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
    for each in kept.values():  # medians of parts add up to that of the whole but for the differences of rounds
        parts, near = sum(each["cpu_s"][part] for part in PARTS), 0.01 if each["rounds"] == 1 else 0.3
        assert abs(parts - each["cpu_s"]["whole"]) < near
    assert len(whole) == len(COMMANDS)
    own = {
        command: {one["function"].rpartition("/")[2]: (one["calls"], one["own_s"]) for one in each["functions"]}
        for command, each in kept.items()
    }
    calls, seconds = own["sit-to-stand predict"]["step_loop.py:run"]
    searches = next(took for name, (_, took) in own["sit-to-stand predict"].items() if "Function_call" in name)
    distances = own["knee settle"]["batch.py:signed_distances"][1]
    most = max(took for _, took in own["gap diagnose"].values())
    assert f"searches {searches:.1f} s and {calls} simulations of the certificate {seconds:.1f} s" in " ".join(
        page.split()
    )
    assert f"distances {distances:.1f} s" in page and f"more than {most:.1f} s" in page
