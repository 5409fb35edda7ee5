"""An empty figure that a notebook shows as a picture, also where pyplot was never imported."""

from __future__ import annotations

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
