"""Files whose names differ in capital letters only: refused where results would share a name or one was dropped."""

from __future__ import annotations

import shutil
from contextlib import chdir
from pathlib import Path

import pytest

import geocontact as gc
from geocontact.analyses.frame.surface_page import write_surface_page
from geocontact.analyses.misalignment.recordings import recordings
from geocontact.app.gap_files import write_trials
from geocontact.data.errors import InputError
from geocontact.io.recordings.tool_folder import read_tool_folder

SAMPLE = Path(__file__).resolve().parents[2] / "meshes" / "sphere_r20.stl"


@pytest.fixture
def distinct(tmp_path: Path) -> Path:
    """A folder in which a.csv and A.csv are two files; some systems have none."""
    (tmp_path / "probe").touch()
    if (tmp_path / "PROBE").exists():
        pytest.skip("names are the same in small and in capital letters here")
    (tmp_path / "probe").unlink()
    return tmp_path


@pytest.mark.parametrize(
    ("names", "words"),
    [
        (("walk.c3d", "walk.C3D"), "walk.C3D and walk.c3d differ in capital letters only"),
        (("walk.trc", "Walk.trc"), "Walk.trc and walk.trc differ in capital letters only"),
        (("walk.trc", "Walk.c3d"), "two trials are called walk"),
        (("walk.trc", "walk.osim", "walk.OSIM"), "walk.OSIM and walk.osim differ in capital letters only"),
    ],
)
def test_trials_of_a_folder(distinct: Path, names: tuple[str, ...], words: str) -> None:
    for name in names:
        (distinct / name).touch()
    with pytest.raises(InputError, match=words):
        read_tool_folder(distinct)


def test_a_recording_that_was_exported_too_is_one_trial(distinct: Path) -> None:
    for name in ("walk.trc", "walk.c3d", "run.TRC"):
        (distinct / name).touch()
    assert [trial.name for trial in read_tool_folder(distinct).trials] == ["run", "walk"]


def test_the_page_of_another_surface_stays(distinct: Path) -> None:
    """Of a.STL beside a.stl, as of a.ply beside it; the page of the same file is renewed."""
    for name in ("a.stl", "a.STL"):
        shutil.copy(SAMPLE, distinct / name)
    with chdir(distinct):
        page = write_surface_page(Path("a.stl"), "mm")
        before = page.read_bytes()
        with pytest.raises(InputError, match=r"a_surface.html.* of another surface than a\.STL; name another file"):
            write_surface_page(Path("a.STL"), "mm")
        assert page.read_bytes() == before
        assert write_surface_page(Path("a.stl"), "mm") == page
        assert write_surface_page(Path("a.STL"), "mm", Path("b.html")).read_bytes() != before
        assert write_surface_page(Path("a.STL"), "mm", page) == page  # named: its own will


def test_trials_of_a_case_that_is_begun(distinct: Path) -> None:
    for name in ("t1.csv", "T1.csv", "t2.csv"):
        (distinct / name).write_text("time [s],angle [rad],torque [N m]\n0,0,0\n1,1,1\n", encoding="utf-8")
    (distinct / "mine.py").write_text("def run(time, inputs, numbers):\n    return inputs[0]\n", encoding="utf-8")
    with pytest.raises(InputError, match="two trials are called t1"):
        gc.init_gap_case(simulator=str(distinct / "mine.py"), data=distinct)
    said = write_trials([distinct / "t1.csv", distinct / "T1.csv"], [], distinct / "out")
    assert "two files have one name" in said[0]


def test_recordings_of_an_elbow(distinct: Path) -> None:
    files = [distinct / "one" / "a.csv", distinct / "other" / "A.CSV"]
    for file in files:
        file.parent.mkdir()
        rows = "".join(f"{0.1 * k:.1f},{20 + k % 7 * 9 + 0.01 * k},{5 + k % 5 + 0.1 * k}\n" for k in range(60))
        file.write_text(f"time [s],beta [deg],force [N]\n{rows}", encoding="utf-8")
    with pytest.raises(InputError, match="is the second recording named 'A'"):
        recordings("locked", files, None, None, None, None)
