"""A number that a model needs and where it is from: the paper, derived from it, or invented."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Source = Literal["paper", "derived", "invented"]
SOURCES: tuple[Source, ...] = ("paper", "derived", "invented")


@dataclass(frozen=True)
class Number:
    """A number in SI, where it is from, and why it is so."""

    value: float
    source: Source
    note: str = ""
