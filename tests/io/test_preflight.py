"""Every reader with every kind of wrong file: refused in one line, within a second, and nothing is waited for.

The readers are those of `benchmarks.damage.readers`; a file that is right is there for each of them.
"""

from __future__ import annotations

import errno
import gzip
import io
import os
import shutil
import signal
import socket
import struct
import tempfile
import time
import warnings
import zipfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from benchmarks.damage.readers import READERS
from benchmarks.damage.samples import Sample, samples
from geocontact.analyses.area.distance_file import FILE, read_series
from geocontact.data.errors import InputError
from geocontact.io.mesh.meshes import read_mesh
from geocontact.io.mocap.c3d_markers import read_c3d_markers
from geocontact.io.text import plain_table, unpacked
from geocontact.io.text.file_preflight import open_file
from geocontact.io.text.tables import read_table
from tests.cli.calls import call

pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")

SECONDS = 1.0
Make = Callable[[Path, bytes], object]


class Late(BaseException):
    """A reader that is still at work; no `except Exception` holds it."""


@contextmanager
def within(seconds: float) -> Iterator[None]:
    """A block that is ended by `Late` after so much time; longer where other processes take the processors."""
    busy = max(1.0, os.getloadavg()[0] / (os.cpu_count() or 1))

    def late(*_: object) -> None:
        raise Late

    before = signal.signal(signal.SIGALRM, late)
    signal.setitimer(signal.ITIMER_REAL, seconds * busy)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def a_socket(path: Path, _: bytes) -> None:
    here = Path.cwd()
    os.chdir(path.parent)  # names of sockets are short
    try:
        with socket.socket(socket.AF_UNIX) as bound:
            bound.bind(path.name)
    finally:
        os.chdir(here)


def a_hole(path: Path, good: bytes) -> None:
    path.write_bytes(good)
    os.truncate(path, 5 * 2**30)  # takes no room


def unreadable(path: Path, good: bytes) -> None:
    path.write_bytes(good)
    path.chmod(0)


WRONG: dict[str, tuple[Make, tuple[str, ...]]] = {
    # what stands in place of the file, and words of which the refusal has one
    "named pipe": (lambda path, _: os.mkfifo(path), ("is a named pipe",)),
    "endless device": (lambda path, _: path.symlink_to("/dev/zero"), ("is a device",)),
    "empty device": (lambda path, _: path.symlink_to("/dev/null"), ("is a device",)),
    "socket": (a_socket, ("is a socket",)),
    "folder": (lambda path, _: path.mkdir(), ("is a folder", "run.json: there is no such file", "neither a file nor")),
    "circle of links": (lambda path, _: path.symlink_to(path.name), ("lead in a circle",)),
    "link to nothing": (lambda path, _: path.symlink_to("nowhere"), ("a link to a file that is not there",)),
    "nothing": (lambda path, _: None, ("there is no such file", "no file trials/t01.csv", "neither a file nor six")),
    "empty file": (lambda path, _: path.write_bytes(b""), ("the file is empty",)),
    "hole of 5 GB": (a_hole, ("that are read",)),
    "not readable": (unreadable, ("check its permissions",)),
}
CONTENTS: dict[str, Callable[[bytes], bytes]] = {
    "blanks": lambda good: b" \n\t\n",
    "NULs": lambda good: bytes(5000),
    "NULs at the end": lambda good: good + bytes(5000),
    "picture": lambda good: b"\x89PNG\r\n\x1a\n" + np.random.default_rng(0).bytes(3000),
    "gzip": gzip.compress,
    "UTF-16": lambda good: good.decode("latin-1").encode("utf-16"),
}
"""What may be refused for what it holds; a head of a table that has none is read as none."""
READ = {("wrench head", "*"), *((name, "UTF-16") for name in ("fit.json", "elbow.json", "run.json"))}
"""Readers that find nothing to say about such a file; JSON may be in UTF-16."""
READ_ON = {("table", "NULs at the end", "gait.xlsx")}
"""A zip file may have bytes behind it."""


@pytest.fixture(scope="module")
def every() -> Iterator[list[Sample]]:
    """A right file for each reader, in a folder that everybody may look into; .c3d is read in a process of its own."""
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        Path(folder).chmod(0o755)
        warnings.simplefilter("ignore")
        found = [one for one in samples(Path(folder)) if not one.reader.startswith("c3d")]
        for one in found:  # the first call imports what is not of the reading
            READERS[one.reader].read(one.home / one.file)
        yield found


@contextmanager
def replaced(sample: Sample) -> Iterator[tuple[Path, bytes]]:
    """The file's place, empty, and what stood there; it is put back."""
    path = sample.home / sample.file
    good = path.with_name(f"{path.name}.right")
    path.rename(good)
    try:
        yield path, good.read_bytes()
    finally:
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        else:
            path.unlink(missing_ok=True)
        good.rename(path)


def outcome(sample: Sample) -> str:
    """ "" where the file is read; else the refusal, or what is wrong with it."""
    try:
        with within(SECONDS):
            READERS[sample.reader].read(sample.home / sample.file)
    except InputError as error:
        line = str(error)
        named = sample.file.rpartition("/")[2] in line or sample.reader == "fit.json"
        return line if "\n" not in line and error.remedy and named else f"UNCLEAR {line}"
    except Late:
        return "WAITS"
    except Exception as error:  # noqa: BLE001  whatever a reader raises is what is looked for
        return f"{type(error).__name__}: {error}"
    return ""


@contextmanager
def nobody() -> Iterator[None]:
    """Rights as most users have them, where tests run as root."""
    if os.geteuid():
        yield
        return
    os.seteuid(65534)
    try:
        yield
    finally:
        os.seteuid(0)


@pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")
@pytest.mark.parametrize("kind", WRONG)
def test_what_is_no_file_is_refused_unopened(every: list[Sample], kind: str) -> None:
    make, words = WRONG[kind]
    bad = []
    for sample in every:
        with replaced(sample) as (path, good):
            make(path, good)
            with nobody() if kind == "not readable" else within(60.0):
                line = outcome(sample)
        if not any(word in line for word in words):
            bad.append(f"{sample.name}: {line or 'READ'}")
    assert not bad, bad


@pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")
@pytest.mark.parametrize("kind", CONTENTS)
def test_what_is_no_such_content_is_refused_in_one_line(every: list[Sample], kind: str) -> None:
    bad = []
    for sample in every:
        with replaced(sample) as (path, good):
            path.write_bytes(CONTENTS[kind](good))
            line = outcome(sample)
        reads = {(sample.reader, kind), (sample.reader, "*")} & READ or (sample.reader, kind, sample.file) in READ_ON
        if line.startswith(("WAITS", "UNCLEAR")) or not (": " in line or reads):
            bad.append(f"{sample.name}: {line or 'READ'}")
    assert not bad, bad


@pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")
def test_a_link_to_a_right_file_is_read(every: list[Sample]) -> None:
    bad = []
    for sample in every:
        with replaced(sample) as (path, _):
            path.symlink_to(f"{path.name}.right")
            if line := outcome(sample):
                bad.append(f"{sample.name}: {line}")
    assert not bad, bad


def refused(read: Callable[[], object]) -> str:
    began = time.perf_counter()
    with within(SECONDS), pytest.raises(InputError) as caught:
        read()
    assert time.perf_counter() - began < SECONDS * max(1.0, os.getloadavg()[0])
    assert "\n" not in str(caught.value) and caught.value.remedy
    return str(caught.value)


def test_counts_that_the_bytes_do_not_bear_out(tmp_path: Path) -> None:
    """Two thousand million faces, vertices or points in a few hundred bytes: nothing is made for them."""
    many = 2_000_000_000
    (tmp_path / "a.stl").write_bytes(bytes(80) + struct.pack("<I", many) + bytes(100))
    assert "cut off or damaged" in refused(lambda: read_mesh(tmp_path / "a.stl", "mm"))
    axes = "".join(f"property float {axis}\n" for axis in "xyz")
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {many}\n{axes}element face 1\n"
    (tmp_path / "a.ply").write_text(f"{head}property list uchar int vertex_indices\nend_header\n")
    assert f"{many} vertices, more than" in refused(lambda: read_mesh(tmp_path / "a.ply", "mm"))
    words = bytearray(1024)
    words[0:20] = struct.pack("<BBHHHHHfHH", 2, 0x50, 65535, 65535, 1, 65534, 0, -1.0, 3, 1)
    words[512:516] = bytes([0, 0, 1, 84])
    (tmp_path / "a.c3d").write_bytes(bytes(words))
    assert "holds 0 of the 65534 frames it declares" in refused(lambda: read_c3d_markers(tmp_path / "a.c3d"))


def workbook(path: Path, cells: str, others: dict[str, bytes] | None = None) -> Path:
    """A workbook of one sheet whose rows are written out."""
    kinds = "application/vnd.openxmlformats-officedocument.spreadsheetml"
    space = "http://schemas.openxmlformats.org"
    parts = {
        "[Content_Types].xml": f'<Types xmlns="{space}/package/2006/content-types"><Default Extension="rels" '
        'ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        f'<Override PartName="/xl/workbook.xml" ContentType="{kinds}.sheet.main+xml"/>'
        f'<Override PartName="/xl/worksheets/sheet1.xml" ContentType="{kinds}.worksheet+xml"/></Types>',
        "_rels/.rels": f'<Relationships xmlns="{space}/package/2006/relationships"><Relationship Id="a" '
        f'Type="{space}/officeDocument/2006/relationships/officeDocument" Target="xl/workbook.xml"/></Relationships>',
        "xl/workbook.xml": f'<workbook xmlns="{space}/spreadsheetml/2006/main" '
        f'xmlns:r="{space}/officeDocument/2006/relationships"><sheets><sheet name="a" sheetId="1" r:id="b"/></sheets>'
        "</workbook>",
        "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{space}/package/2006/relationships"><Relationship '
        f'Id="b" Type="{space}/officeDocument/2006/relationships/worksheet" Target="worksheets/sheet1.xml"/>'
        "</Relationships>",
        "xl/worksheets/sheet1.xml": f'<worksheet xmlns="{space}/spreadsheetml/2006/main"><sheetData>{cells}'
        "</sheetData></worksheet>",
    }
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in {**parts, **(others or {})}.items():
            archive.writestr(name, text)
    return path


def sheet_row(number: int, *cells: tuple[str, object]) -> str:
    """A row of a sheet: column and number, or text in quotes."""
    written = "".join(
        f'<c r="{column}{number}" t="inlineStr"><is><t>{value}</t></is></c>'
        if isinstance(value, str)
        else f'<c r="{column}{number}"><v>{value}</v></c>'
        for column, value in cells
    )
    return f'<row r="{number}">{written}</row>'


TABLE = sheet_row(1, ("A", "time [s]"), ("B", "f [N]")) + sheet_row(2, ("A", 0), ("B", 1.5)) + sheet_row(3, ("A", 1))


def test_a_workbook_with_a_cell_at_the_far_end_is_refused(tmp_path: Path) -> None:
    """One cell in the last row and column that a sheet may have, 16 384 times 1 048 576 of them."""
    assert read_table(workbook(tmp_path / "right.xlsx", TABLE)).values[0, 0] == 1.5
    row = sheet_row(1_048_576, ("XFD", 1))
    for written in (row, row.replace('"', "'"), row.replace("=", " = ")):  # XML knows both quotes, and blanks
        far = workbook(tmp_path / "far.xlsx", TABLE + written)
        assert "row 1048576, column 16384" in refused(lambda file=far: read_table(file))


def test_a_workbook_that_unpacks_to_too_much_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its parts count whether they are read or not; 1000 times its size is no table of numbers."""
    bomb = workbook(tmp_path / "bomb.xlsx", TABLE, {"xl/media/a.bin": bytes(65_000_000)})
    assert "unpacks to 65 MB" in refused(lambda: read_table(bomb))
    whole = workbook(tmp_path / "right.xlsx", TABLE)
    monkeypatch.setattr(plain_table, "MOST_XML", 1000)
    assert "unpacks to" in refused(lambda: read_table(whole))


def test_an_archive_of_maps_that_unpacks_to_too_much_is_refused(tmp_path: Path) -> None:
    for name, array in (("bomb", np.zeros(9_000_000)), ("lies", None)):
        folder = tmp_path / name
        folder.mkdir()
        with zipfile.ZipFile(folder / FILE, "w", zipfile.ZIP_DEFLATED) as archive:
            part = io.BytesIO()
            np.save(part, np.zeros(3) if array is None else array)
            archive.writestr("fixed_vertices.npy", part.getvalue() if array is not None else _lying(part.getvalue()))
    assert "unpacks to 72 MB" in refused(lambda: read_series(tmp_path / "bomb"))
    assert "its head names (2000000000,)" in refused(lambda: read_series(tmp_path / "lies"))


def _lying(part: bytes) -> bytes:
    """An array of three numbers whose head names two thousand million."""
    shape, other = b"(3,), }", b"(2000000000,), }"
    return part.replace(shape + b" " * (len(other) - len(shape)), other)


def test_the_number_of_a_column() -> None:
    assert [unpacked._number(each) for each in (b"A", b"Z", b"AA", b"XFD")] == [1, 26, 27, 16384]


COMMANDS = {
    "area": ("area", "{bad}.stl", "{bad}.stl", "--unit", "mm", "--motion", "{bad}.csv"),
    "fit": ("fit", "{bad}.stl", "--unit", "mm", "--shape", "sphere"),
    "cop": ("cop", "{bad}.csv", "--motion", "{bad}.csv", "--ground", "plane:0,1,0,0"),
    "loadcells": ("loadcells", "{bad}.csv", "--unit", "N"),
    "ik": ("ik", "{bad}.trc", "--model", "{bad}.osim"),
    "id": ("id", "{bad}.mot", "--model", "{bad}.osim"),
    "joint": ("joint", "{bad}.trc", "--axis", "--first", "A,B,C", "--second", "D,E,F"),
    "markers": ("markers", "{bad}.trc", "--model", "{bad}.osim"),
    "cohort": ("cohort", "{bad}.toml"),
    "rerun": ("rerun", "{bad}.json"),
    "gap gather": ("gap", "gather", "{bad}.toml"),
    "elbow population": ("elbow", "population", "{bad}.toml", "--range", "0:120deg", "--limit", "5"),
    "sit-to-stand calibrate": ("sit-to-stand", "calibrate", "{bad}.toml"),
}


@pytest.mark.parametrize("name", COMMANDS)
def test_commands_refuse_pipes_and_devices(name: str, tmp_path: Path) -> None:
    for kind in ("pipe", "device"):
        for suffix in ("stl", "csv", "trc", "osim", "mot", "toml", "json"):
            file = tmp_path / f"{kind}.{suffix}"
            os.mkfifo(file) if kind == "pipe" else file.symlink_to("/dev/zero")
        words = [word.format(bad=tmp_path / kind) for word in COMMANDS[name]]
        with within(5.0):
            result = call(*words, "--out", tmp_path / "out")
        assert result.code == 2 and len(result.complaints) == 1, result.err
        assert "is a named pipe" in result.err or "is a device" in result.err, result.err
    assert not (tmp_path / "out").exists()


def test_a_machine_that_has_no_more_files_is_no_mistake_of_the_input(tmp_path: Path) -> None:
    """The file is right, and none can be opened."""
    import resource

    file = tmp_path / "a.csv"
    file.write_text("1\n", encoding="utf-8")
    before = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (0, before[1]))
    try:
        with pytest.raises(OSError, match=os.strerror(errno.EMFILE)):
            open_file(file)
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, before)
    with open_file(file) as stream:
        assert stream.read() == b"1\n"
