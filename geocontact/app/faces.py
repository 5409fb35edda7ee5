"""Faces that a filled form counts, or what is within its threshold, found in a process of its own for the picture.

The process stays, with the last surfaces, so that the next answer takes no longer than the choice itself.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
import warnings
from base64 import b64encode
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from geocontact.app.files import PATIENCE, Known, known_file, until_close
from geocontact.data.errors import InputError

SIDES = "; medial in blue, lateral in orange"


@dataclass(frozen=True)
class Found:
    """The answer as the page takes it.

    Parameters
    ----------
    said
        Number of faces and their area, or areas within each threshold; why there is none.
    marked
        Bits of the faces that count in base64, their number, the plane to the medial side and mm of the unit; or
        levels of the vertices of each body in base64 (`within`). None without an answer.
    box
        Least and largest values of x y z nx ny nz.
    about, page, thresholds
        Frame and bodies, path of their page, and the thresholds that are filled in [m].
    """

    said: str
    marked: dict[str, Any] | None = None
    box: list[list[float]] | None = None
    about: str = ""
    page: str = ""
    thresholds: Sequence[float] = ()


class Chooser:
    """The process; it starts with the first question, and anew after one that ended it.

    Parameters
    ----------
    patience
        s that an answer may last.
    """

    def __init__(self, patience: float = PATIENCE) -> None:
        self._patience = patience
        self._process: subprocess.Popen[str] | None = None
        self._one_at_a_time = threading.Lock()

    def ask(self, asked: dict[str, Any]) -> Found:
        """The answer; `asked` has the fields of `FaceQuestion`, or what `within` reads."""
        with self._one_at_a_time:
            process = self._started()
            timer = threading.Timer(self._patience, process.kill)
            timer.start()
            try:
                line = _exchanged(process, json.dumps(asked))
            finally:
                timer.cancel()
            if line:
                return Found(**json.loads(line))
            code = process.wait()
            return Found(f"not coloured: the process that reads the surface ended with {code}")

    def close(self) -> None:
        """End the process."""
        if self._process is not None:
            self._process.kill()
            self._process.communicate()

    def _started(self) -> subprocess.Popen[str]:
        if self._process is None or self._process.poll() is not None:
            self._process = subprocess.Popen(
                [sys.executable, "-P", "-m", __name__],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                encoding="utf-8",
                start_new_session=os.name != "nt",
            )
            if not until_close(self._process):
                self._process.kill()
        return self._process


def _exchanged(process: subprocess.Popen[str], line: str) -> str:
    """A line for a line; "" where the process has ended."""
    if process.stdin is None or process.stdout is None:
        return ""
    try:
        process.stdin.write(f"{line}\n")
        process.stdin.flush()
        return process.stdout.readline()
    except (BrokenPipeError, OSError):
        return ""


def answer(asked: dict[str, Any], body_of: Callable[[Any, Any], Any]) -> Found:
    """The answer to a question in this process; `body_of` reads a surface."""
    import numpy as np

    from geocontact.analyses.frame.shown_faces import FaceQuestion, shown_faces

    question = FaceQuestion(**asked)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # stand beside the file already
        try:
            found = shown_faces(question, body_of(question, known_file(Path(question.surface))))
        except InputError as error:
            return Found(f"not coloured: {error}")
    bits = b64encode(np.packbits(found.chosen, bitorder="little").tobytes()).decode("ascii")
    marked = {"faces": bits, "count": len(found.chosen), "medial": found.medial, "scale": found.scale}
    return Found(found.words + (SIDES if found.medial else ""), marked, [list(each) for each in found.box])


def answers() -> None:
    """An answer for each line of standard input."""
    from dataclasses import replace

    from geocontact.analyses.frame import shown_faces

    @lru_cache(maxsize=2)
    def read(question: shown_faces.FaceQuestion, _: Known | None) -> object:
        return shown_faces.body_of(question)

    def body_of(question: shown_faces.FaceQuestion, known: Known | None) -> object:
        return read(replace(question, region="", split="", side="", medial="", option="", elsewhere=""), known)

    for line in sys.stdin:
        asked = json.loads(line)
        sys.stdout.write(json.dumps(asdict(_within(asked) if "command" in asked else answer(asked, body_of))) + "\n")
        sys.stdout.flush()


def _within(asked: dict[str, Any]) -> Found:
    """What is within a threshold."""
    from geocontact.app import within  # the command line, which faces do not need

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return Found(**within.answer(asked))


if __name__ == "__main__":
    answers()
