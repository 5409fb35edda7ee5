"""Examples of docstrings are run as they stand, in a folder of their own beside the shipped samples."""

from __future__ import annotations

import contextlib
import doctest
import os
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


class Checker(doctest.OutputChecker):
    """Accepts an output that `agrees`: (shown, printed) → whether they are the same, spaces and breaks aside."""

    def __init__(self, agrees: Callable[[str, str], bool]) -> None:
        self.agrees = agrees

    def check_output(self, want: str, got: str, optionflags: int) -> bool:
        """Whether the output is what was wanted."""
        return super().check_output(want, got, optionflags) or self.agrees(want, got)


def differences(name: str, example: str, folder: Path, agrees: Callable[[str, str], bool]) -> str:
    """What an example prints otherwise than it shows; "" where it is right."""
    test = doctest.DocTestParser().get_doctest(example, {}, name, None, 0)
    told: list[str] = []
    with inside(folder), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        doctest.DocTestRunner(checker=Checker(agrees), verbose=False).run(test, out=told.append)
    return "".join(told)


@contextlib.contextmanager
def inside(folder: Path) -> Iterator[None]:
    """In a folder that has the samples at `meshes`."""
    (folder / "meshes").symlink_to(ROOT / "meshes", target_is_directory=True)
    before = Path.cwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)
