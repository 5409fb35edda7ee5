"""A child process that crashes, hangs, raises or draws nothing is an answer, not an accident."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import pytest

from geocontact.view.surfaces import child
from geocontact.view.surfaces.child import Probe, off_screen_works
from tests.view.surfaces.conftest import CRASH

posix = pytest.mark.skipif(sys.platform == "win32", reason="signals end processes on POSIX only")


@posix
def test_a_crash_means_no(monkeypatch: pytest.MonkeyPatch, asked_anew: None) -> None:
    pytest.importorskip("pyvista")
    monkeypatch.setattr(child, "PROGRAM", CRASH)
    assert off_screen_works() == Probe(False, "ends the process (signal 11): a system library or driver is missing")


def test_silence_means_no(monkeypatch: pytest.MonkeyPatch, asked_anew: None) -> None:
    pytest.importorskip("pyvista")
    monkeypatch.setattr(child, "PROGRAM", "import time; time.sleep(60)")
    monkeypatch.setattr(child, "PATIENCE", 0.5)
    start = time.perf_counter()
    assert off_screen_works() == Probe(False, "no answer within 0.5 s")
    assert time.perf_counter() - start < 20.0


def test_a_blank_picture_means_no(monkeypatch: pytest.MonkeyPatch, asked_anew: None) -> None:
    """The program of the probe, with a pyvista that draws nothing."""
    pytest.importorskip("pyvista")
    nothing = (
        "import sys, types; fake = types.ModuleType('pyvista'); sys.modules['pyvista'] = fake\n"
        "class Plotter:\n"
        "    def __init__(self, **_): pass\n"
        "    def add_mesh(self, _): pass\n"
        "    def screenshot(self, return_img): import numpy; return numpy.zeros((64, 64, 3))\n"
        "fake.Plotter, fake.Sphere = Plotter, object\n"
    )
    monkeypatch.setattr(child, "PROGRAM", nothing + child.PROGRAM)
    assert off_screen_works() == Probe(False, "AssertionError: the rendered picture is blank")


def test_no_pyvista_means_no(monkeypatch: pytest.MonkeyPatch, asked_anew: None) -> None:
    monkeypatch.setitem(sys.modules, "pyvista", None)
    assert off_screen_works() == Probe(False, "pyvista is not installed")


def test_it_is_asked_once(monkeypatch: pytest.MonkeyPatch, asked_anew: None) -> None:
    pytest.importorskip("pyvista")
    asked = []
    monkeypatch.setattr(child, "start", lambda *_: asked.append(1))
    monkeypatch.setattr(child, "outcome", lambda *_: "")
    assert off_screen_works() == off_screen_works() == Probe(True)
    assert len(asked) == 1


@pytest.mark.parametrize(
    ("program", "said"),
    [
        ("pass", ""),
        ("raise SystemExit(3)", "exit code 3"),
        ("import sys; sys.stderr.write('noise\\n' * 20000 + 'the last line  \\n\\n'); sys.exit(1)", "the last line"),
        ("raise ValueError('x' * 5000)", "ValueError: " + "x" * 148),
        pytest.param("import os; os.abort()", "ends the process (signal 6)", marks=posix),
    ],
)
def test_outcome_in_a_few_words(program: str, said: str) -> None:
    outcome = child.outcome(child.start(program), 60.0)
    assert outcome.startswith(said) and bool(outcome) == bool(said)


def test_a_windows_crash_is_a_crash(monkeypatch: pytest.MonkeyPatch) -> None:
    """An access violation is a large positive exit code there."""
    running = child.start("pass")
    running.communicate()
    monkeypatch.setattr(running, "returncode", 0xC0000005)
    assert child.outcome(running, 60.0).startswith("ends the process (status 0xc0000005)")


def test_the_child_finds_the_package_and_not_what_lies_about(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "numpy.py").write_text("raise SystemExit('the numpy.py beside the data was run')")
    monkeypatch.chdir(tmp_path)
    program = "import sys, numpy, geocontact; assert sys.argv[1:] == ['a b', '--c'], sys.argv"
    assert child.outcome(child.start(program, "a b", "--c"), 60.0) == ""


def test_an_interrupted_caller_leaves_no_child(monkeypatch: pytest.MonkeyPatch) -> None:
    running = child.start("import time; time.sleep(60)")
    wait = running.communicate

    def interrupted(timeout: float | None = None) -> tuple[str, str]:
        if timeout is not None:
            raise KeyboardInterrupt
        return wait()

    monkeypatch.setattr(running, "communicate", interrupted)
    with pytest.raises(KeyboardInterrupt):
        child.outcome(running, 30.0)
    assert running.poll() is not None
