"""Commands that write their figures without drawing them, which takes three quarters of a small command's time.

Figures are still made, with all their curves and labels; what is left out is the way from there into files. Tests that
look into such files are marked `drawn`. The figures of every command are drawn by the pages of the documentation,
which are tests, too.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING
from unittest import mock

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BLANK = {
    ".svg": b'<svg xmlns="http://www.w3.org/2000/svg" width="1pt" height="1pt" viewBox="0 0 1 1"></svg>\n',
    ".png": bytes.fromhex(
        "89504e470d0a1a0a0000000d49484452000000010000000108000000003a7e9b550000000a49444154789c63f80f00010101001b"
        "b6ee560000000049454e44ae426082"
    ),
}
"""The smallest picture of each kind."""


def blank(figure: Figure, path: str | Path) -> None:
    """Write an empty picture of the kind that was asked for."""
    Path(path).write_bytes(BLANK[Path(path).suffix])


@contextmanager
def undrawn() -> Iterator[None]:
    """Figures of commands are empty pictures."""
    with mock.patch("geocontact.analyses.frame.pages.save", blank):
        yield


@contextmanager
def unwritten() -> Iterator[None]:
    """Commands write neither figures nor pages, nor make the pages; figures are made, as long as nobody prevents it."""
    with (
        mock.patch("geocontact.analyses.frame.pages.save_both", return_value=b""),
        mock.patch("geocontact.analyses.frame.result.Result._pages", return_value={}),
    ):
        yield
