"""What of an exoskeleton can be chosen, and between which numbers it can be built."""

from __future__ import annotations

ROOM: dict[str, tuple[str, float, float]] = {
    "share": ("share", 0.0, 1.5),
    "timing": ("timing", 0.0, 0.6),
    "place": ("strap place", 0.10, 0.34),
    "normal": ("strap normal", 1e3, 2e4),
    "tangential": ("strap tangential", 5e2, 1e4),
    "turning": ("strap turning", 5.0, 100.0),
    "shank_place": ("shank strap place", 0.10, 0.38),
    "shank_normal": ("shank strap normal", 1e3, 2e4),
    "shank_tangential": ("shank strap tangential", 5e2, 1e4),
    "shank_turning": ("shank strap turning", 5.0, 100.0),
    "pelvis_place": ("pelvis strap place", 0.0, 0.22),
    "pelvis_normal": ("pelvis strap normal", 1e3, 2e4),
    "pelvis_tangential": ("pelvis strap tangential", 5e2, 1e4),
    "pelvis_turning": ("pelvis strap turning", 5.0, 100.0),
}
"""What may be sought: parameter, and between which values it can be built, in its unit; invented."""
