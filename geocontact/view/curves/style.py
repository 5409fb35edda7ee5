"""One look for every figure, and the files that it is saved into.

Widths are those of a single and a double column in most journals of the field, type is 8 pt. Colours are those
of Okabe and Ito (2008), "Color Universal Design"; line styles and markers repeat what they say, for print in grey.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

import numpy as np

from geocontact.view.curves.sheet import plain, sheet

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.typing import RcKeyType


P = ParamSpec("P")
T = TypeVar("T")

SINGLE, DOUBLE = 0.085, 0.174  # widths of one and two columns [m]
INCH = 0.0254  # [m]
POINT = INCH / 72.0  # [m]
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7")
PALETTE = (*COLOURS, "#E69F00", "#56B4E9")
LINES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (8, 2)))
MARKERS = ("o", "s", "^", "D", "v", "P")
BLACK, GREY = "black", "0.45"
SMALL = 8.0  # size of legends, ticks and notes [pt]: the least that is read with ease

STYLE: dict[RcKeyType, Any] = {
    "font.family": ["sans-serif", "DejaVu Sans"],  # the second comes with matplotlib and has the rarer letters
    "font.sans-serif": ["Arial", "Helvetica", "Liberation Sans", "DejaVu Sans"],
    "font.size": 8.0,
    "axes.labelsize": 8.0,
    "axes.titlesize": 8.0,
    "legend.fontsize": SMALL,
    "xtick.labelsize": SMALL,
    "ytick.labelsize": SMALL,
    "axes.linewidth": 0.6,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "lines.linewidth": 1.2,
    "lines.markersize": 3.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
    "legend.handlelength": 2.4,
    "savefig.dpi": 300.0,
    "svg.fonttype": "none",  # text stays text
    "svg.hashsalt": "geocontact",  # the same figure gives the same file
    "pdf.fonttype": 42,  # TrueType: text stays text here, too
}


@contextmanager
def style() -> Iterator[None]:
    """Matplotlib's defaults and STYLE while it lasts; the user's own settings come back afterwards."""
    import matplotlib as mpl

    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update(STYLE)
        yield


def in_style(draw: Callable[P, T]) -> Callable[P, T]:
    """`draw`, in the style of the house."""

    @functools.wraps(draw)
    def drawn(*args: P.args, **kwargs: P.kwargs) -> T:
        with style():
            return draw(*args, **kwargs)

    return drawn


@in_style
def empty(width: float = SINGLE, height: float = 0.06) -> Figure:
    """Return a figure of `width` times `height` [m] without axes."""
    return sheet(width / INCH, height / INCH)


@in_style
def panels(rows: int = 1, columns: int = 1, width: float = SINGLE, height: float = 0.06) -> tuple[Figure, list[Axes]]:
    """Return a figure of `width` times `height` [m] and its axes row by row, lettered when there are several."""
    figure = empty(width, height)
    axes = [panel for row in figure.subplots(rows, columns, squeeze=False) for panel in row]
    for letter, panel in zip("abcdefghijklmnopqrstuvwxyz" if len(axes) > 1 else "", axes, strict=False):
        panel.annotate(
            letter,
            (0.0, 1.0),
            xycoords="axes fraction",
            xytext=(-30.0, 4.0),
            textcoords="offset points",
            fontweight="bold",
            fontsize=9.0,
        )
    return figure, axes


def on(axes: Axes | None, width: float = SINGLE, height: float = 0.06) -> tuple[Figure, Axes]:
    """Return the axes to draw on, with their figure: those given, or new ones."""
    if axes is None:
        figure, made = panels(width=width, height=height)
        return figure, made[0]
    figure_of = axes.get_figure(root=True)
    if figure_of is None:
        raise ValueError("axes: not part of a figure")
    return figure_of, axes


def legend(axes: Axes, entries: Sequence[tuple[Artist | tuple[Artist, ...], str]], title: str | None = None) -> None:
    """Legend above the axes, where it covers nothing, headed by `title`; names are wrapped to the width there is."""
    grid = axes.get_subplotspec()
    columns = grid.get_gridspec().ncols if grid is not None else 1
    width = (on(axes)[0].get_size_inches()[0] * INCH / columns - 0.016) / POINT
    letter, handle = 0.56 * SMALL, 3.8 * SMALL  # mean width of a letter; line, gap and distance to the next column
    labels = [plain(text, width=max(12, int((width - handle) / letter))) for _, text in entries]
    longest = max(len(line) for label in labels for line in label.split("\n"))
    fitting = int(np.clip(width / (longest * letter + handle), 1, len(entries)))
    rows = -(-len(entries) // fitting)
    axes.legend(
        [artist for artist, _ in entries],
        labels,
        ncols=-(-len(entries) // rows),
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0),
        borderaxespad=0.2,
        borderpad=0.2,
        labelspacing=0.3,
        columnspacing=1.4,
        title=title,
        alignment="left",
    )


UNDATED = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}, ".png": None}
EFFORT = 4  # of compression: 6, the usual one, makes files 3 % smaller and takes twice as long
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
    packing: dict[str, Any] = {"pil_kwargs": {"compress_level": EFFORT}} if ending == ".png" else {}
    figure.savefig(path, format=ending[1:], metadata=UNDATED[ending], **packing)
