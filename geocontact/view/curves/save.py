"""Figures into files: vector where the ending says so, the same bytes for the same figure."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from geocontact.view.curves.style import in_style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

UNDATED = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}, ".png": None}
FINE = 300.0  # dots per inch of the layout: with fewer, small letters are hinted to other widths than in the file


@in_style
def save(figure: Figure, path: str | Path) -> None:
    """Write a figure as SVG or PDF (text stays text, can be searched and edited) or as PNG of 300 dots per inch.

    Files carry no date: the same figure with the same version of matplotlib and the same fonts gives the same bytes.
    An SVG file names its font and leaves it to the reader's machine; a PDF file brings it along (TrueType).
    Saving fixes the layout: what is added to the figure afterwards does not move what is there.
    """
    ending = Path(path).suffix.lower()
    if ending not in UNDATED:
        raise ValueError(f"{Path(path).name}: figures are written as {', '.join(UNDATED)}; end the name in one of them")
    if (engine := figure.get_layout_engine()) is not None:
        shown = figure.dpi
        figure.dpi = FINE
        engine.execute(figure)
        figure.dpi = shown
        figure.set_layout_engine(None)  # a second pass would move everything by a hair, and so change the file
    figure.savefig(path, format=ending[1:], metadata=UNDATED[ending])
