"""What a motion that is not certified is told by."""

from __future__ import annotations

from geocontact.dynamics.collocation.certificate import Certificate
from geocontact.dynamics.collocation.refinement import MOST_HALVINGS


def not_certified(place: str, seen: Certificate) -> str:
    """What failed, and how fine the mesh is that was refined as often as it may be."""
    mesh = f"{seen.intervals} intervals down to {1e3 * seen.shortest:.2g} ms, each halved {MOST_HALVINGS} times at most"
    return f"{place} is not certified: {'; '.join(seen.failed)}; on {mesh}; give more `nodes`"
