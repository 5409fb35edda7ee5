"""Results of trials may come from others: what they say of themselves leads nowhere else."""

from __future__ import annotations

import json
import os
import threading
from hashlib import sha256
from pathlib import Path

import pytest

from geocontact.analyses.frame.folder import RUN
from geocontact.data.errors import InputError
from geocontact.study.address import Digests
from geocontact.study.store import REPORT, Store


@pytest.mark.parametrize("name", ["../../escaped", "/tmp/escaped", "a/../../b"])
def test_a_table_elsewhere_is_refused(tmp_path: Path, name: str) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / REPORT).write_text(json.dumps({"tables": ["area", name], "warnings": []}))
    with pytest.raises(InputError, match="is not in its folder; remove that folder"):
        Store(tmp_path).report("a")


def test_its_own_tables_are_read(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / REPORT).write_text(json.dumps({"tables": ["area", "trials/area"]}))
    assert Store(tmp_path).report("a")["tables"] == ["area", "trials/area"]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    os.mkfifo(tmp_path / "a" / REPORT)
    with pytest.raises(InputError, match="is a named pipe"):
        Store(tmp_path).report("a")


@pytest.mark.parametrize(
    "content",
    [
        "[]",
        "{}",
        "5",
        "{",
        "[" * 100_000,
        '{"tables": "area", "warnings": 5}',
        '{"tables": [5], "warnings": []}',
        '{"tables": ["area"], "warnings": [{}]}',
    ],
)
def test_what_describes_no_trial_is_refused_in_a_line(tmp_path: Path, content: str) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / REPORT).write_text(content)
    with pytest.raises(InputError, match="does not say what a trial has; remove that folder"):
        Store(tmp_path).report("a")


def whole(folder: Path, inputs: object) -> Store:
    """Results of a stranger that say what they were made of."""
    (folder / "a").mkdir()
    (folder / "a" / REPORT).write_text('{"tables": [], "warnings": []}')
    (folder / "a" / RUN).write_text(json.dumps({"inputs": inputs}))
    return Store(folder)


def test_results_are_used_while_their_inputs_are_the_same(tmp_path: Path) -> None:
    (tmp_path / "x.csv").write_text("1")
    store = whole(tmp_path, [{"file": "x.csv", "sha256": sha256(b"1").hexdigest()}, {"file": "no sum"}])
    assert store.holds("a", tmp_path, Digests())
    (tmp_path / "x.csv").write_text("22")
    assert not store.holds("a", tmp_path, Digests())


def ask(store: Store, home: Path, ended: list[bool]) -> None:
    """Whether results are there, once that is known."""
    ended.append(store.holds("a", home, Digests()))


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_inputs_that_would_be_waited_for_are_not_opened(tmp_path: Path) -> None:
    """A pipe, a device without an end, and a folder."""
    os.mkfifo(tmp_path / "pipe")
    for k, name in enumerate(("pipe", "/dev/zero", ".")):
        (tmp_path / str(k)).mkdir()
        store = whole(tmp_path / str(k), [{"file": name, "sha256": "0"}])
        ended: list[bool] = []
        asked = threading.Thread(target=ask, args=(store, tmp_path, ended), daemon=True)
        asked.start()
        asked.join(10.0)
        assert ended == [False], name


@pytest.mark.parametrize("inputs", [5, [5], [{"file": 5, "sha256": 5}], None, [[]] * 3 + [None]])
def test_other_inputs_are_no_results(tmp_path: Path, inputs: object) -> None:
    assert not whole(tmp_path, inputs).holds("a", tmp_path, Digests())


@pytest.mark.parametrize(
    ("name", "kept"),
    [("angles.mot", False), ("below/angles.mot", False), ("report.html", True)],
)
def test_results_are_used_while_they_are_as_they_were_written(tmp_path: Path, name: str, kept: bool) -> None:
    """A byte that differs makes them new, one of a page does not; a file that is missing always does."""
    store = whole(tmp_path, [])
    file = tmp_path / "a" / name
    file.parent.mkdir(exist_ok=True)
    file.write_bytes(b"1.25")
    listed = {"inputs": [], "sha256": {name: sha256(b"1.25").hexdigest()}}
    (tmp_path / "a" / RUN).write_text(json.dumps(listed))
    assert store.holds("a", tmp_path, Digests())
    file.write_bytes(b"1.35")
    assert store.holds("a", tmp_path, Digests()) == kept
    file.unlink()
    assert not store.holds("a", tmp_path, Digests())


@pytest.mark.parametrize("listed", [{"../x.csv": sha256(b"1").hexdigest()}, {"/x.csv": ""}, [], 5, {"": ""}])
def test_results_that_list_files_elsewhere_are_none(tmp_path: Path, listed: object) -> None:
    (tmp_path / "x.csv").write_bytes(b"1")
    store = whole(tmp_path, [])
    (tmp_path / "a" / RUN).write_text(json.dumps({"inputs": [], "sha256": listed}))
    assert not store.holds("a", tmp_path, Digests())
