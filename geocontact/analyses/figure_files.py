"""A figure in the two forms in which every command leaves it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from geocontact.view.curves.style import save

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def save_both(figure: Figure, folder: Path, name: str) -> bytes:
    """Write `name`.png and `name`.svg; returns the drawing that scales, for the page."""
    for ending in ("png", "svg"):
        save(figure, folder / f"{name}.{ending}")
    return (folder / f"{name}.svg").read_bytes()


def drawing(figure: Figure) -> bytes:
    """The drawing that scales, as a page holds it."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "figure.svg"
        save(figure, file)
        return file.read_bytes()


class Drawings(Mapping[str, bytes]):
    """Figures by name as pages hold them, each drawn once, when it is asked for.

    Parameters
    ----------
    figures
        Makes all figures by name.
    """

    def __init__(self, figures: Callable[[], Mapping[str, Figure]]) -> None:
        self._figures = figures
        self._drawn: dict[str, bytes] = {}

    @cached_property
    def figures(self) -> Mapping[str, Figure]:
        """The figures."""
        return self._figures()

    def __getitem__(self, name: str) -> bytes:
        if name not in self._drawn:
            self._drawn[name] = drawing(self.figures[name])
        return self._drawn[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.figures)

    def __len__(self) -> int:
        return len(self.figures)
