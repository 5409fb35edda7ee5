"""Rows of long benchmarks are kept as they come, and added up over runs of one version."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.gap import detectability as gap_detectability
from benchmarks.gap import next_experiment as gap_next_experiment
from benchmarks.gap import rows as gap_rows
from geocontact.analyses.frame import source_digest as sources


def run(path: Path, seed: int, *rows: dict[str, object]) -> None:
    """A run that got so far."""
    gap_rows.begin(path, seed, {"options": {"sources": ["elbow", "knee"]}})
    for row in rows:
        gap_rows.keep(path, seed, row)


def test_a_row_that_was_cut_off_is_the_only_one_that_is_lost(tmp_path: Path) -> None:
    path = tmp_path / "here.rows"
    run(path, 1, {"a": 1}, {"a": 2})
    whole = path.read_bytes()
    for end in range(len(whole)):
        path.write_bytes(whole[:end])
        done = whole[:end].count(b"\n")
        runs, rows = gap_rows.kept(path)
        assert (len(runs), [row["a"] for row in rows]) == (min(done, 1), [1, 2][: max(done - 1, 0)])


def test_runs_of_another_version_or_with_the_same_seed_are_not_added(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "here.rows"
    run(path, 1, {"a": 1})
    run(path, 2, {"a": 1})
    assert [row["seed"] for row in gap_rows.kept(path)[1]] == [1, 2]
    with pytest.raises(SystemExit, match="seed 2"):
        run(path, 2)
    monkeypatch.setattr(gap_rows, "digest", lambda: "another")
    with pytest.raises(SystemExit, match="this is another"):
        run(path, 3)
    assert len(gap_rows.kept(path)[0]) == 2


def test_the_version_is_that_of_the_sources(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "one.py").write_text("")
    monkeypatch.setattr(sources, "ROOT", tmp_path)
    before = sources.digest()
    assert sources.digest() == before
    (tmp_path / "one.py").write_text("x = 1\n")
    assert sources.digest() != before


def test_statements_are_added_up_over_runs(tmp_path: Path) -> None:
    """A case of another seed is another case; what is simulated at the amplitude itself is no statement."""
    out = tmp_path / "told.json"
    right = {"source": "elbow", "case": 0, "times": 0.5, "predicted": 0.1, "seen": False}
    run(out.with_suffix(".rows"), 1, right, right | {"times": 1.0, "predicted": 0.8}, right | {"times": 1.5})
    run(out.with_suffix(".rows"), 2, right | {"seen": True}, right | {"source": "knee"})
    told = gap_detectability.written(out)
    assert (told["all"]["right"], told["all"]["statements"], told["all"]["cases"]) == (3, 4, 3)
    assert (told["of"]["elbow"]["right"], told["of"]["elbow"]["statements"]) == (2, 3)
    assert told["all"]["seen_at"]["0.5"] == {"seen": 1, "of": 3}
    assert out.is_file()


def test_proposals_are_added_up_over_runs(tmp_path: Path) -> None:
    """A case without a proposal is counted as a case only."""
    out = tmp_path / "told.json"
    up = {"source": "elbow", "about": "rivals", "raised": True}
    run(out.with_suffix(".rows"), 1, up, {"source": "elbow"}, up | {"source": "knee", "raised": False})
    run(out.with_suffix(".rows"), 2, up | {"about": "absorbed"})
    told = gap_next_experiment.written(out)
    assert (told["all"]["raised"], told["all"]["proposals"], told["all"]["cases"]) == (2, 3, 4)
    assert (told["of"]["knee"]["raised"], told["about"]["rivals"]["proposals"]) == (0, 2)
