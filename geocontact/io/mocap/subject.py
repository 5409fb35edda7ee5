"""Labels of markers with the subject before a colon: S1:R.Heel."""

from __future__ import annotations

from collections.abc import Sequence


def without_subject(labels: Sequence[str]) -> list[str]:
    """Labels without what stands before a colon, unless two different ones would then be alike."""
    short = [label.rpartition(":")[2] for label in labels]
    return short if len(set(short)) == len(set(labels)) else list(labels)
