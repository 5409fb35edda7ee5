"""Libraries that may print, hang or end the process on a damaged file run in a process of their own."""

from __future__ import annotations

import subprocess
import sys

from geocontact.data.module_folders import searching

PROGRAM = "import runpy\nrunpy.run_module(sys.argv.pop(1), run_name='__main__', alter_sys=True)"


def run_apart(module: str, words: list[str], seconds: float) -> subprocess.CompletedProcess[bytes]:
    """`python -m MODULE WORDS` in another process, which finds the modules that this one finds.

    It finds none in the current folder (`module_folders`).

    Raises
    ------
    subprocess.TimeoutExpired
        It takes longer.
    """
    command = [sys.executable, "-P", "-W", "ignore", "-c", searching(PROGRAM), module, *words]
    return subprocess.run(command, capture_output=True, timeout=seconds, check=False)
