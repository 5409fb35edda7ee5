"""An empty figure that a notebook shows, and names and numbers as they are printed in it."""

from __future__ import annotations

import math
import textwrap
from functools import cache
from io import BytesIO
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure


ON_SCREEN = 96.0  # dots per inch


def sheet(width: float, height: float) -> Figure:
    """Return a figure of `width` times `height` [inch] without axes, whose layout finds room for its labels."""
    return _sheet()(figsize=(width, height), layout="constrained")


def png_of(figure: Figure) -> bytes:
    """The figure as it is shown on a screen."""
    picture = BytesIO()
    figure.savefig(picture, format="png", dpi=ON_SCREEN)
    return picture.getvalue()


@cache
def _sheet() -> type[Figure]:
    from matplotlib.figure import Figure

    class Sheet(Figure):
        """IPython draws figures itself once pyplot is there; before that it asks the figure."""

        def _repr_png_(self) -> bytes:
            return png_of(self)

    return Sheet


UNSEEN = "\u200b"  # zero-width space
FIXED = "\u00a0"  # no-break space
HELD = "\ue000"  # for private use: not a blank


def plain(text: str, width: int | None = None) -> str:
    """Text that is drawn as it stands, on lines of at most `width` characters.

    A dollar sign would start a formula, a leading underscore would keep a name out of the legend, and a control
    character would break an SVG file.
    """
    seen = "".join(c if c.isprintable() or c == FIXED else " " if c.isspace() else "\ufffd" for c in text)
    lines = textwrap.wrap(seen.replace(FIXED, HELD), width) if width else [seen]  # a wrap drops blanks at line ends
    drawn = "\n".join(line.replace("$", r"\$").replace(HELD, FIXED) for line in lines)
    return UNSEEN + drawn if drawn.startswith("_") else drawn


def decimals(scale: float, digits: int = 3) -> int:
    """Decimals with which a number of the size of `scale` shows `digits` significant digits; none above 10^digits."""
    if scale == 0.0 or not math.isfinite(scale):
        return 0
    return max(0, digits - 1 - math.floor(math.log10(abs(scale))))


def number(value: float, scale: float | None = None) -> str:
    """`value` to the decimals that suit `scale` (itself if not given), with a minus sign instead of a hyphen."""
    if not math.isfinite(value):
        return "–"
    places = decimals(value if scale is None else scale)
    shown = f"{value:.{places}f}" if places <= 6 else f"{value:.2e}"
    zero = not any(c in "123456789" for c in shown.partition("e")[0])
    return shown.lstrip("-") if zero else shown.replace("-", "−")
