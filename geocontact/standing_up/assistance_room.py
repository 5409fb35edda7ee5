"""What of an exoskeleton can be chosen, and between which numbers it can be built."""

from __future__ import annotations

ROOM: dict[str, tuple[str, float, float]] = {
    "share": ("share", 0.0, 1.5),
    "timing": ("timing", 0.0, 0.6),
    "place": ("strap place", 0.10, 0.34),
    "normal": ("strap normal", 1e3, 2e4),
    "tangential": ("strap tangential", 5e2, 1e4),
    "turning": ("strap turning", 5.0, 100.0),
}
"""What may be sought: parameter, and between which values it can be built, in its unit; invented."""
