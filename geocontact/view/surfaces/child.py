"""A Python program in a process of its own: what ends that process does not end this one.

A missing graphics driver kills the process that asks for it (segmentation fault) instead of raising, so whatever
renders runs here, and so does the question whether rendering works.
"""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec

from geocontact.data.module_folders import searching

SLOW = "no answer within"
_FATAL_ON_WINDOWS = 0xC0000000  # status codes from here on are crashes; elsewhere a crash is a negative code


def start(program: str, *arguments: str) -> subprocess.Popen[str]:
    """Run `program` by this Python; it finds the modules that this process finds, and sees `arguments` as sys.argv[1:].

    The current folder is not searched for modules: a file called numpy.py beside the data is not run.
    """
    return subprocess.Popen(
        [sys.executable, "-P", "-c", searching(program), *arguments],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        errors="replace",
    )


def outcome(child: subprocess.Popen[str], patience: float | None) -> str:
    """Empty when the program ended well within `patience` [s] (None: however long), else what happened in a few words.

    A program that takes longer is ended, and so is one whose caller is interrupted.
    """
    try:
        _, said = child.communicate(timeout=patience)
    except subprocess.TimeoutExpired:
        return f"{SLOW} {patience:g} s"
    finally:
        if child.poll() is None:
            child.kill()
            child.communicate()
    code = child.returncode
    if code == 0:
        return ""
    if code < 0 or code >= _FATAL_ON_WINDOWS:
        signal = f"signal {-code}" if code < 0 else f"status {code:#x}"
        return f"ends the process ({signal}): a system library or driver is missing"
    lines = [line.strip() for line in said.splitlines() if line.strip()]
    return lines[-1][:160] if lines else f"exit code {code}"


PROGRAM = """
import pyvista
plotter = pyvista.Plotter(off_screen=True, window_size=(64, 64))
plotter.add_mesh(pyvista.Sphere())
assert plotter.screenshot(return_img=True).std() > 0, "the rendered picture is blank"
"""
INSTALL = "pip install 'geocontact[view]'"
REMEDY = f"{INSTALL}, and apt-get install libegl1 libgl1 (Debian, Ubuntu)"
PATIENCE = 20.0  # s; the first import after installing reads a few hundred megabytes


@dataclass(frozen=True)
class Probe:
    """Answer of a probe; `reason` says in a few words why not, and is empty when it works."""

    ok: bool
    reason: str = ""


@cache
def off_screen_works() -> Probe:
    """Render a small scene in a child process; the answer is kept for the life of this process.

    A crash of the child (segmentation fault without libegl1 and libgl1 on a bare Debian), an exception, a blank picture
    and no answer within `PATIENCE` all mean no.
    """
    if find_spec("pyvista") is None:
        return Probe(ok=False, reason="pyvista is not installed")
    trouble = outcome(start(PROGRAM), PATIENCE)
    return Probe(ok=not trouble, reason=trouble)
