"""What is said while something takes long: to a terminal, and to nothing else."""

from __future__ import annotations

import io
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest
from numba.core import event

from geocontact.cli import show
from geocontact.geometry.kernels import compile as kernels

KERNEL = """
from geocontact.geometry.kernels.compile import compilations, kernel


@kernel
def doubled(x):
    return 2 * x


if __name__ == "__main__":
    import doubled as itself

    before = compilations()
    itself.doubled(3)
    print(compilations() - before)
    if compilations() > before:  # numba keeps no text of what it loads
        print(sum("cfunc" in text for text in itself.doubled.inspect_llvm().values()))
"""


class Screen(io.StringIO):
    """Somebody who looks."""

    def isatty(self) -> bool:
        return True


def terminal(monkeypatch: pytest.MonkeyPatch) -> Screen:
    """In the place of stderr; not a fixture, which would come before the test's own capture."""
    shown = Screen()
    monkeypatch.setattr(sys, "stderr", shown)
    monkeypatch.setenv("TERM", "xterm")
    return shown


def test_stages_are_shown_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    shown = terminal(monkeypatch)
    with show.Terminal().stages("knee_07") as at:
        at("every effect alone")
        at("two effects together")
    assert "knee_07: two effects together" in shown.getvalue()


def test_steps_are_counted_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    shown = terminal(monkeypatch)
    with show.Terminal().progress("frames", 3) as step:
        step()
        step()
    assert "2/3" in shown.getvalue()


def test_a_file_gets_a_line_now_and_then(monkeypatch: pytest.MonkeyPatch) -> None:
    """One in half a minute at most: 57 s of work said nothing."""
    now, written = [0.0], io.StringIO()
    monkeypatch.setattr(sys, "stderr", written)
    monkeypatch.setattr(show.time, "monotonic", lambda: now[0])
    with show.Terminal().progress("effects", 52) as step, show.Terminal().stages("knee_07") as at:
        for now[0] in (10.0, 31.0, 40.0, 59.0, 62.0):
            step()
        at("two effects together")
    assert written.getvalue().splitlines() == [
        "effects: 2 of 52 done …",
        "effects: 5 of 52 done …",
        "knee_07: two effects together …",
    ]


def test_a_file_gets_nothing_of_what_is_quick(monkeypatch: pytest.MonkeyPatch) -> None:
    written = io.StringIO()
    monkeypatch.setattr(sys, "stderr", written)
    with show.Terminal().stages("knee_07") as at, show.Terminal().progress("frames", 3) as step:
        at("every effect alone")
        step()
    assert written.getvalue() == ""


@pytest.mark.parametrize(("misses", "ended"), [(0, False), (1, False), (1, True)])
def test_compiling_is_said_where_something_is_compiled(
    misses: int, ended: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Preparation that lasts is not compilation: other work may slow it down, or frames follow what was compiled."""
    shown = terminal(monkeypatch)
    monkeypatch.setattr(show, "SILENCE", 0.05)
    monkeypatch.setattr(show, "AGAIN", 0.01)
    counts = iter([5, 5, *[5 + misses] * 1000])
    monkeypatch.setattr(kernels, "compilations", lambda: next(counts))
    with show.Terminal().preparing():
        with event.trigger_event("numba:compile"):
            time.sleep(0.0 if ended else 0.2)
        time.sleep(0.2 if ended else 0.0)
    assert (show.COMPILING in shown.getvalue()) == (bool(misses) and not ended)


def test_a_kernel_that_the_cache_lacks_is_counted_once(tmp_path: Path) -> None:
    """In a process with an empty cache it is compiled, without a wrapper for C; in the next one it is loaded."""
    (tmp_path / "doubled.py").write_text(KERNEL, encoding="utf-8")
    places = [str(tmp_path), str(Path(__file__).resolve().parents[2])]
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "cache"), "PYTHONPATH": os.pathsep.join(places)}
    environment.pop("NUMBA_DISABLE_JIT", None)
    counts = [
        subprocess.run([sys.executable, "-m", "doubled"], env=environment, capture_output=True, text=True, check=True)
        for _ in range(2)
    ]
    assert [each.stdout.split() for each in counts] == [["1", "0"], ["0"]]
