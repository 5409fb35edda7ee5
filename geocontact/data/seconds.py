"""Times as text: with microseconds, however late the clock is."""

from __future__ import annotations

DECIMALS = 6
"""Of a second, at least: clocks that count from 1970 leave none of nine digits and two of twelve."""


def is_late(value: float, digits: int) -> bool:
    """Whether so many digits would lose microseconds of a time [s]."""
    return bool(abs(value) >= 10.0 ** (digits - DECIMALS))


def seconds(value: float, digits: int = 12) -> str:
    """A time [s] with so many digits, and with microseconds where these are not enough."""
    if not is_late(value, digits):
        return f"{value:.{digits}g}"
    return f"{value:.{DECIMALS}f}".rstrip("0").rstrip(".")
