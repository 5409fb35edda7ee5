"""Schedules as tables: their columns, units, and what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from geocontact.data.errors import InputError
from geocontact.io.recordings.fulcrum_schedule import ScheduleRow, read_fulcrum_schedule


def written(folder: Path, text: str) -> Path:
    (folder / "schedule.csv").write_text(text)
    return folder / "schedule.csv"


def test_read(tmp_path: Path) -> None:
    table = read_fulcrum_schedule(written(tmp_path, "stride [-],setting\n1,low\n3,medium\n"))
    assert (table.by, table.rows) == ("stride", (ScheduleRow(1.0, "low", None), ScheduleRow(3.0, "medium", None)))
    table = read_fulcrum_schedule(written(tmp_path, "phase [%],fulcrum [mm]\n0,66\n70,151\n"))
    assert table.by == "phase"
    assert [each.start for each in table.rows] == pytest.approx([0.0, 0.7])
    assert [each.fulcrum for each in table.rows] == pytest.approx([0.066, 0.151])
    assert read_fulcrum_schedule(written(tmp_path, "speed [cm/s],setting\n0,low\n100,high\n")).rows[1].start == 1.0


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("setting\nlow\n", "write one of stride"),
        ("stride [-],time [s],setting\n1,0,low\n", "write one of stride"),
        ("stride [-]\n1\n", "write one of stride"),
        ("stride [-],setting\n2,low\n1,high\n", "does not rise"),
        ("stride [-],setting\n1.5,low\n", "no count"),
        ("stride [-],setting\n0,low\n", "no count"),
        ("stride [-],setting\n-3,low\n1,high\n", "no count"),
        ("phase [%],setting\n110,low\n", "not 0 to below 100 %"),
        ("stride [-],setting\none,low\n", "is not a finite number"),
    ],
)
def test_refused(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        read_fulcrum_schedule(written(tmp_path, text))
