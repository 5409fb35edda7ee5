"""What is worked out a part at a time is what numpy and scipy get from the whole."""

from __future__ import annotations

import errno
from dataclasses import replace
from io import BytesIO
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.io import netcdf_file
from scipy.signal import butter, sosfiltfilt

from geocontact.data import frame_blocks
from geocontact.data.errors import InputError
from geocontact.data.frame_blocks import Growing, blocks, parts, room, worked
from geocontact.data.pressure_frames import PressureFrames
from geocontact.identify.signals.filters import as_opensim
from geocontact.io.results import RaggedTable, write_netcdf, write_ragged
from geocontact.io.text import file_preflight, results

PRESSURE = np.random.default_rng(58).uniform(0.0, 2e4, (101, 4, 3))


@pytest.fixture(autouse=True)
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    """Parts of a few values."""
    monkeypatch.setattr(frame_blocks, "AT_ONCE", 50)


def test_parts_follow_each_other() -> None:
    assert list(blocks(9, 12)) == [slice(0, 4), slice(4, 8), slice(8, 9)]
    assert list(blocks(0, 12)) == [slice(0, 0)] and len(list(blocks(3, 1000))) == 3


def test_force_and_filter_of_parts_are_those_of_the_whole() -> None:
    area = np.full((4, 3), 1e-4)
    frames = PressureFrames(np.arange(101.0), PRESSURE, (0.01, 0.01), np.ones((4, 3), bool), area, 1.9e4)
    np.testing.assert_allclose(frames.force, np.einsum("trc,rc->t", PRESSURE, area), rtol=1e-14)
    assert (frames.saturated == (PRESSURE >= 1.9e4)).all()
    whole = sosfiltfilt(butter(3, 6.0, fs=100.0, output="sos"), PRESSURE, axis=0, padlen=50)
    np.testing.assert_array_equal(as_opensim(PRESSURE, 0.01, 6.0), whole)
    with pytest.raises(ValueError, match="must be finite"):
        replace(frames, pressure=np.where(PRESSURE[-1, -1, -1] == PRESSURE, np.nan, PRESSURE))


def test_a_table_of_parts_is_that_of_the_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Late clocks are text in every part, also in one whose own rows are not late; an empty table has its header."""
    time = np.r_[0.25, 1.5, 1e9 + 1e-6 * np.arange(5.0)]
    table = pd.DataFrame({"time [s]": time, "force [N]": np.pi * np.arange(7.0), "side": list("llrrlrl")})
    texts = {}
    for rows in (3, 100):
        monkeypatch.setattr(results, "ROWS", rows)
        results.write_table(table, tmp_path, "t")
        texts[rows] = (tmp_path / "t.csv").read_bytes()
    assert texts[3] == texts[100] and texts[3].count(b"\n") == 8
    results.write_table(table.iloc[:0], tmp_path, "none")
    assert (tmp_path / "none.csv").read_text(encoding="utf-8") == "time [s],force [N],side\n"


def test_numbers_that_grow_are_those_that_were_given() -> None:
    """In files and in memory; half a frame more than a part."""
    for count in (3, 75, 151):
        grown, given = Growing(), np.random.default_rng(count).normal(size=count)
        for start in range(0, count, 7):
            grown.extend(given[start : start + 7].tolist())
        assert len(grown) == count
        np.testing.assert_array_equal(grown.values(), given)


def test_side_by_side_and_one_frame_for_a_part() -> None:
    values = room((9, 12))
    values[:] = np.arange(108.0).reshape(9, 12)
    sums = worked(lambda part, scale: part.sum(axis=1) * scale, values, np.arange(9.0))
    np.testing.assert_array_equal(sums, values.sum(axis=1) * np.arange(9.0))
    assert [len(part) for part, _ in parts(values, np.arange(9.0), each=40)] == [1] * 9


def test_a_full_disk_is_said_before_anything_is_computed(monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(frame_blocks.os, "posix_fallocate", full, raising=False)
    with pytest.raises(InputError, match=r"cannot hold 8e-07 GB .* \(No space left on device\); name another folder"):
        room((10, 10))


def test_another_folder_is_no_remedy_for_open_files(monkeypatch: pytest.MonkeyPatch) -> None:
    def many(*_: object) -> None:
        raise OSError(errno.EMFILE, "Too many open files")

    monkeypatch.setattr(frame_blocks.os, "posix_fallocate", many, raising=False)
    with pytest.raises(InputError, match=r"\(Too many open files\); allow more open files \(ulimit -n\)"):
        room((10, 10))


@pytest.mark.skipif(not Path("/proc/self/fd").is_dir(), reason="open files are counted in /proc")
def test_a_netcdf_file_of_more_columns_than_files_may_be_open(tmp_path: Path) -> None:
    """Of a table and of several that are joined, each beyond a part; read again they are the same."""
    import resource

    values = np.random.default_rng(8).normal(size=(60, 90))
    table = pd.DataFrame(values, columns=[f"c{k} [N]" for k in range(90)])
    table["count"], table["there"], table["side"] = np.arange(60), np.arange(60) % 2 == 0, "left"
    table.insert(0, "time [s]", np.arange(60) / 100.0)
    joined = RaggedTable("t", [{"subject": "A"}, {"subject": "B"}], [40, 20])
    columns = [(str(name), False, iter([table[name][:40], table[name][40:]])) for name in table.columns[:91]]
    given = resource.getrlimit(resource.RLIMIT_NOFILE)
    taken = {int(each.name) for each in Path("/proc/self/fd").iterdir()}
    most = [k for k in range(1000) if k not in taken][20]  # numbers of files below it: twenty are free
    resource.setrlimit(resource.RLIMIT_NOFILE, (most, given[1]))
    try:
        write_netcdf(table, tmp_path / "t.nc", {})
        write_ragged(joined, columns, tmp_path / "joined.nc")
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, given)
    for name in ("t.nc", "joined.nc"):
        with netcdf_file(str(tmp_path / name), mmap=False) as found:
            for k in range(90):
                np.testing.assert_array_equal(found.variables[f"c{k}"][:], values[:, k])
            if name == "t.nc":
                np.testing.assert_array_equal(found.variables["count"][:], np.arange(60))
                np.testing.assert_array_equal(found.variables["there"][:], np.arange(60) % 2 == 0)
                assert found.variables["side"][0].tobytes() == b"left"


def test_lines_of_a_file_are_those_of_its_bytes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ends of all kinds, one of them between two blocks; of a line that is too long its beginning comes."""
    monkeypatch.setattr(file_preflight, "BLOCK", 4)
    for data in (b"ab\r\ncd\r\n\r\nefghijk\rl\nm", b"abc\r\nd", b"abc\rd\r", b"\n\n", b""):
        assert list(file_preflight.lines_in(BytesIO(data).read, 20)) == data.splitlines()
    assert len(next(file_preflight.lines_in(BytesIO(b"x" * 100).read, 20))) in range(21, 25)
