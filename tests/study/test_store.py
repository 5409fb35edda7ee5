"""Results of trials may come from others: what they say of themselves leads nowhere else."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from geocontact.data.errors import InputError
from geocontact.study.store import TOLD, Store


@pytest.mark.parametrize("name", ["../../escaped", "/tmp/escaped", "a/../../b"])
def test_a_table_elsewhere_is_refused(tmp_path: Path, name: str) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / TOLD).write_text(json.dumps({"tables": ["area", name], "warnings": []}))
    with pytest.raises(InputError, match="is not in its folder; remove that folder"):
        Store(tmp_path).told("a")


def test_its_own_tables_are_read(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / TOLD).write_text(json.dumps({"tables": ["area", "trials/area"]}))
    assert Store(tmp_path).told("a")["tables"] == ["area", "trials/area"]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    os.mkfifo(tmp_path / "a" / TOLD)
    with pytest.raises(InputError, match="is a named pipe"):
        Store(tmp_path).told("a")
