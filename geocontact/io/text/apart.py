"""Libraries that may print, hang or end the process on a damaged file run in a process of their own."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]


def run_apart(module: str, words: list[str], seconds: float) -> subprocess.CompletedProcess[bytes]:
    """`python -m MODULE WORDS` in another process, which finds the modules that this one finds.

    Raises
    ------
    subprocess.TimeoutExpired
        It takes longer.
    """
    paths = os.pathsep.join(dict.fromkeys([*(path for path in sys.path if path), str(ROOT)]))
    command = [sys.executable, "-P", "-W", "ignore", "-m", module, *words]
    return subprocess.run(
        command, env={**os.environ, "PYTHONPATH": paths}, capture_output=True, timeout=seconds, check=False
    )
