"""A page inside a notebook: live, in a frame of its own, small enough for the notebook to stay readable."""

from __future__ import annotations

from dataclasses import dataclass, field
from html import escape

LARGEST_EMBEDDED = 2_000_000
"""Bytes of a page in a notebook; pages of many frames show fewer until they fit."""


@dataclass(frozen=True)
class Embedded:
    """A page as a notebook shows it.

    It is part of the notebook and needs no file beside it. The frame lets it run its own scripts and save pictures, and
    nothing else: it reaches neither the notebook nor the network.

    Parameters
    ----------
    page
        The page, one HTML text.
    height
        Of the frame, in pixels.
    """

    page: str = field(repr=False)
    height: int

    def _repr_html_(self) -> str:
        """The frame."""
        return (
            f'<iframe srcdoc="{escape(self.page)}" sandbox="allow-scripts allow-downloads" title="page of the result" '
            f'style="width: 100%; height: {self.height}px; border: 0"></iframe>'
        )
