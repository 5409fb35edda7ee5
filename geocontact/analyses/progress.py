"""Nothing is shown; goes as soon as every analysis has its listener."""

from __future__ import annotations

from contextlib import nullcontext
from typing import Any


def preparing() -> Any:
    """Nothing."""
    return nullcontext()


def progress(label: str, total: int) -> Any:
    """Nothing."""
    return nullcontext(lambda: (label, total))


def stages(label: str) -> Any:
    """Nothing."""
    return nullcontext(lambda _: label)
