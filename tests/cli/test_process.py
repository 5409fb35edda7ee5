"""The program as a process of its own: its streams, its folder, its exit code; what it says while one waits."""

from __future__ import annotations

import itertools
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from numba.core import event

from geocontact.analyses.area import result as area_analysis
from geocontact.analyses.area.distance_file import DistanceMaps
from geocontact.analyses.frame import folder as results_folder
from geocontact.cli import main, show
from tests.cli.calls import FEMUR, INSERT, MESHES, PLATE, ROOT, SPHERE, area, done, gait, inventory, poses, process
from tests.contract import FILES


@pytest.mark.slow
def test_from_another_folder_with_relative_paths(tmp_path: Path) -> None:
    """Inputs, the result folder and a path that looks like an option are relative to where the user stands."""
    for file, name in ((FEMUR, "-x.stl"), (INSERT, "insert.stl")):
        shutil.copy(file, tmp_path / name)
    gait(tmp_path, [0])
    result = process("area", "./-x.stl", "insert.stl", "--unit=mm", "--motion=gait.csv", "--out=out/1", cwd=tmp_path)
    assert (result.returncode, result.stderr) == (0, ""), result.stderr
    assert set(inventory(tmp_path / "out/1")) == FILES
    assert "out/1" in result.stdout


def test_refusal_is_one_line_and_exit_2(tmp_path: Path) -> None:
    result = process(
        "area", tmp_path / "no.stl", PLATE, "--unit", "mm", "--sweep", "a=0:1:1", "--out", tmp_path / "out"
    )
    assert result.returncode == 2
    assert result.stderr.count("\n") == 1 and "no such file; check the path" in result.stderr
    assert inventory(tmp_path) == {}


@pytest.mark.slow
def test_refusal_with_a_name_that_the_terminal_cannot_show(tmp_path: Path) -> None:
    """Written with what the terminal has instead of failing on the way out."""
    command = [
        sys.executable,
        "cli.py",
        "area",
        str(tmp_path / "膝 ≤ – é.stl"),
        str(PLATE),
        "--unit=mm",
        "--sweep=a=0:1:1",
    ]
    environment = os.environ | {"PYTHONIOENCODING": "ascii"}
    result = subprocess.run([*command, f"--out={tmp_path / 'out'}"], cwd=ROOT, env=environment, capture_output=True)
    assert result.returncode == 2
    assert result.stderr.count(b"\n") == 1 and b"no such file" in result.stderr


def test_a_process_ends_without_a_search_for_circles() -> None:
    """What is registered first is called last: by then Python has been told to leave all objects to the system."""
    program = """
import atexit, gc
atexit.register(lambda: print(gc.get_freeze_count() > 10_000, len(gc.get_objects()) < 10_000))
from geocontact.cli.main import main
main(["--version"])
"""
    result = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True)
    assert (result.returncode, result.stderr) == (0, "")
    assert result.stdout.split()[-2:] == ["True", "True"]


def ball_on_plate(folder: Path) -> list[str]:
    """A quick call that works."""
    motion = poses(folder, (0, 20, 0))
    return ["area", str(SPHERE), str(PLATE), f"--motion={motion}", "--unit=mm", f"--out={folder / 'out'}"]


@pytest.mark.slow
def test_summary_on_a_terminal_without_unicode(tmp_path: Path) -> None:
    """Results are announced with an ellipsis and end up in an ASCII log all the same."""
    environment = os.environ | {"PYTHONIOENCODING": "ascii"}
    result = subprocess.run(
        [sys.executable, "cli.py", *ball_on_plate(tmp_path)], cwd=ROOT, env=environment, capture_output=True
    )
    assert result.returncode == 0, result.stderr
    assert (tmp_path / "out/area.csv").is_file()


@pytest.mark.slow
def test_results_are_there_when_nobody_reads_the_summary(tmp_path: Path) -> None:
    """`geocontact area … | head -1`: the pipe is closed before the run has said everything."""
    if os.name != "posix":
        pytest.skip("a pipe without a reader is made on Unix")
    reader, writer = os.pipe()
    os.close(reader)
    result = subprocess.run(
        [sys.executable, "-u", "cli.py", *ball_on_plate(tmp_path)], cwd=ROOT, stdout=writer, stderr=subprocess.PIPE
    )
    os.close(writer)
    assert b"Traceback" not in result.stderr
    assert (tmp_path / "out/area.csv").is_file()


@pytest.mark.skipif(os.name != "posix", reason="a terminated process cannot tidy up elsewhere")
def test_a_terminated_run_leaves_nothing_behind(tmp_path: Path) -> None:
    """As a queueing system ends it: once its draft is there."""
    place = tmp_path / "place"
    place.mkdir()
    motion = MESHES / "gait.csv"
    command = ["area", FEMUR, INSERT, f"--motion={motion}", "--unit=mm", "--threshold=0.1,4", f"--out={place / 'out'}"]
    child = subprocess.Popen(
        [sys.executable, "cli.py", *map(str, command)], cwd=ROOT, stderr=subprocess.PIPE, text=True
    )
    until = time.monotonic() + 60.0
    while not inventory(place) and child.poll() is None and time.monotonic() < until:
        time.sleep(0.01)
    assert inventory(place), "no draft was seen"
    child.terminate()
    _, said = child.communicate(timeout=120)
    assert child.returncode not in (0, None)
    assert "Traceback" not in said and len(said.splitlines()) == 1, said
    assert said == "terminated; nothing was written\n"
    assert inventory(place) == {}


def test_an_interrupted_run_tells_what_it_had_finished(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Of several trials those that were done before stay, and the line says where."""
    monkeypatch.setattr(results_folder, "_written", [])

    def two_of_three(*_: object, **__: object) -> None:
        for name in ("first", "second"):
            with results_folder.written_whole(tmp_path / name) as draft:
                (draft / "table.csv").write_text("1")
        raise KeyboardInterrupt

    monkeypatch.setattr(main, "app", two_of_three)
    monkeypatch.setattr(main, "_load_what_is_listed", lambda _: None)
    assert main.run(["area"]) == 130
    assert capsys.readouterr().err == f"interrupted; what was finished is in {tmp_path / 'second'} and 1 folder more\n"


@pytest.mark.skipif(os.name != "posix", reason="the size of files is limited on Unix")
def test_a_full_disk_is_one_line_and_leaves_nothing(tmp_path: Path) -> None:
    """A limit on the size of files in place of a full disk, which benchmarks/robustness/faults.py mounts."""
    file = tmp_path / "frames.csv"
    file.write_text("time [s],AL,PM,AM,PL\n" + "".join(f"{k / 100},100,200,300,400\n" for k in range(400)))
    program = (
        "import resource, signal; signal.signal(signal.SIGXFSZ, signal.SIG_IGN); "
        "resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000)); from geocontact.cli.main import main; main()"
    )
    words = ["loadcells", str(file), "--unit=N", f"--out={tmp_path / 'out'}"]
    ended = subprocess.run([sys.executable, "-B", "-c", program, *words], cwd=ROOT, capture_output=True, text=True)
    assert ended.returncode == 1 and len(ended.stderr.splitlines()) == 1, ended.stderr
    assert ended.stderr.endswith("File too large; nothing was written\n"), ended.stderr
    assert inventory(tmp_path).keys() == {"frames.csv"}


def test_a_command_seldom_looks_for_garbage(tmp_path: Path) -> None:
    """Imports and numba's compiler make objects that stay: with Python's own threshold a first run takes 2 s longer."""
    program = (
        "import atexit, gc; seen = []; gc.callbacks.append(lambda phase, _: seen.append(phase)); "
        "from geocontact.cli.main import main; seen.clear(); atexit.register(lambda: print(f'@{len(seen)}')); main()"
    )
    words = ["fit", str(SPHERE), "--shape=sphere", "--unit=mm", f"--out={tmp_path / 'out'}"]
    ended = subprocess.run([sys.executable, "-c", program, *words], cwd=ROOT, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
    assert int(ended.stdout.rpartition("@")[2]) < 40, "hundreds at a threshold of 700"


def test_module_and_script_are_the_same_program() -> None:
    """The installed command calls what cli.py calls."""
    pyproject = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    assert 'geocontact = "geocontact.cli.main:main"' in pyproject
    assert "from geocontact.cli.main import main" in (ROOT / "cli.py").read_text(encoding="utf-8")


def test_compiling_is_announced_when_it_keeps_the_user_waiting(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(show, "SILENCE", 0.1)
    evolution = area_analysis.area_evolution

    def slow(*given: Any) -> Any:
        with event.trigger_event("numba:compile"):
            time.sleep(1.0)
        return evolution(*given)

    monkeypatch.setattr(area_analysis, "area_evolution", slow)
    monkeypatch.setattr("geocontact.geometry.kernels.compile.compilations", itertools.count().__next__)
    result = area(tmp_path / "out", moving=SPHERE, fixed=PLATE, motion=poses(tmp_path, (0, 20, 0)))
    (line,) = result.complaints
    assert line.startswith("compiling the distance kernels, once on this machine") and result.code == 0


@pytest.mark.parametrize(("height", "called"), [(20.2, False), (19.9, True)])
def test_a_job_compiles_what_it_calls(height: float, called: bool, tmp_path: Path) -> None:
    """The search for the deepest point is a quarter of all compilation: only where bodies overlap."""
    program = (
        "from geocontact.cli.main import run; import sys; code = run(sys.argv[1:]); "
        "from geocontact.geometry.kernels.floor import deepest; print(f'@{len(deepest.signatures)}'); sys.exit(code)"
    )
    motion = poses(tmp_path, (0, height, 0))
    words = [
        "area",
        str(SPHERE),
        str(PLATE),
        "--unit=mm",
        "--threshold=4",
        f"--motion={motion}",
        f"--out={tmp_path / 'out'}",
    ]
    ended = subprocess.run([sys.executable, "-c", program, *words], cwd=ROOT, capture_output=True, text=True)
    assert ended.stdout.rpartition("@")[2].strip() == str(int(called)), ended.stderr


@pytest.mark.slow
def test_many_frames_are_not_mistaken_for_compiling(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Once the kernels are there nothing is said, however long the frames take."""
    motion = poses(tmp_path, (0, 20, 0), (0, 20.1, 0))
    area(tmp_path / "first", moving=SPHERE, fixed=PLATE, motion=motion)
    add = DistanceMaps.add
    monkeypatch.setattr(DistanceMaps, "add", lambda *given, **named: (time.sleep(1.0), add(*given, **named))[1])
    monkeypatch.setattr(show, "SILENCE", 1.0)
    done(area(tmp_path / "out", moving=SPHERE, fixed=PLATE, motion=motion))
