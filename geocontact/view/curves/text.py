"""Names and numbers as they are printed in a figure."""

from __future__ import annotations

import math
import textwrap

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
